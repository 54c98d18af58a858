//! Structures in the coordinates of one eye, and a cache of recent views.

use crate::view::{DisplayStructure, EyeView, ModelEdit};
use glam::Mat4;
use pxpl5_geometry::{Light, ScreenVertex, SurfaceVertex, Touched, Transform, Viewport};
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A structure in the coordinates of one eye: matrices, light source and transformed vertices.
#[derive(Debug)]
pub struct PlacedStructure {
    /// Transform from the structure to the picture. `None` if a matrix is not finite, so that the structure is not
    /// drawn.
    pub transform: Option<Transform>,
    /// The light source in eye coordinates.
    pub light: Light,
    pub structure: DisplayStructure,
    /// Three matrices: from the room (or the head) to the eye, from the structure to the room, and from the eye to the
    /// picture.
    pub(crate) matrices: [Mat4; 3],
    /// Range of the display list's vertices that contains all vertices of the structure.
    pub(crate) named: Range<usize>,
    pub(crate) vertices: OnceLock<Vertices>,
    pub(crate) touched: OnceLock<Touched>,
}

/// The transformed vertices of a structure, from vertex `first` of the display list on.
#[derive(Debug)]
pub(crate) struct Vertices {
    pub(crate) first: usize,
    pub(crate) on_screen: Vec<ScreenVertex>,
    pub(crate) normals: OnceLock<Vec<SurfaceVertex>>,
    pub(crate) colours: OnceLock<Vec<SurfaceVertex>>,
    /// Vertices with the colours of the display list, without light.
    pub(crate) precomputed: OnceLock<Vec<SurfaceVertex>>,
}

/// A cache of the structures of a display list, placed for recent views.
///
/// All graphics processors draw the same views, so they share the transformed vertices. The cache does not change
/// simulated time.
#[derive(Debug)]
pub struct RecentViews {
    views: Mutex<VecDeque<(ViewKey, Arc<[PlacedStructure]>)>>,
    kept: usize,
    /// Range of vertices of each structure, which is the same in all views.
    named: OnceLock<Vec<Range<usize>>>,
}

impl Default for RecentViews {
    fn default() -> Self {
        Self::keeping(RECENT)
    }
}

/// A clone of the cache is empty at first.
impl Clone for RecentViews {
    fn clone(&self) -> Self {
        Self::keeping(self.kept)
    }
}

/// Capacity of the cache: the views of two eyes in two frames. A slow processor may still draw the previous frame.
const RECENT: usize = 4;

/// The data that determine where structures are placed.
#[derive(Debug, PartialEq)]
pub(crate) struct ViewKey {
    pub(crate) eye: EyeView,
    pub(crate) edits: Vec<ModelEdit>,
    pub(crate) viewport: Viewport,
}

impl RecentViews {
    /// Creates an empty cache for `views` views, at least one.
    pub fn keeping(views: usize) -> Self {
        Self { views: Mutex::default(), kept: views.max(1), named: OnceLock::new() }
    }

    pub(crate) fn named(&self, find: impl FnOnce() -> Vec<Range<usize>>) -> &[Range<usize>] {
        self.named.get_or_init(find)
    }

    /// Returns the structures of a view from the cache. If the view is not in the cache, `place` computes them.
    pub(crate) fn cached_or_placed(
        &self,
        key: ViewKey,
        place: impl FnOnce() -> Vec<PlacedStructure>,
    ) -> Arc<[PlacedStructure]> {
        let mut recent = self.views.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, placed)) = recent.iter().find(|(cached, _)| *cached == key) {
            return Arc::clone(placed);
        }
        let placed: Arc<[PlacedStructure]> = place().into();
        recent.truncate(self.kept - 1);
        recent.push_front((key, Arc::clone(&placed)));
        placed
    }
}
