//! The elliptic images of spheres on the screen, as quadratic expressions in floating point and in fixed point.

use crate::newton::{reciprocal_double, reciprocal_root, root, whole};
use pxpl5_wire::Quadratic;

/// Largest number of bits of a sphere's quadratic expression, without the sign, at any pixel of its regions. The
/// renderer evaluates 48 bits.
const VALUE_BITS: i32 = 46;

pub(crate) const ROOT_BITS: i32 = 12;

/// Largest number of low bits of the quadratic that the renderer's square root can ignore.
const MAX_ROOT_SHIFT: i32 = 24;

/// Largest number of bits by which the renderer can shift a square root to the left. The renderer subtracts the shifted
/// root from a depth.
const MAX_DEPTH_SHIFT: i32 = 20;

/// The quadratic `constant + x dx + y dy + xx dx^2 + xy dx dy + yy dy^2`, where (dx, dy) is the distance from `origin`
/// in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Conic {
    /// The point with dx = dy = 0, in pixels of the video frame. The centre of the top left pixel is (0, 0).
    pub(crate) origin: [f64; 2],
    pub(crate) constant: f64,
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) xx: f64,
    pub(crate) xy: f64,
    pub(crate) yy: f64,
}

/// A conic in fixed point. The renderer computes the depth of a sphere from the conic's square root. Before the root,
/// the renderer shifts the conic to the right by `root_shift` bits. After the root, it shifts the root to the left by
/// `depth_shift` bits.
///
/// The value is `Q = 2^root_shift (bulge / 2^depth_shift)^2`. The bulge is the depth by which the sphere's surface is
/// nearer than the plane through its silhouette.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FixedConic {
    pub(crate) quadratic: Quadratic,
    pub(crate) root_shift: u8,
    pub(crate) depth_shift: u8,
}

/// Returns 2 to the power `exponent` exactly. Exponents outside -1022 to 1023 are limited to this range.
pub(crate) fn power_of_two(exponent: i32) -> f64 {
    f64::from_bits(((exponent.clamp(-1022, 1023) + 1023) as u64) << 52)
}

/// Returns the exponent of the smallest power of two above `value`, or -1022 if the value is 0.
fn exponent_above(value: f64) -> i32 {
    ((value.to_bits() >> 52) & 0x7ff) as i32 - 1022
}

/// Position, greatest value and size of a conic that is positive inside an ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Ellipse {
    /// Position of the greatest value, in pixels.
    pub(crate) peak: [f64; 2],
    pub(crate) value: f64,
    half_squares: [f64; 2],
}

impl Ellipse {
    pub(crate) fn per_half_size(&self) -> [f64; 2] {
        self.half_squares.map(reciprocal_root)
    }

    /// Returns the smallest and the largest x and y of the ellipse, in pixels of the video frame. Returns `None` if the
    /// conic is not an ellipse, for example because of an overflow.
    pub(crate) fn bounds(&self) -> Option<[[f64; 2]; 2]> {
        let [x, y] = self.peak;
        let [half_x, half_y] = self.half_squares.map(root);
        let bounds = [[x - half_x, x + half_x], [y - half_y, y + half_y]];
        bounds.iter().flatten().all(|v| v.is_finite()).then_some(bounds)
    }
}

impl Conic {
    pub(crate) fn scaled(self, factor: f64) -> Self {
        Self {
            origin: self.origin,
            constant: self.constant * factor,
            x: self.x * factor,
            y: self.y * factor,
            xx: self.xx * factor,
            xy: self.xy * factor,
            yy: self.yy * factor,
        }
    }

    pub(crate) fn around(&self, origin: [f64; 2]) -> Self {
        let dx = origin[0] - self.origin[0];
        let dy = origin[1] - self.origin[1];
        Self {
            origin,
            constant: self.at(dx, dy),
            x: (self.x + 2.0 * self.xx * dx) + self.xy * dy,
            y: (self.y + 2.0 * self.yy * dy) + self.xy * dx,
            ..*self
        }
    }

    fn at(&self, dx: f64, dy: f64) -> f64 {
        let row = (self.xx * dx + self.xy * dy) + self.x;
        (row * dx + (self.yy * dy + self.y) * dy) + self.constant
    }

    fn determinant(&self) -> f64 {
        4.0 * self.xx * self.yy - self.xy * self.xy
    }

    pub(crate) fn ellipse(&self) -> Ellipse {
        let inverse = reciprocal_double(self.determinant());
        let dx = (self.xy * self.y - 2.0 * self.yy * self.x) * inverse;
        let dy = (self.xy * self.x - 2.0 * self.xx * self.y) * inverse;
        let value = self.constant + (self.x * dx + self.y * dy) * 0.5;
        let scale = -4.0 * value * inverse;
        Ellipse {
            peak: [self.origin[0] + dx, self.origin[1] + dy],
            value,
            half_squares: [scale * self.yy, scale * self.xx],
        }
    }

    /// Rounds the conic to fixed point, for the pixels of `rectangle` (first and last pixel along x, then along y).
    /// `peak` is the conic's greatest value.
    ///
    /// The values are scaled by the largest power of two with which they fit into 46 bits on the rectangle. Rounding
    /// errors are smallest at the pixel (px, py). If this is the pixel of the greatest value, even a small sphere
    /// covers a pixel.
    pub(crate) fn fixed(&self, peak: f64, rectangle: [[i32; 2]; 2], [px, py]: [i32; 2]) -> FixedConic {
        let local = self.around([f64::from(px), f64::from(py)]);
        let depth_shift = ((exponent_above(peak) + 1).div_euclid(2) - ROOT_BITS).clamp(0, MAX_DEPTH_SHIFT);
        let unshifted = power_of_two(-2 * depth_shift);
        let greatest = self.greatest_on(rectangle).max(peak) * unshifted;
        let root_shift = (VALUE_BITS - exponent_above(greatest)).clamp(0, MAX_ROOT_SHIFT);
        let scaled = local.scaled(unshifted * power_of_two(root_shift));
        FixedConic {
            quadratic: scaled.rounded(i64::from(px), i64::from(py)),
            root_shift: root_shift as u8,
            depth_shift: depth_shift as u8,
        }
    }

    /// Returns the greatest absolute value at the corners of a rectangle. On a rectangle, the absolute value of a
    /// concave conic is greatest at a corner or at the peak.
    fn greatest_on(&self, [across, down]: [[i32; 2]; 2]) -> f64 {
        let values = across.into_iter().flat_map(|x| down.map(|y| self.at_pixel(x, y).abs()));
        values.fold(0.0, f64::max)
    }

    fn at_pixel(&self, x: i32, y: i32) -> f64 {
        self.at(f64::from(x) - self.origin[0], f64::from(y) - self.origin[1])
    }

    /// Rounds the coefficients to integers with the origin at pixel (px, py), then moves the origin exactly to pixel
    /// (0, 0).
    fn rounded(&self, px: i64, py: i64) -> Quadratic {
        let [xx, xy, yy] = [self.xx, self.xy, self.yy].map(whole);
        let [x, y] = [self.x, self.y].map(whole);
        Quadratic {
            xx,
            xy,
            yy,
            x: x.wrapping_sub(xx.wrapping_mul(2 * px)).wrapping_sub(xy.wrapping_mul(py)),
            y: y.wrapping_sub(yy.wrapping_mul(2 * py)).wrapping_sub(xy.wrapping_mul(px)),
            one: Quadratic { xx, xy, yy, x: x.wrapping_neg(), y: y.wrapping_neg(), one: 0 }
                .at(px as i32, py as i32)
                .wrapping_add(whole(self.constant)),
        }
    }
}

/// Converts a quadratic over the lines of a video frame to a quadratic over the rows of a picture. The picture's row r
/// is the line with the number `first + r * step`. The value at each pixel stays the same.
pub(crate) fn for_rows(frame: Quadratic, step: i64, first: i64) -> Quadratic {
    Quadratic {
        xx: frame.xx,
        xy: frame.xy.wrapping_mul(step),
        yy: frame.yy.wrapping_mul(step * step),
        x: frame.x.wrapping_add(frame.xy.wrapping_mul(first)),
        y: frame.yy.wrapping_mul(2 * first).wrapping_add(frame.y).wrapping_mul(step),
        one: frame.at(0, first as i32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SHIFTED: Conic = Conic { origin: [3.25, -7.5], constant: 20.0, x: 3.0, y: -2.0, xx: -1.0, xy: 0.5, yy: -2.0 };

    #[test]
    fn a_conic_keeps_its_values_when_its_origin_moves() {
        let moved = SHIFTED.around([10.0, 4.0]);
        for (x, y) in [(0.0, 0.0), (3.0, -7.0), (11.5, 2.25)] {
            let old = SHIFTED.at(x - 3.25, y + 7.5);
            assert!((old - moved.at(x - 10.0, y - 4.0)).abs() < 1e-9);
        }
        assert!((moved.ellipse().value - SHIFTED.ellipse().value).abs() < 1e-9);
    }

    #[test]
    fn no_value_of_a_conic_exceeds_its_peak() {
        let Ellipse { peak: [x, y], value, .. } = SHIFTED.ellipse();
        for (dx, dy) in [(0.1, 0.0), (-0.1, 0.05), (0.0, 0.1), (0.0, -0.1)] {
            assert!(SHIFTED.at(x + dx - 3.25, y + dy + 7.5) < value);
        }
    }

    #[test]
    fn rows_of_a_field_have_the_values_of_their_frame_lines() {
        let frame = Quadratic { xx: -3, xy: 5, yy: -7, x: 11, y: 13, one: -17 };
        for first in [0, 1] {
            let field = for_rows(frame, 2, i64::from(first));
            for (x, row) in [(0, 0), (5, 3), (639, 239)] {
                assert_eq!(field.at(x, row), frame.at(x, 2 * row + first));
            }
        }
    }

    #[test]
    fn a_value_lies_below_the_power_of_two_of_its_exponent() {
        for v in [0.75, 1.0, 3.0, 4096.0, 1e20] {
            let n = exponent_above(v);
            assert!(v < power_of_two(n) && v >= power_of_two(n - 1), "{v}");
        }
    }
}
