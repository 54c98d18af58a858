//! Frames of one or two eyes, which are drawn into frame buffers (TR94).

use crate::drawn::{Drawn, Sent};
use pphigs::{FrameView, Pass, Picture, Share, TransformWork};
use pxpl5_gp::{Gp, Work};
use pxpl5_wire::{Body, CopyTarget, Lines, NodeId, PictureNumber, RegionId, Word, swap_request};
use std::sync::Arc;

/// Frames of one or two eyes. The frame buffers of the eyes swap together.
#[derive(Clone, Debug)]
pub struct Frames {
    /// First ring port of the frame buffer of each eye: one port for a mono picture, and two ports for a stereo
    /// picture.
    pub frame_buffers: Vec<NodeId>,
    /// All ring ports of the frame buffers: the first port of each frame buffer, then the second port of each, and so
    /// on. The regions of an eye use the ports of the eye's frame buffer in turn.
    pub frame_buffer_ports: Vec<NodeId>,
    /// Viewport, shading and layout of a picture, which are the same for all eyes.
    pub picture: Picture,
    /// Number of finished regions that a renderer may store in its backing store until the frame buffer is available.
    ///
    /// If the number is 0, a renderer keeps a finished region in pixel memory and waits until the region is copied.
    /// Otherwise the renderer draws its next region in the meantime. The maximum is `renderer.backing_bits /
    /// renderer.kept_bits`.
    pub regions_stored: usize,
}

impl Sent for FrameView {
    fn number(&self) -> PictureNumber {
        self.number.picture_taken_for()
    }

    fn view(&self) -> &FrameView {
        self
    }

    fn to_words(&self) -> Vec<Word> {
        Self::to_words(self)
    }

    fn from_words(words: &[Word]) -> Option<Self> {
        Self::from_words(words).ok()
    }
}

/// Returns the buffer into which a frame is drawn, 0 or 1. Buffer 0 is shown at the start, so frame 0 is drawn into
/// buffer 1.
const fn buffer_of(frame: PictureNumber) -> u8 {
    (frame.next().0 % 2) as u8
}

impl Drawn for Frames {
    type Sent = FrameView;

    fn picture(&self) -> &Picture {
        &self.picture
    }

    fn eyes(&self) -> u64 {
        self.frame_buffers.len() as u64
    }

    fn regions_stored(&self) -> usize {
        self.regions_stored
    }

    fn target(&self, view: &FrameView, eye: u64, region: RegionId) -> CopyTarget {
        let eyes = self.frame_buffers.len();
        let ports_of_eye = (self.frame_buffer_ports.len() / eyes).max(1);
        let picture = Sent::number(view);
        CopyTarget {
            frame_buffer: self.frame_buffer_ports[usize::from(region.0) % ports_of_eye * eyes + eye as usize],
            buffer: buffer_of(picture),
            lines: Lines::Frame,
            grid: self.picture.viewport.grid(),
            region,
            picture,
        }
    }

    fn eye_at(&self, port: NodeId) -> Option<u64> {
        let place = self.frame_buffer_ports.iter().position(|node| *node == port)?;
        Some(place as u64 % self.eyes())
    }

    fn swaps(&self, gp: &Gp) -> u64 {
        self.frame_buffers.iter().map(|node| gp.status(*node)).min().unwrap_or(0)
    }

    fn swap_requests(&self, frame: PictureNumber) -> Vec<(NodeId, u32, Body)> {
        let request = |node: &NodeId| (*node, 2, Body::Words(swap_request(buffer_of(frame))));
        self.frame_buffers.iter().map(request).collect()
    }

    fn passes(&self, share: &Share, view: &FrameView, eye: u64) -> Vec<Arc<Pass>> {
        vec![share.transform(view, eye as usize, self.picture)]
    }

    fn work(&self, _: &Share, _: &FrameView, passes: &[Arc<Pass>], context: u8) -> impl Work {
        TransformWork { passes, context, begins: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_go_to_the_hidden_buffer_starting_with_the_second_buffer() {
        let buffers = [0, 1, 2, 3].map(|frame| buffer_of(PictureNumber(frame)));
        assert_eq!(buffers, [1, 0, 1, 0]);
    }
}
