//! Pictures in memory, painted from regions.

use crate::region::Segment;
use image::RgbImage;
use pxpl5_wire::Word;
use std::ops::Deref;
use std::sync::Arc;

/// Bits that mark a pixel of a canvas as painted: the upper 8 bits of a word 0x00RRGGBB, which no colour uses.
const PUT: Word = 0xff00_0000;

/// A picture of words 0x00RRGGBB, row by row. The newest region is painted first, so a painted pixel is never painted
/// again.
pub(crate) struct Canvas {
    width: u32,
    words: Vec<Word>,
}

pub(crate) struct CanvasRow<'a>(&'a mut [Word]);

impl Canvas {
    pub(crate) fn new(width: u32, height: u32) -> Self {
        let words = vec![0; (width * height) as usize];
        Self { width, words }
    }

    /// Returns `length` pixels of a row, beginning with the pixel at [x, y]. All of them must be in the canvas.
    pub(crate) fn row(&mut self, [x, y]: [u32; 2], length: u32) -> CanvasRow<'_> {
        let begin = (y * self.width + x) as usize;
        CanvasRow(&mut self.words[begin..begin + length as usize])
    }

    pub(crate) fn into_image(self) -> RgbImage {
        let height = self.words.len() as u32 / self.width;
        let mut bytes = vec![0; 3 * self.words.len()];
        for (pixel, word) in bytes.chunks_exact_mut(3).zip(&self.words) {
            let [_, red, green, blue] = word.to_be_bytes();
            pixel.copy_from_slice(&[red, green, blue]);
        }
        RgbImage::from_raw(self.width, height, bytes).unwrap_or_default()
    }
}

impl CanvasRow<'_> {
    /// Paints the unpainted pixels of a segment. The words of `image` are computed only if there is such a pixel.
    pub(crate) fn put(self, image: &impl Deref<Target = Arc<[Word]>>, segment: &Segment) {
        // If the image is too short, the remaining pixels stay black.
        for (word, pixel) in self.missing(image, segment) {
            *word = if *word & PUT == 0 { pixel | PUT } else { *word };
        }
    }

    /// Paints the unpainted pixels of a segment for which `chosen` returns true. The argument of `chosen` is the index
    /// of the pixel in the segment.
    pub(crate) fn put_chosen(
        self,
        image: &impl Deref<Target = Arc<[Word]>>,
        segment: &Segment,
        chosen: impl Fn(u32) -> bool,
    ) {
        for (i, (word, pixel)) in (0..).zip(self.missing(image, segment)) {
            if *word & PUT == 0 && chosen(i) {
                *word = pixel | PUT;
            }
        }
    }

    /// Returns the pixels of this row, each with its word of `image`. Returns nothing if the row is completely painted,
    /// so that the words of `image` are not computed.
    fn missing<'a, I: Deref<Target = Arc<[Word]>>>(
        self,
        image: &'a I,
        segment: &Segment,
    ) -> impl Iterator<Item = (&'a mut Word, &'a Word)>
    where
        Self: 'a,
    {
        let all_put = self.0.iter().fold(PUT, |all, word| all & word) == PUT;
        let pixels = if all_put { &[] } else { image.get(segment.image_range()).unwrap_or_default() };
        self.0.iter_mut().zip(pixels)
    }
}
