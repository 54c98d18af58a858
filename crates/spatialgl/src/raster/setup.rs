//! Set-up of one triangle in the window of a slice, in homogeneous coordinates (Olano and Greer 1997).
//!
//! Nothing is clipped and nothing divided: each edge is a linear function of the window, positive inside, and the three of
//! them are the weights of the corners at every sample, up to one positive factor; behind the eye all are negative. What a
//! vertex carries is interpolated by these weights, so corners behind the eye or 10^6 px away need no case of their own.

/// A place in homogeneous window coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) z: f64,
    pub(super) w: f64,
}

/// A corner, with what it carries for the test of the slice's volume, and its colour.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    pub(super) place: Place,
    pub(super) p: f64,
    pub(super) q: f64,
    pub(super) colour: [f64; 3],
}

impl Corner {
    /// The point at `t` of the way to another.
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

    /// The corner moved in the window by so many pixels.
    pub(super) fn moved(&self, [dx, dy]: [f64; 2]) -> Self {
        let Place { x, y, z, w } = self.place;
        Self { place: Place { x: x + dx * w, y: y + dy * w, z, w }, ..*self }
    }
}

/// Row of a matrix times (p, 1).
#[inline(always)]
pub(super) fn along(row: &[f64; 4], p: [f64; 3]) -> f64 {
    row[0] * p[0] + row[1] * p[1] + row[2] * p[2] + row[3]
}

/// A linear function of the window, a (x - x0) + (b (y - y0) + c).
///
/// The anchor (x0, y0) is a vertex, the same one whichever triangle asks: the function is exactly zero there, and that of
/// the neighbour on the same edge is its exact negative.
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

    /// What is the same for all of a row.
    #[inline(always)]
    pub(super) fn row(&self, y: f64) -> f64 {
        self.b * (y - self.y) + self.c
    }

    /// Value at a homogeneous point.
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

    /// The least value with which a sample is inside: zero for left edges and upper horizontal ones, which have the
    /// samples on them, and else just above it.
    #[inline(always)]
    fn least(&self) -> f64 {
        let has_its_samples = self.a > 0.0 || (self.a == 0.0 && self.b > 0.0);
        if has_its_samples { 0.0 } else { f64::from_bits(1) }
    }
}

/// The end of an edge that both its triangles measure from: the left one, of two above each other the upper one.
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

/// Rows and columns of pixels, ends excluded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Bounds {
    pub(super) x: [u32; 2],
    pub(super) y: [u32; 2],
}

/// A triangle ready to be sampled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Setup {
    /// Opposite the corners, in their order.
    pub(super) edges: [Edge; 3],
    /// The least value with which a sample is inside: zero, or just above it.
    pub(super) least: [f64; 3],
    /// Distance from the near plane.
    pub(super) near: [f64; 3],
    /// Distance from the far plane.
    pub(super) far: [f64; 3],
    pub(super) p: [f64; 3],
    pub(super) q: [f64; 3],
    /// By channel, then by corner.
    pub(super) colour: [[f64; 3]; 3],
    pub(super) bounds: Bounds,
}

/// Pixels by which bounds are wider than the corners, against rounding.
const MARGIN: f64 = 1e-3;

impl Setup {
    /// `None` if the triangle's plane contains the eye, or as [`bounds`] has none.
    #[inline(always)]
    pub(super) fn new(corners: &[Corner; 3], size: [u32; 2]) -> Option<Self> {
        let [a, b, c] = corners;
        let bounds = bounds([&a.place, &b.place, &c.place], size)?;
        Self::within(corners, bounds)
    }

    /// The same with the bounds that [`bounds`] has found.
    #[inline(always)]
    pub(super) fn within(corners: &[Corner; 3], bounds: Bounds) -> Option<Self> {
        let [a, b, c] = corners;
        let near = [a.place.z, b.place.z, c.place.z];
        let far = [a.place.w - a.place.z, b.place.w - b.place.z, c.place.w - c.place.z];
        let opposite_a = Edge::between(&b.place, &c.place);
        let opposite_b = Edge::between(&c.place, &a.place);
        let opposite_c = Edge::between(&a.place, &b.place);
        let edges = [opposite_a, opposite_b, opposite_c];
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

/// The pixels whose centres the triangle can cover; all of them if a corner is behind the eye. `None` if there are none
/// or if it lies beyond the near or far plane.
#[inline(always)]
pub(super) fn bounds([a, b, c]: [&Place; 3], size: [u32; 2]) -> Option<Bounds> {
    if all_negative([a.z, b.z, c.z]) || all_negative([a.w - a.z, b.w - b.z, c.w - c.z]) {
        return None;
    }
    let width = f64::from(size[0]);
    let height = f64::from(size[1]);
    if !(a.w > 0.0 && b.w > 0.0 && c.w > 0.0) {
        let is_behind = a.w <= 0.0 && b.w <= 0.0 && c.w <= 0.0;
        return (!is_behind).then_some(Bounds { x: [0, size[0]], y: [0, size[1]] });
    }
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

/// The sum of what corners carry by their weights.
#[inline(always)]
pub(super) fn weighted(weights: [f64; 3], values: [f64; 3]) -> f64 {
    weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2]
}

/// An interpolated channel as 8 bits.
#[inline(always)]
pub(super) fn channel(weights: [f64; 3], values: [f64; 3], inverse_sum: f64) -> u8 {
    (weighted(weights, values) * inverse_sum + 0.5) as u8
}
