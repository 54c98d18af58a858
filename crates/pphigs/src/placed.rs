//! Structures in place, as one eye sees them, and those that were placed lately.

use crate::structure::DisplayStructure;
use crate::view::{EyeView, ModelEdit};
use glam::Mat4;
use pxpl5_geometry::{Light, ScreenVertex, SurfaceVertex, Touched, Transform, Viewport};
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// One structure as an eye sees it.
#[derive(Debug)]
pub struct PlacedStructure {
    /// From its coordinates to the picture; `None` where a matrix is not finite, so that it is not drawn.
    pub transform: Option<Transform>,
    /// The light in eye coordinates.
    pub light: Light,
    /// Which primitives belong to it, and what it is fixed to.
    pub structure: DisplayStructure,
    /// From its frame to the eye, from its own coordinates to its frame, and from the eye to the picture.
    pub(crate) matrices: [Mat4; 3],
    /// Places among the list's vertices, from the first that one of its triangles names to the last.
    pub(crate) named: Range<usize>,
    pub(crate) vertices: OnceLock<Vertices>,
    pub(crate) touched: OnceLock<Touched>,
}

/// The vertices of a structure, from the first [named](PlacedStructure::named) one.
#[derive(Debug)]
pub(crate) struct Vertices {
    pub(crate) first: usize,
    pub(crate) on_screen: Vec<ScreenVertex>,
    pub(crate) normals: OnceLock<Vec<SurfaceVertex>>,
    pub(crate) colours: OnceLock<Vec<SurfaceVertex>>,
    /// The colours as the display list has them.
    pub(crate) precomputed: OnceLock<Vec<SurfaceVertex>>,
}

/// Views of a display list that graphics processors asked for lately. All of them ask for the same ones, and get the
/// same transformed vertices; only the host's time is saved by it.
#[derive(Debug)]
pub struct RecentViews {
    views: Mutex<VecDeque<(ViewKey, Arc<[PlacedStructure]>)>>,
    kept: usize,
    /// By structure, the vertices that it names: the same in all views.
    named: OnceLock<Vec<Range<usize>>>,
}

impl Default for RecentViews {
    fn default() -> Self {
        Self::keeping(RECENT)
    }
}

/// A clone holds none.
impl Clone for RecentViews {
    fn clone(&self) -> Self {
        Self::keeping(self.kept)
    }
}

/// Two eyes of two views: a frame being transformed while a slower processor is at the one before.
const RECENT: usize = 4;

/// All that the place of a structure depends on.
#[derive(Debug, PartialEq)]
pub(crate) struct ViewKey {
    pub(crate) eye: EyeView,
    pub(crate) edits: Vec<ModelEdit>,
    pub(crate) viewport: Viewport,
}

impl RecentViews {
    /// None yet; so many will be kept, at least one.
    #[must_use]
    pub fn keeping(views: usize) -> Self {
        Self { views: Mutex::default(), kept: views.max(1), named: OnceLock::new() }
    }

    /// By structure, the vertices that it names, found when first asked for.
    pub(crate) fn named(&self, find: impl FnOnce() -> Vec<Range<usize>>) -> &[Range<usize>] {
        self.named.get_or_init(find)
    }

    /// The structures of a view, placed by `place` unless somebody asked for the same view lately.
    pub(crate) fn find_or_place(
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
