//! The kind of pictures that the firmware draws: the part that Rendering Control and Cube control do not share.

use crate::rules::Drawing;
use pphigs::{FrameView, Pass, Picture, Share};
use pxpl5_gp::{Gp, Work};
use pxpl5_wire::{Body, CopyContent, CopyTarget, NodeId, PictureNumber, RegionId, Word};
use std::fmt::Debug;
use std::sync::Arc;

/// Content of the message that the host sends for a picture (SEND).
pub trait Sent: Clone + Debug + PartialEq + 'static {
    /// Returns the number of the picture.
    fn number(&self) -> PictureNumber;

    /// Returns the view of the picture, with the edits of structures.
    fn view(&self) -> &FrameView;

    /// Encodes the content as words.
    fn to_words(&self) -> Vec<Word>;

    /// Decodes the content, or returns `None` for invalid words.
    fn from_words(words: &[Word]) -> Option<Self>;
}

/// A kind of pictures. A picture consists of one or more *drawings*, and each drawing passes TRANSFORM, RENDER and COPY
/// alone.
pub trait Drawn: Clone + 'static {
    /// Content of the host's messages.
    type Sent: Sent;

    /// Number of views of a drawing. The regions of all views are counted one view after the other.
    const VIEWS: u16 = 1;

    /// True if the master announces each drawing to its frame buffer before COPY. The announcement lists the regions
    /// that will arrive, so empty regions are neither drawn nor copied. The announcement also requests the swap.
    ///
    /// Otherwise all regions are copied, and the master requests a swap when the whole picture has arrived.
    const ANNOUNCES: bool = false;

    /// Returns the parameters of the picture of one view.
    fn picture(&self) -> &Picture;

    /// Returns the number of drawings in a picture: the number of eyes.
    fn eyes(&self) -> u64 {
        1
    }

    /// Returns the contents of a pixel that are copied to the frame buffer.
    fn content(&self) -> CopyContent {
        CopyContent::Colour
    }

    /// Returns the largest number of finished regions in the backing store of a renderer.
    fn regions_stored(&self) -> usize {
        0
    }

    /// Returns the destination of a region of an eye.
    fn target(&self, sent: &Self::Sent, eye: u64, region: RegionId) -> CopyTarget;

    /// Returns the eye to whose frame buffer a port belongs. Returns `None` if the node is not a frame-buffer port.
    fn eye_at(&self, port: NodeId) -> Option<u64>;

    /// Returns the number of swaps so far, from the status signals of the frame buffers. The master looks for work when
    /// the number increases.
    fn swaps(&self, gp: &Gp) -> u64;

    /// Returns the messages that announce a drawing to its frame buffer ([`Drawn::ANNOUNCES`]).
    fn announcement(&self, _sent: &Self::Sent, _regions: &[RegionId]) -> Vec<(u32, Body)> {
        Vec::new()
    }

    /// Returns the messages that request a swap after COPY of a picture.
    fn swap_requests(&self, _picture: PictureNumber) -> Vec<(NodeId, u32, Body)> {
        Vec::new()
    }

    /// Returns the share of a slave with the vertices of a picture. The default leaves all vertices in place.
    fn placed(&self, share: &Share, _sent: &Self::Sent) -> Share {
        share.clone()
    }

    /// Transforms a share for all views of an eye's drawing.
    fn passes(&self, share: &Share, sent: &Self::Sent, eye: u64) -> Vec<Arc<Pass>>;

    /// Returns the CPU work of TRANSFORM for these passes. `context` is the bin context of the drawing, 0 or 1.
    fn work(&self, share: &Share, sent: &Self::Sent, passes: &[Arc<Pass>], context: u8) -> impl Work;

    /// Returns the number of regions of a view.
    fn view_regions(&self) -> u16 {
        self.picture().viewport.grid().regions() as u16
    }

    /// Returns the number of regions of a drawing.
    fn regions(&self) -> u16 {
        self.view_regions() * Self::VIEWS
    }

    /// Returns the view that contains a region, and the index of the region within this view.
    fn on_view(&self, region: RegionId) -> (usize, RegionId) {
        (usize::from(region.0 / self.view_regions()), RegionId(region.0 % self.view_regions()))
    }

    /// Returns the number of entries in the bin of each region of a drawing.
    fn entries(&self, passes: &[Arc<Pass>]) -> Vec<u32> {
        let entries = |region: u16| {
            let (view, region) = self.on_view(RegionId(region));
            passes.get(view).map_or(0, |pass| pass.counts(region).total())
        };
        (0..self.regions()).map(entries).collect()
    }
}

/// The boards that run the firmware, and the kind of pictures that they draw.
#[derive(Clone, Debug)]
pub struct RenderingControlConfig<D> {
    /// Ring port of the host, which sends views and edits.
    pub host: NodeId,
    /// Ring port of the master, which begins every stage.
    pub master: NodeId,
    /// Ring ports of the slaves, at least one.
    pub slaves: Vec<NodeId>,
    /// Ring ports of the renderers, at least one.
    pub renderers: Vec<NodeId>,
    /// Kind and destination of the pictures.
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

    /// Returns the share of the primitives that the slave with index `index` holds.
    #[must_use]
    pub fn share(&self, list: &Arc<pphigs::DisplayList>, index: usize) -> Share {
        Share::new(Arc::clone(list), index, self.slaves.len())
    }
}
