//! Where code and data lie in a board's memory.
//!
//! ```text
//!   0          1 MB                            ...                 8 MB
//!   | code, parameters, | display list | commands, bins   ...  | commands, bins |
//!   | table of bins, stack             | of context 0          |  of context 1  |
//! ```

/// Where the code of triangles begins, with its clipper; below are a processor's vectors.
pub(crate) const CODE: u32 = 0x1000;
/// Where the code begins that decides which of six views a primitive is given to.
pub(crate) const SORT_CODE: u32 = 0xB000;
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
/// A kernel's stack frame; the clipper's lies below, and that of what calls kernels for runs of primitives.
pub(crate) const STACK: u32 = 0x1_1400;
/// The display list lies behind the first megabyte, which is the program's.
pub(crate) const DISPLAY_LIST: u32 = 1 << 20;
/// Where a message of the host lies: matrices, edits.
pub(crate) const MESSAGE: u32 = 0x1_4000;
/// Model matrices by structure, up to the bins of further views.
pub(crate) const MODELS: u32 = 0x1_6000;
/// As [`BINS`], of further views that share a context: of each of them both contexts.
const MORE_BINS: u32 = 0x7_D000;
/// Where matrices end.
pub(crate) const MODELS_END: u32 = MORE_BINS;
/// Views whose bins may share a context: those of the faces of a cube.
pub(crate) const MOST_VIEWS: u32 = 6;
/// Where the bins of both contexts begin and end, as their tokens find them.
const BINS: u32 = 0x1_2F00;
/// Bytes of that for one context: the number of its spheres, and two addresses for each region.
const BIN_BOUNDS_BYTES: u32 = 0x480;
/// The parameter block of a token's code, the commands that enclose a region, and the code itself.
pub(crate) const TOKEN_PARAMETERS: u32 = 0x1_3800;
pub(crate) const ENVELOPES: u32 = 0x1_3900;
pub(crate) const TOKEN_CODE: u32 = 0x1_3C00;
/// Messages of a region that is handed over, and their pieces.
pub(crate) const LISTS: u32 = 0x8_0000;
pub(crate) const PIECES: u32 = 0x9_0000;
pub(crate) const LISTS_END: u32 = pxpl5_gp::RING_MEMORY.start;

/// Where the bins of a context begin and end, of the first view of those that share it or of a further one.
pub(crate) fn bins(context: u8, view: u8) -> u32 {
    let context = u32::from(context % 2);
    match u32::from(view).checked_sub(1) {
        None => BINS + context * BIN_BOUNDS_BYTES,
        Some(further) => MORE_BINS + (2 * further + context) * BIN_BOUNDS_BYTES,
    }
}

const _: () = {
    let regions = pxpl5_geometry::RegionMask::CAPACITY;
    assert!(BIN_TABLE + 4 * regions <= SPHERE_PARAMETERS, "a bin's end for each region");
    assert!(4 * (1 + 2 * regions) <= BIN_BOUNDS_BYTES && BINS + 2 * BIN_BOUNDS_BYTES <= TOKEN_PARAMETERS);
    assert!(MORE_BINS + 2 * (MOST_VIEWS - 1) * BIN_BOUNDS_BYTES <= LISTS);
};
