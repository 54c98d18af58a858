//! Settings of Rendering Control: the boards and the picture.

use crate::rules::EyeDrawing;
use pphigs::{Picture, Share};
use pxpl5_geometry::Viewport;
use pxpl5_wire::{CopyTarget, Lines, NodeId, PictureNumber, RegionGrid, RegionId, SurfaceId};

/// The boards of the pipeline, and the settings of its pictures.
#[derive(Clone, Debug)]
pub struct RenderingControlConfig {
    /// Ring port of the host, which sends views and edits.
    pub host: NodeId,
    /// Ring port of the master, which begins every stage.
    pub master: NodeId,
    /// Ring ports of the slaves, at least one.
    pub slaves: Vec<NodeId>,
    /// Ring ports of the renderers, at least one.
    pub renderers: Vec<NodeId>,
    /// First ring port of each frame buffer: one frame buffer for a mono picture, or a frame buffer for each eye.
    pub frame_buffers: Vec<NodeId>,
    /// All ring ports of the frame buffers: the first port of each frame buffer, then the second ports, and so on. The
    /// regions of an eye's picture use the ports of its frame buffer in turn.
    pub frame_buffer_ports: Vec<NodeId>,
    /// Settings of each eye's picture.
    pub picture: Picture,
    /// Largest number of finished regions in the backing store of a renderer, where the regions wait for the frame
    /// buffer.
    ///
    /// Meanwhile, the renderer draws the next region. With a value of 0, the renderer keeps a finished region in pixel
    /// memory and waits for its copy. The size of the backing store limits the number to `renderer.backing_bits /
    /// renderer.kept_bits`.
    pub regions_stored: usize,
}

impl RenderingControlConfig {
    /// Returns the number of eyes of a frame: 1 or 2.
    #[must_use]
    pub fn eyes(&self) -> u64 {
        self.frame_buffers.len() as u64
    }

    /// Returns the first drawing of a frame. A drawing is the picture of one eye.
    pub(crate) fn first_of(&self, frame: PictureNumber) -> EyeDrawing {
        EyeDrawing::first_of(frame, self.eyes())
    }

    pub(crate) fn frame_of(&self, drawing: EyeDrawing) -> PictureNumber {
        drawing.frame(self.eyes())
    }

    pub(crate) fn eye_of(&self, drawing: EyeDrawing) -> SurfaceId {
        SurfaceId(drawing.eye(self.eyes()) as u16)
    }

    pub(crate) fn grid(&self) -> RegionGrid {
        self.viewport().grid()
    }

    pub(crate) fn viewport(&self) -> Viewport {
        self.picture.viewport
    }

    /// Returns the index of the buffer into which a frame is drawn. This buffer is hidden meanwhile. Buffer 0 is shown
    /// at the start.
    pub(crate) fn buffer_of(frame: PictureNumber) -> u8 {
        (frame.next().0 % 2) as u8
    }

    pub(crate) fn target(&self, drawing: EyeDrawing, region: RegionId) -> CopyTarget {
        let frame = self.frame_of(drawing);
        CopyTarget {
            frame_buffer: self.port(self.eye_of(drawing), region),
            buffer: Self::buffer_of(frame),
            lines: Lines::Frame,
            grid: self.grid(),
            region,
            picture: frame,
        }
    }

    fn port(&self, eye: SurfaceId, region: RegionId) -> NodeId {
        let eyes = self.frame_buffers.len();
        let of_an_eye = (self.frame_buffer_ports.len() / eyes).max(1);
        self.frame_buffer_ports[usize::from(region.0) % of_an_eye * eyes + eye.index()]
    }

    /// Returns the index of the eye whose frame buffer has the port `port`, or `None` if no frame buffer has this port.
    pub(crate) fn eye_at(&self, port: NodeId) -> Option<usize> {
        let place = self.frame_buffer_ports.iter().position(|node| *node == port)?;
        Some(place % self.frame_buffers.len())
    }

    /// Returns the primitives of the slave with index `index`.
    #[must_use]
    pub fn share(&self, list: &std::sync::Arc<pphigs::DisplayList>, index: usize) -> Share {
        Share::new(std::sync::Arc::clone(list), index, self.slaves.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_go_to_the_buffer_that_is_not_shown_beginning_with_the_second() {
        let buffers = [0, 1, 2, 3].map(|frame| RenderingControlConfig::buffer_of(PictureNumber(frame)));
        assert_eq!(buffers, [1, 0, 1, 0]);
    }
}
