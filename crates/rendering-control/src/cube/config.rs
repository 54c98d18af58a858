//! Settings of Cube control: the boards, and the format of the faces.

use crate::cube::update::FaceUpdate;
use crate::cube::warped_lists::WarpedLists;
use address_recalculation::{CubeFace, region_grid};
use pphigs::{Picture, Share};
use pxpl5_wire::{CopyContent, CopyTarget, Lines, NodeId, RegionGrid, RegionId};
use std::sync::Arc;

/// The boards of Cube control, and the format of the faces that they draw.
#[derive(Clone, Debug)]
pub struct CubeControlConfig {
    /// Ring port of the host, which sends updates.
    pub host: NodeId,
    /// Ring port of the master, which begins every stage.
    pub master: NodeId,
    /// Ring ports of the slaves, at least one.
    pub slaves: Vec<NodeId>,
    /// Ring ports of the renderers, at least one.
    pub renderers: Vec<NodeId>,
    /// Format and destination of the faces.
    pub faces: Faces,
    /// Cache of display lists with displaced vertices, which all slaves share. The cache is empty at first.
    pub warped: WarpedLists,
}

/// Format of the faces in the memories of a display.
#[derive(Clone, Debug)]
pub struct Faces {
    /// Ring port of each display memory.
    pub memories: Vec<NodeId>,
    /// Viewport and shading of each face.
    pub picture: Picture,
    /// Values of a texel that are copied to a display memory, such as colour and depth.
    pub content: CopyContent,
}

impl Faces {
    /// Returns the number of texels along an edge of a face.
    #[must_use]
    pub const fn face_texels(&self) -> u32 {
        self.picture.viewport.grid().width
    }

    /// Returns the regions of all six faces, one face below the other.
    #[must_use]
    pub const fn grid(&self) -> RegionGrid {
        region_grid(self.face_texels())
    }

    pub(crate) const fn face_regions(&self) -> u16 {
        self.picture.viewport.grid().regions() as u16
    }

    /// Returns the number of regions of all six faces together.
    #[must_use]
    pub const fn regions(&self) -> u16 {
        self.face_regions() * CubeFace::ALL.len() as u16
    }

    /// Returns the face that contains a region, and the index of the region within this face.
    #[must_use]
    pub const fn on_face(&self, region: RegionId) -> (usize, RegionId) {
        ((region.0 / self.face_regions()) as usize, RegionId(region.0 % self.face_regions()))
    }

    /// Returns the place in a display memory to which a region of an update is copied.
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
    /// Returns the primitives of the slave with index `index`.
    #[must_use]
    pub fn share(&self, list: &Arc<pphigs::DisplayList>, index: usize) -> Share {
        Share::new(Arc::clone(list), index, self.slaves.len())
    }
}
