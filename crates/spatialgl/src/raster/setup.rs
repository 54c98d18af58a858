//! Set-up of a triangle in the window of a slice, in homogeneous coordinates (Olano and Greer 1997).
//!
//! The triangle needs neither clipping nor a division. Each edge is a linear function of the position in the window,
//! positive inside the triangle and negative behind the eye. At every sample, the three functions are the weights of
//! the corners, except for one common positive factor, and interpolate the vertex attributes. Corners behind the eye or
//! 10^6 px away therefore need no special case.

/// A position in homogeneous window coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) z: f64,
    pub(super) w: f64,
}

/// A corner of a triangle, with its colour and the attributes p and q for the test of the slice's volume.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) place: Place,
    pub(super) p: f64,
    pub(super) q: f64,
    pub(super) colour: [f64; 3],
}

impl Corner {
    /// Returns the interpolation between this corner and another corner: `self` at t = 0, `other` at t = 1.
    pub(super) fn mixed(&self, other: &Self, t: f64) -> Self {
        let mix = |a: f64, b: f64| a * (1.0 - t) + b * t;
        let from = &self.place;
        let to = &other.place;
        let place = Place { x: mix(from.x, to.x), y: mix(from.y, to.y), z: mix(from.z, to.z), w: mix(from.w, to.w) };
        Self {
            place,
            p: mix(self.p, other.p),
            q: mix(self.q, other.q),
            colour: [0, 1, 2].map(|i| mix(self.colour[i], other.colour[i])),
        }
    }

    pub(super) fn moved(&self, [dx, dy]: [f64; 2]) -> Self {
        let Place { x, y, z, w } = self.place;
        Self { place: Place { x: x + dx * w, y: y + dy * w, z, w }, ..*self }
    }
}

/// Returns the scalar product of the matrix row `row` and the vector (p, 1).
#[inline(always)]
pub(super) fn along(row: &[f64; 4], p: [f64; 3]) -> f64 {
    row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3]
}

/// The linear function of an edge in the window, a (x - x0) + (b (y - y0) + c).
///
/// The anchor (x0, y0) is a vertex, and both triangles at an edge use the same vertex. The function is exactly zero
/// there, and the function of the neighbouring triangle is its exact negative.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edge {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) c: f64,
}

impl Edge {
    #[inline(always)]
    fn between(from: &Place, to: &Place) -> Self {
        let a = from.y * to.w - from.w * to.y;
        let b = from.w * to.x - from.x * to.w;
        if from.w > 0.0 && to.w > 0.0 {
            let [x, y] = anchor(from, to);
            return Self { a, b, x, y, c: 0.0 };
        }
        Self { a, b, x: 0.0, y: 0.0, c: from.x * to.y - from.y * to.x }
    }

    #[inline(always)]
    fn at(&self, x: f64, y: f64) -> f64 {
        self.a * (x - self.x) + self.row(y)
    }

    /// Returns the part of the edge function that is constant along a row of pixels.
    #[inline(always)]
    pub(super) fn row(&self, y: f64) -> f64 {
        self.b * (y - self.y) + self.c
    }

    #[inline(always)]
    fn dot(&self, corner: &Place) -> f64 {
        if corner.w > 0.0 {
            return corner.w * self.at(corner.x / corner.w, corner.y / corner.w);
        }
        let constant = self.c - self.a * self.x - self.b * self.y;
        self.a * corner.x + self.b * corner.y + constant * corner.w
    }

    const fn negated(self) -> Self {
        Self { a: -self.a, b: -self.b, c: -self.c, ..self }
    }

    /// Returns the least value that the edge function has for a sample inside the triangle. It is zero for left edges
    /// and horizontal upper edges, because samples on them count as inside, and otherwise the smallest number above
    /// zero.
    #[inline(always)]
    fn least(&self) -> f64 {
        let has_its_samples = self.a > 0.0 || (self.a == 0.0 && self.b > 0.0);
        if has_its_samples { 0.0 } else { f64::from_bits(1) }
    }
}

/// Returns the end of an edge that both adjacent triangles use as the anchor: the left end, or the upper end of a
/// vertical edge.
#[inline(always)]
fn anchor(from: &Place, to: &Place) -> [f64; 2] {
    if from.w == 1.0 && to.w == 1.0 {
        let first = from.x < to.x || (from.x == to.x && from.y < to.y);
        return if first { [from.x, from.y] } else { [to.x, to.y] };
    }
    let one = [from.x / from.w, from.y / from.w];
    let other = [to.x / to.w, to.y / to.w];
    if one < other { one } else { other }
}

/// Ranges of columns and rows of pixels, with exclusive ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bounds {
    pub(super) x: [u32; 2],
    pub(super) y: [u32; 2],
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Setup {
    /// Edges of the triangle. Edge i is opposite to corner i.
    pub(super) edges: [Edge; 3],
    /// Least value of each edge's function for a sample inside the triangle: zero, or the smallest number above zero.
    pub(super) least: [f64; 3],
    /// Distances of the corners from the near plane.
    pub(super) near: [f64; 3],
    /// Distances of the corners from the far plane.
    pub(super) far: [f64; 3],
    pub(super) p: [f64; 3],
    pub(super) q: [f64; 3],
    /// Colours of the corners: the first index is the channel, the second is the corner.
    pub(super) colour: [[f64; 3]; 3],
    pub(super) bounds: Bounds,
}

/// Number of pixels by which bounds are enlarged, to allow for rounding.
const MARGIN: f64 = 1e-3;

impl Setup {
    /// Prepares a triangle for sampling. Returns `None` if the triangle's plane contains the eye, or if [`bounds`]
    /// returns `None`.
    #[inline(always)]
    pub(super) fn new(corners: &[Corner; 3], size: [u32; 2]) -> Option<Self> {
        let [a, b, c] = corners;
        let bounds = bounds([&a.place, &b.place, &c.place], size)?;
        Self::within(corners, bounds)
    }

    #[inline(always)]
    pub(super) fn within(corners: &[Corner; 3], bounds: Bounds) -> Option<Self> {
        let [a, b, c] = corners;
        let near = [a.place.z, b.place.z, c.place.z];
        let far = [a.place.w - a.place.z, b.place.w - b.place.z, c.place.w - c.place.z];
        let opposite_a = Edge::between(&b.place, &c.place);
        let opposite_b = Edge::between(&c.place, &a.place);
        let opposite_c = Edge::between(&a.place, &b.place);
        let edges = [opposite_a, opposite_b, opposite_c];
        // The weights must be positive inside. A triangle seen from behind gets all signs reversed.
        let area = opposite_a.dot(&a.place);
        let edges = match area {
            area if area > 0.0 => edges,
            area if area < 0.0 => [edges[0].negated(), edges[1].negated(), edges[2].negated()],
            _ => return None,
        };
        let least = [edges[0].least(), edges[1].least(), edges[2].least()];
        let channel = |i: usize| [a.colour[i], b.colour[i], c.colour[i]];
        let colour = [channel(0), channel(1), channel(2)];
        Some(Self { edges, least, near, far, p: [a.p, b.p, c.p], q: [a.q, b.q, c.q], colour, bounds })
    }
}

#[inline(always)]
fn all_negative(values: [f64; 3]) -> bool {
    values[0] < 0.0 && values[1] < 0.0 && values[2] < 0.0
}

/// Returns the ranges of pixels whose centres the triangle can cover, or all pixels if a corner is behind the eye.
/// Returns `None` if no pixel can be covered, or if the triangle lies beyond the near or far plane.
#[inline(always)]
pub(super) fn bounds([a, b, c]: [&Place; 3], size: [u32; 2]) -> Option<Bounds> {
    if all_negative([a.z, b.z, c.z]) || all_negative([a.w - a.z, b.w - b.z, c.w - c.z]) {
        return None;
    }
    let width = f64::from(size[0]);
    let height = f64::from(size[1]);
    // With a corner behind the eye, the projected corners give no bounds.
    if !(a.w > 0.0 && b.w > 0.0 && c.w > 0.0) {
        let is_behind = a.w <= 0.0 && b.w <= 0.0 && c.w <= 0.0;
        return (!is_behind).then_some(Bounds { x: [0, size[0]], y: [0, size[1]] });
    }
    // Without perspective the divisions are not needed.
    let is_flat = a.w == 1.0 && b.w == 1.0 && c.w == 1.0;
    let xs = if is_flat { [a.x, b.x, c.x] } else { [a.x / a.w, b.x / b.w, c.x / c.w] };
    let ys = if is_flat { [a.y, b.y, c.y] } else { [a.y / a.w, b.y / b.w, c.y / c.w] };
    let x = extent(xs, width);
    let y = extent(ys, height);
    (x[0] < x[1] && y[0] < y[1]).then_some(Bounds { x, y })
}

#[inline(always)]
fn extent(values: [f64; 3], most: f64) -> [u32; 2] {
    let low = values[0].min(values[1]).min(values[2]);
    let high = values[0].max(values[1]).max(values[2]);
    // Pixel i is sampled at i + 1/2.
    let first = (low - 0.5 - MARGIN).ceil().clamp(0.0, most);
    let end = ((high - 0.5 + MARGIN).floor() + 1.0).clamp(0.0, most);
    [first as u32, end as u32]
}

#[inline(always)]
pub(super) fn weighted(weights: [f64; 3], values: [f64; 3]) -> f64 {
    weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]
}

#[inline(always)]
pub(super) fn channel(weights: [f64; 3], values: [f64; 3], inverse_sum: f64) -> u8 {
    (weighted(weights, values) * inverse_sum + 0.5) as u8
}
