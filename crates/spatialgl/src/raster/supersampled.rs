//! Supersampling, for comparison with jitter. The SpatialGL paper rejects supersampling as too expensive.

use super::{Coverage, SliceRenderer, SliceStats, SliceWork};
use crate::command::Combine;
use crate::image::SliceImage;
use crate::view::SliceView;
use pxpl5_sim::parameters::SettingError;
use std::sync::{Mutex, PoisonError};

/// A renderer that draws each slice with 4 or 16 samples per pixel and returns the mean of each pixel's samples.
/// Samples are counted as fragments.
///
/// A pixel counts as drawn if any of its samples was drawn. Samples without a fragment have the background's colour, so
/// a partly covered pixel is darker. [`Coverage::Connected`] adds whole pixels after the mean.
#[derive(Debug)]
pub struct Supersampled<R> {
    inner: R,
    factor: u32,
    scratch: Mutex<Vec<SliceImage>>,
}

impl<R: SliceRenderer> Supersampled<R> {
    /// Creates a renderer with this number of samples per pixel.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] unless `samples` is 4 or 16.
    pub fn new(inner: R, samples: u32) -> Result<Self, SettingError> {
        SettingError::require([4, 16].contains(&samples), "draw.samples", "4 or 16", samples)?;
        Ok(Self { inner, factor: samples.isqrt(), scratch: Mutex::new(Vec::new()) })
    }

    /// Computes the mean of the samples of every pixel with at least one drawn sample.
    fn resolve(&self, large: &SliceImage, image: &mut SliceImage) {
        let [width, height] = image.size();
        let samples = self.factor * self.factor;
        for y in (0..height).filter(|y| self.is_row_marked(large, *y)) {
            for x in 0..width {
                if !self.is_marked(large, x, y) {
                    continue;
                }
                // Half of the divisor in the sum rounds the mean to the nearest.
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
        let mut stats = self.inner.render(sampled, &view.supersampled_view(self.factor), &mut large);
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
