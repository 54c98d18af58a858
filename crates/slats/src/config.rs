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
    pub renderers: Vec<NodeId>,
    /// Ring ports of the left and the right eye's frame buffer.
    pub frame_buffers: [NodeId; 2],
    /// Order and time of the copies of a field's regions.
    pub copy: CopySchedule,
    /// Choice of the regions to which a clump is sent.
    pub binning: RegionBinning,
    /// Precomputed colours of vertices ([`Shading::Precomputed`]), or lighting on the graphics processors
    /// ([`Shading::Gouraud`]).
    pub shading: Shading,
    /// Use of the bits of a pixel's memory, for up to four regions.
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

    /// Returns the place in a frame buffer to which a region is copied. `buffer` is the index of the buffer.
    ///
    /// A field needs only buffer 0, because the beam scans the lines of the other field during the copy. Only
    /// [`CopySchedule::Backup`] uses two buffers.
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
