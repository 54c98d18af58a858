//! A finished volume: the bits of all slices, and counts of the work to draw them.

use crate::pack::pixel_of_word;
use crate::projection::Size;
use crate::stats::VolumeStats;
use pxpl5_sim::mix;

/// The pixels of all slices, with one bit per colour. One word holds eight pixels, as in the projector's memory.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BitPlanes {
    size: Size,
    slices: u32,
    pub(crate) words: Vec<u32>,
}

impl BitPlanes {
    /// Creates slices of this size in which no pixel is lit.
    pub fn dark(size: Size, slices: u32) -> Self {
        Self { size, slices, words: vec![0; slices as usize * words_of_slice(size)] }
    }

    pub const fn size(&self) -> Size {
        self.size
    }

    pub const fn slices(&self) -> u32 {
        self.slices
    }

    /// Returns the words of a slice, row by row from the top. Each word holds eight pixels of a row.
    ///
    /// # Panics
    /// Panics if there is no such slice.
    pub fn slice(&self, k: u32) -> &[u32] {
        let words = words_of_slice(self.size);
        &self.words[k as usize * words..][..words]
    }

    /// Returns the words of a slice, so that they can be changed.
    ///
    /// # Panics
    ///
    /// Panics if there is no such slice.
    pub fn slice_mut(&mut self, k: u32) -> &mut [u32] {
        let words = words_of_slice(self.size);
        &mut self.words[k as usize * words..][..words]
    }

    /// Returns the three bits of a pixel: bit 0 is red, bit 1 green and bit 2 blue.
    ///
    /// # Panics
    /// Panics if there is no such slice or pixel.
    pub fn pixel(&self, k: u32, x: u32, y: u32) -> u8 {
        pixel_of_word(self.slice(k)[(y * (self.size[0] / 8) + x / 8) as usize], x % 8)
    }

    /// Returns the number of pixels in all slices that are lit in any colour.
    pub fn lit_voxels(&self) -> u64 {
        self.words.iter().map(|word| u64::from((word | word >> 8 | word >> 16).to_le_bytes()[0].count_ones())).sum()
    }

    /// Returns a hash of all bits. The hash does not depend on threads, tiles or the order of drawing.
    pub fn hash(&self) -> u64 {
        let lit = (0u64..).zip(&self.words).filter(|(_, word)| **word != 0);
        let sum = lit.fold(0u64, |sum, (at, word)| sum.wrapping_add(mix(at << 32 | u64::from(*word))));
        let [width, height] = self.size.map(u64::from);
        mix(sum ^ mix(u64::from(self.slices) << 32 | width << 16 | height))
    }
}

pub(crate) const fn words_of_slice(size: Size) -> usize {
    (size[0] / 8) as usize * size[1] as usize
}

/// A drawn pixel with its colour before halftoning.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColourSample {
    /// Index of the pixel in its slice, row by row from the top left.
    pub pixel: u32,
    pub colour: [u8; 3],
}

/// A volume in the form that a display receives.
#[derive(Clone, Debug, PartialEq)]
pub struct VolumeFrame {
    pub planes: BitPlanes,
    pub stats: VolumeStats,
    /// Drawn pixels of each slice before halftoning, or `None` if
    /// [`VolumeConfig::keeps_colours`](crate::VolumeConfig::keeps_colours) is false.
    pub colours: Option<Vec<Vec<ColourSample>>>,
}
