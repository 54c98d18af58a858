//! The inner loops of the fast path: eight pixels of a row at a time, in plain Rust.
//!
//! Every lane computes what the oracle computes for one pixel, with the same operations in the same order. What is left out
//! cannot change anything: pixels outside a conservative range of a row, and sums of which every term has one sign.

use super::setup::{Edge, Setup, channel};
use crate::command::Combine;
use crate::image::SliceImage;
use crate::slice_volume::{SampleTest, hyperbolic, parallel, taper};

/// Pixels in a vector, which is also the pixels of a byte of the stencil.
const LANES: usize = 8;

/// One value a pixel.
type EachLane = [f64; LANES];

/// Width in pixels from which on the range of each row is computed before its pixels are.
const WIDE: u32 = 24;

/// Fragments of a triangle: those generated and those accepted.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Fragments {
    pub(super) generated: u64,
    pub(super) accepted: u64,
}

/// What is the same for all fragments of a draw.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mode {
    pub(super) test: SampleTest,
    pub(super) combine: Combine,
    /// Whether only accepted fragments are generated.
    pub(super) clips_first: bool,
    pub(super) hides: bool,
}

#[inline(always)]
pub(super) fn draw(setup: &Setup, mode: Mode, image: &mut SliceImage) -> Fragments {
    if let Some(bits) = mode.test.fraction_bits() {
        let scale = libm::ldexp(1.0, bits as i32);
        return draw_rounded(setup, mode, scale, image);
    }
    match mode.test {
        SampleTest::All => rows(setup, mode, image, |_, _, _| true),
        SampleTest::Slab => rows(setup, mode, image, |p, q, _| (p >= 0.0) & (q > 0.0)),
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

/// The same with planes of few bits, which need a division for every pixel.
fn draw_rounded(setup: &Setup, mode: Mode, scale: f64, image: &mut SliceImage) -> Fragments {
    let round = |x: f64, w: f64| (x / w * scale).round_ties_even() / scale;
    let exact = mode.test.without_rounding();
    rows(setup, mode, image, |p, q, w| exact.accepts(round(p, w), round(q, w), 1.0))
}

#[inline(always)]
fn rows(setup: &Setup, mode: Mode, image: &mut SliceImage, accepts: impl Fn(f64, f64, f64) -> bool) -> Fragments {
    let mut fragments = Fragments::default();
    let [left, right] = setup.bounds.x;
    let is_wide = right - left > WIDE;
    let checks = Checks { near: has_negative(setup.near), far: has_negative(setup.far) };
    for y in setup.bounds.y[0]..setup.bounds.y[1] {
        let row = setup.edges.map(|edge| edge.row(f64::from(y) + 0.5));
        let [from, to] = if is_wide { setup.row_range(row, checks) } else { [left, right] };
        let mut x = from & !(LANES as u32 - 1);
        while x < to {
            let weights = setup.weights_at(x, row);
            chunk(setup, mode, image, [x, y], &weights, checks, &accepts, &mut fragments);
            x += LANES as u32;
        }
    }
    fragments
}

/// Which of the two planes some corner lies beyond.
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
    let mut lanes = [0u8; LANES];
    for i in 0..LANES {
        lanes[i] = u8::from(holds(i)) << i;
    }
    lanes.iter().fold(0, |mask, lane| mask | lane)
}

#[inline(always)]
fn weighted_lanes(weights: &[EachLane; 3], values: [f64; 3]) -> EachLane {
    let mut sums = [0.0; LANES];
    for i in 0..LANES {
        sums[i] = weights[0][i] * values[0] + weights[1][i] * values[1] + weights[2][i] * values[2];
    }
    sums
}

#[inline(always)]
#[expect(clippy::too_many_arguments, reason = "inlined: a struct of these would be taken apart again")]
fn chunk(
    setup: &Setup,
    mode: Mode,
    image: &mut SliceImage,
    [x, y]: [u32; 2],
    weights: &[EachLane; 3],
    checks: Checks,
    accepts: &impl Fn(f64, f64, f64) -> bool,
    fragments: &mut Fragments,
) {
    let [a, b, c] = weights;
    let least = setup.least;
    let mut inside = bits(|i| (a[i] >= least[0]) & (b[i] >= least[1]) & (c[i] >= least[2]));
    if inside == 0 {
        return;
    }
    if checks.near {
        let near = weighted_lanes(weights, setup.near);
        inside &= bits(|i| near[i] >= 0.0);
    }
    if checks.far {
        let far = weighted_lanes(weights, setup.far);
        inside &= bits(|i| far[i] >= 0.0);
    }
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
        fragment(setup, mode, image, [x + i as u32, y], [a[i], b[i], c[i]], sum[i]);
    }
}

#[inline(always)]
fn fragment(setup: &Setup, mode: Mode, image: &mut SliceImage, [x, y]: [u32; 2], weights: [f64; 3], sum: f64) {
    let inverse = 1.0 / sum;
    let colour = [0, 1, 2].map(|c| channel(weights, setup.colour[c], inverse));
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

    /// The pixels of a row that can be inside and between near and far plane, a pixel more on both sides.
    fn row_range(&self, row: [f64; 3], checks: Checks) -> [u32; 2] {
        let mut range = self.bounds.x.map(f64::from);
        for k in 0..3 {
            let Edge { a, b, x, c, .. } = self.edges[k];
            let is_well_posed = c == 0.0 && a.abs() > 1e-6 * b.abs();
            if is_well_posed {
                narrow(&mut range, a, x - row[k] / a);
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

    /// Narrows a range by where a weighted sum is not negative, if rounding cannot move that by a pixel.
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
        if slope.abs() > 1e-6 * size {
            narrow(range, slope, -constant / slope);
        }
    }
}

/// Narrows a range of pixels by a function that rises or falls through zero at `crossing`.
#[inline(always)]
fn narrow(range: &mut [f64; 2], slope: f64, crossing: f64) {
    let [left, right] = *range;
    if slope > 0.0 {
        range[0] = (crossing - 1.5).floor().clamp(left, right);
    } else {
        range[1] = (crossing + 1.5).ceil().clamp(left, right);
    }
}
