//! What is drawn at a time: an update of one display memory.

use crate::warp::{FaceWarp, WARP_WORDS};
use address_recalculation::{begin_update, swap_together};
use pphigs::FrameView;
use pxpl5_wire::{PictureNumber, RegionId, Word, swap_request};
use std::sync::Arc;

/// An update of a display memory: what the host asks for.
#[derive(Clone, Debug, PartialEq)]
pub struct FaceUpdate {
    /// Its number among all updates, from 0.
    pub number: PictureNumber,
    /// The memory that it is for.
    pub memory: u8,
    /// The memory's buffer that it goes to, 0 or 1.
    pub buffer: u8,
    /// Memories that may only swap together with this one, bit by bit; 0 for this one alone.
    pub together: u8,
    /// The one view of an eye that is not turned, with the projection of a face; edits.
    pub view: FrameView,
    /// Structures of the display list that the memory holds.
    pub structures: Vec<bool>,
    /// How its vertices are moved to meet the slower memory; `None` where they stay.
    pub warp: Option<FaceWarp>,
}

/// The bit that says that a warp follows the structures.
const WARPED: Word = 1 << 24;

/// Words before the structures.
const HEADER: usize = 4;

impl FaceUpdate {
    /// What its memory is told of it, for faces of so many texels: which regions come, and that they are to be shown when they are there.
    #[must_use]
    pub fn announcement(&self, face_texels: u32, regions: &[RegionId]) -> [Arc<[Word]>; 2] {
        let map = begin_update(face_texels, self.buffer, regions);
        let alone = || swap_request(self.buffer);
        let request = if self.together == 0 { alone() } else { swap_together(self.buffer, self.together) };
        [map, request]
    }

    /// Number (two words), memory with buffer and group, count of structures; a bit for each structure; the warp, if any;
    /// the view.
    pub(crate) fn to_words(&self) -> Vec<Word> {
        let [low, high] = self.number.to_words();
        let place = u32::from(self.memory) | u32::from(self.buffer) << 8 | u32::from(self.together) << 16;
        let place = place | self.warp.map_or(0, |_| WARPED);
        let mut words = vec![low, high, place, self.structures.len() as Word];
        words.extend(self.structures.chunks(32).map(bits));
        words.extend(self.warp.iter().flat_map(|warp| warp.to_words()));
        words.extend(self.view.to_words());
        words
    }

    /// `None` for words that are no update.
    pub(crate) fn from_words(words: &[Word]) -> Option<Self> {
        let [low, high, place, count] = *words.first_chunk::<HEADER>()?;
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
