//! Configuration of Slats: the boards, and the variant of the pipeline.

use crate::bind::Binding;
use crate::schedule::CopySchedule;
use pphigs::{Picture, RegionBinning, Shading};
use pxpl5_geometry::Viewport;
use pxpl5_renderer::Layout;
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{CopyTarget, FieldParity, Lines, NodeId, PeriodNumber, PictureNumber, RegionGrid};

/// The boards of the pipeline, and the variant of Slats.
#[derive(Clone, Debug)]
pub struct SlatsConfig {
    /// Ring port of the host, which sends the viewing transforms.
    pub host: NodeId,
    /// Ring ports of the graphics processors. The first graphics processor is the leader.
    pub processors: Vec<NodeId>,
    /// Ring ports of the renderers. [`crate::BoundRegion`] uses the indices of this list.
    pub renderers: Vec<NodeId>,
    /// Ring ports of the left and the right eye's frame buffer.
    pub frame_buffers: [NodeId; 2],
    /// Schedule for copying the regions of a field.
    pub copy: CopySchedule,
    /// Binning mode: the regions that receive the commands of a clump.
    pub binning: RegionBinning,
    /// Shading mode: precomputed vertex colours ([`Shading::Precomputed`]) or lighting on the graphics processors
    /// ([`Shading::Gouraud`]).
    pub shading: Shading,
    /// Division of pixel memory among contexts.
    pub layout: Layout,
    /// True if the run can compute pixels. If false, no command words are made, but all times stay the same.
    pub pixels: bool,
}

impl SlatsConfig {
    /// Checks the numbers of boards, and binds the regions to renderers.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the renderers have too few contexts for the regions, or if there is no graphics
    /// processor.
    pub fn check(&self) -> Result<Binding, SettingError> {
        if self.processors.is_empty() {
            return Err(SettingError::combination("Slats needs at least one graphics processor, found none"));
        }
        Binding::new(self.renderers.len(), self.layout.plan().contexts, self.copy)
    }

    pub(crate) fn picture(&self, parity: FieldParity) -> Picture {
        Picture {
            viewport: Viewport::field(parity),
            shading: self.shading,
            binning: self.binning,
            layout: self.layout,
            pixels: self.pixels,
        }
    }

    /// Returns the destination of a region's pixels: the frame buffer of the eye, pixel buffer `buffer`, and the lines
    /// of field `field`.
    ///
    /// While a field is written into its lines, the beam scans the other lines of the frame. Interlace thus acts as a
    /// double buffer. Without a backup buffer, only buffer 0 is needed.
    pub(crate) fn target(&self, bound: &crate::BoundRegion, field: PeriodNumber, buffer: u8) -> CopyTarget {
        CopyTarget {
            frame_buffer: self.frame_buffers[bound.eye.index()],
            buffer,
            lines: Lines::Field(FieldParity::of_field(field)),
            grid: RegionGrid::FIELD,
            region: bound.region,
            picture: PictureNumber::drawn_for(field),
        }
    }
}
