//! Who takes part, and which variant runs.

use crate::bind::Binding;
use crate::error::SlatsConfigError;
use crate::schedule::CopySchedule;
use pphigs::{Picture, RegionBinning, Shading};
use pxpl5_geometry::Viewport;
use pxpl5_renderer::Layout;
use pxpl5_wire::{CopyTarget, FieldParity, Lines, NodeId, PeriodNumber, PictureNumber, RegionGrid};

/// The boards that take part, and the variant of Slats that they run.
#[derive(Clone, Debug)]
pub struct SlatsConfig {
    /// Node of the host interface, which sends the viewing transforms.
    pub host: NodeId,
    /// Nodes of the GPs; the first one leads.
    pub processors: Vec<NodeId>,
    /// Nodes of the renderers, by the index that [`crate::BoundRegion`] uses.
    pub renderers: Vec<NodeId>,
    /// Nodes of the left and the right eye's frame buffer.
    pub frame_buffers: [NodeId; 2],
    /// When the regions of a field are copied.
    pub copy: CopySchedule,
    /// Who gets the commands of a clump.
    pub binning: RegionBinning,
    /// Whether vertex colours are precomputed ([`Shading::Precomputed`]) or lit on the GPs ([`Shading::Gouraud`]).
    pub shading: Shading,
    /// How the bits of pixel memory are divided among contexts.
    pub layout: Layout,
    /// Whether somebody may want pixels: without it no command words are made, and all times stay the same.
    pub pixels: bool,
}

impl SlatsConfig {
    /// Checks the numbers of boards.
    ///
    /// # Errors
    ///
    /// [`SlatsConfigError`] when regions do not fit or no processor is there.
    pub fn check(&self) -> Result<Binding, SlatsConfigError> {
        if self.processors.is_empty() {
            return Err(SlatsConfigError::NoProcessor);
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

    /// A field is written into the lines that are not being scanned, so without a backup buffer 0 is enough: interlace
    /// is the double buffer.
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
