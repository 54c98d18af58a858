//! The interface between a display and the pipeline. The pipeline uses only the views and the slice volumes of a
//! display.

use crate::bin::BinLayout;
use crate::projection::{Size, window_of};
use crate::slice_volume::SliceVolume;
use glam::{DMat4, DVec3};
use serde::{Deserialize, Serialize};

/// One slice: its position, the projection of the scene onto the slice, and the part of space that the slice
/// represents.
#[derive(Clone, Debug, PartialEq)]
pub struct SliceView {
    /// Matrix from the world to (u, v, s), all in pixels: horizontal position in the slice, vertical position, and
    /// distance from the slice.
    pub view: DMat4,
    /// Matrix from the coordinates (u, v, s, 1) of the slice to clip coordinates, with depth 0 at the near plane and 1
    /// at the far plane.
    pub projection: DMat4,
    pub volume: SliceVolume,
    /// Bins whose primitives the slice draws, as a bit mask. Bit g stands for the regions of [`SpatialDisplay::bins`]
    /// with group g.
    pub bins: u64,
    /// True if the nearest surface hides farther surfaces, as on a display that is seen from one side only.
    pub hides: bool,
    pub(crate) window: [[f64; 4]; 4],
    /// Range of distances from the slice in which anything can be drawn, slightly enlarged. `None` if the range is
    /// unknown.
    pub(crate) reach: Option<[f64; 2]>,
    /// Number of samples along a side of a pixel. The number exceeds 1 while a supersampled image is drawn.
    pub(crate) magnification: f64,
}

impl SliceView {
    /// Creates the view of a slice with an image of this size. The slice draws the primitives of bin 0.
    pub fn new(view: DMat4, projection: DMat4, volume: SliceVolume, size: Size) -> Self {
        let window = window_of(&projection, size);
        Self { view, projection, volume, bins: 1, hides: false, window, reach: None, magnification: 1.0 }
    }

    pub(crate) fn supersampled_view(&self, factor: u32) -> Self {
        let factor = f64::from(factor);
        let mut view = self.clone();
        for row in &mut view.window[..2] {
            *row = row.map(|coefficient| coefficient * factor);
        }
        view.magnification = factor;
        view
    }

    /// Converts a point of the world to the coordinates u, v, s of the slice.
    pub fn local(&self, world: DVec3) -> DVec3 {
        self.view.transform_point3(world)
    }

    /// Returns true if a point of the world belongs to the slice: between the slice's near and far planes, and in the
    /// slice's volume.
    pub fn accepts(&self, world: DVec3) -> bool {
        let local = self.local(world);
        let clip = self.projection * local.extend(1.0);
        let between = clip.z >= 0.0 && clip.w - clip.z >= 0.0;
        between && self.volume.contains(world.to_array(), local.x, local.z)
    }
}

/// The number of bits for each colour of a pixel: 1 or 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PixelFormat {
    Rgb1,
    Rgb8,
}

/// A volumetric or flat display, reduced to the properties that the pipeline uses. A display does not depend on the
/// triangles that it shows.
pub trait SpatialDisplay: Send + Sync {
    /// Returns the slices, in the order in which they are shown.
    fn views(&self) -> &[SliceView];

    fn target_size(&self) -> Size;

    fn pixel_format(&self) -> PixelFormat;

    /// Returns the planes and regions for sorting primitives into bins. By default, one bin contains all primitives.
    fn bins(&self) -> BinLayout {
        BinLayout::one()
    }

    fn shows(&self, point: DVec3) -> bool;

    /// Returns true if the slice with index `view` (among [`Self::views`]) shows this point of the world.
    fn accepts(&self, view: usize, point: DVec3) -> bool {
        self.views().get(view).is_some_and(|view| view.accepts(point))
    }
}
