//! Structures in the coordinates of one eye, and a cache of recent views.

use crate::structure::DisplayStructure;
use crate::view::{EyeView, ModelEdit};
use glam::Mat4;
use pxpl5_geometry::{Light, ScreenVertex, SurfaceVertex, Touched, Transform, Viewport};
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// One structure in the coordinates of an eye.
#[derive(Debug)]
pub struct PlacedStructure {
    /// Map from the structure's coordinates to the picture; `None` if a matrix is not finite, so that the structure is
    /// not drawn.
    pub transform: Option<Transform>,
    /// The light in eye coordinates.
    pub light: Light,
    /// The structure's primitives and its frame of reference.
    pub structure: DisplayStructure,
    /// Matrices from the structure's frame to the eye, from its own coordinates to its frame, and from the eye to the
    /// picture.
    pub(crate) matrices: [Mat4; 3],
    /// Range of the list's vertices from the first to the last one that the structure's triangles use.
    pub(crate) named: Range<usize>,
    pub(crate) vertices: OnceLock<Vertices>,
    pub(crate) touched: OnceLock<Touched>,
}

/// The vertices of a structure, from the first [used](PlacedStructure::named) one on.
#[derive(Debug)]
pub(crate) struct Vertices {
    pub(crate) first: usize,
    pub(crate) on_screen: Vec<ScreenVertex>,
    pub(crate) normals: OnceLock<Vec<SurfaceVertex>>,
    pub(crate) colours: OnceLock<Vec<SurfaceVertex>>,
    /// Vertices with the unlit colours of the display list.
    pub(crate) precomputed: OnceLock<Vec<SurfaceVertex>>,
}

/// Cache of a display list's recent views.
///
/// All graphics processors use the same views, so they share the transformed vertices. The cache saves only the
/// simulator's time.
#[derive(Debug)]
pub struct RecentViews {
    views: Mutex<VecDeque<(ViewKey, Arc<[PlacedStructure]>)>>,
    kept: usize,
    /// By structure, the vertices that it uses, which are the same in all views.
    named: OnceLock<Vec<Range<usize>>>,
}

impl Default for RecentViews {
    fn default() -> Self {
        Self::keeping(RECENT)
    }
}

/// A clone starts empty.
impl Clone for RecentViews {
    fn clone(&self) -> Self {
        Self::keeping(self.kept)
    }
}

/// Capacity for two eyes of two views: one frame is transformed while a slower processor works at the frame before.
const RECENT: usize = 4;

/// Cache key of a view: everything that the placement of structures depends on.
#[derive(Debug, PartialEq)]
pub(crate) struct ViewKey {
    pub(crate) eye: EyeView,
    pub(crate) edits: Vec<ModelEdit>,
    pub(crate) viewport: Viewport,
}

impl RecentViews {
    /// Creates an empty cache for `views` views, at least one.
    #[must_use]
    pub fn keeping(views: usize) -> Self {
        Self { views: Mutex::default(), kept: views.max(1), named: OnceLock::new() }
    }

    /// Returns the vertices that each structure uses, computed at the first call.
    pub(crate) fn named(&self, find: impl FnOnce() -> Vec<Range<usize>>) -> &[Range<usize>] {
        self.named.get_or_init(find)
    }

    /// Returns the structures of a view from the cache, or places them by `place`.
    pub(crate) fn cached_or_placed(
        &self,
        key: ViewKey,
        place: impl FnOnce() -> Vec<PlacedStructure>,
    ) -> Arc<[PlacedStructure]> {
        let mut recent = self.views.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, placed)) = recent.iter().find(|(known, _)| *known == key) {
            return Arc::clone(placed);
        }
        let placed: Arc<[PlacedStructure]> = place().into();
        recent.truncate(self.kept - 1);
        recent.push_front((key, Arc::clone(&placed)));
        placed
    }
}
