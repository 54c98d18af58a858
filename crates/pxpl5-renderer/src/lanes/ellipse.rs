//! Bounds of the pixels that a sphere can cover.
//!
//! Floating-point numbers with a margin only select the pixels to test. Integer arithmetic decides whether a pixel is
//! inside.

use pxpl5_wire::Quadratic;
use std::ops::Range;

const SIZE: usize = 128;
const MARGIN: f64 = 1e-3;
/// Upper limit of the rounding error of a discriminant `b^2 - 4 a c`, as a fraction of its two terms.
const ROUNDING: f64 = 1e-9;

/// The pixels at which a quadratic expression can be positive. The expression has the upper left pixel of the array as
/// origin of coordinates.
pub(super) struct Ellipse {
    rows: Range<usize>,
    /// The quadratic expression, which limits the columns of each row. `None` if all columns of all rows must be
    /// tested.
    quadratic: Option<Quadratic>,
}

impl Ellipse {
    pub(super) fn where_positive(q: &Quadratic) -> Self {
        if q.xx >= 0 || !stays_in_48_bits(q) {
            return Self { rows: 0..SIZE, quadratic: None };
        }
        let [xx, xy, yy, x, y, one] = [q.xx, q.xy, q.yy, q.x, q.y, q.one].map(|c| c as f64);
        // A row contains pixels inside if the discriminant of the expression, as a polynomial in x, is positive. The
        // discriminant is a quadratic function of y.
        let rows = positive(xy * xy - 4.0 * xx * yy, 2.0 * xy * x - 4.0 * xx * y, x * x - 4.0 * xx * one);
        Self { rows, quadratic: Some(*q) }
    }

    pub(super) fn rows(&self) -> Range<usize> {
        self.rows.clone()
    }

    #[inline(always)]
    pub(super) fn columns(&self, row: usize) -> Range<usize> {
        let Some(q) = &self.quadratic else { return 0..SIZE };
        let (b, c) = along_row(q, row);
        positive(q.xx as f64, b as f64, c as f64)
    }
}

/// Returns the coefficient of x and the constant of `q` as a polynomial in x along row `row`. The coefficient of x
/// squared is the same in all rows.
#[inline(always)]
pub(super) const fn along_row(q: &Quadratic, row: usize) -> (i64, i64) {
    let y = row as i64;
    let x = q.xy.wrapping_mul(y).wrapping_add(q.x);
    let one = q.yy.wrapping_mul(y).wrapping_add(q.y).wrapping_mul(y).wrapping_add(q.one);
    (x, one)
}

fn stays_in_48_bits(q: &Quadratic) -> bool {
    let [xx, xy, yy, x, y, one] = [q.xx, q.xy, q.yy, q.x, q.y, q.one].map(|c| c.unsigned_abs() as f64);
    let last = (SIZE - 1) as f64;
    (xx + xy + yy) * last * last + (x + y) * last + one < (1_u64 << 46) as f64
}

/// Returns the columns t of the array at which `a t^2 + b t + c` can be positive. If `a < 0`, these are the columns
/// between the zeros, with a margin. Otherwise, these are all columns.
#[inline(always)]
fn positive(a: f64, b: f64, c: f64) -> Range<usize> {
    if a >= 0.0 {
        return 0..SIZE;
    }
    let slack = ROUNDING * (b * b + (4.0 * a * c).abs());
    let discriminant = b * b - 4.0 * a * c + slack;
    if discriminant < 0.0 {
        return 0..0;
    }
    let middle = b / (-2.0 * a);
    let half = discriminant.sqrt() / (-2.0 * a);
    let low = (middle - half - MARGIN).ceil().max(0.0) as usize;
    let high = (middle + half + MARGIN + 1.0).clamp(0.0, SIZE as f64) as usize;
    low..high.max(low)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    fn random_ellipse(random: &mut Random) -> Quadratic {
        let x = random.between(-300, 300);
        let y = random.between(-300, 300);
        let r = random.between(1, 400);
        let scale = 1 << random.between(1, 20);
        let tilt = random.between(-scale, scale);
        let flat = random.between(scale / 2 + 1, 2 * scale);
        Quadratic {
            xx: -scale,
            xy: tilt,
            yy: -flat,
            x: 2 * scale * x - tilt * y,
            y: 2 * flat * y - tilt * x,
            one: scale * r * r - scale * x * x - flat * y * y + tilt * x * y,
        }
    }

    #[test]
    fn every_pixel_inside_an_ellipse_is_within_the_bounds() {
        let mut random = Random::new(9);
        let mut inside = 0;
        for _ in 0..1000 {
            let q = random_ellipse(&mut random);
            let ellipse = Ellipse::where_positive(&q);
            for (x, y) in (0..128).flat_map(|y| (0..128).map(move |x| (x, y))) {
                if q.at(x, y) >= 0 {
                    inside += 1;
                    assert!(ellipse.rows().contains(&(y as usize)), "{q:?} {x} {y}");
                    assert!(ellipse.columns(y as usize).contains(&(x as usize)), "{q:?} {x} {y}");
                }
            }
        }
        assert!(inside > 100_000, "{inside}");
    }

    /// Tests ellipses with such large coefficients that values exceed the 48 bits of the array and wrap around.
    #[test]
    fn quadratics_that_overflow_exclude_no_pixel() {
        let mut random = Random::new(12);
        let mut inside = 0;
        for _ in 0..2000 {
            let [xx, xy, yy, x, y, one] = [(); 6].map(|()| {
                let bits = random.below(48);
                random.between(-(1 << bits), 1 << bits) * i64::from(random.below(4) > 0)
            });
            let q = Quadratic { xx: -xx.abs(), xy, yy, x, y, one };
            let ellipse = Ellipse::where_positive(&q);
            for row in (0..128).step_by(9) {
                let columns = ellipse.columns(row as usize);
                for column in (0..128).filter(|column| q.at(*column, row) << 16 >= 0) {
                    inside += 1;
                    assert!(ellipse.rows().contains(&(row as usize)), "{q:?} {column} {row}");
                    assert!(columns.contains(&(column as usize)), "{q:?} {column} {row}");
                }
            }
        }
        assert!(inside > 100_000, "{inside}");
    }

    /// Tests circles with radii of 0 to 4 pixels and coefficients so large that their squares are rounded. At the first
    /// and last row, the test subtracts nearly equal squares, where rounding has the greatest effect.
    #[test]
    fn small_circles_reach_their_last_row_despite_rounding() {
        let mut random = Random::new(13);
        for _ in 0..1000 {
            let [x, y] = [(); 2].map(|()| random.between(10, 118));
            let r = random.between(0, 4);
            let scale = random.between(1 << 26, 1 << 27);
            let one = scale * (r * r - x * x - y * y);
            let q = Quadratic { xx: -scale, xy: 0, yy: -scale, x: 2 * scale * x, y: 2 * scale * y, one };
            let ellipse = Ellipse::where_positive(&q);
            for row in [y - r, y + r].map(|row| row as usize) {
                assert!(ellipse.rows().contains(&row), "{q:?} {row}");
                assert!(ellipse.columns(row).contains(&(x as usize)), "{q:?} {row}");
            }
        }
    }

    /// Tests that the columns of an ellipse contain no pixel outside the ellipse. The coefficients are small integers,
    /// so the margin around the ellipse contains no pixel.
    #[test]
    fn the_columns_of_an_ellipse_contain_no_pixel_outside_the_ellipse() {
        let mut random = Random::new(10);
        for _ in 0..1000 {
            let [x, y] = [(); 2].map(|()| random.between(-40, 170));
            let [xx, yy] = [(); 2].map(|()| -random.between(1, 4));
            let xy = random.between(-1, 2);
            let r = random.between(1, 60);
            let one = r * r + xx * x * x + xy * x * y + yy * y * y;
            let q = Quadratic { xx, xy, yy, x: -2 * xx * x - xy * y, y: -2 * yy * y - xy * x, one };
            let ellipse = Ellipse::where_positive(&q);
            let columns =
                |row: i32| -> Vec<usize> { (0..128).filter(|x| q.at(*x, row) >= 0).map(|x| x as usize).collect() };
            for row in 0..128 {
                let expected = columns(row);
                if ellipse.rows().contains(&(row as usize)) {
                    let found: Vec<usize> = ellipse.columns(row as usize).collect();
                    assert_eq!(found, expected, "{q:?} {row}");
                } else {
                    assert!(expected.is_empty(), "{q:?} {row}");
                }
            }
        }
    }

    #[test]
    fn the_bounds_of_rows_end_at_the_circle() {
        let mut random = Random::new(11);
        for _ in 0..1000 {
            let [x, y] = [(); 2].map(|()| random.between(-40, 170));
            let r = random.between(1, 60);
            let scale = random.between(1, 100);
            let one = scale * (r * r - x * x - y * y);
            let q = Quadratic { xx: -scale, xy: 0, yy: -scale, x: 2 * scale * x, y: 2 * scale * y, one };
            let rows: Vec<usize> = Ellipse::where_positive(&q).rows().collect();
            let expected: Vec<usize> = (0..128).filter(|row| (*row as i64 - y).abs() <= r).collect();
            assert_eq!(rows, expected, "({x}, {y}) {r}");
        }
    }

    #[test]
    fn a_circle_is_bounded_by_its_square() {
        let q = Quadratic { xx: -1, xy: 0, yy: -1, x: 40, y: 60, one: 25 - 400 - 900 };
        let ellipse = Ellipse::where_positive(&q);
        assert_eq!((ellipse.rows(), ellipse.columns(30)), (25..36, 15..26));
    }
}
