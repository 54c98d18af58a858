//! Numbers of bits in which pixel memory stores depths and square roots.

use pxpl5_renderer::Layout;
use pxpl5_wire::format::{Z_BITS, Z_FRACTION_BITS};

#[derive(Clone, Copy, Debug)]
pub(crate) struct Widths {
    z_bits: u32,
    /// Bits of a sphere's square root, 10 to 12. If pixel memory has no bits for the root, the renderer draws no
    /// spheres, and the value is 12.
    pub(crate) root_bits: u32,
}

impl Widths {
    pub(crate) fn of_layout(layout: &Layout) -> Self {
        Self { z_bits: layout.plan().z.width.into(), root_bits: layout.root_bits().map_or(ROOT_BITS, u32::from) }
    }

    pub(crate) const fn stored_depth(self, depth: u32) -> u32 {
        depth >> (Z_FRACTION_BITS + Z_BITS - self.z_bits)
    }

    /// Returns a stored depth as 24 bits, as a display receives it. Bits that are not stored are 0.
    pub(crate) const fn sent_depth(self, stored: u32) -> u32 {
        stored << (Z_BITS - self.z_bits)
    }
}

/// Number of bits of the square root for which the operands of a sphere's command are computed.
pub(crate) const ROOT_BITS: u32 = 12;
