//! The messages that transfer a volume: a map of tiles for each batch of slices, then the occupied tiles.
//!
//! ```text
//! map   MAP   first slice | slices   tile size   bit i: tile i is sent for every slice of the batch
//! tile  TILE  slice       | tile     tile size   eight pixels a word, row by row
//! ```
//!
//! Empty tiles are not sent, so the map must make them dark. Without this rule (derived), the frame store would still
//! show tiles of the volume that it held before. Messages consist of ring words, at most [`MAX_MESSAGE_WORDS`] each,
//! and all of them write to the store that is not shown.

use crate::{BitPlanes, Size, TileGrid, Tiling};
use pxpl5_wire::{MAX_MESSAGE_WORDS, Word};
use std::sync::Arc;

const MAP: Word = 0x0050_4D41;

const TILE: Word = 0x0050_5449;

/// Number of words in a message before the map's bits or the tile's pixels.
const HEADER_WORDS: usize = 3;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum StoreMessage<'a> {
    /// A map of the tiles that will arrive for each of `slices` slices, from slice `first` on. Bit i of `bits` is set
    /// if tile i will arrive. `tile` is the side of a tile in pixels.
    Map { first: u32, slices: u32, tile: u32, bits: &'a [Word] },
    /// The pixels of tile `number` of slice `slice`. `tile` is the side of a tile in pixels.
    Tile { slice: u32, number: u32, tile: u32, words: &'a [Word] },
}

/// Parses a message. Returns `None` if the message is neither a map nor a tile. The frame store later checks that the
/// slices and tiles of the message exist.
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

/// Returns the messages of a volume, batch by batch: first the map, then the tiles, slice by slice. Returns `None` if
/// there are no tiles, if a tile is too large for a message, or if a slice has more than 65,536 tiles.
pub fn volume_messages(planes: &BitPlanes, tiling: Tiling) -> Option<Vec<Arc<[Word]>>> {
    let batches = batch_messages(planes, tiling, planes.slices())?;
    let in_order =
        |batch: BatchMessages| std::iter::once(batch.map).chain(batch.tiles.into_iter().map(|tile| tile.words));
    Some(batches.into_iter().flat_map(in_order).collect())
}

/// The messages of one batch of slices.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BatchMessages {
    /// Message with the map of the tiles that will arrive. This message is sent before the tiles.
    pub map: Arc<[Word]>,
    /// Messages of the occupied tiles, slice by slice.
    pub tiles: Vec<TileMessage>,
}

/// The message with the pixels of one tile of a slice.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TileMessage {
    pub slice: u32,
    /// Index of the tile in the slice, row by row from the top left.
    pub tile: u32,
    /// All words of the message, including the words before the pixels.
    pub words: Arc<[Word]>,
}

/// Returns the messages of the first `slices` slices, batch by batch. The last batch may have fewer slices. Returns
/// `None` in the same cases as [`volume_messages`].
pub fn batch_messages(planes: &BitPlanes, tiling: Tiling, slices: u32) -> Option<Vec<BatchMessages>> {
    let tile = tiling.tile?;
    let grid = tiling.grid(planes.size());
    let fits = tile * tile / 8 + HEADER_WORDS as u32 <= MAX_MESSAGE_WORDS && grid.tiles() <= 0x1_0000;
    let map_fits = grid.tiles().div_ceil(32) + HEADER_WORDS as u32 <= MAX_MESSAGE_WORDS;
    if !fits || !map_fits || tiling.batch == 0 {
        return None;
    }
    let end = slices.min(planes.slices());
    let firsts = (0..end).step_by(tiling.batch as usize);
    Some(firsts.map(|first| batch(planes, first, tiling.batch.min(end - first), tile, &grid)).collect())
}

fn batch(planes: &BitPlanes, first: u32, slices: u32, tile: u32, grid: &TileGrid) -> BatchMessages {
    let size = planes.size();
    // A tile is sent for every slice of the batch if the tile is occupied in any of these slices.
    let is_lit = |number: &u32| (first..first + slices).any(|k| has_light(planes.slice(k), size, grid, *number));
    let lit: Vec<u32> = (0..grid.tiles()).filter(is_lit).collect();
    let of_tile = |slice: u32, number: u32| TileMessage {
        slice,
        tile: number,
        words: tile_message(slice, number, tile, planes.slice(slice), size, grid),
    };
    let tiles = (first..first + slices).flat_map(|k| lit.iter().map(move |number| (k, *number)));
    BatchMessages {
        map: map_message(first, slices, tile, grid.tiles(), &lit),
        tiles: tiles.map(|(k, number)| of_tile(k, number)).collect(),
    }
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

/// Returns the words of a slice that make up a tile, as one range of indices for each row of the tile.
pub(crate) fn rows(size: Size, grid: &TileGrid, number: u32) -> impl Iterator<Item = std::ops::Range<usize>> + use<> {
    let [left, top, right, bottom] = grid.rectangle(number);
    let row_words = size[0] / 8;
    (top..bottom).map(move |y| {
        let begin = (y * row_words + left / 8) as usize;
        begin..begin + ((right - left) / 8) as usize
    })
}
