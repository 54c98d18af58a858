//! A user who moves around the volume, and the same user with a head-mounted display of the same latency.
//!
//! A volume stands still: whoever moves sees another side of it at once, and what is wrong with it is where its voxels lie. A
//! head-mounted display draws each picture for where the head was, so that what is wrong with it is its latency.
//!
//! # Behaviour
//!
//! - The display stands upright before the head: its middle `viewer.distance_mm` ahead of where the motion begins, its +z axis towards
//!   it. The scene is the same for both displays, in the volume's place.
//! - Errors are taken at [`POINTS`] vertices of the scene, for both eyes. *Head-mounted*: the angle between where a point is drawn, for
//!   the pose one latency ago, and where it is. *Volume*: the angle between a point and the voxel that shows it, in the slice nearest
//!   to it.
//! - Dither: a colour's level is right on the mean of a cell of the matrix; the cell's angle is how coarse that is.
//! - Pictures: each eye looks at the middle of the volume, upright. What the head-mounted display shows it is drawn for the eye of one
//!   latency ago, and moved by as much as its middle is off.
//!
//! # Not modelled
//!
//! A predicting tracker, tracker noise and the head-mounted display's own pixels (their angle is reported); roll of the head in
//! pictures; the eye's resolution.

use crate::error::VolumeError;
use crate::experiment::Volume;
use crate::numbers::ViewerNumbers;
use crate::pictures::{Look, grid};
use glam::{DMat4, DQuat, DVec2, DVec3};
use image::{Rgb, RgbImage};
use serde::Serialize;
use spatialgl::{
    Bin, Coverage, FlatDisplay, HostRenderer, SliceImage, SliceRenderer, SliceWork, SpatialDisplay, Workers,
};
use tracking::Pose;
use tracking::motion::Motion;
use tracking::view::HmdView;

/// Vertices of the scene at which errors are taken (assumed: the mean does not move any more).
pub const POINTS: usize = 512;

/// Picoseconds of a second.
const PS_PER_S: f64 = 1e12;

/// Errors at one instant, over all points and both eyes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HeadSample {
    /// Time since the motion began, seconds.
    pub time_s: f64,
    /// Where the head is: angle around the volume from its +z to its +x axis, degrees.
    pub azimuth_deg: f64,
    /// Where the head is: angle above the volume's middle, degrees.
    pub elevation_deg: f64,
    /// Distance of the head from the volume's middle, millimetres.
    pub distance_mm: f64,
    /// Head-mounted display: mean angle between drawn and true place, degrees; none with every point behind the eye.
    pub hmd_mean_deg: Option<f64>,
    /// Head-mounted display: the largest such angle, degrees.
    pub hmd_worst_deg: Option<f64>,
    /// The mean in pixels of the head-mounted display.
    pub hmd_mean_px: Option<f64>,
    /// The mean at the points' distance, millimetres.
    pub hmd_mean_mm: Option<f64>,
    /// Volume: mean angle between a point and its voxel, degrees.
    pub voxel_mean_deg: f64,
    /// Volume: the largest such angle, degrees.
    pub voxel_worst_deg: f64,
    /// Volume: the mean distance between a point and its voxel, across the line of sight, millimetres.
    pub voxel_mean_mm: f64,
    /// Angle of a cell of the dither matrix in the middle of the volume, degrees.
    pub dither_cell_deg: f64,
}

/// A head before a volume.
#[derive(Clone, Debug, Serialize)]
pub struct HeadStudy {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// Name of the scene.
    pub scene: String,
    /// Latency of the head-mounted display, milliseconds.
    pub latency_ms: f64,
    /// Whose latency that is.
    pub latency_is: &'static str,
    /// Latency of the volume itself, milliseconds: how late it shows what changes in the scene.
    pub volume_latency_ms: Option<f64>,
    /// Angle of a pixel in the middle of the head-mounted display, degrees.
    pub hmd_pixel_deg: f64,
    /// Edge of a voxel in a slice, millimetres.
    pub voxel_mm: f64,
    /// The instants, from one latency after the beginning of the motion.
    pub samples: Vec<HeadSample>,
}

/// What is asked of a head.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeadQuestion {
    /// Latency of the head-mounted display, milliseconds; none for that of the volume.
    pub latency_ms: Option<f64>,
    /// Length of the study, seconds.
    pub seconds: f64,
    /// Instants of it, 2 or more.
    pub instants: u32,
}

/// A volume with a head before it.
#[derive(Debug)]
pub struct HeadBefore<'a> {
    volume: &'a Volume,
    motion: &'a dyn Motion,
    viewer: ViewerNumbers,
    /// From the world of the motion, metres, to the volume, pixels.
    into_volume: DMat4,
    latency_ps: u64,
    /// Points of the scene and the voxels that show them, pixels of the volume.
    points: Vec<[DVec3; 2]>,
}

impl Volume {
    /// How late the volume shows what changes in the scene, milliseconds: the time of the model for one volume, and on the mean half a
    /// turn until strobe 0 and a quarter until the plane is met. None if no GPU drew it.
    #[must_use]
    pub fn latency_ms(&self) -> Option<f64> {
        let turn_ms = 60e3 / self.settings.display.spin_rpm as f64;
        let serial_hz = self.bounds.is_none().then(|| self.time().serial_hz())?;
        Some(1e3 / serial_hz + turn_ms * 0.75)
    }
}

impl<'a> HeadBefore<'a> {
    /// Puts a volume before a moving head.
    ///
    /// # Errors
    ///
    /// [`VolumeError::Missing`] for a latency that is negative or no number, and where there is none.
    pub fn new(volume: &'a Volume, motion: &'a dyn Motion, latency_ms: Option<f64>) -> Result<Self, VolumeError> {
        let wrong = |found: String| VolumeError::Missing {
            what: "latency",
            expected: "0 to 10000 ms (--latency; Pixel-Planes 5 has none of its own here)".to_owned(),
            found,
        };
        let latency_ms = latency_ms.or_else(|| volume.latency_ms()).ok_or_else(|| wrong("none".to_owned()))?;
        if !(0.0..=10_000.0).contains(&latency_ms) {
            return Err(wrong(latency_ms.to_string()));
        }
        let viewer = volume.settings.viewer;
        let points = points(volume);
        let latency_ps = (latency_ms * 1e9) as u64;
        Ok(Self { volume, motion, viewer, into_volume: placed(&motion.pose(0), volume, &viewer), latency_ps, points })
    }

    fn view(&self) -> Result<HmdView, VolumeError> {
        let width = self.viewer.hmd_width_px as u32;
        HmdView::new(width, width * 3 / 4, self.viewer.hmd_angle_deg).map_err(|error| VolumeError::Missing {
            what: "viewer",
            expected: "a head-mounted display that can be".to_owned(),
            found: error.to_string(),
        })
    }

    fn millimetres_per_pixel(&self) -> f64 {
        self.viewer.diameter_mm / self.volume.settings.display.width as f64
    }

    /// The pose of an eye: -1 the left one, 1 the right one.
    fn eye(&self, time_ps: u64, side: f64) -> Pose {
        let head = self.motion.pose(time_ps);
        let across = head.orientation * DVec3::X * (side * self.viewer.eye_separation_mm / 2e3);
        Pose { position: head.position + across, ..head }
    }

    /// Errors at every instant.
    ///
    /// # Errors
    ///
    /// [`VolumeError::Missing`] for a length that is no time, fewer than two instants, and a view that cannot be.
    pub fn study(&self, question: &HeadQuestion) -> Result<HeadStudy, VolumeError> {
        let view = self.view()?;
        let samples = self.instants(question)?.into_iter().map(|time_ps| self.sample(time_ps, &view)).collect();
        let volume_latency_ms = self.volume.latency_ms();
        let is_own = question.latency_ms.is_none();
        Ok(HeadStudy {
            schema: "pxpl5-volume-head/1",
            scene: self.volume.scene.clone(),
            latency_ms: self.latency_ps as f64 / 1e9,
            latency_is: if is_own { "the volume's" } else { "given" },
            volume_latency_ms,
            hmd_pixel_deg: (1.0 / view.focal_px()).atan().to_degrees(),
            voxel_mm: self.millimetres_per_pixel(),
            samples,
        })
    }

    /// Instants, evenly spread from one latency on.
    fn instants(&self, question: &HeadQuestion) -> Result<Vec<u64>, VolumeError> {
        let HeadQuestion { seconds, instants, .. } = *question;
        let wrong =
            |what, expected: &str, found: String| VolumeError::Missing { what, expected: expected.to_owned(), found };
        if !(seconds > 0.0 && seconds <= 3600.0) {
            return Err(wrong("length", "above 0 s and at most an hour", seconds.to_string()));
        }
        if instants < 2 {
            return Err(wrong("instants", "2 or more", instants.to_string()));
        }
        let step = seconds * PS_PER_S / f64::from(instants - 1);
        Ok((0..instants).map(|i| self.latency_ps + (f64::from(i) * step) as u64).collect())
    }

    fn sample(&self, time_ps: u64, view: &HmdView) -> HeadSample {
        let mut hmd = Mean::default();
        let mut hmd_px = Mean::default();
        let mut hmd_mm = Mean::default();
        let mut voxel = Mean::default();
        let mut voxel_mm = Mean::default();
        let from_volume = self.into_volume.inverse();
        for side in [-1.0, 1.0] {
            let seen_from = self.eye(time_ps, side);
            let drawn_for = self.eye(time_ps - self.latency_ps, side);
            let eye = self.into_volume.transform_point3(seen_from.position);
            for [point, shown] in &self.points {
                let distance_mm = (*point - eye).length() * self.millimetres_per_pixel();
                let angle = angle_between(*point - eye, *shown - eye);
                voxel.add(angle.to_degrees());
                voxel_mm.add(angle * distance_mm);
                if let Some(error) = view.pixel_error(from_volume.transform_point3(*point), &drawn_for, &seen_from) {
                    hmd.add(error.degrees);
                    hmd_px.add(error.pixels);
                    hmd_mm.add(error.degrees.to_radians() * distance_mm);
                }
            }
        }
        let head = self.into_volume.transform_point3(self.motion.pose(time_ps).position);
        let [azimuth_deg, elevation_deg] = around(head);
        let cell = self.volume.settings.draw.matrix as f64 / head.length();
        HeadSample {
            time_s: time_ps as f64 / PS_PER_S,
            azimuth_deg,
            elevation_deg,
            distance_mm: head.length() * self.millimetres_per_pixel(),
            hmd_mean_deg: hmd.mean(),
            hmd_worst_deg: hmd.worst(),
            hmd_mean_px: hmd_px.mean(),
            hmd_mean_mm: hmd_mm.mean(),
            voxel_mean_deg: voxel.mean().unwrap_or(0.0),
            voxel_worst_deg: voxel.worst().unwrap_or(0.0),
            voxel_mean_mm: voxel_mm.mean().unwrap_or(0.0),
            dither_cell_deg: (cell / 2.0).atan().to_degrees() * 2.0,
        }
    }

    /// What both eyes see: above of the volume, left and right, below of the head-mounted display. `exposure` as of
    /// [`Look::picture`].
    ///
    /// # Errors
    ///
    /// [`VolumeError`] for a side that is no multiple of 8, and an eye within the display.
    pub fn picture(
        &self,
        time_ps: u64,
        side: u32,
        exposure: f64,
        workers: &dyn Workers,
    ) -> Result<RgbImage, VolumeError> {
        let mut shown = Vec::new();
        for eye in [-1.0, 1.0] {
            shown.push(self.look(time_ps, eye, side)?.picture(self.volume, Some(exposure), workers)?);
        }
        for eye in [-1.0, 1.0] {
            shown.push(self.head_mounted(time_ps, eye, side)?);
        }
        Ok(grid(&shown, 2))
    }

    /// An exposure for all pictures: that of the left eye at an instant.
    ///
    /// # Errors
    ///
    /// As [`Self::picture`].
    pub fn exposure(&self, time_ps: u64, side: u32, workers: &dyn Workers) -> Result<f64, VolumeError> {
        self.look(time_ps, -1.0, side)?.exposure(self.volume, workers)
    }

    /// Instants of a film.
    ///
    /// # Errors
    ///
    /// As [`Self::study`].
    pub fn film_instants(&self, question: &HeadQuestion, frames: u32) -> Result<Vec<u64>, VolumeError> {
        self.instants(&HeadQuestion { instants: frames, ..*question })
    }

    fn look(&self, time_ps: u64, side: f64, picture_px: u32) -> Result<Look, VolumeError> {
        let eye = self.into_volume.transform_point3(self.eye(time_ps, side).position);
        let [azimuth_deg, elevation_deg] = around(eye);
        let mut look = Look::around(&self.volume.settings, azimuth_deg, elevation_deg, picture_px);
        look.camera.distance = eye.length();
        look.check(&self.volume.settings)?;
        Ok(look)
    }

    fn head_mounted(&self, time_ps: u64, side: f64, picture_px: u32) -> Result<RgbImage, VolumeError> {
        let then = time_ps - self.latency_ps;
        let look = self.look(then, side, picture_px)?;
        let camera = look.camera;
        let azimuth = camera.azimuth_deg.to_radians();
        let elevation = camera.elevation_deg.to_radians();
        let display = FlatDisplay::around(camera.size, azimuth, elevation, camera.distance, camera.focal)?;
        let commands = &self.volume.commands;
        let bin = Bin::new(commands, (0..commands.primitives() as u32).collect());
        let mut drawn = SliceImage::new(camera.size);
        let work = SliceWork { commands, bin: &bin, coverage: Coverage::Sampled };
        HostRenderer.render(work, &display.views()[0], &mut drawn);
        let middle = self.into_volume.inverse().transform_point3(DVec3::ZERO);
        let then = direction(&self.eye(then, side), middle);
        let now = direction(&self.eye(time_ps, side), middle);
        let dark = RgbImage::new(picture_px, picture_px);
        let (Some(then), Some(now)) = (then, now) else { return Ok(dark) };
        Ok(moved(&drawn, (then - now) * camera.focal))
    }
}

/// Where a point is seen in a head's flat picture of focal length 1, x to the right and y down; none behind the head.
fn direction(head: &Pose, point: DVec3) -> Option<DVec2> {
    let seen = head.view_of(point);
    (seen.z < -1e-6).then(|| DVec2::new(seen.x, -seen.y) / -seen.z)
}

fn moved(image: &SliceImage, by: DVec2) -> RgbImage {
    let [width, height] = image.size();
    let by = by.round();
    RgbImage::from_fn(width, height, |x, y| {
        let source = DVec2::new(f64::from(x), f64::from(y)) - by;
        let inside = source.cmpge(DVec2::ZERO).all() && source.x < f64::from(width) && source.y < f64::from(height);
        Rgb(if inside { image.pixel(source.x as u32, source.y as u32) } else { [0; 3] })
    })
}

/// The upright volume before a head: from metres of the world to pixels of the volume.
fn placed(head: &Pose, volume: &Volume, viewer: &ViewerNumbers) -> DMat4 {
    let ahead = head.orientation * DVec3::NEG_Z;
    let yaw = DQuat::from_rotation_y(libm::atan2(-ahead.x, -ahead.z));
    let middle = head.position + yaw * DVec3::NEG_Z * (viewer.distance_mm / 1e3);
    let pixels_per_metre = volume.settings.display.width as f64 / viewer.diameter_mm * 1e3;
    let turn = DMat4::from_quat(yaw.conjugate());
    DMat4::from_scale(DVec3::splat(pixels_per_metre)) * turn * DMat4::from_translation(-middle)
}

/// Azimuth and elevation of a place, degrees, as cameras have them.
fn around(place: DVec3) -> [f64; 2] {
    let level = libm::hypot(place.x, place.z);
    [libm::atan2(place.x, place.z).to_degrees(), libm::atan2(place.y, level).to_degrees()]
}

/// Vertices that the display shows, evenly spread over the list, and the voxels that show them.
fn points(volume: &Volume) -> Vec<[DVec3; 2]> {
    let shown: Vec<DVec3> = volume
        .commands
        .positions()
        .iter()
        .map(|position| DVec3::from_array(*position))
        .filter(|point| volume.display.shows(*point))
        .collect();
    let step = shown.len().div_ceil(POINTS).max(1);
    shown.iter().step_by(step).filter_map(|point| Some([*point, voxel_of(volume, *point)?])).collect()
}

/// The middle of the pixel in which a point is drawn, in the nearest slice of the first half turn.
fn voxel_of(volume: &Volume, point: DVec3) -> Option<DVec3> {
    let views = volume.display.views();
    let half = &views[..views.len().div_ceil(2)];
    let off = |view: &spatialgl::SliceView| view.local(point).z.abs();
    let nearest = half.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    let clip = nearest.projection * nearest.local(point).extend(1.0);
    let half_size = volume.display.target_size().map(|side| f64::from(side) / 2.0);
    let u = (clip.x / clip.w * half_size[0]).floor() + 0.5;
    let v = (clip.y / clip.w * half_size[1]).floor() + 0.5;
    Some(nearest.view.inverse().transform_point3(DVec3::new(u, v, 0.0)))
}

fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// A mean and a largest value.
#[derive(Clone, Copy, Debug, Default)]
struct Mean {
    sum: f64,
    most: f64,
    count: u32,
}

impl Mean {
    fn add(&mut self, value: f64) {
        self.sum += value;
        self.most = self.most.max(value);
        self.count += 1;
    }

    fn mean(&self) -> Option<f64> {
        (self.count > 0).then(|| self.sum / f64::from(self.count))
    }

    fn worst(&self) -> Option<f64> {
        (self.count > 0).then_some(self.most)
    }
}
