//! Ideal pictures: pixels with their depths, and the pixels at which several primitives are nearest.

use crate::shade::Paint;
use image::{Rgb, RgbImage};
use pxpl5_wire::format::Z_BITS;
use std::collections::BTreeMap;

/// Depth of a pixel on which nothing is drawn: the farthest of 24 bits.
pub const DEPTH_FARTHEST: u32 = (1 << Z_BITS) - 1;

/// The correct picture of a view.
#[derive(Clone, Debug)]
pub struct IdealPicture {
    image: RgbImage,
    depths: Vec<u32>,
    ties: BTreeMap<[u32; 2], Vec<[u8; 3]>>,
}

/// A pixel at which several primitives are nearest, with exactly the same depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tie<'a> {
    /// Column, counted from the left.
    pub x: u32,
    /// Row of the picture, counted from the top.
    pub y: u32,
    /// Red, green and blue of each of the nearest primitives, in the order of the display list.
    pub colours: &'a [[u8; 3]],
}

impl IdealPicture {
    /// Returns the image. At a tie it shows the primitive that comes first in the display list.
    #[must_use]
    pub const fn image(&self) -> &RgbImage {
        &self.image
    }

    /// Returns the depth of every pixel in 24 bits, row by row: 0 is the near plane, [`DEPTH_FARTHEST`] an empty pixel.
    #[must_use]
    pub fn depths(&self) -> &[u32] {
        &self.depths
    }

    /// Returns the pixels at which the order of arrival decides, row by row.
    pub fn ties(&self) -> impl ExactSizeIterator<Item = Tie<'_>> {
        self.ties.iter().map(|([y, x], colours)| Tie { x: *x, y: *y, colours })
    }

    /// Returns the pixels (x, y) of another image that differ and are not explained by a tie, row by row.
    ///
    /// If `other` has a different size, all of its pixels are returned.
    #[must_use]
    pub fn differences(&self, other: &RgbImage) -> Vec<[u32; 2]> {
        let same_size = other.dimensions() == self.image.dimensions();
        let pixels = other.enumerate_pixels();
        let wrong = pixels.filter(|(x, y, colour)| !same_size || !self.may_be(*x, *y, **colour));
        wrong.map(|(x, y, _)| [x, y]).collect()
    }

    fn may_be(&self, x: u32, y: u32, Rgb(colour): Rgb<u8>) -> bool {
        let tied = || self.ties.get(&[y, x]).is_some_and(|colours| colours.contains(&colour));
        self.image.get_pixel(x, y).0 == colour || tied()
    }
}

/// The nearest primitive at a pixel, with its depth and colour.
#[derive(Clone, Copy, Debug)]
struct Nearest {
    depth: u32,
    primitive: usize,
    paint: Paint,
}

/// Pixels while primitives are being drawn.
#[derive(Debug)]
pub(crate) struct DepthBuffer {
    width: u32,
    far: u32,
    nearest: Vec<Option<Nearest>>,
    /// Colours of further primitives that are as near as the first one.
    tied: BTreeMap<[u32; 2], Vec<Paint>>,
}

impl DepthBuffer {
    /// Creates an empty buffer. Depths of at least `far` are behind everything.
    pub(crate) fn new(width: u32, height: u32, far: u32) -> Self {
        Self { width, far, nearest: vec![None; (width * height) as usize], tied: BTreeMap::new() }
    }

    /// Draws one pixel of a primitive. Primitives are numbered in the order of drawing.
    ///
    /// `paint` is called only if the primitive is at least as near as the nearest one.
    pub(crate) fn draw(&mut self, pixel: [i32; 2], primitive: usize, depth: u32, paint: impl FnOnce() -> Paint) {
        let [x, y] = pixel.map(i32::cast_unsigned);
        let place = &mut self.nearest[(y * self.width + x) as usize];
        let before = place.as_ref().map_or(self.far, |nearest| nearest.depth);
        if depth < before {
            *place = Some(Nearest { depth, primitive, paint: paint() });
            self.tied.remove(&[y, x]);
        } else if depth == before && place.as_ref().is_some_and(|nearest| nearest.primitive != primitive) {
            self.tied.entry([y, x]).or_default().push(paint());
        }
    }

    /// Returns the picture over a background. `colour` and `depth` convert the stored values of each pixel; depths
    /// become 24 bits.
    pub(crate) fn finish(
        self,
        background: [u8; 3],
        colour: impl Fn(Paint) -> [u8; 3],
        depth: impl Fn(u32) -> u32,
    ) -> IdealPicture {
        let width = self.width;
        let at = |x: u32, y: u32| self.nearest[(y * width + x) as usize].map(|nearest| colour(nearest.paint));
        let height = self.nearest.len() as u32 / width.max(1);
        let image = RgbImage::from_fn(width, height, |x, y| Rgb(at(x, y).unwrap_or(background)));
        let ties = self.tied.iter().map(|([y, x], others)| {
            let first = at(*x, *y).into_iter();
            ([*y, *x], first.chain(others.iter().map(|paint| colour(*paint))).collect())
        });
        let stored = |place: &Option<Nearest>| place.map_or(DEPTH_FARTHEST, |nearest| depth(nearest.depth));
        IdealPicture { ties: ties.collect(), image, depths: self.nearest.iter().map(stored).collect() }
    }
}
