//! Addresses of code and data in a board's memory.
//!
//! ```text
//!   0          1 MB                            ...                 8 MB
//!   | code, parameters, | display list | commands, bins   ...  | commands, bins |
//!   | table of bins, stack             | of context 0          |  of context 1  |
//! ```

/// Address of the i860 code for triangles, with the clipper (the program that cuts triangles at the guard band). The
/// processor's trap vectors are below this address.
pub(crate) const CODE: u32 = 0x1000;
pub(crate) const SORT_CODE: u32 = 0xB000;
pub(crate) const BEGIN_CODE: u32 = 0xC000;
pub(crate) const SPHERE_CODE: u32 = 0xE000;
pub(crate) const PARAMETERS: u32 = 0x1_0000;
/// Address of the table of bins. A kernel reads and updates the end of each bin in this table.
pub(crate) const BIN_TABLE: u32 = 0x1_0200;
pub(crate) const SPHERE_PARAMETERS: u32 = 0x1_0400;
/// Address of the stack frame of a kernel. The stack frames of the clipper and of kernels/runs.s are below this
/// address.
pub(crate) const STACK: u32 = 0x1_1400;
pub(crate) const RIGHT_PARAMETERS: u32 = 0x1_2500;
/// Address of the display list, after the first megabyte, which belongs to the program.
pub(crate) const DISPLAY_LIST: u32 = 1 << 20;
/// Address of a message from the host, with matrices or edits.
pub(crate) const MESSAGE: u32 = 0x1_4000;
pub(crate) const MODELS: u32 = 0x1_6000;
/// Address of the bounds of the bins for the second and later views in a set of bins, in the format of [`BINS`].
const MORE_BINS: u32 = 0x7_D000;
pub(crate) const MODELS_END: u32 = BLENDED;
/// Address of the matrix elements of the first view, of the second view, and of the view between them.
pub(crate) const BLENDED: u32 = 0x7_5000;
pub(crate) const BLENDED_ELEMENTS: u32 = 1024;
/// Address of the code that finds the primitives in windows (rectangles of the screen).
pub(crate) const WINDOWS_CODE: u32 = 0x7_8000;
/// Address of the windows (rectangles of the screen) to search. The rectangle around all windows comes first.
pub(crate) const WINDOWS: u32 = 0x7_9000;
pub(crate) const REGION_WINDOWS: u32 = 0x7_9C00;
pub(crate) const WINDOW_PLACES: u32 = 0x7_AE00;
/// Address of the lists of the primitives in windows (rectangles of the screen), each with a start and an end like a
/// bin (see [`bins`]).
pub(crate) const WINDOW_LISTS: u32 = 0x7_B000;
/// Address of the records of stored passes. A stored pass is a result of TRANSFORM that later searches use instead of
/// bins.
pub(crate) const KEPT: u32 = 0x7_B400;
/// Size of the record of a stored pass, in bytes.
pub(crate) const KEPT_BYTES: u32 = 32;
pub(crate) const MAX_KEPT: u32 = 16;
pub(crate) const ORDER_CODE: u32 = 0x7_B600;
/// Address of the first words of an order, before its views.
pub(crate) const ORDER_HEAD: u32 = 0x7_B800;
pub(crate) const ORDER_VIEWS: u32 = 0x7_C000;
pub(crate) const MAX_WINDOWS: u32 = 64;
pub(crate) const WINDOW_BYTES: u32 = 32;
/// Size in bytes of the area at the end of memory for the list of primitives that one search finds.
pub(crate) const ENTRY_BYTES: u32 = 4 * (LISTS_END - PIECES) / 8;
/// Largest number of views that share a set of bins: the six faces of a cube.
pub(crate) const MAX_VIEWS: u32 = 6;
/// Address of the bounds of all bins, in both sets of bins, for the code that sends a region's bin.
const BINS: u32 = 0x1_2F00;
/// Bytes of the bounds of one set of bins: the address of the first sphere command, and two addresses for each region.
const BIN_BOUNDS_BYTES: u32 = 0x480;
pub(crate) const TOKEN_PARAMETERS: u32 = 0x1_3800;
pub(crate) const ENVELOPES: u32 = 0x1_3900;
pub(crate) const TOKEN_CODE: u32 = 0x1_3C00;
/// Address of the list of a region's messages.
pub(crate) const LISTS: u32 = 0x8_0000;
pub(crate) const PIECES: u32 = 0x9_0000;
pub(crate) const LISTS_END: u32 = pxpl5_gp::RING_MEMORY.start;

/// Returns the address of the table of the start and end addresses of bins. The bins belong to one view, with the index
/// `view`. `context` selects one of two sets of bins, which alternate.
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
    assert!(MORE_BINS + 2 * (MAX_VIEWS - 1) * BIN_BOUNDS_BYTES <= LISTS);
    assert!(BLENDED + 3 * 4 * BLENDED_ELEMENTS <= WINDOWS_CODE);
    assert!(WINDOWS + WINDOW_BYTES * (1 + MAX_WINDOWS) <= REGION_WINDOWS);
    assert!(REGION_WINDOWS + WINDOW_BYTES * (1 + regions) <= WINDOW_PLACES, "a window for each region");
    assert!(WINDOW_PLACES + 4 * regions <= WINDOW_LISTS && MAX_WINDOWS <= regions);
    assert!(WINDOW_LISTS + 4 * (1 + 2 * MAX_WINDOWS) <= KEPT && KEPT + KEPT_BYTES * MAX_KEPT <= ORDER_CODE);
    assert!(ORDER_VIEWS + 4 * pxpl5_wire::MAX_MESSAGE_WORDS <= MORE_BINS);
};
