//! What a display memory shows.

use crate::world::World;
use address_recalculation::FaceSet;
use cube_faces::{CubeView, Drawing};
use glam::DVec3;
use priority_rendering::{Dealing, PriorityError, RegionWarp};

/// What a display memory was drawn from: enough to draw its faces when somebody looks.
#[derive(Clone, Debug, PartialEq)]
pub struct Content {
    /// The place of the eye.
    pub eye: DVec3,
    /// The frame at whose beginning the eye was there.
    pub frame: u64,
    /// The segments in it.
    pub segments: Vec<usize>,
    /// How vertices are moved, where they are: the warp, how cells were dealt, and which memory this is.
    pub warp: Option<(RegionWarp, Dealing, usize)>,
}

impl Content {
    /// Where a vertex is drawn.
    #[must_use]
    pub fn place(&self, vertex: DVec3) -> DVec3 {
        self.warp
            .as_ref()
            .map_or(vertex, |(warp, dealing, memory)| warp.moved(vertex, dealing.to_slower(vertex, *memory)))
    }

    /// The direction in which a vertex is drawn, not of unit length.
    #[must_use]
    pub fn direction(&self, vertex: DVec3) -> DVec3 {
        self.place(vertex) - self.eye
    }

    /// Draws it into faces.
    pub fn draw(&self, world: &World, view: &CubeView, faces: &mut FaceSet) -> Drawing {
        view.draw(self.eye, world.triangles(&self.segments, |vertex| self.place(vertex)), faces)
    }

    /// Triangles of an update.
    #[must_use]
    pub fn triangles(&self, world: &World) -> u64 {
        self.segments.iter().map(|segment| world.segments[*segment].triangles.len() as u64).sum()
    }
}

/// The warp of a memory towards its slower neighbour; `None` where there is no displacement.
pub(crate) fn warp(
    settings: &crate::settings::Settings,
    dealing: &Dealing,
    memory: usize,
    places: [DVec3; 2],
) -> Result<Option<(RegionWarp, Dealing, usize)>, PriorityError> {
    let warp = RegionWarp::new(settings.falloff, settings.numbers.falloff_length_m(), places[0], places[1])?;
    Ok(Some((warp, *dealing, memory)))
}

/// Angle between two directions, radians; small ones as exact as large ones.
pub(crate) fn angle(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}
