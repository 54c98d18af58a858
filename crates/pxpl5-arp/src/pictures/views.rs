//! Pictures of the views that the eye sees, and of the errors in these views.

use super::plan::MEMORY_COLOURS;
use crate::content::angle;
use crate::cube_faces::CubeView;
use crate::simulation::Simulation;
use crate::walk_faces::{WalkFaces, picture, rgb};
use address_recalculation::{ArpConfig, Lens, LensPicture};
use glam::{DQuat, DVec3};
use image::{Rgb, RgbImage};
use pxpl5_sim::parameters::SettingError;

/// The cube faces of all memories, seen by an eye with an orientation and through a lens.
#[derive(Clone, Debug)]
pub struct MemoryViews<'a> {
    pub faces: &'a WalkFaces,
    pub orientation: DQuat,
    pub lens: Lens,
}

/// Returns the lens for pictures without lens distortion: a flat lens, or the display's own lens if the view is too
/// wide for a plane.
pub(crate) fn without_lens(display: &ArpConfig) -> Lens {
    if Lens::Flat.check(&display.picture()).is_ok() { Lens::Flat } else { display.lens.clone() }
}

impl MemoryViews<'_> {
    /// Returns the picture that the eye sees.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the lens is invalid.
    pub fn seen(&self) -> Result<RgbImage, SettingError> {
        Ok(self.faces.clone().through(self.lens.clone()).seen(self.orientation)?.0)
    }

    /// Returns the view, tinted by the colour of the memory that is shown at each pixel.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`MemoryViews::seen`].
    pub fn memories(&self) -> Result<RgbImage, SettingError> {
        let mut seen = self.seen()?;
        let (width, winners) = self.faces.clone().through(self.lens.clone()).winners(self.orientation)?;
        let tints =
            picture(width, &winners, |winner| winner.map_or(0, |memory| MEMORY_COLOURS[usize::from(memory % 8)]));
        for (pixel, tint) in seen.pixels_mut().zip(tints.pixels()) {
            let grey = pixel.0.iter().map(|part| u32::from(*part)).sum::<u32>() / 3;
            pixel.0 = tint.0.map(|part| (u32::from(part) * (128 + grey) / 320).min(255) as u8);
        }
        Ok(seen)
    }

    /// Returns a picture of the error that each pixel has because its memory was drawn from an older eye position.
    ///
    /// Black means no error, and white means an error of two pixels or more. The unit is the size of a pixel in the
    /// middle of the picture. A scale is drawn below the picture.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`MemoryViews::seen`].
    pub fn errors(&self, simulation: &Simulation<'_>, eye: DVec3) -> Result<RgbImage, SettingError> {
        let view = simulation.settings.view()?;
        let screen = simulation.settings.display.picture();
        let bar = 24;
        let focal = pixels_per_radian(&self.lens, &screen);
        // The rows below the picture hold the scale.
        Ok(RgbImage::from_fn(screen.width, screen.height + bar, |x, y| match y.checked_sub(screen.height) {
            Some(_) => heat(2.0 * f64::from(x) / f64::from(screen.width), x % (screen.width / 8) == 0),
            None => {
                let ray = self.orientation * DVec3::from_array(self.lens.view(&screen, x, y));
                self.off(simulation, &view, ray, eye).map_or(rgb(0x0000_0040), |off| heat(off * focal, false))
            }
        }))
    }

    /// Returns the error of one pixel for [`Self::errors`], in radians. The error is the angle between the displayed
    /// and the correct direction of the point that the pixel's ray hits.
    ///
    /// Returns `None` if the ray hits nothing.
    fn off(&self, simulation: &Simulation<'_>, view: &CubeView, ray: DVec3, eye: DVec3) -> Option<f64> {
        let texel = view.geometry.texel(ray.to_array())?;
        let texels = self.faces.memories.iter().zip(&simulation.shown);
        let seen = texels.filter_map(|(faces, content)| Some((faces.texel(texel)?.1, content.as_ref()?.eye)));
        let (depth, from) = seen.min_by_key(|(depth, _)| *depth)?;
        let axis = DVec3::from_array(texel.face.forward().map(|component| component as f64));
        let place = from + ray * (view.depth.distance_m(depth) / ray.dot(axis));
        Some(angle(place - from, place - eye))
    }
}

fn pixels_per_radian(lens: &Lens, screen: &LensPicture) -> f64 {
    let view = |x: u32| DVec3::from_array(lens.view(screen, x.min(screen.width - 1), screen.height / 2));
    let middle = screen.width / 2;
    1.0 / angle(view(middle.saturating_sub(1)), view(middle)).max(f64::MIN_POSITIVE)
}

/// Returns the colour of an error in pixels: black, red, yellow, then white at two pixels. Marks of the scale are blue.
fn heat(pixels: f64, is_mark: bool) -> Rgb<u8> {
    if is_mark {
        return Rgb([0, 128, 255]);
    }
    let share = (pixels / 2.0).clamp(0.0, 1.0) * 3.0;
    Rgb([0.0, 1.0, 2.0].map(|from: f64| ((share - from).clamp(0.0, 1.0) * 255.0) as u8))
}

/// Returns half the difference of two pictures. Equal pixels become grey.
pub fn difference(first: &RgbImage, second: &RgbImage) -> RgbImage {
    RgbImage::from_fn(first.width(), first.height(), |x, y| {
        let [a, b] = [first, second].map(|picture| picture.get_pixel(x, y).0.map(i32::from));
        Rgb([0, 1, 2].map(|part| (128 + (a[part] - b[part]) / 2).clamp(0, 255) as u8))
    })
}
