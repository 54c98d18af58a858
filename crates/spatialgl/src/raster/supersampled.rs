//! Several samples of each pixel, which the paper rejects as too dear: for comparison with jitter.

use super::{Coverage, SliceRenderer, SliceStats, SliceWork};
use crate::command::Combine;
use crate::error::{SpatialError, require};
use crate::image::SliceImage;
use crate::view::SliceView;
use std::sync::{Mutex, PoisonError};

/// Draws each slice with 4 or 16 samples a pixel and hands on their mean; samples are counted as fragments.
///
/// A pixel with any sample drawn on is marked. Samples on which nothing was drawn have the background's colour, so that a
/// pixel that a surface covers in part is darker. Pixels that [`Coverage::Connected`] adds are whole pixels, added last.
#[derive(Debug)]
pub struct Supersampled<R> {
    inner: R,
    factor: u32,
    /// Large images that no slice uses, with the colour that they are clean in.
    scratch: Mutex<Vec<SliceImage>>,
}

impl<R: SliceRenderer> Supersampled<R> {
    /// A renderer that draws with so many samples of each pixel.
    ///
    /// # Errors
    ///
    /// [`SpatialError::Setting`] unless there are 4 or 16.
    pub fn new(inner: R, samples: u32) -> Result<Self, SpatialError> {
        require([4, 16].contains(&samples), "draw.samples", "4 or 16", samples)?;
        Ok(Self { inner, factor: samples.isqrt(), scratch: Mutex::new(Vec::new()) })
    }

    /// The mean of every pixel that has a sample.
    fn resolve(&self, large: &SliceImage, image: &mut SliceImage) {
        let [width, height] = image.size();
        let samples = self.factor * self.factor;
        for y in (0..height).filter(|y| self.is_row_marked(large, *y)) {
            for x in 0..width {
                if !self.is_marked(large, x, y) {
                    continue;
                }
                let mut sums = [samples / 2; 3];
                for (sx, sy) in self.places(x, y) {
                    for (sum, value) in sums.iter_mut().zip(large.pixel(sx, sy)) {
                        *sum += u32::from(value);
                    }
                }
                image.put(x, y, sums.map(|sum| (sum / samples) as u8), Combine::Last);
            }
        }
    }

    fn is_row_marked(&self, large: &SliceImage, y: u32) -> bool {
        let bytes = large.size()[0] as usize / 8 * self.factor as usize;
        large.stencil[y as usize * bytes..][..bytes].iter().any(|byte| *byte != 0)
    }

    fn is_marked(&self, large: &SliceImage, x: u32, y: u32) -> bool {
        self.places(x, y).any(|(sx, sy)| large.is_marked(sx, sy))
    }

    /// Columns and rows of a pixel's samples.
    fn places(&self, x: u32, y: u32) -> impl Iterator<Item = (u32, u32)> + use<R> {
        let factor = self.factor;
        (0..factor * factor).map(move |i| (x * factor + i % factor, y * factor + i / factor))
    }

    fn large(&self, image: &SliceImage) -> SliceImage {
        let used = self.scratch.lock().unwrap_or_else(PoisonError::into_inner).pop();
        let size = image.size().map(|side| side * self.factor);
        used.filter(|used| used.size() == size).unwrap_or_else(|| SliceImage::new(size))
    }
}

impl<R: SliceRenderer> SliceRenderer for Supersampled<R> {
    fn render(&self, work: SliceWork<'_>, view: &SliceView, image: &mut SliceImage) -> SliceStats {
        let mut large = self.large(image);
        large.clear(work.commands.background());
        let sampled = SliceWork { coverage: Coverage::Sampled, ..work };
        let mut stats = self.inner.render(sampled, &view.magnified(self.factor), &mut large);
        self.resolve(&large, image);
        self.scratch.lock().unwrap_or_else(PoisonError::into_inner).push(large);
        if work.coverage == Coverage::Connected {
            stats.added = super::connected::draw(work, &super::assemble::SliceTransform::new(view), image);
        }
        stats
    }

    fn samples(&self) -> u32 {
        self.factor * self.factor
    }
}
