//! Halftoning from eight bits to one bit per channel: ordered dither with Bayer's matrix, eight pixels of a row at a
//! time.

use pxpl5_sim::parameters::SettingError;

/// Thresholds of an ordered dither, the same for all channels and slices.
///
/// The size of the matrix, 8 x 8, is assumed (2, 4 and 16 are allowed). The threshold of a matrix element M is
/// `floor((2 M + 1) 255 / (2 n^2))`. A bit is set if the channel exceeds the threshold. The value 0 lights no pixels,
/// and 255 lights all pixels. The value c lights `round(n^2 c / 255)` of `n^2` pixels.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Halftone {
    size: u32,
    /// Rows of thresholds. Each row is repeated until its length is a multiple of eight pixels.
    rows: Vec<Vec<u8>>,
}

impl Halftone {
    /// Creates the thresholds of a dither matrix with `size` rows and columns.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] unless the size is 2, 4, 8 or 16.
    pub fn bayer(size: u32) -> Result<Self, SettingError> {
        SettingError::require([2, 4, 8, 16].contains(&size), "halftone.matrix", "2, 4, 8 or 16", size)?;
        // Repeat small matrices, so that eight thresholds can always be read at once.
        let period = size.max(8);
        let threshold = |i: u32, j: u32| ((2 * bayer(size, i % size, j % size) + 1) * 255 / (2 * size * size)) as u8;
        let rows = (0..size).map(|j| (0..period).map(|i| threshold(i, j)).collect()).collect();
        Ok(Self { size, rows })
    }

    /// Returns the number of rows of the matrix, which is also the number of columns.
    pub const fn size(&self) -> u32 {
        self.size
    }

    /// Returns the threshold at pixel (x, y). The bit of a channel is set if the channel's value exceeds the threshold.
    pub fn threshold(&self, x: u32, y: u32) -> u8 {
        self.rows[(y % self.size) as usize][(x % self.size) as usize]
    }

    /// Returns the thresholds of eight pixels of a row from x on. The leftmost pixel is in the lowest byte. x is a
    /// multiple of 8.
    #[inline(always)]
    pub(crate) fn eight(&self, x: u32, y: u32) -> u64 {
        let row = &self.rows[(y % self.size) as usize];
        let at = x as usize % row.len();
        let mut bytes = [0; 8];
        bytes.copy_from_slice(&row[at..at + 8]);
        u64::from_le_bytes(bytes)
    }
}

/// Returns the element in column i and row j of Bayer's matrix. The element interleaves the bits of i xor j and of j,
/// starting from the lowest.
fn bayer(size: u32, i: u32, j: u32) -> u32 {
    let levels = size.trailing_zeros();
    let digit = |bit: u32| ((i ^ j) >> bit & 1) << 1 | (j >> bit & 1);
    (0..levels).fold(0, |value, bit| value << 2 | digit(bit))
}

/// Compares eight channel values with eight thresholds. Each value and each threshold is one byte. The result for the
/// leftmost pixel (lowest byte) is in bit 7.
#[inline(always)]
pub(crate) fn bits_above(values: u64, thresholds: u64) -> u8 {
    const HIGH: u64 = 0x8080_8080_8080_8080;
    // Compute threshold >= value byte by byte, without borrows between bytes, and negate the result.
    let low_bits = (thresholds | HIGH) - (values & !HIGH);
    let not_above = ((thresholds & !values) | (!(thresholds ^ values) & low_bits)) & HIGH;
    let above = (!not_above & HIGH) >> 7;
    // Byte i of `above` (0 or 1) moves to bit 63 - i.
    (above.wrapping_mul(0x8040_2010_0804_0201) >> 56) as u8
}
