//! Who takes part.

use crate::update::FaceUpdate;
use crate::warped_lists::WarpedLists;
use address_recalculation::{CubeFace, region_grid};
use pphigs::{Picture, Share};
use pxpl5_wire::{CopyContent, CopyTarget, Lines, NodeId, RegionGrid, RegionId};
use std::sync::Arc;

/// The boards that take part, and the kind of faces that they make.
#[derive(Clone, Debug)]
pub struct CubeControlConfig {
    /// Node of the host interface, which sends updates.
    pub host: NodeId,
    /// Node of the GP that begins every stage.
    pub master: NodeId,
    /// Nodes of the slave GPs, at least one.
    pub slaves: Vec<NodeId>,
    /// Nodes of the renderers, at least one.
    pub renderers: Vec<NodeId>,
    /// What they draw, and where it goes.
    pub faces: Faces,
    /// What slaves keep for each other of updates that are warped; empty at first.
    pub warped: WarpedLists,
}

/// The kind of faces that a display's memories take.
#[derive(Clone, Debug)]
pub struct Faces {
    /// The port of each display memory.
    pub memories: Vec<NodeId>,
    /// What is drawn of each face.
    pub picture: Picture,
    /// What of a texel goes to a memory.
    pub content: CopyContent,
}

impl Faces {
    /// Texels along an edge of a face.
    #[must_use]
    pub const fn face_texels(&self) -> u32 {
        self.picture.viewport.grid().width
    }

    /// All six faces, one under the other.
    #[must_use]
    pub const fn grid(&self) -> RegionGrid {
        region_grid(self.face_texels())
    }

    /// Regions of one face.
    pub(crate) const fn face_regions(&self) -> u16 {
        self.picture.viewport.grid().regions() as u16
    }

    /// Regions of all faces.
    #[must_use]
    pub const fn regions(&self) -> u16 {
        self.face_regions() * CubeFace::ALL.len() as u16
    }

    /// The face that a region of all is on, and its number there.
    #[must_use]
    pub const fn on_face(&self, region: RegionId) -> (usize, RegionId) {
        ((region.0 / self.face_regions()) as usize, RegionId(region.0 % self.face_regions()))
    }

    /// Where a region of an update goes.
    #[must_use]
    pub fn target(&self, update: &FaceUpdate, region: RegionId) -> CopyTarget {
        CopyTarget {
            frame_buffer: self.memories[usize::from(update.memory)],
            buffer: update.buffer,
            lines: Lines::Frame,
            grid: self.grid(),
            region,
            picture: update.number,
        }
    }
}

impl CubeControlConfig {
    /// The primitives that slave `index` holds.
    #[must_use]
    pub fn share(&self, list: &Arc<pphigs::DisplayList>, index: usize) -> Share {
        Share::new(Arc::clone(list), index, self.slaves.len())
    }
}
