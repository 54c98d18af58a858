//! Tiles of 32 x 16 pixels, into which the array is divided.
//!
//! One bit of each pixel of a tile takes 512 adjacent bits of the simulator's memory, because the widest vector
//! registers (AVX-512) have 512 bits.

use crate::array::{EMPTY_PLANE, PIXELS, Plane};
use crate::isa::MEMORY_BITS;
use pxpl5_wire::REGION_SIZE;

pub(super) const WIDTH: usize = 32;
pub(super) const HEIGHT: usize = 16;
pub(super) const ACROSS: usize = REGION_SIZE as usize / WIDTH;
pub(super) const TILES: usize = PIXELS / (WIDTH * HEIGHT);

/// One bit of every pixel of a tile. The bit of pixel (x, y) is bit `x + 32 (y % 2)` of word `y / 2`.
pub(super) type TilePlane = [u64; HEIGHT / 2];

pub(super) const EMPTY: TilePlane = [0; HEIGHT / 2];
pub(super) const FULL: TilePlane = [u64::MAX; HEIGHT / 2];

#[derive(Clone, Debug)]
#[repr(align(64))] // No vector of pixels crosses a border between lines of the host's cache.
pub(super) struct Tile {
    pub(super) memory: [TilePlane; MEMORY_BITS as usize],
    pub(super) enable: TilePlane,
    /// Number of clocks in which this tile has processed bits, without the clocks for the set-up of instructions.
    pub(super) clock: u64,
}

impl Tile {
    pub(super) const EMPTY: Self = Self { memory: [EMPTY; MEMORY_BITS as usize], enable: EMPTY, clock: 0 };

    #[inline(always)]
    pub(super) fn enabled(&self) -> bool {
        any(&self.enable)
    }

    /// Returns true if this tile must execute an instruction that changes only enabled pixels.
    ///
    /// In the reference mode every tile does, in the skipping mode only one with an enabled pixel.
    #[inline(always)]
    pub(super) fn has_work(&self, skipping: bool) -> bool {
        !skipping || self.enabled()
    }
}

#[inline(always)]
pub(super) fn any(words: &[u64]) -> bool {
    words.iter().fold(0, |any, word| any | word) != 0
}

/// Returns the column and the row of the tile's upper left pixel in the array.
#[inline(always)]
pub(super) const fn origin(tile: usize) -> [usize; 2] {
    [tile % ACROSS * WIDTH, tile / ACROSS * HEIGHT]
}

/// Joins one bit plane of each tile, in the order of the tile indices, into a bit plane of the whole array.
pub(super) fn join<'a>(tiles: impl IntoIterator<Item = &'a TilePlane>) -> Plane {
    let mut plane = EMPTY_PLANE;
    for (number, tile) in tiles.into_iter().enumerate() {
        for y in 0..HEIGHT {
            let (word, by) = place(number, y);
            plane[word] |= (tile[y / 2] >> (WIDTH * (y % 2)) & u64::from(u32::MAX)) << by;
        }
    }
    plane
}

pub(super) fn part(plane: &Plane, number: usize) -> TilePlane {
    let mut tile = EMPTY;
    for y in 0..HEIGHT {
        let (word, by) = place(number, y);
        tile[y / 2] |= (plane[word] >> by & u64::from(u32::MAX)) << (WIDTH * (y % 2));
    }
    tile
}

/// Returns the place of the first pixel of row `y` of tile `number` in a bit plane of the array. The place is the index
/// of a word, and the index of a bit in this word.
const fn place(number: usize, y: usize) -> (usize, usize) {
    let [left, top] = origin(number);
    (2 * (top + y) + left / 64, left % 64)
}
