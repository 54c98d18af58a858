//! Which pixels a triangle can touch: a box, and spans of rows in wide boxes.
//!
//! Floating point decides only which pixels are looked at, with a margin; the edges themselves decide in integers.

use pxpl5_wire::Linear;

/// Last column and row of the array.
const LAST: i64 = 127;
/// More than the error of a quotient, less than what costs pixels.
const MARGIN: f64 = 1e-3;

/// Pixels `left .. right` of the rows `top .. bottom`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Area {
    pub(super) left: usize,
    pub(super) right: usize,
    pub(super) top: usize,
    pub(super) bottom: usize,
}

const WHOLE: Area = Area { left: 0, right: 128, top: 0, bottom: 128 };

/// The pixels outside of which one of the edges is negative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    pub(super) area: Area,
    /// Edges that limit a row from the left (`a > 0`) or from the right.
    limits: Option<[Limit; 3]>,
}

/// x >= or <= (b y + c) * scale.
#[derive(Clone, Copy, Debug)]
struct Limit {
    b: i64,
    c: i64,
    scale: f64,
    from_left: bool,
}

impl Bounds {
    /// `None` where no pixel is inside.
    #[inline(always)]
    pub(super) fn of(edges: &[Linear; 3]) -> Option<Self> {
        let lanes = Lanes::of(edges);
        let area = match lanes.corners() {
            Some(corners) => corners.area()?,
            None if lanes.straight() && edges.iter().any(|e| largest(e) < 0) => return None,
            None => WHOLE,
        };
        let wide = area.right - area.left > 24 && area.bottom - area.top > 2 && lanes.straight();
        Some(Self { area, limits: wide.then(|| edges.each_ref().map(Limit::of)) })
    }

    /// First and one past the last column of row `y`.
    #[inline(always)]
    pub(super) fn row(&self, y: usize) -> (usize, usize) {
        let Some(limits) = &self.limits else { return (self.area.left, self.area.right) };
        let (mut left, mut right) = (self.area.left as f64, self.area.right as f64 - 1.0);
        for limit in limits {
            let x = (limit.b * y as i64 + limit.c) as f64 * limit.scale;
            if limit.from_left {
                left = left.max(x - MARGIN);
            } else {
                right = right.min(x + MARGIN);
            }
        }
        (left.ceil() as usize, (right + 1.0) as usize)
    }
}

impl Limit {
    #[inline(always)]
    fn of(e: &Linear) -> Self {
        let (a, b, c) = (i64::from(e.a), i64::from(e.b), i64::from(e.c));
        // A horizontal edge limits no row; the box has taken it into account.
        let scale = if a == 0 { 0.0 } else { -1.0 / a as f64 };
        Self { b, c, scale, from_left: a >= 0 }
    }
}

/// The coefficients of three edges side by side, the third one twice: four lanes are a vector.
struct Lanes {
    a: [f64; 4],
    b: [f64; 4],
    c: [f64; 4],
}

/// Corner i, times its determinant, is where edges i and i + 1 are zero; the third one twice.
struct Corners {
    determinant: [f64; 4],
    x: [f64; 4],
    y: [f64; 4],
}

/// Pixels by which an edge may be followed from the array's first one: then no coefficient has more than 22 bits, nor the
/// constant more than 31, and their products are exact in 53.
const REACH: f64 = 512.0;

impl Lanes {
    #[inline(always)]
    fn of([e, f, g]: &[Linear; 3]) -> Self {
        let four = |p: i32, q: i32, r: i32| [f64::from(p), f64::from(q), f64::from(r), f64::from(r)];
        Self { a: four(e.a, f.a, g.a), b: four(e.b, f.b, g.b), c: four(e.c, f.c, g.c) }
    }

    /// No value in the array needs more than 32 bits, so the edges are straight lines.
    #[inline(always)]
    fn straight(&self) -> bool {
        let mut straight = true;
        for i in 0..4 {
            straight &= REACH * (self.a[i].abs() + self.b[i].abs()) + self.c[i].abs() <= f64::from(i32::MAX);
        }
        straight
    }

    /// `None` unless straight edges enclose a triangle: normals that turn the same way at all corners leave no way out to
    /// infinity.
    #[inline(always)]
    fn corners(&self) -> Option<Corners> {
        let next = |[_, q, r, _]: [f64; 4], p: f64| [q, r, p, p];
        let (p, q, r) = (next(self.a, self.a[0]), next(self.b, self.b[0]), next(self.c, self.c[0]));
        let mut corners = Corners { determinant: [0.0; 4], x: [0.0; 4], y: [0.0; 4] };
        let (mut left, mut right) = (true, true);
        for i in 0..4 {
            let determinant = self.a[i] * q[i] - p[i] * self.b[i];
            left &= determinant > 0.0;
            right &= determinant < 0.0;
            corners.determinant[i] = determinant;
            corners.x[i] = self.b[i] * r[i] - q[i] * self.c[i];
            corners.y[i] = p[i] * self.c[i] - self.a[i] * r[i];
        }
        ((left | right) & self.straight()).then_some(corners)
    }
}

impl Corners {
    /// The box of the corners within the array.
    #[inline(always)]
    fn area(&self) -> Option<Area> {
        let (mut x, mut y) = ([0.0; 4], [0.0; 4]);
        for i in 0..4 {
            let scale = 1.0 / self.determinant[i];
            x[i] = self.x[i] * scale;
            y[i] = self.y[i] * scale;
        }
        let (left, right) = range(x)?;
        let (top, bottom) = range(y)?;
        Some(Area { left, right, top, bottom })
    }
}

/// The largest value in the array.
#[inline(always)]
fn largest(e: &Linear) -> i64 {
    let [a, b, c] = [e.a, e.b, e.c].map(i64::from);
    c + LAST * (a.max(0) + b.max(0))
}

#[inline(always)]
fn range([a, b, c, _]: [f64; 4]) -> Option<(usize, usize)> {
    let low = (a.min(b).min(c) - MARGIN).ceil().max(0.0);
    let high = (a.max(b).max(c) + MARGIN).floor().min(LAST as f64);
    (low <= high).then_some((low as usize, high as usize + 1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conformance::Random;

    fn touched(edges: &[Linear; 3]) -> Vec<(usize, usize)> {
        let pixels = (0..128).flat_map(|y| (0..128).map(move |x| (x, y)));
        pixels.filter(|&(x, y)| edges.iter().all(|e| e.at(x, y) >= 0)).map(|(x, y)| (x as usize, y as usize)).collect()
    }

    fn random_edge(random: &mut Random) -> Linear {
        let mut part = |bits: u32| (random.next() as i32) >> (32 - bits);
        Linear { a: part(12), b: part(12), c: part(20) }
    }

    #[test]
    fn no_pixel_inside_all_edges_is_outside_of_the_bounds() {
        let mut random = Random::new(5);
        let mut inside = 0;
        for _ in 0..2000 {
            let edges = [(); 3].map(|()| random_edge(&mut random));
            let pixels = touched(&edges);
            inside += pixels.len();
            let Some(bounds) = Bounds::of(&edges) else {
                assert_eq!(pixels, []);
                continue;
            };
            for (x, y) in pixels {
                let (left, right) = bounds.row(y);
                assert!((bounds.area.top..bounds.area.bottom).contains(&y), "{edges:?} {x} {y}");
                assert!((left..right).contains(&x), "{edges:?} {x} {y} {bounds:?}");
            }
        }
        assert!(inside > 100_000, "{inside}");
    }

    #[test]
    fn a_small_triangle_has_the_box_of_its_corners() {
        // (10, 20), (14, 20), (10, 26).
        let edges =
            [Linear { a: 1, b: 0, c: -10 }, Linear { a: 0, b: 1, c: -20 }, Linear { a: -6, b: -4, c: 6 * 14 + 4 * 20 }];
        let area = Bounds::of(&edges).unwrap().area;
        assert_eq!(area, Area { left: 10, right: 15, top: 20, bottom: 27 });
    }
}
