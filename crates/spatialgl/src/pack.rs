//! Packing of projector pixels of three bits into 32-bit words: eight per word as in the SpatialGL paper, or ten for
//! comparison.

use serde::{Deserialize, Serialize};

/// Number of three-bit pixels in one word of [`pack_dense`] (derived): 32 / 3, rounded down.
pub const DENSE_PIXELS: usize = 10;

/// Number of pixels in one word of the projector's memory (published in the SpatialGL paper).
pub const PIXELS_PER_WORD: u32 = 8;

/// The order of eight pixels in a byte.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BitOrder {
    /// Bit 7 is the leftmost pixel. Assumed.
    #[default]
    LeftIsHigh,
    /// Bit 0 is the leftmost pixel.
    LeftIsLow,
}

/// Packs eight pixels into a word: byte 0 is red, byte 1 green, byte 2 blue, byte 3 zero. Bit 7 of each byte is the
/// leftmost pixel.
#[inline(always)]
pub const fn packed_word(red: u8, green: u8, blue: u8) -> u32 {
    u32::from_le_bytes([red, green, blue, 0])
}

/// Returns the three bits (bit 0 red, 1 green, 2 blue) of a pixel in a word. Pixel 0 is the leftmost, and pixel 7 the
/// rightmost.
#[inline(always)]
pub const fn pixel_of_word(word: u32, pixel: u32) -> u8 {
    let column = word >> (7 - pixel % 8);
    (column & 1 | column >> 7 & 2 | column >> 14 & 4) as u8
}

/// Returns a word of eight pixels in the given order of bits.
pub const fn in_bit_order(word: u32, order: BitOrder) -> u32 {
    match order {
        BitOrder::LeftIsHigh => word,
        BitOrder::LeftIsLow => word.reverse_bits().swap_bytes(),
    }
}

/// Packs ten three-bit pixels into each word, with the first pixel in bits 0 to 2. The last word may hold fewer pixels.
/// This packing is for comparison only.
pub fn pack_dense(pixels: &[u8]) -> Vec<u32> {
    let word = |pixels: &[u8]| pixels.iter().rev().fold(0, |word, pixel| word << 3 | u32::from(pixel & 7));
    pixels.chunks(DENSE_PIXELS).map(word).collect()
}

/// Returns the first `count` pixels of words that [`pack_dense`] made.
pub fn unpack_dense(words: &[u32], count: usize) -> Vec<u8> {
    let pixels = words.iter().flat_map(|word| (0..DENSE_PIXELS).map(move |i| (word >> (3 * i) & 7) as u8));
    pixels.take(count).collect()
}
