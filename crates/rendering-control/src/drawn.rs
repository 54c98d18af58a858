//! The interface between the programs of Rendering Control and the pictures that they draw: frames of a display, or
//! faces of a cube.

use crate::rules::Drawing;
use pphigs::{FrameView, Pass, Picture, Share};
use pxpl5_gp::{Gp, Work};
use pxpl5_wire::{Body, CopyContent, CopyTarget, NodeId, PictureNumber, RegionId, Word};
use std::fmt::Debug;
use std::sync::Arc;

/// The host's message for one picture (SEND).
pub trait Sent: Clone + Debug + PartialEq + 'static {
    fn number(&self) -> PictureNumber;

    /// Returns the views of all eyes, with the edits of structures.
    fn view(&self) -> &FrameView;

    fn to_words(&self) -> Vec<Word>;

    /// Decodes the message, or returns `None` if the words are invalid.
    fn from_words(words: &[Word]) -> Option<Self>;
}

/// The kind of pictures that the programs draw: frames of a display, or faces of a cube.
///
/// A picture consists of one drawing for each eye. TRANSFORM, RENDER and COPY process one drawing after the other.
pub trait Drawn: Clone + 'static {
    type Sent: Sent;

    /// Number of views of a drawing, such as the six faces of a cube. The regions of all views are numbered together:
    /// first the regions of view 0, then the regions of view 1, and so on.
    const VIEWS: u16 = 1;

    /// True if the master announces each drawing to its frame buffer before COPY. The announcement lists the regions
    /// that will arrive and requests the swap. Empty regions are then neither drawn nor copied. Pictures that are
    /// announced have one eye.
    ///
    /// If false, all regions are copied, and the master requests the swap when the whole picture has arrived.
    const ANNOUNCES: bool = false;

    /// Returns the viewport, shading and layout of a view.
    fn picture(&self) -> &Picture;

    /// Returns the number of drawings in a picture, which is the number of eyes.
    fn eyes(&self) -> u64 {
        1
    }

    /// Returns the parts of a pixel that are copied to the frame buffer, such as colour and depth.
    fn content(&self) -> CopyContent {
        CopyContent::Colour
    }

    /// Returns the number of finished regions that a renderer may store in its backing store.
    fn regions_stored(&self) -> usize {
        0
    }

    /// Returns the destination of a region of the picture of `eye`: ring port, buffer, and place in the picture.
    fn target(&self, sent: &Self::Sent, eye: u64, region: RegionId) -> CopyTarget;

    /// Returns the eye of a frame buffer, found by the ring port `port`. Drawings of one eye have eye 0. Returns `None`
    /// if no frame buffer has this port.
    fn eye_at(&self, port: NodeId) -> Option<u64>;

    /// Returns the number of swaps of the frame buffers so far. When the number increases, the master may begin new
    /// work.
    fn swaps(&self, gp: &Gp) -> u64;

    /// Returns the messages that announce a drawing to its frame buffer, if [`Drawn::ANNOUNCES`] is true.
    fn announcement(&self, _sent: &Self::Sent, _regions: &[RegionId]) -> Vec<(u32, Body)> {
        Vec::new()
    }

    /// Returns the messages that request the swap after COPY of a picture, if [`Drawn::ANNOUNCES`] is false.
    fn swap_requests(&self, _picture: PictureNumber) -> Vec<(NodeId, u32, Body)> {
        Vec::new()
    }

    /// Returns a slave's share with the vertices at their positions in a picture. By default, no vertex moves.
    fn placed(&self, share: &Share, _sent: &Self::Sent) -> Share {
        share.clone()
    }

    /// Transforms the triangles and spheres of a share for the picture of `eye`. Returns one pass for each view.
    fn passes(&self, share: &Share, sent: &Self::Sent, eye: u64) -> Vec<Arc<Pass>>;

    /// Returns the CPU work of TRANSFORM. `context` is the index of the set of bins, 0 or 1.
    fn work(&self, share: &Share, sent: &Self::Sent, passes: &[Arc<Pass>], context: u8) -> impl Work;

    fn view_regions(&self) -> u16 {
        self.picture().viewport.grid().regions() as u16
    }

    /// Returns the number of regions of a drawing, which is the sum over its views.
    fn regions(&self) -> u16 {
        self.view_regions() * Self::VIEWS
    }

    /// Returns the view that contains `region`, and the number of the region within this view.
    fn on_view(&self, region: RegionId) -> (usize, RegionId) {
        (usize::from(region.0 / self.view_regions()), RegionId(region.0 % self.view_regions()))
    }

    /// Returns the number of entries in each region's bin.
    fn entries(&self, passes: &[Arc<Pass>]) -> Vec<u32> {
        let entries = |region: u16| {
            let (view, region) = self.on_view(RegionId(region));
            passes.get(view).map_or(0, |pass| pass.counts(region).total())
        };
        (0..self.regions()).map(entries).collect()
    }
}

/// Ring ports of the boards, and the kind of pictures that they draw.
#[derive(Clone, Debug)]
pub struct RenderingControlConfig<D> {
    /// Ring port of the host, which sends views and edits of structures.
    pub host: NodeId,
    /// Ring port of the master, the graphics processor that permits each stage to begin.
    pub master: NodeId,
    /// Ring ports of the slaves. There is at least one.
    pub slaves: Vec<NodeId>,
    /// Ring ports of the renderers. There is at least one.
    pub renderers: Vec<NodeId>,
    /// Kind of pictures, and the ring ports of the frame buffers that receive the pictures.
    pub drawn: D,
}

impl<D: Drawn> RenderingControlConfig<D> {
    pub(crate) fn first_of(&self, picture: PictureNumber) -> Drawing {
        Drawing::first_of(picture, self.drawn.eyes())
    }

    pub(crate) fn picture_of(&self, drawing: Drawing) -> PictureNumber {
        drawing.picture(self.drawn.eyes())
    }

    pub(crate) fn eye_of(&self, drawing: Drawing) -> u64 {
        drawing.eye(self.drawn.eyes())
    }

    /// Returns the share of the slave `index`: the triangles and spheres that the slave stores and transforms.
    pub fn share(&self, list: &Arc<pphigs::DisplayList>, index: usize) -> Share {
        Share::new(Arc::clone(list), index, self.slaves.len())
    }
}
