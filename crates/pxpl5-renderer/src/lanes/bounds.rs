//! Bounds of the pixels that a triangle can touch: a bounding box and, for wide boxes, the first and last column of
//! each row.
//!
//! Floating-point numbers only select the pixels to test, with a margin for rounding. Integer arithmetic on the edges
//! decides whether a pixel is inside.

use pxpl5_wire::{LANES, Linear, LinearLanes};

const WIDTH: i32 = 128;
const LAST: i64 = 127;
/// Number of pixels by which the computed bounds are widened. It is greater than the rounding error, but adds few
/// pixels.
const MARGIN: f64 = 1e-3;

/// A rectangle of pixels: columns `left .. right` of rows `top .. bottom`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Area {
    pub(super) left: usize,
    pub(super) right: usize,
    pub(super) top: usize,
    pub(super) bottom: usize,
}

const WHOLE: Area = Area { left: 0, right: 128, top: 0, bottom: 128 };

/// The pixels that a triangle can cover. At every pixel outside the bounds, at least one edge expression is negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) area: Area,
    /// Limits of the columns in each row, one for each edge. `None` for a narrow triangle, for which the bounding box
    /// suffices.
    limits: Option<[RowLimit; 3]>,
}

/// A limit of the columns x in row y, set by one edge. It is `x >= (b y + c) * scale` if `from_left` is true, otherwise
/// `x <= (b y + c) * scale`. All numbers except `scale` are exact.
#[derive(Clone, Copy, Debug)]
struct RowLimit {
    b: f64,
    c: f64,
    scale: f64,
    from_left: bool,
}

/// The columns `left .. right` of several consecutive rows. A row is empty if `left >= right`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spans {
    pub(super) left: [i32; LANES],
    pub(super) right: [i32; LANES],
}

impl Bounds {
    /// Returns the columns that the triangle can cover in each of [`LANES`] consecutive rows, beginning with row `top`.
    #[inline(always)]
    pub(super) fn spans(&self, top: usize) -> Spans {
        let mut spans = Spans { left: [self.area.left as i32; LANES], right: [self.area.right as i32; LANES] };
        let Some(limits) = &self.limits else { return spans };
        let mut first = [self.area.left as f64; LANES];
        let mut last = [self.area.right as f64 - 1.0; LANES];
        // Each edge limits every row at one side.
        for limit in limits {
            let mut at = [0.0; LANES];
            for (i, at) in at.iter_mut().enumerate() {
                *at = (limit.b * f64::from((top + i) as i32) + limit.c) * limit.scale;
            }
            if limit.from_left {
                for i in 0..LANES {
                    first[i] = first[i].max(at[i] - MARGIN);
                }
            } else {
                for i in 0..LANES {
                    last[i] = last[i].min(at[i] + MARGIN);
                }
            }
        }
        // Round to whole pixels inside the limits, which already include the margin.
        for i in 0..LANES {
            spans.left[i] = small(first[i].ceil().min(f64::from(WIDTH)));
            spans.right[i] = small((last[i] + 1.0).floor().max(0.0));
        }
        spans
    }
}

impl RowLimit {
    #[inline(always)]
    fn from_edge(e: &Linear) -> Self {
        let a = f64::from(e.a);
        // A horizontal edge limits no columns, and the bounding box already limits the rows.
        let scale = if e.a == 0 { 0.0 } else { -1.0 / a };
        Self { b: f64::from(e.b), c: f64::from(e.c), scale, from_left: e.a >= 0 }
    }
}

pub(super) type PerTriangle<T> = [T; LANES];

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edges(pub(super) [LinearLanes; 3]);

impl Edges {
    #[inline(always)]
    pub(super) fn set(&mut self, i: usize, edges: [Linear; 3]) {
        for (e, Linear { a, b, c }) in edges.into_iter().enumerate() {
            self.0[e].a[i] = a;
            self.0[e].b[i] = b;
            self.0[e].c[i] = c;
        }
    }

    /// Converts all edge expressions from coordinates of the picture to coordinates of the array. The origin of each is
    /// its upper left pixel. `left` and `top` are the place of the array in the picture.
    #[inline(always)]
    pub(super) fn localise(&mut self, [left, top]: [i32; 2]) {
        for e in &mut self.0 {
            for i in 0..LANES {
                let moved = e.a[i].wrapping_mul(left).wrapping_add(e.b[i].wrapping_mul(top));
                e.c[i] = e.c[i].wrapping_add(moved);
            }
        }
    }

    #[inline(always)]
    pub(super) const fn get(&self, i: usize) -> [Linear; 3] {
        [self.0[0].get(i), self.0[1].get(i), self.0[2].get(i)]
    }
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Boxes {
    /// First column (0 to 128) and last column (-1 to 127) of each triangle in the array. The first column is greater
    /// than the last column if the triangle covers no column.
    pub(super) x: [PerTriangle<i32>; 2],
    pub(super) y: [PerTriangle<i32>; 2],
    /// True if the edges enclose a finite triangle. The determinants of all pairs of edges then have the same sign.
    pub(super) closed: PerTriangle<bool>,
    /// True if the values of all edge expressions in the array fit in 32 bits. No value then wraps around, and every
    /// edge is a straight line.
    straight: PerTriangle<bool>,
}

/// Distance from the array's upper left pixel, in pixels. The fast computation of bounds requires that the values of
/// edge expressions within this distance fit in 32 bits.
///
/// Each coefficient then has at most 22 bits, and the constant has 31, so their products are exact in the 53 bits of an
/// `f64`.
const REACH: f64 = 512.0;

impl Boxes {
    #[inline(always)]
    pub(super) fn enclosing(edges: &Edges) -> Self {
        let [p, q, r] = &edges.0;
        let a = [doubles(&p.a), doubles(&q.a), doubles(&r.a)];
        let b = [doubles(&p.b), doubles(&q.b), doubles(&r.b)];
        let c = [doubles(&p.c), doubles(&q.c), doubles(&r.c)];
        // Use numbers for truth values until the end, because vectors of numbers are fastest.
        let mut reach = [0.0_f64; LANES];
        let mut least = [f64::INFINITY; LANES];
        let mut greatest = [f64::NEG_INFINITY; LANES];
        let mut low = [[f64::INFINITY; LANES]; 2];
        let mut high = [[f64::NEG_INFINITY; LANES]; 2];
        for e in 0..3 {
            let f = (e + 1) % 3;
            for i in 0..LANES {
                reach[i] = reach[i].max(REACH * (a[e][i].abs() + b[e][i].abs()) + c[e][i].abs());
                // A corner is the point where edges e and f are zero. Its coordinates are the products below, divided
                // by the determinant.
                let determinant = a[e][i] * b[f][i] - a[f][i] * b[e][i];
                least[i] = least[i].min(determinant);
                greatest[i] = greatest[i].max(determinant);
                let scale = 1.0 / determinant;
                let x = (b[e][i] * c[f][i] - b[f][i] * c[e][i]) * scale;
                let y = (a[f][i] * c[e][i] - a[e][i] * c[f][i]) * scale;
                low[0][i] = low[0][i].min(x);
                high[0][i] = high[0][i].max(x);
                low[1][i] = low[1][i].min(y);
                high[1][i] = high[1][i].max(y);
            }
        }
        let mut straight = [false; LANES];
        let mut closed = [false; LANES];
        // A separate loop converts to bool, so that the loop above stays vectorized.
        for i in 0..LANES {
            straight[i] = reach[i] <= f64::from(i32::MAX);
            closed[i] = (least[i] > 0.0) | (greatest[i] < 0.0);
        }
        for i in 0..LANES {
            closed[i] &= straight[i];
        }
        Self { x: pixels(&low[0], &high[0]), y: pixels(&low[1], &high[1]), closed, straight }
    }

    /// Returns the bounds of triangle `i`, whose edge expressions are `edges`. Returns `None` if the triangle can cover
    /// no pixel of the array.
    #[inline(always)]
    pub(super) fn bounds(&self, i: usize, edges: &[Linear; 3]) -> Option<Bounds> {
        let area = if self.closed[i] {
            self.area(i)?
        } else if self.straight[i] && edges.iter().any(|e| largest(e) < 0) {
            return None;
        } else {
            WHOLE
        };
        let wide = area.right - area.left > 24 && area.bottom - area.top > 2 && self.straight[i];
        Some(Bounds { area, limits: wide.then(|| edges.each_ref().map(RowLimit::from_edge)) })
    }

    #[inline(always)]
    fn area(&self, i: usize) -> Option<Area> {
        let left = self.x[0][i];
        let right = self.x[1][i];
        let top = self.y[0][i];
        let bottom = self.y[1][i];
        let area =
            Area { left: left as usize, right: (right + 1) as usize, top: top as usize, bottom: (bottom + 1) as usize };
        (left <= right && top <= bottom).then_some(area)
    }
}

#[inline(always)]
fn doubles(v: &PerTriangle<i32>) -> PerTriangle<f64> {
    let mut out = [0.0; LANES];
    for (out, v) in out.iter_mut().zip(v) {
        *out = f64::from(*v);
    }
    out
}

/// Returns, for each triangle, the first and the last pixel in the interval from `low` to `high`, widened by [`MARGIN`]
/// at both ends.
#[inline(always)]
fn pixels(low: &PerTriangle<f64>, high: &PerTriangle<f64>) -> [PerTriangle<i32>; 2] {
    const BEYOND: f64 = (LAST + 1) as f64;
    let mut out = [[0; LANES]; 2];
    for i in 0..LANES {
        out[0][i] = small((low[i] - MARGIN).ceil().clamp(0.0, BEYOND));
        out[1][i] = small((high[i] + MARGIN).floor().clamp(-1.0, LAST as f64));
    }
    out
}

/// Converts a number between -2^31 and 2^31 to an integer. The result for NaN is arbitrary.
///
/// A cast with `as` would not compile to a single vector instruction.
#[inline(always)]
fn small(value: f64) -> i32 {
    /// The number 1.5 * 2^52. The sum of this number and a small number has the small number, as an integer, in its low
    /// bits.
    const UNIT: f64 = 6_755_399_441_055_744.0;
    (value + UNIT).to_bits() as i32
}

#[inline(always)]
fn largest(e: &Linear) -> i64 {
    let [a, b, c] = [e.a, e.b, e.c].map(i64::from);
    c + LAST * (a.max(0) + b.max(0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    /// Returns the bounds of a triangle, computed as one of the triangles of a batch.
    fn bounds(edges: &[Linear; 3]) -> Option<Bounds> {
        let mut all = Edges::default();
        all.set(5, *edges);
        Boxes::enclosing(&all).bounds(5, edges)
    }

    fn touched(edges: &[Linear; 3]) -> Vec<(usize, usize)> {
        let pixels = (0..128).flat_map(|y| (0..128).map(move |x| (x, y)));
        pixels.filter(|&(x, y)| edges.iter().all(|e| e.at(x, y) >= 0)).map(|(x, y)| (x as usize, y as usize)).collect()
    }

    fn random_edge(random: &mut Random) -> Linear {
        Linear { a: random.signed(12), b: random.signed(12), c: random.signed(20) }
    }

    /// Returns an edge expression with random coefficients of 1 to 32 bits. Many of these expressions overflow in the
    /// array of one-bit processors.
    fn any_edge(random: &mut Random) -> Linear {
        let [a, b, c] = [(); 3].map(|()| {
            let bits = 1 + random.below(32) as u32;
            random.signed(bits) * i32::from(random.below(4) > 0)
        });
        Linear { a, b, c: [c, c ^ i32::MAX][random.below(2) as usize] }
    }

    /// Checks that the bounds of random triangles contain all pixels inside the triangles. Returns the number of these
    /// pixels.
    fn pixels_lie_within(triangles: u32, edge: fn(&mut Random) -> Linear) -> usize {
        let mut random = Random::new(5);
        let mut inside = 0;
        for _ in 0..triangles {
            let edges = [(); 3].map(|()| edge(&mut random));
            let pixels = touched(&edges);
            inside += pixels.len();
            let Some(bounds) = bounds(&edges) else {
                assert_eq!(pixels, []);
                continue;
            };
            for (x, y) in pixels {
                // The spans of several rows are computed together.
                let place = y % LANES;
                let spans = bounds.spans(y - place);
                let [left, right] = [spans.left[place], spans.right[place]].map(|x| x as usize);
                assert!((bounds.area.top..bounds.area.bottom).contains(&y), "{edges:?} {x} {y}");
                assert!((left..right).contains(&x), "{edges:?} {x} {y} {bounds:?}");
            }
        }
        inside
    }

    #[test]
    fn every_pixel_inside_all_edges_is_within_the_bounds() {
        let inside = pixels_lie_within(2000, random_edge);
        assert!(inside > 100_000, "{inside}");
    }

    #[test]
    fn edges_that_overflow_exclude_no_pixel() {
        let inside = pixels_lie_within(2000, any_edge);
        assert!(inside > 100_000, "{inside}");
    }

    /// Returns the corners and the edges of a random triangle, or `None` if the corners lie on one line.
    fn triangle(random: &mut Random) -> Option<([[i32; 2]; 3], [Linear; 3])> {
        let mut corners = [(); 3].map(|()| [random.between(-70, 200) as i32, random.between(-70, 200) as i32]);
        let [[ax, ay], [bx, by], [cx, cy]] = corners;
        let area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay);
        if area < 0 {
            corners.swap(1, 2);
        }
        let edge = |[px, py]: [i32; 2], [qx, qy]: [i32; 2]| Linear {
            a: py - qy,
            b: qx - px,
            c: (qy - py) * px - (qx - px) * py,
        };
        let [p, q, r] = corners;
        (area != 0).then(|| (corners, [edge(p, q), edge(q, r), edge(r, p)]))
    }

    /// Tests that the bounds of a triangle contain no pixel outside the triangle. The bounds normally include a small
    /// margin. The corners are integers, so the margin contains no pixel.
    #[test]
    fn the_bounds_of_a_triangle_contain_no_pixel_outside_the_triangle() {
        let mut random = Random::new(6);
        let mut rows_of_their_own = 0;
        for (corners, edges) in (0..3000).filter_map(|_| triangle(&mut random)) {
            let [x, y] = [0, 1].map(|i| corners.map(|corner| corner[i]));
            let first = |v: [i32; 3]| v.into_iter().min().unwrap().max(0);
            let end = |v: [i32; 3]| v.into_iter().max().unwrap().min(127) + 1;
            let expected = (first(x) < end(x) && first(y) < end(y)).then(|| Area {
                left: first(x) as usize,
                right: end(x) as usize,
                top: first(y) as usize,
                bottom: end(y) as usize,
            });
            let bounds = bounds(&edges);
            assert_eq!(bounds.map(|bounds| bounds.area), expected, "{corners:?}");
            let Some(bounds) = bounds.filter(|bounds| bounds.limits.is_some()) else { continue };
            let area = bounds.area;
            for first in (area.top..area.bottom).step_by(LANES) {
                let spans = bounds.spans(first);
                for y in first..area.bottom.min(first + LANES) {
                    let inside: Vec<i32> = (0..128).filter(|x| edges.iter().all(|e| e.at(*x, y as i32) >= 0)).collect();
                    let [left, right] = [spans.left[y - first], spans.right[y - first]];
                    let found: Vec<i32> = (left..right).collect();
                    assert_eq!(found, inside, "{corners:?} {y}");
                    rows_of_their_own += u32::from(left > area.left as i32 && right < area.right as i32);
                }
            }
        }
        assert!(rows_of_their_own > 10_000, "{rows_of_their_own}");
    }

    #[test]
    fn a_small_triangle_has_the_box_of_its_corners() {
        // The corners of the triangle are (10, 20), (14, 20) and (10, 26).
        let edges =
            [Linear { a: 1, b: 0, c: -10 }, Linear { a: 0, b: 1, c: -20 }, Linear { a: -6, b: -4, c: 6 * 14 + 4 * 20 }];
        let area = bounds(&edges).unwrap().area;
        assert_eq!(area, Area { left: 10, right: 15, top: 20, bottom: 27 });
    }
}
