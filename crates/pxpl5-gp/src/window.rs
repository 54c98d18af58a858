//! The part of a board's memory that belongs to the software of messages, and the window in it that no cache holds.

use std::ops::Range;

/// The part of a board's memory that belongs to the software of messages: the end of the first megabyte. No program may use it.
pub const RING_MEMORY: Range<u32> = 0xF_0000..0x10_0000;

/// From here to its end the ring's interface writes and reads beside the processor, which does not watch its bus: the board
/// keeps these addresses out of the caches (KEN#).
pub(crate) const WINDOW: u32 = 0xF_4000;

/// Whether the caches may hold what lies at an address.
pub(crate) const fn is_cacheable(address: u32) -> bool {
    address < WINDOW || address >= RING_MEMORY.end
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_is_from_its_first_byte_to_the_end_of_the_softwares_memory() {
        let addresses = [0, WINDOW - 1, WINDOW, RING_MEMORY.end - 1, RING_MEMORY.end, u32::MAX];
        assert_eq!(addresses.map(is_cacheable), [true, true, false, false, true, true]);
    }
}
