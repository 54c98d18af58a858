//! A finished volume: the bits of all slices, and what was counted while they were drawn.

use crate::pack::pixel_of_word;
use crate::projection::{Size, mix};
use crate::stats::VolumeStats;

/// One bit a colour for every pixel of every slice, eight pixels a word as the projector takes them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BitPlanes {
    size: Size,
    slices: u32,
    pub(crate) words: Vec<u32>,
}

impl BitPlanes {
    /// Dark slices of this size.
    #[must_use]
    pub fn dark(size: Size, slices: u32) -> Self {
        Self { size, slices, words: vec![0; slices as usize * words_of_slice(size)] }
    }

    /// Width and height of a slice in pixels.
    #[must_use]
    pub const fn size(&self) -> Size {
        self.size
    }

    /// How many slices there are.
    #[must_use]
    pub const fn slices(&self) -> u32 {
        self.slices
    }

    /// The words of a slice, row by row from the top, each of eight pixels of a row.
    ///
    /// # Panics
    /// If there is no such slice.
    #[must_use]
    pub fn slice(&self, k: u32) -> &[u32] {
        let words = words_of_slice(self.size);
        &self.words[k as usize * words..][..words]
    }

    /// The words of a slice, to write.
    ///
    /// # Panics
    /// If there is no such slice.
    pub fn slice_mut(&mut self, k: u32) -> &mut [u32] {
        let words = words_of_slice(self.size);
        &mut self.words[k as usize * words..][..words]
    }

    /// The three bits of a pixel: bit 0 red, 1 green, 2 blue.
    ///
    /// # Panics
    /// If there is no such slice or pixel.
    #[must_use]
    pub fn pixel(&self, k: u32, x: u32, y: u32) -> u8 {
        pixel_of_word(self.slice(k)[(y * (self.size[0] / 8) + x / 8) as usize], x % 8)
    }

    /// Pixels that are lit in any colour, in all slices.
    #[must_use]
    pub fn lit_voxels(&self) -> u64 {
        self.words.iter().map(|word| u64::from((word | word >> 8 | word >> 16).to_le_bytes()[0].count_ones())).sum()
    }

    /// A number that any other bit would change; it does not depend on threads, tiles or the order of drawing.
    #[must_use]
    pub fn hash(&self) -> u64 {
        let lit = (0u64..).zip(&self.words).filter(|(_, word)| **word != 0);
        let sum = lit.fold(0u64, |sum, (at, word)| sum.wrapping_add(mix(at << 32 | u64::from(*word))));
        let [width, height] = self.size.map(u64::from);
        mix(sum ^ mix(u64::from(self.slices) << 32 | width << 16 | height))
    }
}

/// Words of one slice.
pub(crate) const fn words_of_slice(size: Size) -> usize {
    (size[0] / 8) as usize * size[1] as usize
}

/// A pixel on which something was drawn, with its colour before halftoning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColourSample {
    /// Its number in the slice, row by row from the top left.
    pub pixel: u32,
    /// Red, green and blue, 8 bits each.
    pub colour: [u8; 3],
}

/// A volume as a display gets it.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeFrame {
    /// The bits of all slices.
    pub planes: BitPlanes,
    /// Counts of the volume.
    pub stats: VolumeStats,
    /// The drawn pixels of each slice before halftoning, where they were asked for.
    pub colours: Option<Vec<Vec<ColourSample>>>,
}
