//! Planes: linear expressions of the pixel position that pass through one value at each of the three corners of a
//! triangle.
//!
//! Slopes are rounded to integers, so the error grows with the distance (dx, dy) from a reference pixel. The error is
//! at most `(|dx| + |dy|) (1/2 + 2^-15) + 1` in the last bit. Rounding the slopes adds 1/2 per pixel of distance.
//! Rounding the constant adds 1/2. The floating-point steps add 1/2, and 2^-15 per pixel (see [`MAX_SLOPE`]). The
//! reference pixel is in the middle of the visible part of the triangle's bounding box. The sum |dx| + |dy| is
//! therefore at most half of width plus height. On the largest picture, the error is below 1,026.
//!
//! A depth slope can need more than 32 bits: the depth of a wall seen edge-on can change by the whole range within a
//! pixel. Expressions are therefore evaluated modulo 2^32. The result is correct at every pixel whose true value fits
//! 32 bits, which includes all covered pixels.

use crate::newton::reciprocal_double;
use crate::outline::Outline;
use crate::stats::SetupStats;
use pxpl5_wire::Linear;

/// Steepest slope of a plane, in units of the last bit per pixel: the value changes by the range of 32 bits within one
/// subpixel.
///
/// Only a triangle thinner than a subpixel can have a steeper plane. Such a plane gets the mean of the corners' values
/// at every pixel. [`SetupStats::flattened_planes`] counts such planes.
///
/// The relative error of a slope is 2^-51, because Newton steps compute the reciprocal of the area. For slopes up to
/// this limit, the absolute error is 2^-15. A corner is at most 2^13 px away from the reference pixel. Over this
/// distance, no intermediate result exceeds 2^50, and the error of all steps together is less than 1/2.
pub const MAX_SLOPE: f64 = 68_719_476_736.0;

/// The constant 1.5 * 2^52. The addition of this constant rounds a number below 2^51 to an integer, ties to even.
const ROUND: f64 = 6_755_399_441_055_744.0;

/// Returns the integer nearest to a number below 2^51 in absolute value, modulo 2^32.
#[inline(always)]
pub(crate) fn rounded(value: f64) -> i32 {
    (value + ROUND).to_bits() as i32
}

/// Returns the constant plane that replaces a plane with a slope above [`MAX_SLOPE`]: the mean of the corners' values.
pub(crate) fn flat(v: [f64; 3]) -> Linear {
    Linear::constant(rounded(((v[0] + v[1]) + v[2]) / 3.0))
}

#[inline(always)]
fn pixels_to_centre(corner: i32, pixel: i32) -> f64 {
    f64::from(16 * pixel + 8 - corner) * (1.0 / 16.0)
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Planes {
    /// Differences in x from corner 0 to corners 1 and 2, in subpixels.
    x: [f64; 2],
    y: [f64; 2],
    /// Factor from cross products to slopes per pixel: 16 divided by twice the area.
    per_pixel: f64,
    to_reference: [f64; 2],
    reference: [i32; 2],
}

impl Planes {
    /// Computes the values that all planes of `outline` share. Planes are most exact at the pixel `reference`.
    #[inline(always)]
    pub(crate) fn for_outline(outline: &Outline, reference: [i32; 2]) -> Self {
        let x = &outline.x;
        let y = &outline.y;
        Self {
            x: [f64::from(x[1] - x[0]), f64::from(x[2] - x[0])],
            y: [f64::from(y[1] - y[0]), f64::from(y[2] - y[0])],
            per_pixel: 16.0 * reciprocal_double(outline.twice_area() as f64),
            to_reference: [pixels_to_centre(x[0], reference[0]), pixels_to_centre(y[0], reference[1])],
            reference,
        }
    }

    /// Returns the plane through the values `v` at the three corners of the triangle. The values must be integers below
    /// 2^32 in absolute value.
    ///
    /// A cross product is a sum of two products below 2^32 * 2^17, so it is exact.
    #[inline(always)]
    pub(crate) fn through(&self, v: [f64; 3], stats: &mut SetupStats) -> Linear {
        let d1 = v[1] - v[0];
        let d2 = v[2] - v[0];
        let slope_x = (d1 * self.y[1] - d2 * self.y[0]) * self.per_pixel;
        let slope_y = (d2 * self.x[0] - d1 * self.x[1]) * self.per_pixel;
        if slope_x.abs() > MAX_SLOPE || slope_y.abs() > MAX_SLOPE {
            stats.flattened_planes += 1;
            return flat(v);
        }
        let there = (v[0] + slope_x * self.to_reference[0]) + slope_y * self.to_reference[1];
        let a = rounded(slope_x);
        let b = rounded(slope_y);
        let back = a.wrapping_mul(self.reference[0]).wrapping_add(b.wrapping_mul(self.reference[1]));
        Linear { a, b, c: rounded(there).wrapping_sub(back) }
    }
}
