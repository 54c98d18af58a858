//! What is drawn at a time: an update of one display memory.

use pphigs::FrameView;
use pxpl5_wire::{PictureNumber, Word};

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
}

/// Words before the structures.
const HEADER: usize = 4;

impl FaceUpdate {
    /// Number (two words), memory with buffer and group, count of structures; a bit for each structure; the view.
    pub(crate) fn to_words(&self) -> Vec<Word> {
        let [low, high] = self.number.to_words();
        let place = u32::from(self.memory) | u32::from(self.buffer) << 8 | u32::from(self.together) << 16;
        let mut words = vec![low, high, place, self.structures.len() as Word];
        words.extend(self.structures.chunks(32).map(bits));
        words.extend(self.view.to_words());
        words
    }

    /// `None` for words that are no update.
    pub(crate) fn from_words(words: &[Word]) -> Option<Self> {
        let [low, high, place, count] = *words.first_chunk::<HEADER>()?;
        let rest = &words[HEADER..];
        let (map, view) = rest.split_at_checked((count as usize).div_ceil(32))?;
        let structures = (0..count as usize).map(|i| map[i / 32] >> (i % 32) & 1 == 1).collect();
        Some(Self {
            number: PictureNumber(u64::from(low) | u64::from(high) << 32),
            memory: place as u8,
            buffer: (place >> 8) as u8,
            together: (place >> 16) as u8,
            view: FrameView::from_words(view).ok()?,
            structures,
        })
    }
}

fn bits(chosen: &[bool]) -> Word {
    (0..).zip(chosen).fold(0, |word, (bit, chosen)| word | Word::from(*chosen) << bit)
}
