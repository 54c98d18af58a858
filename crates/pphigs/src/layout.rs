//! Where code and data lie in a board's memory.
//!
//! ```text
//!   0          1 MB                            ...                 8 MB
//!   | code, parameters, | display list | commands, bins   ...  | commands, bins |
//!   | table of bins, stack             | of context 0          |  of context 1  |
//! ```

/// Where the code of triangles begins, with its clipper; below are a processor's vectors.
pub(crate) const CODE: u32 = 0x1000;
/// Where the code of edits and of a pass's beginning begins.
pub(crate) const BEGIN_CODE: u32 = 0xC000;
/// Where the code of spheres begins.
pub(crate) const SPHERE_CODE: u32 = 0xE000;
/// A kernel's parameter block.
pub(crate) const PARAMETERS: u32 = 0x1_0000;
/// Where a kernel finds the end of each bin, and leaves it.
pub(crate) const BIN_TABLE: u32 = 0x1_0200;
/// The parameter block of spheres.
pub(crate) const SPHERE_PARAMETERS: u32 = 0x1_0400;
/// A kernel's stack frame, and the clipper's below.
pub(crate) const STACK: u32 = 0x1_1400;
/// The display list lies behind the first megabyte, which is the program's.
pub(crate) const DISPLAY_LIST: u32 = 1 << 20;
/// Where a message of the host lies: matrices, edits.
pub(crate) const MESSAGE: u32 = 0x1_4000;
/// Model matrices by structure, up to the lists of messages.
pub(crate) const MODELS: u32 = 0x1_6000;
/// Where the bins of both contexts begin and end, as their tokens find them.
pub(crate) const BINS: u32 = 0x1_3000;
/// Bytes of that for one context.
pub(crate) const BIN_BOUNDS_BYTES: u32 = 0x400;
/// The parameter block of a token's code, the commands that enclose a region, and the code itself.
pub(crate) const TOKEN_PARAMETERS: u32 = 0x1_3800;
pub(crate) const ENVELOPES: u32 = 0x1_3900;
pub(crate) const TOKEN_CODE: u32 = 0x1_3C00;
/// Messages of a region that is handed over, and their pieces.
pub(crate) const LISTS: u32 = 0x8_0000;
pub(crate) const PIECES: u32 = 0x9_0000;
pub(crate) const LISTS_END: u32 = pxpl5_gp::RING_MEMORY.start;
