use crate::cube::faces::{CubeWork, face_view};
use crate::cube::update::FaceUpdate;
use crate::cube::warped_lists::WarpedLists;
use crate::drawn::Drawn;
use address_recalculation::{CubeFace, region_grid};
use pphigs::{FrameView, Pass, Picture, Share};
use pxpl5_gp::{Gp, Work};
use pxpl5_wire::{Body, CopyContent, CopyTarget, Lines, NodeId, RegionGrid, RegionId};
use std::sync::Arc;

/// Pictures of six faces of a cube, which the firmware draws into the display memories of the address recalculation
/// display.
#[derive(Clone, Debug)]
pub struct Faces {
    /// Ring port of each display memory.
    pub memories: Vec<NodeId>,
    pub picture: Picture,
    /// Parts of a texel that are copied to a display memory, such as colour and depth.
    pub content: CopyContent,
    /// Cache of display lists with displaced vertices. All slaves of the machine use the same cache.
    pub warped: WarpedLists,
}

impl Faces {
    /// Returns the number of texels along an edge of a face.
    pub const fn face_texels(&self) -> u32 {
        self.picture.viewport.grid().width
    }

    /// Returns the grid of regions of an update, in which the six faces lie one below the other.
    pub const fn grid(&self) -> RegionGrid {
        region_grid(self.face_texels())
    }
}

impl Drawn for Faces {
    type Sent = FaceUpdate;

    const VIEWS: u16 = CubeFace::ALL.len() as u16;
    const ANNOUNCES: bool = true;

    fn picture(&self) -> &Picture {
        &self.picture
    }

    fn content(&self) -> CopyContent {
        self.content
    }

    fn target(&self, update: &FaceUpdate, _: u64, region: RegionId) -> CopyTarget {
        CopyTarget {
            frame_buffer: self.memories[usize::from(update.memory)],
            buffer: update.buffer,
            lines: Lines::Frame,
            grid: self.grid(),
            region,
            picture: update.number,
        }
    }

    fn eye_at(&self, port: NodeId) -> Option<u64> {
        self.memories.contains(&port).then_some(0)
    }

    fn swaps(&self, gp: &Gp) -> u64 {
        self.memories.iter().map(|node| gp.status(*node)).sum()
    }

    fn announcement(&self, update: &FaceUpdate, regions: &[RegionId]) -> Vec<(u32, Body)> {
        let messages = update.announcement(self.face_texels(), regions);
        messages.map(|words| (words.len() as u32, Body::Words(words))).into()
    }

    /// Returns the share with displaced vertices if the update has a warp, and the unchanged share otherwise.
    fn placed(&self, share: &Share, update: &FaceUpdate) -> Share {
        if update.warp.is_none() { share.clone() } else { share.with_list(self.warped.placed(share.list(), update)) }
    }

    /// Transforms those triangles and spheres of a share that the update draws, for each of the six faces.
    fn passes(&self, share: &Share, update: &FaceUpdate, _: u64) -> Vec<Arc<Pass>> {
        let ahead = update.view.eyes.first();
        let faces = CubeFace::ALL.iter().flat_map(|face| ahead.map(|ahead| face_view(ahead, *face)));
        let view = FrameView { eyes: faces.collect(), ..update.view.clone() };
        let pass = |face: usize| share.transform_chosen(&view, face, self.picture, &update.structures);
        (0..view.eyes.len()).map(pass).collect()
    }

    fn work(&self, share: &Share, update: &FaceUpdate, passes: &[Arc<Pass>], context: u8) -> impl Work {
        CubeWork::new(share, update, passes, context)
    }
}
