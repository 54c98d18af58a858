//! Packing of projector pixels of three bits into 32-bit words: eight per word as in the SpatialGL paper, or ten for
//! comparison.

/// Number of three-bit pixels in one word of [`pack_dense`] (derived): 32 / 3, rounded down.
pub const DENSE_PIXELS: usize = 10;

/// Number of pixels in one word of the projector's memory (published in the SpatialGL paper).
pub const PIXELS_PER_WORD: u32 = 8;

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

/// Packs ten three-bit pixels into each word, with the first pixel in bits 0 to 2. The last word may hold fewer pixels.
/// This packing is for comparison only.
pub fn pack_dense(pixels: &[u8]) -> Vec<u32> {
    let word = |pixels: &[u8]| pixels.iter().rev().fold(0, |word, pixel| word << 3 | u32::from(pixel & 7));
    pixels.chunks(DENSE_PIXELS).map(word).collect()
}
