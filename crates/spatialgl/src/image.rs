//! The image into which one slice is drawn: eight-bit colours, the stencil and the depth. The image has depths only if
//! hidden surfaces are removed.

use crate::command::Combine;
use crate::projection::Size;

/// The image of a slice before halftoning. Colours are stored channel by channel. The stencil has one bit per pixel,
/// eight per byte.
#[derive(Clone, Debug)]
pub struct SliceImage {
    size: Size,
    pub(crate) channels: [Vec<u8>; 3],
    /// Stencil bits: bit i of byte n is pixel 8 n + i.
    pub(crate) stencil: Vec<u8>,
    depth: Vec<f64>,
}

impl SliceImage {
    /// Creates a dark image. The width must be a multiple of 8, and every display has such a width.
    pub fn new(size: Size) -> Self {
        let pixels = size[0] as usize * size[1] as usize;
        Self { size, channels: [0, 1, 2].map(|_| vec![0; pixels]), stencil: vec![0; pixels / 8], depth: Vec::new() }
    }

    pub const fn size(&self) -> Size {
        self.size
    }

    /// Fills all pixels with a colour, and clears the stencil and the depth.
    pub fn clear(&mut self, colour: [u8; 3]) {
        for (channel, value) in self.channels.iter_mut().zip(colour) {
            channel.fill(value);
        }
        self.stencil.fill(0);
        self.depth.clear();
    }

    /// Fills a rectangle (left, top, right, bottom) with a colour, and clears its stencil and depth.
    pub(crate) fn clear_rectangle(&mut self, [left, top, right, bottom]: [u32; 4], colour: [u8; 3]) {
        for y in top..bottom {
            let from = self.at(left, y);
            let to = from + (right - left) as usize;
            for (channel, value) in self.channels.iter_mut().zip(colour) {
                channel[from..to].fill(value);
            }
            self.stencil[from / 8..to / 8].fill(0);
            if !self.depth.is_empty() {
                self.depth[from..to].fill(f64::INFINITY);
            }
        }
    }

    /// Returns true if a fragment was drawn on any of the eight pixels from index `at` on. `at` is a multiple of 8.
    #[inline(always)]
    pub(crate) fn is_marked_at(&self, at: usize) -> bool {
        self.stencil[at / 8] != 0
    }

    /// Returns true if a fragment was drawn on any of the pixels `from..to`. Both indices are multiples of 8.
    #[inline(always)]
    pub(crate) fn is_marked_between(&self, from: usize, to: usize) -> bool {
        self.stencil[from / 8..to / 8].iter().fold(0, |any, byte| any | byte) != 0
    }

    /// Makes the eight pixels from index `at` on dark, and clears their stencil and depth.
    #[inline(always)]
    pub(crate) fn darken_eight(&mut self, at: usize) {
        for channel in &mut self.channels {
            channel[at..at + 8].fill(0);
        }
        self.stencil[at / 8] = 0;
        if !self.depth.is_empty() {
            self.depth[at..at + 8].fill(f64::INFINITY);
        }
    }

    /// Returns the red, green and blue values of eight successive pixels, from pixel index `at` on. The leftmost pixel
    /// is in the lowest byte. `at` is a multiple of 8.
    #[inline(always)]
    pub(crate) fn eight(&self, at: usize) -> [u64; 3] {
        [0, 1, 2].map(|c| {
            let mut bytes = [0; 8];
            bytes.copy_from_slice(&self.channels[c][at..at + 8]);
            u64::from_le_bytes(bytes)
        })
    }

    /// Returns red, green and blue of a pixel.
    ///
    /// # Panics
    /// Panics if the pixel lies outside the image.
    pub fn pixel(&self, x: u32, y: u32) -> [u8; 3] {
        let at = self.at(x, y);
        [0, 1, 2].map(|c| self.channels[c][at])
    }

    /// Returns true if a fragment has been drawn on a pixel, and false for pixels outside the image.
    pub fn is_marked(&self, x: u32, y: u32) -> bool {
        let inside = x < self.size[0] && y < self.size[1];
        inside && self.stencil[self.at(x, y) / 8] >> (x % 8) & 1 == 1
    }

    const fn at(&self, x: u32, y: u32) -> usize {
        y as usize * self.size[0] as usize + x as usize
    }

    /// Returns true if a fragment is nearer to the near plane than all earlier fragments of its pixel. In this case,
    /// the function also stores the distance of the fragment.
    #[inline]
    pub(crate) fn is_nearest(&mut self, x: u32, y: u32, distance: f64) -> bool {
        if self.depth.is_empty() {
            self.depth.resize(self.channels[0].len(), f64::INFINITY);
        }
        let at = self.at(x, y);
        let is_nearer = distance < self.depth[at];
        if is_nearer {
            self.depth[at] = distance;
        }
        is_nearer
    }

    #[inline(always)]
    pub(crate) fn put(&mut self, x: u32, y: u32, colour: [u8; 3], combine: Combine) {
        let at = self.at(x, y);
        self.stencil[at / 8] |= 1 << (x % 8);
        for (channel, value) in self.channels.iter_mut().zip(colour) {
            let pixel = &mut channel[at];
            *pixel = match combine {
                Combine::Last => value,
                Combine::Max => value.max(*pixel),
                Combine::Add => value.saturating_add(*pixel),
            };
        }
    }

    /// Draws a fragment: sets the stencil bit of its pixel, and combines its colour with the pixel's colour.
    ///
    /// # Panics
    /// Panics if the pixel lies outside the image.
    pub fn draw_pixel(&mut self, x: u32, y: u32, colour: [u8; 3], combine: Combine) {
        self.put(x, y, colour, combine);
    }

    /// Returns the number of pixels on which a fragment has been drawn.
    pub fn marked(&self) -> u64 {
        self.stencil.iter().map(|byte| u64::from(byte.count_ones())).sum()
    }

    /// Draws a pixel if the pixel has no fragment yet. Returns true if this call drew the pixel.
    pub(crate) fn fill_gap(&mut self, x: f64, y: f64, colour: [u8; 3]) -> bool {
        let inside = x >= 0.0 && y >= 0.0 && x < f64::from(self.size[0]) && y < f64::from(self.size[1]);
        let is_gap = inside && !self.is_marked(x as u32, y as u32);
        if is_gap {
            self.put(x as u32, y as u32, colour, Combine::Last);
        }
        is_gap
    }
}
