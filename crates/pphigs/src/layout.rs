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
/// The right eye's parameter block, of kernels that serve both eyes: behind a kernel's stack frame.
pub(crate) const RIGHT_PARAMETERS: u32 = 0x1_2500;
/// The display list lies behind the first megabyte, which is the program's.
pub(crate) const DISPLAY_LIST: u32 = 1 << 20;
/// Where a message of the host lies: matrices, edits.
pub(crate) const MESSAGE: u32 = 0x1_4000;
/// Model matrices by structure, up to the bins of further views.
pub(crate) const MODELS: u32 = 0x1_6000;
/// As [`BINS`], of further views that share a context: of each of them both contexts.
const MORE_BINS: u32 = 0x7_D000;
/// Where matrices end.
pub(crate) const MODELS_END: u32 = BLENDED;
/// Elements of matrices of two views and of one between them, and how many there is room for.
pub(crate) const BLENDED: u32 = 0x7_5000;
pub(crate) const BLENDED_ELEMENTS: u32 = 1024;
/// Where the code begins that finds what meets windows.
pub(crate) const WINDOWS_CODE: u32 = 0x7_8000;
/// The windows that are searched for, the rectangle around them first, and the picture's regions as windows.
pub(crate) const WINDOWS: u32 = 0x7_9000;
pub(crate) const REGION_WINDOWS: u32 = 0x7_9C00;
/// Upper left pixels of windows.
pub(crate) const WINDOW_PLACES: u32 = 0x7_AE00;
/// Lists of what meets windows, as [`bins`] of a context.
pub(crate) const WINDOW_LISTS: u32 = 0x7_B000;
/// Where the passes lie that are kept, of each in a part of memory.
pub(crate) const KEPT: u32 = 0x7_B400;
/// Bytes of that for one.
pub(crate) const KEPT_BYTES: u32 = 32;
/// Passes that there is room for.
pub(crate) const MOST_KEPT: u32 = 16;
/// Where the code begins that puts orders together.
pub(crate) const ORDER_CODE: u32 = 0x7_B600;
/// What an order says, and its views.
pub(crate) const ORDER_HEAD: u32 = 0x7_B800;
pub(crate) const ORDER_VIEWS: u32 = 0x7_C000;
/// Windows that are searched for at once.
pub(crate) const MOST_WINDOWS: u32 = 64;
/// Bytes of a window.
pub(crate) const WINDOW_BYTES: u32 = 32;
/// Bytes at the end of memory for the entries of the windows of an order.
pub(crate) const ENTRY_BYTES: u32 = 4 * (LISTS_END - PIECES) / 8;
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
    assert!(RIGHT_PARAMETERS + 4 * pxpl5_geometry::kernel::PARAMETER_WORDS as u32 <= BINS);
    assert!(BIN_TABLE + 4 * regions <= SPHERE_PARAMETERS, "a bin's end for each region");
    assert!(4 * (1 + 2 * regions) <= BIN_BOUNDS_BYTES && BINS + 2 * BIN_BOUNDS_BYTES <= TOKEN_PARAMETERS);
    assert!(MORE_BINS + 2 * (MOST_VIEWS - 1) * BIN_BOUNDS_BYTES <= LISTS);
    assert!(BLENDED + 3 * 4 * BLENDED_ELEMENTS <= WINDOWS_CODE);
    assert!(WINDOWS + WINDOW_BYTES * (1 + MOST_WINDOWS) <= REGION_WINDOWS);
    assert!(REGION_WINDOWS + WINDOW_BYTES * (1 + regions) <= WINDOW_PLACES, "a window for each region");
    assert!(WINDOW_PLACES + 4 * regions <= WINDOW_LISTS && MOST_WINDOWS <= regions);
    assert!(WINDOW_LISTS + 4 * (1 + 2 * MOST_WINDOWS) <= KEPT && KEPT + KEPT_BYTES * MOST_KEPT <= ORDER_CODE);
    assert!(ORDER_VIEWS + 4 * pxpl5_wire::MAX_MESSAGE_WORDS <= MORE_BINS);
};
