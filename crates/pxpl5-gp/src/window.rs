//! The memory range of the message software, and the uncached part of this range.

use std::ops::Range;

/// Memory range of the message software, the last 64 KB of the first megabyte. Programs may not use this range for
/// other data.
pub const RING_MEMORY: Range<u32> = 0xF_0000..0x10_0000;

/// First address of the uncached memory, which extends to the end of [`RING_MEMORY`]. Here the ring interface reads and
/// writes directly. The i860 does not snoop the bus, so the board excludes this memory from the caches (KEN# pin).
pub(crate) const WINDOW: u32 = 0xF_4000;

/// Returns true if the caches can hold the data at `address`.
pub(crate) const fn is_cacheable(address: u32) -> bool {
    address < WINDOW || address >= RING_MEMORY.end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_extends_to_the_end_of_the_ring_softwares_memory() {
        let addresses = [0, WINDOW - 1, WINDOW, RING_MEMORY.end - 1, RING_MEMORY.end, u32::MAX];
        assert_eq!(addresses.map(is_cacheable), [true, true, false, false, true, true]);
    }
}
