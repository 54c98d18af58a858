//! An update, which is a new drawing of one display memory.

use crate::cube::warp::{FaceWarp, WARP_WORDS};
use crate::drawn::Sent;
use address_recalculation::{begin_update, swap_together};
use pphigs::FrameView;
use pxpl5_wire::{PictureNumber, RegionId, Word, swap_request};
use std::sync::Arc;

/// An update of one display memory, as requested by the host.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceUpdate {
    /// Number of the update. The updates of all memories share one sequence of numbers, from 0.
    pub number: PictureNumber,
    /// Index of the display memory.
    pub memory: u8,
    /// Buffer of the memory that receives the update, 0 or 1.
    pub buffer: u8,
    /// Bit mask of the memories that must swap together with this memory. The mask is 0 if this memory swaps alone.
    pub together: u8,
    /// The view of an eye while the head has its initial orientation, with the projection of a face. The view also
    /// contains the edits of structures.
    pub view: FrameView,
    /// True for each structure that the memory holds, by index in the display list.
    pub structures: Vec<bool>,
    /// Displacement of vertices near the border to a display memory that is updated less often. `None` if no vertex is
    /// displaced.
    pub warp: Option<FaceWarp>,
}

/// Bit in the third word of an encoded update. If this bit is set, a warp follows the bits of the structures.
const WARPED: Word = 1 << 24;

/// Number of words before the bits of the structures.
const HEADER: usize = 4;

impl FaceUpdate {
    /// Returns the two messages that announce the update to its memory: the list of regions that will arrive, and the
    /// swap request.
    #[must_use]
    pub fn announcement(&self, face_texels: u32, regions: &[RegionId]) -> [Arc<[Word]>; 2] {
        let map = begin_update(face_texels, self.buffer, regions);
        let alone = || swap_request(self.buffer);
        let request = if self.together == 0 { alone() } else { swap_together(self.buffer, self.together) };
        [map, request]
    }
}

impl Sent for FaceUpdate {
    fn number(&self) -> PictureNumber {
        self.number
    }

    fn view(&self) -> &FrameView {
        &self.view
    }

    /// Encodes the update as words.
    ///
    /// The order is: number (two words), memory with buffer and group, number of structures, one bit for each
    /// structure, the warp if the update has a warp, and the view.
    fn to_words(&self) -> Vec<Word> {
        let [low, high] = self.number.to_words();
        let place = u32::from(self.memory) | u32::from(self.buffer) << 8 | u32::from(self.together) << 16;
        let place = place | self.warp.map_or(0, |_| WARPED);
        let mut words = vec![low, high, place, self.structures.len() as Word];
        words.extend(self.structures.chunks(32).map(bits));
        words.extend(self.warp.iter().flat_map(|warp| warp.to_words()));
        words.extend(self.view.to_words());
        words
    }

    fn from_words(words: &[Word]) -> Option<Self> {
        let [low, high, place, count] = *words.first_chunk::<HEADER>()?;
        // Split the words after the header: bits of structures, warp if any, view.
        let rest = &words[HEADER..];
        let (map, rest) = rest.split_at_checked((count as usize).div_ceil(32))?;
        let warp_words = if place & WARPED == 0 { 0 } else { WARP_WORDS };
        let (warp, view) = rest.split_at_checked(warp_words)?;
        let warp = match warp.first_chunk() {
            Some(words) => Some(FaceWarp::from_words(words)?),
            None => None,
        };
        let structures = (0..count as usize).map(|i| map[i / 32] >> (i % 32) & 1 == 1).collect();
        Some(Self {
            number: PictureNumber::from_words(low, high),
            memory: place as u8,
            buffer: (place >> 8) as u8,
            together: (place >> 16) as u8,
            view: FrameView::from_words(view).ok()?,
            structures,
            warp,
        })
    }
}

fn bits(chosen: &[bool]) -> Word {
    (0..).zip(chosen).fold(0, |word, (bit, chosen)| word | Word::from(*chosen) << bit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_wire::ViewNumber;

    #[test]
    fn every_update_survives_its_words() {
        let view = FrameView { number: ViewNumber(3), eyes: Vec::new(), edits: Vec::new() };
        let structures = (0..70).map(|i| i % 3 == 0).collect();
        let number = PictureNumber(1 << 33);
        let sent = FaceUpdate { number, memory: 3, buffer: 1, together: 0b1011, view, structures, warp: None };
        let warped = FaceUpdate { warp: Some(crate::cube::warp::tests::warp()), ..sent.clone() };
        for update in [sent, warped] {
            assert_eq!(FaceUpdate::from_words(&update.to_words()), Some(update));
        }
    }
}
