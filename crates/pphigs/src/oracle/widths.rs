//! Numbers of bits of a pixel's values, as far as the layout of pixel memory determines them.

use pxpl5_renderer::Layout;
use pxpl5_wire::format::{Z_BITS, Z_FRACTION_BITS};

/// Numbers of bits of a pixel's values, as far as the layout of pixel memory determines them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Widths {
    z_bits: u32,
    /// Bits of a sphere's square root, 10 to 12. A layout of pixel memory without bits for the root cannot draw
    /// spheres. The value is then 12.
    pub(crate) root_bits: u32,
}

impl Widths {
    pub(crate) fn of_layout(layout: &Layout) -> Self {
        Self { z_bits: layout.plan().z.width.into(), root_bits: layout.root_bits().map_or(ROOT_BITS, u32::from) }
    }

    /// Returns a depth with the bits that pixel memory stores. `depth` has all bits that a renderer computes.
    pub(crate) const fn stored_depth(self, depth: u32) -> u32 {
        depth >> (Z_FRACTION_BITS + Z_BITS - self.z_bits)
    }

    /// Returns a stored depth in 24 bits, as a display receives it. Bits that the layout does not store are 0.
    pub(crate) const fn sent_depth(self, stored: u32) -> u32 {
        stored << (Z_BITS - self.z_bits)
    }
}

/// Number of bits of the square root that the computation of a sphere's operands assumes.
pub(crate) const ROOT_BITS: u32 = 12;
