//! The inner loops of the fast rasterizer, in plain Rust. The loops process eight pixels of a row at a time.
//!
//! Each of the eight lanes computes the same as the reference model for one pixel, with the same operations in the same
//! order. Two optimizations cannot change a result. The loops omit pixels of a row that are certainly not covered. The
//! loops also omit sums whose terms all have the same sign.

use super::setup::{Edge, Setup, channel};
use crate::command::Combine;
use crate::image::SliceImage;
use crate::slice_volume::{SampleTest, hyperbolic, parallel, taper};

/// Number of pixels in a vector, which is also the number of pixels in a byte of the stencil.
const LANES: usize = 8;

type EachLane = [f64; LANES];

/// Largest number of pixels in the bounds of a triangle whose rows are drawn together, as one sequence of pixels.
const SMALL: u32 = 64;

/// Smallest width in pixels of a triangle for which the covered range of a row is computed before the row's pixels.
const WIDE: u32 = 24;

#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fragments {
    pub(super) generated: u64,
    pub(super) accepted: u64,
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    pub(super) test: SampleTest,
    pub(super) combine: Combine,
    /// True if fragments that fail the slice's test do not count as generated.
    pub(super) clips_first: bool,
    pub(super) hides: bool,
}

#[inline(always)]
pub(super) fn draw(setup: &Setup, mode: Mode, image: &mut SliceImage) -> Fragments {
    if let Some(bits) = mode.test.fraction_bits() {
        let scale = libm::ldexp(1.0, bits as i32);
        return draw_rounded(setup, mode, scale, image);
    }
    // Each test gets its own copy of the loops, so that the test is inlined.
    match mode.test {
        SampleTest::All => rows(setup, mode, image, |_, _, _| true),
        SampleTest::Taper { offset, slope, plus } => {
            rows(setup, mode, image, |u, s, w| taper(u, s, w, offset, slope, plus))
        }
        SampleTest::Plus(ties, _) => rows(setup, mode, image, |p, q, _| ties.plus(p, q)),
        SampleTest::Minus(ties, _) => rows(setup, mode, image, |p, q, _| ties.minus(p, q)),
        SampleTest::Both(ties, _) => rows(setup, mode, image, |p, q, _| ties.plus(p, q) | ties.minus(p, q)),
        SampleTest::Parallel(offset, _) => rows(setup, mode, image, |p, q, w| parallel(p, q, w, offset)),
        SampleTest::Hyperbolic(bias, _) => rows(setup, mode, image, |p, q, w| hyperbolic(p, q, w, bias)),
    }
}

/// Draws a triangle when boundary planes are rounded to few bits. The rounding needs a division for every pixel.
fn draw_rounded(setup: &Setup, mode: Mode, scale: f64, image: &mut SliceImage) -> Fragments {
    let round = |x: f64, w: f64| (x / w * scale).round_ties_even() / scale;
    let exact = mode.test.without_rounding();
    rows(setup, mode, image, |p, q, w| exact.accepts(round(p, w), round(q, w), 1.0))
}

#[inline(always)]
fn rows(setup: &Setup, mode: Mode, image: &mut SliceImage, accepts: impl Fn(f64, f64, f64) -> bool) -> Fragments {
    let mut fragments = Fragments::default();
    let [left, right] = setup.bounds.x;
    let [top, bottom] = setup.bounds.y;
    let checks = Checks { near: has_negative(setup.near), far: has_negative(setup.far) };
    if (right - left) * (bottom - top) <= SMALL {
        small(setup, mode, image, checks, &accepts, &mut fragments);
        return fragments;
    }
    // Computing the range of a row pays off only for wide triangles.
    let is_wide = right - left > WIDE;
    for y in top..bottom {
        let centre = f64::from(y) + 0.5;
        let row = [setup.edges[0].row(centre), setup.edges[1].row(centre), setup.edges[2].row(centre)];
        let [from, to] = if is_wide { setup.row_range(row, checks) } else { [left, right] };
        let mut x = from;
        while x < to {
            let weights = setup.weights_at(x, row);
            let pixels = Pixels { weights, count: to - x, x, y, width: u32::MAX };
            chunk(setup, mode, image, &pixels, checks, &accepts, &mut fragments);
            x += LANES as u32;
        }
    }
    fragments
}

/// Draws a triangle with few pixels. The pixels of its bounds are numbered row by row and processed eight at a time.
#[inline(always)]
fn small(
    setup: &Setup,
    mode: Mode,
    image: &mut SliceImage,
    checks: Checks,
    accepts: &impl Fn(f64, f64, f64) -> bool,
    fragments: &mut Fragments,
) {
    let [left, right] = setup.bounds.x;
    let [top, bottom] = setup.bounds.y;
    let width = right - left;
    let area = width * (bottom - top);
    let mut first = 0;
    // The last vector may hold fewer than eight pixels.
    while first < area {
        let weights = setup.weights_of_block(first, width);
        let pixels = Pixels { weights, count: area - first, x: left + first, y: top, width };
        chunk(setup, mode, image, &pixels, checks, accepts, fragments);
        first += LANES as u32;
    }
}

/// Eight pixels, and the weights of the triangle's corners at each pixel.
struct Pixels {
    weights: [EachLane; 3],
    count: u32,
    /// Column of the first pixel, in the top row of the block of pixels.
    x: u32,
    y: u32,
    /// Number of pixels in a row of the block of pixels. `u32::MAX` if all pixels are in one row.
    width: u32,
}

/// Flags for the near and the far plane: true if pixels must be tested because a corner lies beyond the plane.
#[derive(Clone, Copy)]
struct Checks {
    near: bool,
    far: bool,
}

#[inline(always)]
fn has_negative(values: [f64; 3]) -> bool {
    values[0] < 0.0 || values[1] < 0.0 || values[2] < 0.0
}

#[inline(always)]
fn bits(holds: impl Fn(usize) -> bool) -> u8 {
    let mut lanes = [0u64; LANES];
    for (i, lane) in lanes.iter_mut().enumerate() {
        *lane = if holds(i) { 1 << i } else { 0 };
    }
    let mut mask = 0;
    for lane in lanes {
        mask |= lane;
    }
    mask as u8
}

#[inline(always)]
fn weighted_lanes(weights: &[EachLane; 3], values: [f64; 3]) -> EachLane {
    let mut sums = [0.0; LANES];
    for i in 0..LANES {
        sums[i] = weights[0][i] * values[0] + weights[1][i] * values[1] + weights[2][i] * values[2];
    }
    sums
}

impl Pixels {
    /// Returns column and row of a pixel. `left` is the first column of the block of pixels.
    #[inline(always)]
    const fn place(&self, lane: u32, left: u32) -> [u32; 2] {
        if self.width == u32::MAX {
            return [self.x + lane, self.y];
        }
        let number = self.x - left + lane;
        [left + number % self.width, self.y + number / self.width]
    }
}

#[inline(always)]
fn chunk(
    setup: &Setup,
    mode: Mode,
    image: &mut SliceImage,
    pixels: &Pixels,
    checks: Checks,
    accepts: &impl Fn(f64, f64, f64) -> bool,
    fragments: &mut Fragments,
) {
    let weights = &pixels.weights;
    let [a, b, c] = weights;
    // Test the edges first, because this test rejects most vectors.
    let least = setup.least;
    let there = if pixels.count < LANES as u32 { (1 << pixels.count) - 1 } else { u8::MAX };
    let mut inside = there & bits(|i| (a[i] >= least[0]) & (b[i] >= least[1]) & (c[i] >= least[2]));
    if inside == 0 {
        return;
    }
    // Test near and far plane only if a corner lies beyond the plane.
    if checks.near {
        let near = weighted_lanes(weights, setup.near);
        inside &= bits(|i| near[i] >= 0.0);
    }
    if checks.far {
        let far = weighted_lanes(weights, setup.far);
        inside &= bits(|i| far[i] >= 0.0);
    }
    // Interpolate the attributes of the slice's volume, and test them.
    let p = weighted_lanes(weights, setup.p);
    let q = weighted_lanes(weights, setup.q);
    let mut sum = [0.0; LANES];
    for i in 0..LANES {
        sum[i] = a[i] + b[i] + c[i];
    }
    let accepted = inside & bits(|i| accepts(p[i], q[i], sum[i]));
    fragments.generated += u64::from(if mode.clips_first { accepted } else { inside }.count_ones());
    fragments.accepted += u64::from(accepted.count_ones());
    let mut rest = accepted;
    while rest != 0 {
        let i = rest.trailing_zeros() as usize;
        rest &= rest - 1;
        let at = pixels.place(i as u32, setup.bounds.x[0]);
        fragment(setup, mode, image, at, [a[i], b[i], c[i]], sum[i]);
    }
}

#[inline(always)]
fn fragment(setup: &Setup, mode: Mode, image: &mut SliceImage, [x, y]: [u32; 2], weights: [f64; 3], sum: f64) {
    let inverse = 1.0 / sum;
    let [red, green, blue] = &setup.colour;
    let colour = [channel(weights, *red, inverse), channel(weights, *green, inverse), channel(weights, *blue, inverse)];
    if mode.hides && !image.is_nearest(x, y, super::setup::weighted(weights, setup.near) / sum) {
        return;
    }
    image.put(x, y, colour, mode.combine);
}

impl Setup {
    #[inline(always)]
    fn weights_at(&self, x: u32, row: [f64; 3]) -> [EachLane; 3] {
        let mut weights = [[0.0; LANES]; 3];
        for (k, lanes) in weights.iter_mut().enumerate() {
            let edge = &self.edges[k];
            for (i, lane) in lanes.iter_mut().enumerate() {
                let centre = f64::from(x) + (i as f64 + 0.5);
                *lane = edge.a * (centre - edge.x) + row[k];
            }
        }
        weights
    }

    /// Returns the weights of the corners at eight pixels, from index `first` on. The pixels of the triangle's bounds
    /// are numbered row by row.
    #[inline(always)]
    fn weights_of_block(&self, first: u32, width: u32) -> [EachLane; 3] {
        let columns = f64::from(width);
        let per_column = 1.0 / columns;
        let left = f64::from(self.bounds.x[0]) + 0.5;
        let top = f64::from(self.bounds.y[0]) + 0.5;
        let mut x = [0.0; LANES];
        let mut y = [0.0; LANES];
        for i in 0..LANES {
            let number = f64::from(first) + i as f64;
            // The numbers are integers below 72. Adding half a column keeps the product away from an integer, so
            // rounding cannot change the row.
            let row = ((number + 0.5) * per_column).floor();
            x[i] = left + (number - row * columns);
            y[i] = top + row;
        }
        let mut weights = [[0.0; LANES]; 3];
        for (k, lanes) in weights.iter_mut().enumerate() {
            let edge = &self.edges[k];
            for i in 0..LANES {
                lanes[i] = edge.a * (x[i] - edge.x) + edge.row(y[i]);
            }
        }
        weights
    }

    /// Returns the range of pixels of a row that can be inside the triangle and between the near and far planes. The
    /// range is enlarged by one pixel on both sides.
    fn row_range(&self, row: [f64; 3], checks: Checks) -> [u32; 2] {
        let mut range = self.bounds.x.map(f64::from);
        for (Edge { a, b, x, c, .. }, row) in self.edges.iter().zip(row) {
            // A nearly horizontal edge would move the limit by a large rounding error.
            let is_well_posed = *c == 0.0 && a.abs() > 1e-6 * b.abs();
            if is_well_posed {
                narrow(&mut range, *a, x - row / a);
            }
        }
        if checks.near {
            self.narrow_by(&mut range, row, self.near);
        }
        if checks.far {
            self.narrow_by(&mut range, row, self.far);
        }
        [range[0] as u32, range[1].max(range[0]) as u32]
    }

    /// Reduces a range of pixels to the part where a weighted sum is not negative. Leaves the range unchanged if
    /// rounding could move the limit of this part by a pixel.
    fn narrow_by(&self, range: &mut [f64; 2], row: [f64; 3], values: [f64; 3]) {
        let mut slope = 0.0;
        let mut constant = 0.0;
        let mut size = 0.0;
        for k in 0..3 {
            let Edge { a, b, x, c, .. } = self.edges[k];
            if c != 0.0 {
                return;
            }
            slope += values[k] * a;
            constant += values[k] * (row[k] - a * x);
            size += values[k].abs() * (a.abs() + b.abs());
        }
        // A small slope relative to its terms is mostly rounding error.
        if slope.abs() > 1e-6 * size {
            narrow(range, slope, -constant / slope);
        }
    }
}

/// Reduces a range of pixels to the side of `crossing` at which a linear function is positive. The function has slope
/// `slope` and is zero at `crossing`.
#[inline(always)]
fn narrow(range: &mut [f64; 2], slope: f64, crossing: f64) {
    let [left, right] = *range;
    if slope > 0.0 {
        range[0] = (crossing - 1.5).floor().clamp(left, right);
    } else {
        range[1] = (crossing + 1.5).ceil().clamp(left, right);
    }
}
