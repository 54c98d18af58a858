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
