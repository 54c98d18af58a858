//! Who takes part, and which variant runs.

use crate::bind::Binding;
use pphigs::{Binning, Picture, Shading};
use pxpl5_geometry::Viewport;
use pxpl5_renderer::Layout;
use pxpl5_wire::{CopyTarget, FieldParity, Lines, NodeId, RegionGrid};
use thiserror::Error;

/// When the regions of a field are copied to the frame buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CopySchedule {
    /// All regions before the retrace.
    Whole,
    /// Top regions before the retrace, bottom regions right after it (the COPY optimisation).
    Split,
    /// All before the retrace, into the buffer that does not hold the last complete field of these lines; only a
    /// complete field is shown, otherwise that one again. (Beyond the prototype: named as future work in TR94.)
    Backup,
}

impl CopySchedule {
    /// Whether bottom regions are copied after the retrace.
    #[must_use]
    pub const fn is_split(self) -> bool {
        matches!(self, Self::Split)
    }
}

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
    pub binning: Binning,
    /// How the bits of pixel memory are divided among contexts.
    pub layout: Layout,
    /// Whether somebody may want pixels: without it no command words are made, and all times stay the same.
    pub pixels: bool,
}

/// A machine on which Slats cannot run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SlatsConfigError {
    /// There are more regions than contexts.
    #[error(
        "Slats binds 20 field regions statically: expected at least {expected} renderers of four contexts, found {found}"
    )]
    TooFewRenderers {
        /// How many renderers the machine has.
        found: usize,
        /// The fewest whose contexts hold the 20 regions of both eyes.
        expected: usize,
    },
    /// There is no graphics processor.
    #[error("Slats needs at least one graphics processor, found none")]
    NoProcessor,
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
            shading: Shading::Gouraud,
            binning: self.binning,
            layout: self.layout,
            pixels: self.pixels,
        }
    }

    /// A field is written into the lines that are not being scanned, so without a backup buffer 0 is enough: interlace
    /// is the double buffer.
    pub(crate) fn target(&self, bound: &crate::BoundRegion, field: u64, buffer: u8) -> CopyTarget {
        CopyTarget {
            frame_buffer: self.frame_buffers[bound.eye.index()],
            buffer,
            lines: Lines::Field(FieldParity::of_field(field)),
            grid: RegionGrid::FIELD,
            region: bound.region,
            picture: field,
        }
    }
}
