//! Texels of a display memory, and sets of six faces.

use crate::face::TexelAddress;
use crate::timing::ArpTiming;

/// The farthest depth, in 24 bits. A texel with this depth is empty.
pub const DEPTH_FARTHEST: u32 = 0x00FF_FFFF;

/// Numbers of bits with which a display memory stores colour and depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexelFormat {
    /// Number of colour bits: 24, or 16 (5 red, 6 green, 5 blue).
    pub colour_bits: u32,
    /// Number of depth bits: 24, or 16 (the highest 16 of the 24 bits).
    pub depth_bits: u32,
}

impl TexelFormat {
    pub const fn new(timing: &ArpTiming) -> Self {
        Self { colour_bits: timing.colour_bits as u32, depth_bits: timing.depth_bits as u32 }
    }

    /// Returns the number of words per texel in ring messages: 1 if colour and depth fit into 32 bits, otherwise 2.
    ///
    /// If colour and depth share a word, the colour is in its lower half.
    pub const fn words(&self) -> u32 {
        if self.colour_bits + self.depth_bits <= 32 { 1 } else { 2 }
    }

    /// Returns a colour (0x00RRGGBB) as it is read back from a memory. With 16 bits, the upper bits of each channel are
    /// repeated in its lower bits.
    pub const fn kept_colour(&self, colour: u32) -> u32 {
        if self.colour_bits == 24 { colour & 0x00FF_FFFF } else { widened(narrowed(colour)) }
    }

    /// Returns the part of a 24-bit depth that a memory stores: its highest bits.
    pub const fn kept_depth(&self, depth: u32) -> u32 {
        (depth & DEPTH_FARTHEST) >> (24 - self.depth_bits)
    }
}

/// Converts a colour from 8 bits per channel to 5 bits red, 6 green and 5 blue.
pub(crate) const fn narrowed(colour: u32) -> u32 {
    (colour >> 8 & 0xF800) | (colour >> 5 & 0x07E0) | (colour >> 3 & 0x001F)
}

/// Converts a colour of 5 bits red, 6 green and 5 blue to 8 bits per channel.
pub(crate) const fn widened(colour: u32) -> u32 {
    let red = colour >> 11 & 31;
    let green = colour >> 5 & 63;
    let blue = colour & 31;
    (red << 3 | red >> 2) << 16 | (green << 2 | green >> 4) << 8 | (blue << 3 | blue >> 2)
}

/// The six faces of one buffer, initially empty.
///
/// Each texel is one word. Its upper half is the nearness (the farthest depth minus the texel's depth), and its lower
/// half the colour. The larger of two words is therefore the nearer texel, and 0 is an empty one. The host allocates no
/// memory pages for undrawn parts.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FaceSet {
    texels: u32,
    format: TexelFormat,
    words: Vec<u64>,
}

impl FaceSet {
    /// Creates six empty faces with `texels` texels along an edge.
    pub fn new(texels: u32, format: TexelFormat) -> Self {
        Self { texels, format, words: vec![0; 6 * (texels * texels) as usize] }
    }

    pub const fn texels(&self) -> u32 {
        self.texels
    }

    pub const fn format(&self) -> TexelFormat {
        self.format
    }

    /// Overwrites a texel with a colour 0x00RRGGBB and a depth of 24 bits. With the farthest depth the texel becomes
    /// empty.
    ///
    /// # Panics
    ///
    /// Panics if column or row exceed the face.
    pub fn set(&mut self, texel: TexelAddress, colour: u32, depth: u32) {
        assert!(texel.column < self.texels && texel.row < self.texels, "{texel:?} in faces of {}", self.texels);
        self.words[texel.index(self.texels)] = word(self.format, colour, depth);
    }

    /// Overwrites consecutive texels of a row, starting at `first`.
    ///
    /// # Panics
    ///
    /// Panics if the texels exceed the row.
    pub fn set_row(&mut self, first: TexelAddress, colours: &[u32], depths: impl Iterator<Item = u32>) {
        assert!(first.column as usize + colours.len() <= self.texels as usize && first.row < self.texels, "{first:?}");
        let start = first.index(self.texels);
        let row = &mut self.words[start..start + colours.len()];
        for ((kept, colour), depth) in row.iter_mut().zip(colours).zip(depths) {
            *kept = word(self.format, *colour, depth);
        }
    }

    /// Draws consecutive texels of a row with a depth test. A texel of equal depth keeps its old colour.
    ///
    /// Colours and depths have 24 bits.
    ///
    /// # Panics
    ///
    /// Panics if the texels exceed the row, or if there are fewer depths than colours.
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

    /// Returns the colour and the stored depth of a texel. Returns `None` for an empty texel.
    pub fn texel(&self, texel: TexelAddress) -> Option<(u32, u32)> {
        let word = self.words[texel.index(self.texels)];
        let farthest = DEPTH_FARTHEST >> (24 - self.format.depth_bits);
        (nearness(word) > 0).then(|| (colour(word), farthest - nearness(word)))
    }

    pub(crate) fn words(&self) -> &[u64] {
        &self.words
    }
}

/// Returns the word for a texel of this colour and depth. The word is 0 for an empty texel.
#[inline(always)]
pub(crate) const fn word(format: TexelFormat, colour: u32, depth: u32) -> u64 {
    let farthest = DEPTH_FARTHEST >> (24 - format.depth_bits);
    let nearness = farthest - format.kept_depth(depth);
    if nearness == 0 { 0 } else { (nearness as u64) << 32 | format.kept_colour(colour) as u64 }
}

/// Returns the nearness stored in a texel's word: the farthest depth minus the texel's depth. The nearness is 0 for an
/// empty texel.
#[inline(always)]
pub(crate) const fn nearness(word: u64) -> u32 {
    (word >> 32) as u32
}

pub(crate) const fn colour(word: u64) -> u32 {
    word as u32
}
