//! A stack of planes: pictures one behind the other, each of which represents a slab of space.

use super::flat::check_size;
use crate::projection::{Size, matrix_of_rows};
use crate::slice_volume::SliceVolume;
use crate::view::{PixelFormat, SliceView, SpatialDisplay};
use glam::{DMat4, DVec3};
use pxpl5_sim::parameters::SettingError;

/// Parallel planes perpendicular to z, from the farthest (least z) to the nearest. The slabs of neighbouring planes
/// touch.
#[derive(Clone, Debug)]
pub struct PlaneStack {
    size: Size,
    depth: f64,
    views: Vec<SliceView>,
}

impl PlaneStack {
    /// Creates a stack of `planes` planes. The planes divide a range of z around 0, `depth` pixels long, into equal
    /// slabs.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the invalid number, the expected range and the found value.
    pub fn new(size: Size, planes: u32, depth: f64) -> Result<Self, SettingError> {
        check_size(size)?;
        SettingError::require((1..=65_536).contains(&planes), "display.slices", "1 to 65536", planes)?;
        SettingError::require(depth.is_finite() && depth > 0.0, "display.depth", "a finite depth above 0 px", depth)?;
        let views = (0..planes).map(|i| plane(size, planes, depth, i)).collect();
        Ok(Self { size, depth, views })
    }
}

/// Returns the z coordinate, in pixels, at which slab `i` begins. Slab `i` - 1 ends at exactly the same coordinate, so
/// no point lies between two slabs.
fn face(planes: u32, depth: f64, i: u32) -> f64 {
    depth * (f64::from(i) / f64::from(planes) - 0.5)
}

fn plane(size: Size, planes: u32, depth: f64, i: u32) -> SliceView {
    let low = face(planes, depth, i);
    let high = face(planes, depth, i + 1);
    let far = 2.0 * depth;
    let clip = matrix_of_rows([
        [2.0 / f64::from(size[0]), 0.0, 0.0, 0.0],
        [0.0, 2.0 / f64::from(size[1]), 0.0, 0.0],
        [0.0, 0.0, -1.0 / (2.0 * far), 0.5],
        [0.0, 0.0, 0.0, 1.0],
    ]);
    let mut view = SliceView::new(DMat4::IDENTITY, clip, SliceVolume::Slab { low, high }, size);
    // A small tolerance prevents rounding errors from rejecting primitives that touch the slab.
    let slack = depth * 1e-9;
    view.reach = Some([low - slack, high + slack]);
    view
}

impl SpatialDisplay for PlaneStack {
    fn views(&self) -> &[SliceView] {
        &self.views
    }

    fn target_size(&self) -> Size {
        self.size
    }

    fn pixel_format(&self) -> PixelFormat {
        PixelFormat::Rgb1
    }

    fn shows(&self, point: DVec3) -> bool {
        let half_width = f64::from(self.size[0]) / 2.0;
        let half_height = f64::from(self.size[1]) / 2.0;
        point.x.abs() <= half_width && point.y.abs() <= half_height && 2.0 * point.z.abs() <= self.depth
    }
}
