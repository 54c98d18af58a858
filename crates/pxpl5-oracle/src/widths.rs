//! Bits that layouts of pixel memory differ in.

use pxpl5_renderer::Layout;
use pxpl5_wire::format::{Z_BITS, Z_FRACTION_BITS};

/// Widths of fields that layouts of pixel memory differ in.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Widths {
    z_bits: u32,
    /// Bits of a sphere's root, 10 to 12; spheres need a layout that has any.
    pub(crate) root_bits: u32,
}

impl Widths {
    pub(crate) fn of_layout(layout: &Layout) -> Self {
        Self { z_bits: layout.plan().z.width.into(), root_bits: layout.root_bits().map_or(ROOT_BITS, u32::from) }
    }

    /// A depth with all its bits as pixel memory keeps it.
    pub(crate) const fn stored_depth(self, depth: u32) -> u32 {
        depth >> (Z_FRACTION_BITS + Z_BITS - self.z_bits)
    }

    /// A depth that pixel memory keeps as it is sent to a display, in 24 bits; what a layout does not hold of them is 0.
    pub(crate) const fn sent_depth(self, stored: u32) -> u32 {
        stored << (Z_BITS - self.z_bits)
    }
}

/// Bits of the root for which a sphere's operands are computed.
pub(crate) const ROOT_BITS: u32 = 12;
