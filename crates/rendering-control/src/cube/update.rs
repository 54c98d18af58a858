use crate::cube::warp::{FaceWarp, WARP_WORDS};
use crate::drawn::Sent;
use address_recalculation::{begin_update, swap_together};
use pphigs::FrameView;
use pxpl5_wire::{PictureNumber, RegionId, Word, swap_request};
use std::sync::Arc;

/// A request of the host for a new drawing of one display memory.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceUpdate {
    /// Number of the update. All display memories together have one sequence of numbers, from 0.
    pub number: PictureNumber,
    pub memory: u8,
    /// Buffer of the display memory that gets the update, 0 or 1.
    pub buffer: u8,
    /// Display memories that must swap in the same retrace as this memory, one bit for each memory. A value of 0 means
    /// that this memory swaps alone.
    pub together: u8,
    /// The eye's view in the initial orientation of the head, with the projection of a face. The view also contains the
    /// edits of structures.
    pub view: FrameView,
    /// For each structure of the display list, true if the display memory holds the structure.
    pub structures: Vec<bool>,
    /// Displacement of vertices at the border to a display memory that is updated less often, or `None`.
    pub warp: Option<FaceWarp>,
}

/// Flag in the third word of an encoded update. The flag is set if the update has a warp. The words of the warp follow
/// the words with one bit for each structure.
const WARPED: Word = 1 << 24;

/// Number of words of an encoded update before the bits of the structures.
const HEADER: usize = 4;

impl FaceUpdate {
    /// Returns the two messages that announce the update to its display memory. The messages contain the list of
    /// regions that will arrive, and the swap request.
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
    /// The first four words are the number of the update (two words), one word for memory, buffer and group, and the
    /// number of structures. One bit for each structure follows, then the warp if the update has one, and finally the
    /// view.
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
    fn every_update_is_decoded_from_its_words() {
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
