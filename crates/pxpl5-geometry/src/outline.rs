//! Corners and edges of a triangle on the screen.

use crate::regions::RegionMask;
use pxpl5_wire::{Linear, format};

pub(crate) const SUBPIXELS: i32 = 1 << format::SUBPIXEL_BITS;

/// The corners of a triangle on the screen, and the regions that the triangle touches.
///
/// The corners run clockwise on the screen (y increases downwards), for both windings of the input.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outline {
    /// Distance of each corner from the picture's left border, in 1/16 px.
    pub x: [i32; 3],
    /// Distance of each corner from the top of the whole video frame, in 1/16 px, also if the picture is a field.
    pub y: [i32; 3],
    /// Depth of each corner, from [`crate::DEPTH_NEAR`] to [`crate::DEPTH_FAR`].
    pub z: [u32; 3],
    /// Regions that the triangle touches. The renderers of these regions receive the triangle's commands.
    pub regions: RegionMask,
}

impl Outline {
    /// Returns twice the area, in 1/256 square px. The result is 0 if the corners lie on one line.
    #[inline(always)]
    pub(crate) fn twice_area(&self) -> i64 {
        let x = &self.x;
        let y = &self.y;
        i64::from(x[1] - x[0]) * i64::from(y[2] - y[0]) - i64::from(y[1] - y[0]) * i64::from(x[2] - x[0])
    }

    /// Returns the expressions of the edges from corner 0 to 1, 1 to 2 and 2 to 0, over the lines of the video frame.
    #[inline(always)]
    pub(crate) fn edges(&self) -> [Linear; 3] {
        [self.edge(0, 1), self.edge(1, 2), self.edge(2, 0)]
    }

    /// Returns the expression of an edge. The value of the expression at a pixel is twice the area of the triangle
    /// (from, to, pixel centre), in 1/16 square px, rounded down.
    ///
    /// In 1/256 square px, the value at pixel (x, y) is `16 (dx y - dy x) + k`. This value is at least 0 exactly if `dx
    /// y - dy x + floor(k / 16)` is at least 0, so rounding changes no covered pixel. If a pixel's centre is on the
    /// edge, the triangle covers the pixel only for top and left edges. For other edges, k is reduced by one.
    #[inline(always)]
    fn edge(&self, from: usize, to: usize) -> Linear {
        let dx = self.x[to] - self.x[from];
        let dy = self.y[to] - self.y[from];
        let top_left = dy < 0 || (dy == 0 && dx > 0);
        let k = i64::from(dx) * i64::from(SUBPIXELS / 2 - self.y[from])
            - i64::from(dy) * i64::from(SUBPIXELS / 2 - self.x[from])
            - i64::from(!top_left);
        Linear { a: -dy, b: dx, c: (k >> format::SUBPIXEL_BITS) as i32 }
    }
}

#[inline(always)]
pub(crate) fn extent(v: &[i32; 3]) -> [i32; 2] {
    [v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2])]
}
