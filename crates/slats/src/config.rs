//! Who takes part, and which variant runs.

use crate::bind::Binding;
use pphigs::{Binning, Picture, Shading};
use pxpl5_geometry::Viewport;
use pxpl5_renderer::Layout;
use pxpl5_wire::{CopyTarget, FieldParity, Lines, NodeId, RegionGrid};
use std::fmt;

/// When regions are copied.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Copy {
    /// All before the retrace.
    Whole,
    /// Top regions before the retrace, bottom regions right after it (the COPY optimisation).
    Split,
    /// All before the retrace, into the buffer that does not hold the last complete field of these lines; only a
    /// complete field is shown, otherwise that one again. (Beyond the prototype: named as future work in TR94.)
    Backup,
}

impl Copy {
    /// Whether bottom regions are copied after the retrace.
    #[must_use]
    pub const fn is_split(self) -> bool {
        matches!(self, Self::Split)
    }
}

/// The boards and the variant.
#[derive(Clone, Debug)]
pub struct Config {
    /// The host interface.
    pub host: NodeId,
    /// The GPs; the first one leads.
    pub processors: Vec<NodeId>,
    /// The renderers.
    pub renderers: Vec<NodeId>,
    /// Left and right frame buffer.
    pub frame_buffers: [NodeId; 2],
    /// When regions are copied.
    pub copy: Copy,
    /// Who gets the commands of a clump.
    pub binning: Binning,
    /// Division of pixel memory.
    pub layout: Layout,
    /// Whether somebody may want pixels.
    pub pixels: bool,
}

/// A machine on which Slats cannot run.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ConfigError {
    /// There are more regions than contexts.
    TooFewRenderers {
        /// Renderers found.
        found: usize,
        /// Renderers needed.
        expected: usize,
    },
    /// There is no graphics processor.
    NoProcessor,
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooFewRenderers { found, expected } => write!(
                f,
                "Slats binds 20 field regions statically: expected at least {expected} renderers of four contexts, found {found}"
            ),
            Self::NoProcessor => f.write_str("Slats needs at least one graphics processor, found none"),
        }
    }
}

impl std::error::Error for ConfigError {}

impl Config {
    /// Checks the numbers of boards.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] when regions do not fit or no processor is there.
    pub fn check(&self) -> Result<Binding, ConfigError> {
        if self.processors.is_empty() {
            return Err(ConfigError::NoProcessor);
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
