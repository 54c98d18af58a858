//! Ideal pictures: colours and depths of pixels, and pixels at which several primitives are nearest.

use crate::oracle::shade::Paint;
use image::{Rgb, RgbImage};
use pxpl5_wire::format::Z_BITS;
use std::collections::BTreeMap;

/// Depth of a pixel on which no primitive is drawn: the largest 24-bit number.
pub const DEPTH_FARTHEST: u32 = (1 << Z_BITS) - 1;

/// The correct picture of a view, with depths.
#[derive(Clone, Debug)]
pub struct IdealPicture {
    image: RgbImage,
    depths: Vec<u32>,
    ties: BTreeMap<[u32; 2], Vec<[u8; 3]>>,
}

/// A pixel at which two or more primitives are nearest, with exactly the same depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tie<'a> {
    /// Column, counted from the left.
    pub x: u32,
    /// Row of the picture, counted from the top.
    pub y: u32,
    /// Colours of the nearest primitives at this pixel, in the order of the display list.
    pub colours: &'a [[u8; 3]],
}

impl IdealPicture {
    /// Returns the frame whose even lines are those of the first field, and whose odd lines are those of the second.
    pub fn interlaced(fields: &[Self; 2]) -> Self {
        let (width, height) = fields[0].image.dimensions();
        let image = RgbImage::from_fn(width, 2 * height, |x, y| *fields[y as usize % 2].image.get_pixel(x, y / 2));
        let row = |y: usize| fields[y % 2].depths.iter().skip(y / 2 * width as usize).take(width as usize).copied();
        let depths = (0..2 * height as usize).flat_map(row).collect();
        let of_field = |first: u32| {
            let ties = fields[first as usize].ties.iter();
            ties.map(move |([y, x], colours)| ([2 * y + first, *x], colours.clone()))
        };
        Self { image, depths, ties: of_field(0).chain(of_field(1)).collect() }
    }

    /// Returns the image. If several primitives are nearest at a pixel, the image has the colour of the primitive that
    /// comes first in the display list.
    pub const fn image(&self) -> &RgbImage {
        &self.image
    }

    /// Returns the 24-bit depth of every pixel, row by row. The depth is 0 at the near plane and [`DEPTH_FARTHEST`] at
    /// an empty pixel.
    pub fn depths(&self) -> &[u32] {
        &self.depths
    }

    /// Returns the pixels at which several primitives are nearest, row by row. On the machine, the order in which
    /// commands arrive determines the colours of these pixels.
    pub fn ties(&self) -> impl ExactSizeIterator<Item = Tie<'_>> {
        self.ties.iter().map(|([y, x], colours)| Tie { x: *x, y: *y, colours })
    }

    /// Returns the pixels (x, y) of the image `other` whose colour is wrong, row by row. If several primitives are
    /// nearest at a pixel, each of their colours is right.
    ///
    /// If `other` has a different size, all its pixels are returned.
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

#[derive(Clone, Copy, Debug)]
struct Nearest {
    depth: u32,
    primitive: usize,
    paint: Paint,
}

#[derive(Debug)]
pub(crate) struct DepthBuffer {
    width: u32,
    far: u32,
    nearest: Vec<Option<Nearest>>,
    tied: BTreeMap<[u32; 2], Vec<Paint>>,
}

impl DepthBuffer {
    /// Creates a buffer in which pixels with a depth of `far` or more are not drawn.
    pub(crate) fn new(width: u32, height: u32, far: u32) -> Self {
        Self { width, far, nearest: vec![None; (width * height) as usize], tied: BTreeMap::new() }
    }

    /// Draws one pixel of a primitive. `primitive` is the index of the primitive in the order of drawing.
    ///
    /// The function calls `paint` only if no nearer primitive has been drawn at this pixel.
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

    /// Returns the picture. `colour` converts a stored value to a colour, and `depth` converts a stored depth to 24
    /// bits.
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
