//! Tiles of 32 x 16 pixels, in which the array's pixels are kept: one bit of them is 512 bits side by side in memory, as
//! many as the widest vector has.

use crate::array::{EMPTY_PLANE, PIXELS, Plane};
use crate::isa::MEMORY_BITS;
use pxpl5_wire::REGION_SIZE;

/// Columns of a tile.
pub(super) const WIDTH: usize = 32;
/// Rows of a tile.
pub(super) const HEIGHT: usize = 16;
/// Tiles side by side in the array.
pub(super) const ACROSS: usize = REGION_SIZE as usize / WIDTH;
/// Tiles of the array.
pub(super) const TILES: usize = PIXELS / (WIDTH * HEIGHT);

/// One bit of every pixel of a tile: pixel (x, y) is bit `x + 32 (y % 2)` of word `y / 2`.
pub(super) type TilePlane = [u64; HEIGHT / 2];

pub(super) const EMPTY: TilePlane = [0; HEIGHT / 2];
pub(super) const FULL: TilePlane = [u64::MAX; HEIGHT / 2];

/// Pixel memory and Enable of a tile. Tiles have nothing to do with each other.
#[derive(Clone, Debug)]
#[repr(align(64))] // No vector of pixels lies across two lines of the host's cache.
pub(super) struct Tile {
    pub(super) memory: [TilePlane; MEMORY_BITS as usize],
    pub(super) enable: TilePlane,
    /// Clocks in which planes moved.
    pub(super) clock: u64,
}

impl Tile {
    pub(super) const EMPTY: Self = Self { memory: [EMPTY; MEMORY_BITS as usize], enable: EMPTY, clock: 0 };

    /// Whether any of the pixels is enabled.
    #[inline(always)]
    pub(super) fn enabled(&self) -> bool {
        any(&self.enable)
    }

    /// Whether an instruction that changes only enabled pixels has to be carried out here: always in the literal way, and
    /// where pixels are enabled in the one that is `skipping`.
    #[inline(always)]
    pub(super) fn has_work(&self, skipping: bool) -> bool {
        !skipping || self.enabled()
    }
}

/// Whether a bit is set anywhere.
#[inline(always)]
pub(super) fn any(words: &[u64]) -> bool {
    words.iter().fold(0, |any, word| any | word) != 0
}

/// Left column and top row of a tile.
#[inline(always)]
pub(super) const fn origin(tile: usize) -> [usize; 2] {
    [tile % ACROSS * WIDTH, tile / ACROSS * HEIGHT]
}

/// A plane of the array from those of its tiles.
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

/// The part of a plane that belongs to a tile.
pub(super) fn part(plane: &Plane, number: usize) -> TilePlane {
    let mut tile = EMPTY;
    for y in 0..HEIGHT {
        let (word, by) = place(number, y);
        tile[y / 2] |= (plane[word] >> by & u64::from(u32::MAX)) << (WIDTH * (y % 2));
    }
    tile
}

/// The word of a plane that holds row `y` of a tile, and from which bit on.
const fn place(number: usize, y: usize) -> (usize, usize) {
    let [left, top] = origin(number);
    (2 * (top + y) + left / 64, left % 64)
}
