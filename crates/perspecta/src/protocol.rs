//! The messages that bring a volume: a map of tiles for each batch of slices, then the tiles that hold something.
//!
//! ```text
//! map   MAP   first slice | slices   tile size   bit i: tile i is sent for every slice of the batch
//! tile  TILE  slice       | tile     tile size   eight pixels a word, row by row
//! ```
//!
//! Empty tiles are not sent, so the map is what blanks them (derived: without it the last volume but one would shine
//! through). Words of the ring, at most [`MAX_MESSAGE_WORDS`] a message; all of it goes to the store that is not shown.

use pxpl5_wire::{MAX_MESSAGE_WORDS, Word};
use spatialgl::{BitPlanes, Size, TileGrid, Tiling};
use std::sync::Arc;

/// First word of a map of tiles.
const MAP: Word = 0x0050_4D41;

/// First word of a tile.
const TILE: Word = 0x0050_5449;

/// Words before the map's bits or the tile's pixels.
const HEADER_WORDS: usize = 3;

/// A message as the frame store reads it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum StoreMessage<'a> {
    /// Which tiles of so many slices are coming.
    Map { first: u32, slices: u32, tile: u32, bits: &'a [Word] },
    /// The pixels of a tile of one slice.
    Tile { slice: u32, number: u32, tile: u32, words: &'a [Word] },
}

/// Reads a message; `None` if it is no such message. Whether its slices and tiles exist, the store checks.
pub(crate) fn read(words: &[Word]) -> Option<StoreMessage<'_>> {
    let (header, rest) = words.split_at_checked(HEADER_WORDS)?;
    let [kind, numbers, tile] = *header else { return None };
    let high = numbers >> 16;
    let low = numbers & 0xFFFF;
    match kind {
        MAP => Some(StoreMessage::Map { first: high, slices: low, tile, bits: rest }),
        TILE => Some(StoreMessage::Tile { slice: high, number: low, tile, words: rest }),
        _ => None,
    }
}

/// The messages of a volume, batch by batch: its map, then its tiles, slice by slice. `None` if tiles are switched off, too
/// large for a message, or more than 65,536 a slice.
#[must_use]
pub fn volume_messages(planes: &BitPlanes, tiling: Tiling) -> Option<Vec<Arc<[Word]>>> {
    let tile = tiling.tile?;
    let grid = tiling.grid(planes.size());
    let fits = tile * tile / 8 + HEADER_WORDS as u32 <= MAX_MESSAGE_WORDS && grid.tiles() <= 0x1_0000;
    let map_fits = grid.tiles().div_ceil(32) + HEADER_WORDS as u32 <= MAX_MESSAGE_WORDS;
    if !fits || !map_fits || tiling.batch == 0 {
        return None;
    }
    let mut messages = Vec::new();
    for first in (0..planes.slices()).step_by(tiling.batch as usize) {
        let slices = tiling.batch.min(planes.slices() - first);
        let batch: Vec<&[Word]> = (first..first + slices).map(|k| planes.slice(k)).collect();
        let is_lit = |number: &u32| batch.iter().any(|words| has_light(words, planes.size(), &grid, *number));
        let lit: Vec<u32> = (0..grid.tiles()).filter(is_lit).collect();
        messages.push(map_message(first, slices, tile, grid.tiles(), &lit));
        for (k, words) in (first..).zip(&batch) {
            messages.extend(lit.iter().map(|number| tile_message(k, *number, tile, words, planes.size(), &grid)));
        }
    }
    Some(messages)
}

fn map_message(first: u32, slices: u32, tile: u32, tiles: u32, lit: &[u32]) -> Arc<[Word]> {
    let mut words = vec![0; HEADER_WORDS + tiles.div_ceil(32) as usize];
    words[..HEADER_WORDS].copy_from_slice(&[MAP, first << 16 | slices, tile]);
    for number in lit {
        words[HEADER_WORDS + (number / 32) as usize] |= 1 << (number % 32);
    }
    words.into()
}

fn tile_message(slice: u32, number: u32, tile: u32, words: &[Word], size: Size, grid: &TileGrid) -> Arc<[Word]> {
    let header = [TILE, slice << 16 | number, tile];
    let pixels = rows(size, grid, number).flat_map(|row| words[row].iter().copied());
    header.into_iter().chain(pixels).collect()
}

fn has_light(words: &[Word], size: Size, grid: &TileGrid, number: u32) -> bool {
    rows(size, grid, number).any(|row| words[row].iter().any(|word| *word != 0))
}

/// The words of a slice that make up a tile, row by row.
pub(crate) fn rows(size: Size, grid: &TileGrid, number: u32) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
    let [left, top, right, bottom] = grid.rectangle(number);
    let row_words = size[0] / 8;
    (top..bottom).map(move |y| {
        let begin = (y * row_words + left / 8) as usize;
        begin..begin + ((right - left) / 8) as usize
    })
}
