//! Contents of a display memory.

use crate::cube_faces::{CubeView, DrawCounts};
use crate::world::World;
use address_recalculation::FaceSet;
use address_recalculation::priority::{CellAssignment, RegionWarp};
use glam::DVec3;
use pxpl5_sim::parameters::SettingError;

/// The data from which a display memory is drawn. The memory's cube faces are drawn later, when the faces are read.
#[derive(Clone, Debug, PartialEq)]
pub struct Content {
    /// Position of the eye from which the memory is drawn.
    pub eye: DVec3,
    /// Index of the frame at whose start the eye had this position.
    pub frame: u64,
    /// Indices of the segments (parts of objects) that the memory contains.
    pub segments: Vec<usize>,
    /// Data for the displacement of vertices, or `None` without warping: the warp, the assignment of cells, and the
    /// index of this memory.
    pub warp: Option<(RegionWarp, CellAssignment, usize)>,
}

impl Content {
    /// Returns the position at which a vertex of the scene is drawn after warping.
    pub fn place(&self, vertex: DVec3) -> DVec3 {
        self.warp
            .as_ref()
            .map_or(vertex, |(warp, assignment, memory)| warp.moved(vertex, assignment.to_slower(vertex, *memory)))
    }

    /// Returns the direction from the eye in which a vertex is drawn. The vector does not have unit length.
    pub fn direction(&self, vertex: DVec3) -> DVec3 {
        self.place(vertex) - self.eye
    }

    pub fn draw(&self, world: &World, view: &CubeView, faces: &mut FaceSet) -> DrawCounts {
        view.draw(self.eye, world.triangles(&self.segments, |vertex| self.place(vertex)), faces)
    }

    /// Returns the number of triangles that an update of the memory draws.
    pub fn triangles(&self, world: &World) -> u64 {
        self.segments.iter().map(|segment| world.segments[*segment].triangles.len() as u64).sum()
    }
}

/// Returns the warp that closes the gap at the outer border of `memory`. The memory beyond this border is updated less
/// often. `places` are the eye positions from which `memory` and the memory beyond the border were drawn.
pub(crate) fn warp(
    settings: &crate::settings::WalkSettings,
    assignment: &CellAssignment,
    memory: usize,
    places: [DVec3; 2],
) -> Result<Option<(RegionWarp, CellAssignment, usize)>, SettingError> {
    let warp = RegionWarp::new(settings.falloff, settings.numbers.falloff_length_m(), places[0], places[1])?;
    Ok(Some((warp, *assignment, memory)))
}

/// Returns the angle between two directions in radians. The formula is also accurate for small angles.
pub(crate) fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}
