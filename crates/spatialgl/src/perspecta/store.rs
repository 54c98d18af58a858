//! Two frame stores of bit planes. One is shown while the other is filled.

use crate::perspecta::protocol::{StoreMessage, read, rows};
use crate::{Size, Tiling};
use pxpl5_sim::Time;
use pxpl5_wire::{Word, read_swap_request};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The words of one slice. Both frame stores share the words until one store writes to the slice.
type Slice = Arc<Vec<Word>>;

/// A memory for two volumes of N slices each.
///
/// Tiles go to the volume that is not shown. A swap request waits until every tile announced by a map has arrived, so a
/// volume with a partly written slice is never shown.
#[derive(Clone, Debug)]
pub(crate) struct FrameStore {
    size: Size,
    volumes: [Vec<Slice>; 2],
    shown: usize,
    /// Slices of the store that was visible until the last strobe 0 (the first flash of a revolution).
    scanned: Vec<Slice>,
    /// Announced tiles that have not yet arrived: index of the slice, index of the tile, and side of the tile in
    /// pixels.
    missing: BTreeSet<(u32, u32, u32)>,
    /// Arrival time of the last swap request, and the number of the requested buffer.
    requested: Option<(Time, u8)>,
    pub(crate) tiles: u64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum StoreReceipt {
    /// The message was the last announced tile of the slice with this index.
    SliceComplete(u32),
    /// The message was a map, a swap request, or a tile that does not complete its slice.
    Part,
    /// The store cannot use the message. The text states the reason.
    Fault(&'static str),
}

impl FrameStore {
    pub(crate) fn new(size: Size, slices: u32) -> Self {
        let dark: Slice = Arc::new(vec![0; (size[0] / 8 * size[1]) as usize]);
        let volume = vec![dark; slices as usize];
        Self {
            size,
            volumes: [volume.clone(), volume.clone()],
            shown: 0,
            scanned: volume,
            missing: BTreeSet::new(),
            requested: None,
            tiles: 0,
        }
    }

    pub(crate) fn receive(&mut self, words: &[Word], now: Time) -> StoreReceipt {
        if let Some(buffer) = read_swap_request(words) {
            return self.request(buffer, now);
        }
        match read(words) {
            Some(StoreMessage::Map { first, slices, tile, bits }) => self.announce(first, slices, tile, bits),
            Some(StoreMessage::Tile { slice, number, tile, words }) => self.write(slice, number, tile, words),
            None => StoreReceipt::Fault("neither a map of tiles, a tile nor a request to swap"),
        }
    }

    fn request(&mut self, buffer: u8, now: Time) -> StoreReceipt {
        if buffer > 1 {
            return StoreReceipt::Fault("a request for a store that does not exist");
        }
        self.requested = Some((now, buffer));
        StoreReceipt::Part
    }

    fn announce(&mut self, first: u32, slices: u32, tile: u32, bits: &[Word]) -> StoreReceipt {
        let Some(tiling) = tiling(tile) else { return StoreReceipt::Fault("tiles of a size that is no multiple of 8") };
        let grid = tiling.grid(self.size);
        let end = u64::from(first) + u64::from(slices);
        if bits.len() != grid.tiles().div_ceil(32) as usize || end > self.scanned.len() as u64 {
            return StoreReceipt::Fault("a map of slices or tiles that do not exist");
        }
        // A new map replaces earlier announcements of its slices.
        for slice in first..first + slices {
            self.missing.retain(|(other, ..)| *other != slice);
            let words = Arc::make_mut(&mut self.volumes[1 - self.shown][slice as usize]);
            words.fill(0);
            let coming = (0..grid.tiles()).filter(|i| bits[(i / 32) as usize] >> (i % 32) & 1 == 1);
            self.missing.extend(coming.map(|number| (slice, number, tile)));
        }
        StoreReceipt::Part
    }

    fn write(&mut self, slice: u32, number: u32, tile: u32, words: &[Word]) -> StoreReceipt {
        // Only announced tiles of the right size are stored.
        if !self.missing.remove(&(slice, number, tile)) {
            return StoreReceipt::Fault("a tile that no map has announced");
        }
        let Some(tiling) = tiling(tile) else { return StoreReceipt::Fault("tiles of a size that is no multiple of 8") };
        let grid = tiling.grid(self.size);
        if words.len() as u64 != grid.words(number) {
            self.missing.insert((slice, number, tile));
            return StoreReceipt::Fault("a tile with too few or too many words");
        }
        // Copy the rows of the tile into the store that is not shown.
        let stored = Arc::make_mut(&mut self.volumes[1 - self.shown][slice as usize]);
        let mut source = words.iter();
        for row in rows(self.size, &grid, number) {
            for (word, new) in stored[row].iter_mut().zip(&mut source) {
                *word = *new;
            }
        }
        self.tiles += 1;
        let is_complete = self.missing.range((slice, 0, 0)..(slice + 1, 0, 0)).next().is_none();
        if is_complete { StoreReceipt::SliceComplete(slice) } else { StoreReceipt::Part }
    }

    /// Handles strobe 0, the first flash of a revolution. A swap request from before `now` takes effect if all
    /// announced tiles have arrived. Returns the number of the buffer that is then shown, or `None` without a swap.
    pub(crate) fn swap(&mut self, now: Time) -> Option<u8> {
        self.scanned.clone_from(&self.volumes[self.shown]);
        let is_whole = self.missing.is_empty();
        let (_, buffer) = self.requested.take_if(|(asked_at, _)| *asked_at < now && is_whole)?;
        self.shown = usize::from(buffer);
        Some(buffer)
    }

    pub(crate) fn shown(&self, slice: usize) -> Option<&[Word]> {
        self.volumes[self.shown].get(slice).map(|words| words.as_slice())
    }

    pub(crate) fn scanned(&self, slice: usize) -> Option<&[Word]> {
        self.scanned.get(slice).map(|words| words.as_slice())
    }
}

fn tiling(tile: u32) -> Option<Tiling> {
    let is_valid = (8..=4096).contains(&tile) && tile.is_multiple_of(8);
    is_valid.then_some(Tiling { tile: Some(tile), batch: 1 })
}
