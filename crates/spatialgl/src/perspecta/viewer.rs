//! The view of an eye at any position during one revolution: the sum of the light of all lit pixels in all strobes.

use crate::{BitPlanes, ColourSample, Rotation, Size, VolumeFrame, Workers, sin_cos_of_turn};
use image::{Rgb, RgbImage};
use pxpl5_sim::parameters::SettingError;
use std::sync::{Mutex, PoisonError};

/// Light of one lit pixel in one strobe (flash), in integer units. With 256 x 256 units, the parts of this light for
/// four neighbouring picture pixels are integers.
const FULL: u64 = 1 << 16;

/// Number of slices whose light one task sums up, before the task adds this sum to the total.
const SLICES_PER_TASK: u32 = 33;

/// The position of an eye in front of the display, and the size of the eye's picture. The eye looks at the middle of
/// the display, and y points downwards in the picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// Azimuth of the eye: angle around the axis from +z to +x, degrees.
    pub azimuth_deg: f64,
    /// Elevation of the eye above the horizon, degrees.
    pub elevation_deg: f64,
    /// Distance of the eye from the middle of the display, in pixels of the display.
    pub distance: f64,
    /// Focal length of the picture, in pixels of the picture.
    pub focal: f64,
    pub size: Size,
}

impl Camera {
    /// Creates an eye four radii away from a display of this radius, with a picture about as wide as the display.
    pub fn around(radius: f64, azimuth_deg: f64, elevation_deg: f64, side: u32) -> Self {
        let focal = f64::from(side) * 1.9;
        Self { azimuth_deg, elevation_deg, distance: 4.0 * radius, focal, size: [side, side] }
    }

    /// Checks that the camera is outside a display with slices of this size, and that its other numbers are valid.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the number that is out of range.
    pub fn check_before(&self, slice: Size) -> Result<(), SettingError> {
        let [half_width, half_height] = slice.map(|side| f64::from(side) / 2.0);
        let reach = libm::hypot(half_width, half_height);
        let rule = |holds: bool, name, expected, found: f64| {
            SettingError::require(holds, name, expected, found).map_err(|error| error.in_table("view"))
        };
        rule(self.azimuth_deg.is_finite(), "azimuth", "a finite angle", self.azimuth_deg)?;
        rule(self.elevation_deg.is_finite(), "elevation", "a finite angle", self.elevation_deg)?;
        // The eye must be outside of the sphere that contains all voxels.
        let is_outside = self.distance.is_finite() && self.distance > reach;
        rule(is_outside, "distance", "an eye outside of the display", self.distance)?;
        rule(self.focal.is_finite() && self.focal > 0.0, "focal", "a length above 0 px", self.focal)?;
        for side in self.size {
            rule((1..=8192).contains(&side), "size", "1 to 8192 px", f64::from(side))?;
        }
        Ok(())
    }

    /// Returns the axes of the eye as unit vectors: to the right, upwards, and from the middle of the display to the
    /// eye.
    fn axes(&self) -> [[f64; 3]; 3] {
        let (sin_a, cos_a) = libm::sincos(self.azimuth_deg.to_radians());
        let (sin_e, cos_e) = libm::sincos(self.elevation_deg.to_radians());
        [[cos_a, 0.0, -sin_a], [-sin_e * sin_a, cos_e, -sin_e * cos_a], [cos_e * sin_a, sin_e, cos_e * cos_a]]
    }

    /// Returns the position of a world point in the picture, in pixels from the top left.
    pub fn project(&self, world: [f64; 3]) -> [f64; 2] {
        let [right, up, back] = self.axes().map(|axis| dot(axis, world));
        let scale = self.focal / (self.distance - back);
        let [width, height] = self.size.map(f64::from);
        [width / 2.0 + right * scale, height / 2.0 - up * scale]
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Options of a view: the part of the volume to show, and the dependence of brightness on the angle of the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ViewOptions {
    /// Range of angles around the axis in which nothing is shown (a cutaway), in degrees from +x to +z. `None` shows
    /// everything.
    pub cut_deg: Option<[f64; 2]>,
    /// True if brightness depends on the angle of the screen. The factor is |view . e_s|, the cosine of the angle
    /// between the direction of view and the screen's normal.
    pub lambert: bool,
    /// Angle of slice 0 from +x towards +z, degrees.
    pub phase_deg: f64,
    pub rotation: Rotation,
}

impl ViewOptions {
    /// Returns the angle of slice `k` in degrees, from +x to +z, with the angle's sine and cosine.
    fn angle(&self, k: u32, slices: u32) -> (f64, f64, f64) {
        let is_forward = self.rotation == Rotation::XToZ;
        let steps = if is_forward { i64::from(k) } else { -i64::from(k) };
        let degrees = 360.0 * steps as f64 / f64::from(slices) + self.phase_deg;
        let (sin, cos) =
            if self.phase_deg == 0.0 { sin_cos_of_turn(steps, slices) } else { libm::sincos(degrees.to_radians()) };
        (degrees, sin, cos)
    }
}

/// The light that reaches each pixel of a picture, in integer units. Integer sums are exact in any order and on any
/// number of threads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureLight {
    size: Size,
    sums: Vec<[u64; 3]>,
}

impl PictureLight {
    fn dark(size: Size) -> Self {
        Self { size, sums: vec![[0; 3]; size[0] as usize * size[1] as usize] }
    }

    /// Returns the sum of the light over the picture for each channel. The unit is the light of one lit pixel in one
    /// strobe (flash).
    pub fn total(&self) -> [f64; 3] {
        let mut sums = [0.0; 3];
        for pixel in &self.sums {
            for (sum, value) in sums.iter_mut().zip(pixel) {
                *sum += *value as f64 / FULL as f64;
            }
        }
        sums
    }

    /// Returns the exposure at which a fraction `share` (0 to 1) of the lit picture pixels stays below white.
    pub fn exposure(&self, share: f64) -> f64 {
        let lit = self.sums.iter().map(|pixel| pixel[0].max(pixel[1]).max(pixel[2])).filter(|value| *value > 0);
        let mut lit: Vec<u64> = lit.collect();
        if lit.is_empty() {
            return 1.0;
        }
        let at = ((lit.len() - 1) as f64 * share.clamp(0.0, 1.0)) as usize;
        let (_, value, _) = lit.select_nth_unstable(at);
        255.0 * FULL as f64 / *value as f64
    }

    /// Returns the picture. `exposure` is the brightness, in steps of 1/255, that one lit pixel gives in one strobe
    /// (flash).
    pub fn picture(&self, exposure: f64) -> RgbImage {
        let mut picture = RgbImage::new(self.size[0], self.size[1]);
        for (pixel, sums) in picture.pixels_mut().zip(&self.sums) {
            *pixel = Rgb(sums.map(|sum| (sum as f64 * exposure / FULL as f64 + 0.5) as u8));
        }
        picture
    }

    fn add(&mut self, other: &Self) {
        for (sum, more) in self.sums.iter_mut().zip(&other.sums) {
            *sum = [0, 1, 2].map(|c| sum[c] + more[c]);
        }
    }

    /// Adds a point of light, divided among the four nearest picture pixels. `levels` are 0 to 255, and `weight` is 0
    /// to 256.
    #[inline(always)]
    fn splat(&mut self, [x, y]: [f64; 2], levels: [u64; 3], weight: u64) {
        let left = (x - 0.5).floor();
        let top = (y - 0.5).floor();
        let across = ((x - 0.5 - left) * 256.0 + 0.5) as u64;
        let down = ((y - 0.5 - top) * 256.0 + 0.5) as u64;
        // The point lies between four pixels. Each gets its bilinear share.
        for (row, part) in [(top, 256 - down), (top + 1.0, down)] {
            for (column, share) in [(left, 256 - across), (left + 1.0, across)] {
                let is_inside = row >= 0.0 && column >= 0.0 && row < f64::from(self.size[1]);
                if is_inside && column < f64::from(self.size[0]) {
                    let sum = &mut self.sums[row as usize * self.size[0] as usize + column as usize];
                    let light = part * share * weight;
                    *sum = [0, 1, 2].map(|c| sum[c] + light * levels[c] / (255 * 256));
                }
            }
        }
    }
}

/// Returns the light that an eye receives from a volume in one revolution of the screen, after halftoning.
///
/// # Errors
///
/// Returns a [`SettingError`] if a number of the camera is out of range.
pub fn view_planes(
    planes: &BitPlanes,
    camera: &Camera,
    options: ViewOptions,
    workers: &dyn Workers,
) -> Result<PictureLight, SettingError> {
    sum(planes.size(), planes.slices(), camera, options, workers, &|k, each| {
        let row = planes.size()[0] / 8;
        for (at, word) in (0u32..).zip(planes.slice(k)).filter(|(_, word)| **word != 0) {
            // Visit the lit pixels of a word. Bit 7 is the leftmost pixel.
            let mut rest = (word | word >> 8 | word >> 16) & 0xFF;
            while rest != 0 {
                let bit = rest.ilog2();
                rest &= !(1 << bit);
                let levels = [0, 8, 16].map(|shift| 255 * u64::from(word >> (bit + shift) & 1));
                each(at % row * 8 + 7 - bit, at / row, levels);
            }
        }
    })
}

/// Returns the light that an eye receives from a volume in one revolution, before halftoning, with all 256 levels. A
/// comparison with [`view_planes`] shows the loss by the dither.
///
/// Returns `None` if the frame was made without its colours.
///
/// # Errors
///
/// The same as [`view_planes`].
pub fn view_undithered(
    frame: &VolumeFrame,
    camera: &Camera,
    options: ViewOptions,
    workers: &dyn Workers,
) -> Result<Option<PictureLight>, SettingError> {
    let Some(colours) = frame.colours.as_ref() else { return Ok(None) };
    let size = frame.planes.size();
    let light = sum(size, frame.planes.slices(), camera, options, workers, &|k, each| {
        let drawn = colours.len() as u32;
        // Slices that were not drawn show a drawn slice mirrored.
        let is_mirrored = k >= drawn;
        for ColourSample { pixel, colour } in &colours[(k % drawn) as usize] {
            let x = pixel % size[0];
            each(if is_mirrored { size[0] - 1 - x } else { x }, pixel / size[0], colour.map(u64::from));
        }
    })?;
    Ok(Some(light))
}

/// A function that receives the index of a slice and a callback. The function calls the callback with column, row and
/// levels of every lit pixel.
type EachPixel<'a> = dyn Fn(u32, &mut dyn FnMut(u32, u32, [u64; 3])) + Sync + 'a;

fn sum(
    size: Size,
    slices: u32,
    camera: &Camera,
    options: ViewOptions,
    workers: &dyn Workers,
    pixels: &EachPixel<'_>,
) -> Result<PictureLight, SettingError> {
    camera.check_before(size)?;
    // Each task sums a range of slices, so that the lock is taken rarely.
    let total = Mutex::new(PictureLight::dark(camera.size));
    let part = |first: u32| {
        let mut light = PictureLight::dark(camera.size);
        for k in first..(first + SLICES_PER_TASK).min(slices) {
            let strobe = Strobe::new(k, slices, size, camera, options);
            pixels(k, &mut |x, y, levels| strobe.add(&mut light, x, y, levels));
        }
        total.lock().unwrap_or_else(PoisonError::into_inner).add(&light);
    };
    let firsts = (0..slices).step_by(SLICES_PER_TASK as usize);
    workers.run(firsts.map(|first| Box::new(move || part(first)) as crate::Task<'_>).collect());
    Ok(total.into_inner().unwrap_or_else(PoisonError::into_inner))
}

/// The geometry of the screen during one strobe (flash), in the coordinates of the eye.
struct Strobe {
    half: [f64; 2],
    /// Vectors from a screen pixel to the next pixel on its right (`across`) and above (`upward`). The components are
    /// right, up and back along the eye's axes.
    across: [f64; 3],
    upward: [f64; 3],
    normal: [f64; 3],
    distance: f64,
    focal: f64,
    centre: [f64; 2],
    lambert: bool,
    /// Flags of the two halves of the screen, left and right of the axis: true if the cutaway hides the half.
    cut: [bool; 2],
}

impl Strobe {
    fn new(k: u32, slices: u32, size: Size, camera: &Camera, options: ViewOptions) -> Self {
        let (angle, sin, cos) = options.angle(k, slices);
        let axes = camera.axes();
        let turned = |direction: [f64; 3]| axes.map(|axis| dot(axis, direction));
        Self {
            half: size.map(|side| f64::from(side) / 2.0),
            across: turned([cos, 0.0, sin]),
            upward: turned([0.0, 1.0, 0.0]),
            normal: turned([-sin, 0.0, cos]),
            distance: camera.distance,
            focal: camera.focal,
            centre: camera.size.map(|side| f64::from(side) / 2.0),
            lambert: options.lambert,
            // The half of a slice with u < 0 points in the opposite direction.
            cut: [is_cut(options.cut_deg, angle + 180.0), is_cut(options.cut_deg, angle)],
        }
    }

    #[inline(always)]
    fn add(&self, light: &mut PictureLight, x: u32, y: u32, levels: [u64; 3]) {
        let u = f64::from(x) + 0.5 - self.half[0];
        let v = self.half[1] - f64::from(y) - 0.5;
        if self.cut[usize::from(u >= 0.0)] {
            return;
        }
        let [right, up, back] = [0, 1, 2].map(|i| u * self.across[i] + v * self.upward[i]);
        let ahead = self.distance - back;
        let scale = self.focal / ahead;
        let weight = if self.lambert { self.facing([-right, -up, ahead]) } else { 256 };
        light.splat([self.centre[0] + right * scale, self.centre[1] - up * scale], levels, weight);
    }

    /// Returns the absolute cosine of the angle between the direction of view and the screen's normal, in steps of
    /// 1/256.
    fn facing(&self, to_eye: [f64; 3]) -> u64 {
        let length = dot(to_eye, to_eye).sqrt();
        (256.0 * (dot(self.normal, to_eye) / length).abs() + 0.5) as u64
    }
}

/// Returns true if an angle lies in the range `cut`. The range may wrap at 360 degrees.
fn is_cut(cut: Option<[f64; 2]>, angle: f64) -> bool {
    let Some([from, to]) = cut else { return false };
    let past = (angle - from).rem_euclid(360.0);
    to - from >= 360.0 || past < (to - from).rem_euclid(360.0)
}

/// Returns `frames` pictures from viewpoints on a circle around a volume. The first viewpoint is the camera's own, and
/// all pictures have the same exposure.
///
/// # Errors
///
/// The same as [`view_planes`], for every picture.
pub fn film(
    planes: &BitPlanes,
    camera: Camera,
    options: ViewOptions,
    frames: u32,
    workers: &dyn Workers,
) -> impl Iterator<Item = Result<RgbImage, SettingError>> {
    let mut exposure = None;
    (0..frames).map(move |i| {
        let azimuth_deg = camera.azimuth_deg + 360.0 * f64::from(i) / f64::from(frames);
        let light = view_planes(planes, &Camera { azimuth_deg, ..camera }, options, workers)?;
        // The first picture determines the exposure of the film.
        let exposure = *exposure.get_or_insert_with(|| light.exposure(0.98));
        Ok(light.picture(exposure))
    })
}
