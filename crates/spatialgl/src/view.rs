//! What a display is to the pipeline: views and slice volumes, and nothing of its machinery.

use crate::bin::BinLayout;
use crate::projection::{Size, window_of};
use crate::slice_volume::SliceVolume;
use glam::{DMat4, DVec3};
use serde::{Deserialize, Serialize};

/// One slice: where it stands, how the scene is projected on it, which part of the scene is its own.
#[derive(Clone, Debug, PartialEq)]
pub struct SliceView {
    /// From the world to (u, v, s): along the slice, up it, off it; pixels.
    pub view: DMat4,
    /// From (u, v, s, 1) to clip coordinates, depth from 0 at the near plane to 1 at the far plane.
    pub projection: DMat4,
    /// The part of space that it stands for.
    pub volume: SliceVolume,
    /// The bins that it draws, one bit for each group of regions of [`SpatialDisplay::bins`].
    pub bins: u64,
    /// Whether the nearest surface hides others; only for a view that somebody looks at from one side.
    pub hides: bool,
    pub(crate) window: [[f64; 4]; 4],
    /// All s at which anything can be drawn, with some slack, where that is known.
    pub(crate) reach: Option<[f64; 2]>,
    /// Samples along a pixel of the image: more than one while a supersampled image is drawn.
    pub(crate) magnification: f64,
}

impl SliceView {
    /// A view of an image of this size that draws the bins of one group, number 0.
    #[must_use]
    pub fn new(view: DMat4, projection: DMat4, volume: SliceVolume, size: Size) -> Self {
        let window = window_of(&projection, size);
        Self { view, projection, volume, bins: 1, hides: false, window, reach: None, magnification: 1.0 }
    }

    /// The same view of an image with so many samples along each pixel.
    pub(crate) fn magnified(&self, factor: u32) -> Self {
        let factor = f64::from(factor);
        let mut view = self.clone();
        for row in &mut view.window[..2] {
            *row = row.map(|coefficient| coefficient * factor);
        }
        view.magnification = factor;
        view
    }

    /// A point of the world in the coordinates of the slice: u, v, s.
    #[must_use]
    pub fn local(&self, world: DVec3) -> DVec3 {
        self.view.transform_point3(world)
    }

    /// Whether a point of the world belongs to the slice: between near and far plane and in its volume.
    #[must_use]
    pub fn accepts(&self, world: DVec3) -> bool {
        let local = self.local(world);
        let clip = self.projection * local.extend(1.0);
        let between = clip.z >= 0.0 && clip.w - clip.z >= 0.0;
        between && self.volume.contains(world.to_array(), local.x, local.z)
    }
}

/// What one pixel of a display can show.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PixelFormat {
    /// One bit for each of red, green and blue.
    Rgb1,
    /// Eight bits for each of red, green and blue.
    Rgb8,
}

/// A display as the pipeline sees it. It knows no triangles, and the pipeline knows no display.
pub trait SpatialDisplay: Send + Sync {
    /// Its slices, in the order in which they are shown.
    fn views(&self) -> &[SliceView];

    /// Size of every slice's image.
    fn target_size(&self) -> Size;

    /// What a pixel can show.
    fn pixel_format(&self) -> PixelFormat;

    /// How primitives are sorted before slices are drawn; one bin of everything, unless the display has planes for it.
    fn bins(&self) -> BinLayout {
        BinLayout::one()
    }

    /// Whether a point of the world can be shown at all.
    fn shows(&self, point: DVec3) -> bool;

    /// Whether a slice shows a point of the world.
    fn accepts(&self, view: usize, point: DVec3) -> bool {
        self.views().get(view).is_some_and(|view| view.accepts(point))
    }
}
