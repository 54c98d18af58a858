//! The Enable register of the fast array.

use crate::array::{EMPTY_PLANE, PIXELS, Plane};
use std::ops::Range;

const WIDTH: usize = 128;

/// One byte for each pixel: 255 if the pixel is enabled, otherwise 0.
///
/// The register also records the rows that can contain enabled pixels, because then only these rows must be cleared
/// after a small primitive.
#[derive(Clone, Debug)]
pub(super) struct Enable {
    pixels: Box<[u8; PIXELS]>,
    used: Range<usize>,
}

impl Enable {
    pub(super) fn new() -> Self {
        Self { pixels: Box::new([0; PIXELS]), used: 0..0 }
    }

    pub(super) fn pixels(&self) -> &[u8; PIXELS] {
        &self.pixels
    }

    pub(super) fn pixels_mut(&mut self) -> &mut [u8; PIXELS] {
        self.used = 0..WIDTH;
        &mut self.pixels
    }

    /// Disables all pixels, and returns the Enable bytes of all pixels for modification. The caller may change only the
    /// rows `rows`.
    pub(super) fn emptied(&mut self, rows: Range<usize>) -> &mut [u8; PIXELS] {
        self.pixels[WIDTH * self.used.start..WIDTH * self.used.end].fill(0);
        self.used = rows;
        &mut self.pixels
    }

    /// Returns the Enable bytes of all pixels for modification. The caller may change only the rows that it passed to
    /// the last call of [`Self::emptied`].
    #[inline(always)]
    pub(super) fn rows_in_use(&mut self) -> &mut [u8; PIXELS] {
        &mut self.pixels
    }

    pub(super) fn fill(&mut self, enabled: bool) {
        if enabled {
            self.pixels_mut().fill(255);
        } else {
            self.emptied(0..0);
        }
    }

    pub(super) fn plane(&self) -> Plane {
        let mut plane = EMPTY_PLANE;
        for (pixel, enable) in self.pixels.iter().enumerate() {
            plane[pixel / 64] |= u64::from(enable & 1) << (pixel % 64);
        }
        plane
    }

    pub(super) fn set_plane(&mut self, plane: &Plane) {
        for (pixel, enable) in self.pixels_mut().iter_mut().enumerate() {
            *enable = if plane[pixel / 64] >> (pixel % 64) & 1 == 1 { 255 } else { 0 };
        }
    }
}
