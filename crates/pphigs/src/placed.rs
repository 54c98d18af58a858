//! Structures in the coordinates of one eye, and a cache of recent views.

use crate::structure::DisplayStructure;
use crate::view::{EyeView, ModelEdit};
use glam::Mat4;
use pxpl5_geometry::{Light, ScreenVertex, SurfaceVertex, Touched, Transform, Viewport};
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// One structure, placed for an eye: its matrices, light source and transformed vertices.
#[derive(Debug)]
pub struct PlacedStructure {
    /// Map from the structure's coordinates to the picture. `None` if a matrix is not finite. Such a structure is not
    /// drawn.
    pub transform: Option<Transform>,
    /// The light source in eye coordinates.
    pub light: Light,
    /// The structure's primitives and its frame of reference.
    pub structure: DisplayStructure,
    /// Three matrices. The first leads from the structure's frame of reference to the eye. The second leads from the
    /// structure's own coordinates to this frame. The third leads from the eye to the picture.
    pub(crate) matrices: [Mat4; 3],
    /// Range of the list's vertices from the first vertex to the last vertex of the structure's triangles.
    pub(crate) named: Range<usize>,
    pub(crate) vertices: OnceLock<Vertices>,
    pub(crate) touched: OnceLock<Touched>,
}

/// The transformed vertices of a structure, for the range [`PlacedStructure::named`] of the display list's vertices.
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
/// All graphics processors draw the same views, so they share the transformed vertices. The cache shortens the run time
/// of the simulator, and does not change simulated time.
#[derive(Debug)]
pub struct RecentViews {
    views: Mutex<VecDeque<(ViewKey, Arc<[PlacedStructure]>)>>,
    kept: usize,
    /// For each structure, the range of vertices that it uses. The range is the same in all views.
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

/// Capacity of the cache: two eyes of two views. A slow processor may still work on the previous frame while another
/// processor works on the newest frame.
const RECENT: usize = 4;

/// Cache key of a view. The key contains all data that affect the placement of structures.
#[derive(Debug, PartialEq)]
pub(crate) struct ViewKey {
    pub(crate) eye: EyeView,
    pub(crate) edits: Vec<ModelEdit>,
    pub(crate) viewport: Viewport,
}

impl RecentViews {
    /// Creates an empty cache for `views` views. A value of 0 counts as 1.
    #[must_use]
    pub fn keeping(views: usize) -> Self {
        Self { views: Mutex::default(), kept: views.max(1), named: OnceLock::new() }
    }

    /// Returns the range of vertices that each structure uses. `find` computes the ranges at the first call.
    pub(crate) fn named(&self, find: impl FnOnce() -> Vec<Range<usize>>) -> &[Range<usize>] {
        self.named.get_or_init(find)
    }

    /// Returns the structures of a view from the cache. If the view is not in the cache, `place` places them.
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
