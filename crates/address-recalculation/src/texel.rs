//! What a display memory holds for a texel, and six faces of them.

use crate::face::TexelAddress;
use crate::timing::ArpTiming;

/// The farthest depth, in 24 bits: a texel of that depth is empty.
pub const DEPTH_FARTHEST: u32 = 0x00FF_FFFF;

/// Bits of colour and depth that a display memory keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelFormat {
    /// 24, or 16 as 5, 6 and 5.
    pub colour_bits: u32,
    /// 24, or 16: the highest of 24.
    pub depth_bits: u32,
}

impl TexelFormat {
    /// The format of a display with these numbers.
    #[must_use]
    pub const fn new(timing: &ArpTiming) -> Self {
        Self { colour_bits: timing.colour_bits as u32, depth_bits: timing.depth_bits as u32 }
    }

    /// Words of the ring that a texel takes: one where colour and depth fit in it, colour in the lower half.
    #[must_use]
    pub const fn words(&self) -> u32 {
        if self.colour_bits + self.depth_bits <= 32 { 1 } else { 2 }
    }

    /// A colour (0x00RRGGBB) as it is kept and read again: of 16 bits the upper bits are repeated below.
    #[must_use]
    pub const fn kept_colour(&self, colour: u32) -> u32 {
        if self.colour_bits == 24 { colour & 0x00FF_FFFF } else { widened(narrowed(colour)) }
    }

    /// A depth of 24 bits as it is kept: its highest bits.
    #[must_use]
    pub const fn kept_depth(&self, depth: u32) -> u32 {
        (depth & DEPTH_FARTHEST) >> (24 - self.depth_bits)
    }
}

/// A colour in 5, 6 and 5 bits.
pub(crate) const fn narrowed(colour: u32) -> u32 {
    (colour >> 8 & 0xF800) | (colour >> 5 & 0x07E0) | (colour >> 3 & 0x001F)
}

/// A colour of 5, 6 and 5 bits in 8 bits each.
pub(crate) const fn widened(colour: u32) -> u32 {
    let red = colour >> 11 & 31;
    let green = colour >> 5 & 63;
    let blue = colour & 31;
    (red << 3 | red >> 2) << 16 | (green << 2 | green >> 4) << 8 | (blue << 3 | blue >> 2)
}

/// Six faces of one buffer, all of them empty at first.
///
/// A texel is one word: how much nearer than the farthest it is in the upper half, its colour in the lower one, so that of
/// two texels the nearer one is the larger word, and an empty one is 0. Memory that nothing is drawn to is never touched.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaceSet {
    texels: u32,
    format: TexelFormat,
    words: Vec<u64>,
}

impl FaceSet {
    /// Six empty faces with so many texels along an edge.
    #[must_use]
    pub fn new(texels: u32, format: TexelFormat) -> Self {
        Self { texels, format, words: vec![0; 6 * (texels * texels) as usize] }
    }

    /// Texels along an edge.
    #[must_use]
    pub const fn texels(&self) -> u32 {
        self.texels
    }

    /// What is kept of colours and depths.
    #[must_use]
    pub const fn format(&self) -> TexelFormat {
        self.format
    }

    /// Writes a texel, whatever was there: colour as 0x00RRGGBB, depth in 24 bits, the farthest for an empty one.
    ///
    /// # Panics
    /// For a column or row beyond the faces.
    pub fn set(&mut self, texel: TexelAddress, colour: u32, depth: u32) {
        assert!(texel.column < self.texels && texel.row < self.texels, "{texel:?} in faces of {}", self.texels);
        self.words[texel.index(self.texels)] = word(self.format, colour, depth);
    }

    /// Writes a run of texels of one row from one on, from words of colour and of depth.
    ///
    /// # Panics
    /// For a run that does not lie in a row.
    pub fn set_row(&mut self, first: TexelAddress, colours: &[u32], depths: impl Iterator<Item = u32>) {
        assert!(first.column as usize + colours.len() <= self.texels as usize && first.row < self.texels, "{first:?}");
        let start = first.index(self.texels);
        let row = &mut self.words[start..start + colours.len()];
        for ((kept, colour), depth) in row.iter_mut().zip(colours).zip(depths) {
            *kept = word(self.format, *colour, depth);
        }
    }

    /// Draws a run of texels of one row from one on, colour and depth in 24 bits each: where something as near is there already it
    /// stays.
    ///
    /// # Panics
    /// For a run that does not lie in a row, and for fewer depths than colours.
    #[inline(always)]
    pub fn keep_nearer(&mut self, first: TexelAddress, colours: &[u32], depths: &[u32]) {
        let count = colours.len();
        assert!(first.column as usize + count <= self.texels as usize && first.row < self.texels, "{first:?}");
        let start = first.index(self.texels);
        let depths = &depths[..count];
        for ((kept, colour), depth) in self.words[start..start + count].iter_mut().zip(colours).zip(depths) {
            let drawn = word(self.format, *colour, *depth);
            *kept = if nearness(drawn) > nearness(*kept) { drawn } else { *kept };
        }
    }

    /// Colour and kept depth of a texel; `None` of an empty one.
    #[must_use]
    pub fn texel(&self, texel: TexelAddress) -> Option<(u32, u32)> {
        let word = self.words[texel.index(self.texels)];
        let farthest = DEPTH_FARTHEST >> (24 - self.format.depth_bits);
        (nearness(word) > 0).then(|| (colour(word), farthest - nearness(word)))
    }

    /// All words, face by face and row by row.
    pub(crate) fn words(&self) -> &[u64] {
        &self.words
    }
}

/// The word of a texel; 0 where it is empty.
#[inline(always)]
pub(crate) const fn word(format: TexelFormat, colour: u32, depth: u32) -> u64 {
    let farthest = DEPTH_FARTHEST >> (24 - format.depth_bits);
    let nearness = farthest - format.kept_depth(depth);
    if nearness == 0 { 0 } else { (nearness as u64) << 32 | format.kept_colour(colour) as u64 }
}

/// How much nearer than the farthest a word's texel is; 0 for an empty one.
#[inline(always)]
pub(crate) const fn nearness(word: u64) -> u32 {
    (word >> 32) as u32
}

/// A word's colour.
pub(crate) const fn colour(word: u64) -> u32 {
    word as u32
}
