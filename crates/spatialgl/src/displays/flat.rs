//! A flat screen: one view of the whole scene, with hidden surfaces removed.

use crate::projection::Size;
use crate::slice_volume::SliceVolume;
use crate::view::{PixelFormat, SliceView, SpatialDisplay};
use glam::{DMat4, DVec3};
use pxpl5_sim::parameters::SettingError;

/// A flat screen with the usual graphics pipeline: one picture of the scene from one eye, with a depth test.
#[derive(Clone, Debug)]
pub struct FlatDisplay {
    size: Size,
    views: [SliceView; 1],
}

impl FlatDisplay {
    /// Creates a screen with a view matrix and a projection. The projection maps to clip coordinates with depths from 0
    /// to 1.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if a side of the size is out of range, or if the width is not a multiple of 8.
    pub fn new(size: Size, view: DMat4, projection: DMat4) -> Result<Self, SettingError> {
        check_size(size)?;
        let mut only = SliceView::new(view, projection, SliceVolume::Frustum, size);
        only.hides = true;
        Ok(Self { size, views: [only] })
    }

    /// Creates a screen for an eye that looks at the origin. Azimuth (from +z to +x) and elevation are in radians,
    /// distance and focal length in pixels.
    ///
    /// # Errors
    ///
    /// The same as [`Self::new`].
    pub fn around(size: Size, azimuth: f64, elevation: f64, distance: f64, focal: f64) -> Result<Self, SettingError> {
        let (sin_a, cos_a) = libm::sincos(azimuth);
        let (sin_e, cos_e) = libm::sincos(elevation);
        let eye = distance * DVec3::new(cos_e * sin_a, sin_e, cos_e * cos_a);
        let view = DMat4::look_at_rh(eye, DVec3::ZERO, DVec3::Y);
        // Near and far plane enclose everything that the eye can look at.
        let near = distance * 0.01;
        let far = distance * 100.0;
        let half = [f64::from(size[0]) / 2.0, f64::from(size[1]) / 2.0];
        let columns = [
            [focal / half[0], 0.0, 0.0, 0.0],
            [0.0, focal / half[1], 0.0, 0.0],
            [0.0, 0.0, far / (near - far), -1.0],
            [0.0, 0.0, near * far / (near - far), 0.0],
        ];
        Self::new(size, view, DMat4::from_cols_array_2d(&columns))
    }
}

fn check_size(size: Size) -> Result<(), SettingError> {
    let [width, height] = size;
    SettingError::require((8..=4096).contains(&width), "display.width", "8 to 4096", width)?;
    SettingError::require(width.is_multiple_of(8), "display.width", "a multiple of 8", width)?;
    SettingError::require((1..=4096).contains(&height), "display.height", "1 to 4096", height)
}

impl SpatialDisplay for FlatDisplay {
    fn views(&self) -> &[SliceView] {
        &self.views
    }

    fn target_size(&self) -> Size {
        self.size
    }

    fn pixel_format(&self) -> PixelFormat {
        PixelFormat::Rgb8
    }

    fn shows(&self, point: DVec3) -> bool {
        let clip = self.views[0].projection * self.views[0].view * point.extend(1.0);
        clip.w > 0.0 && clip.x.abs() <= clip.w && clip.y.abs() <= clip.w && (0.0..=clip.w).contains(&clip.z)
    }
}
