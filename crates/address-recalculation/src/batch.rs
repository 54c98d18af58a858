//! Runs of pixels, each step a loop over all of them, so that a vector unit takes several at a time.
//!
//! Directions are sums of three products below 2^53, so doubles hold them exactly. A quotient needs no correction: it is a
//! multiple of 1/(2F) with F below 2^(v + m - 1), v and m being the bits of vector and matrix, and less than 2^q; a double near
//! it is at most 2^(q - 54) wrong. With v + m + q <= 53 that is less than 1/(2F), so rounding never reaches the next whole number.

use crate::address::AddressUnit;
use crate::orientation::MatrixWords;
use multiversion::multiversion;

/// Pixels that are looked up together: enough to hide what a call costs, few enough to stay in the first cache.
pub(crate) const BATCH: usize = 64;

/// Pixels are taken in multiples of this: the doubles in a vector of the widest unit.
const LANES: usize = 8;

type Each<T> = [T; BATCH];

/// Where the footprints of pixels begin, and their fractions.
pub(crate) struct Batch {
    /// How many pixels there are.
    pub(crate) count: usize,
    /// The upper left texel of each; the first of all for one that leaves its face.
    pub(crate) index: Each<u32>,
    right: Each<u32>,
    down: Each<u32>,
    /// Not 0 for a footprint that leaves its face, which has no numbers here.
    leaves: Each<i32>,
    /// Whether one of them leaves its face.
    pub(crate) is_left: bool,
}

impl Batch {
    /// The upper left texels of those that stay on their face.
    pub(crate) fn inside(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.count).filter(|i| self.leaves[*i] == 0).map(|i| self.index[i])
    }

    /// The pixels of their number whose footprints leave their face.
    pub(crate) fn left(&self) -> impl Iterator<Item = usize> + '_ {
        let any = if self.is_left { self.count } else { 0 };
        (0..any).filter(|i| self.leaves[*i] != 0)
    }
}

/// Directions by the axes of the faces that they meet.
struct Met {
    face: Each<i32>,
    forward: Each<f64>,
    right: Each<f64>,
    down: Each<f64>,
}

/// Looks up to [`BATCH`] directions up.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(crate) fn addresses(unit: &AddressUnit, vectors: [&[i32]; 3], matrix: &MatrixWords) -> Batch {
    let count = vectors[0].len();
    let whole = count.next_multiple_of(LANES).min(BATCH);
    // What is beyond the last pixel takes the first one's numbers.
    let filled = vectors.map(|axis| {
        let mut all = [axis[0]; BATCH];
        all[..count].copy_from_slice(axis);
        all
    });
    let met = meetings(&filled, matrix, whole);
    let across = places(unit, &met.right, &met.forward, whole);
    let down = places(unit, &met.down, &met.forward, whole);
    footprints(unit, &met.face, [&across, &down], [whole, count])
}

#[inline(always)]
fn meetings(vectors: &[Each<i32>; 3], matrix: &MatrixWords, whole: usize) -> Met {
    let mut met = Met { face: [0; BATCH], forward: [0.0; BATCH], right: [0.0; BATCH], down: [0.0; BATCH] };
    let m = matrix.0.map(|row| row.map(f64::from));
    for i in 0..whole {
        let v = [f64::from(vectors[0][i]), f64::from(vectors[1][i]), f64::from(vectors[2][i])];
        let x = m[0][0] * v[0] + m[0][1] * v[1] + m[0][2] * v[2];
        let y = m[1][0] * v[0] + m[1][1] * v[1] + m[1][2] * v[2];
        let z = m[2][0] * v[0] + m[2][1] * v[1] + m[2][2] * v[2];
        let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
        let is_x = (ax >= ay) & (ax >= az);
        let is_y = !is_x & (ay >= az);
        let longest = select(is_x, x, select(is_y, y, z));
        let is_negative = longest < 0.0;
        let axis = if is_x {
            0
        } else if is_y {
            2
        } else {
            4
        };
        met.face[i] = axis + i32::from(is_negative);
        met.forward[i] = longest.abs();
        // To the right lie z, x and -x on the positive faces of x, y and z; below lie -y, -z and -y.
        let right = select(is_x, z, -x);
        met.right[i] = select(is_y, x, select(is_negative, -right, right));
        met.down[i] = select(is_y, select(is_negative, z, -z), -y);
    }
    met
}

#[inline(always)]
const fn select(condition: bool, yes: f64, no: f64) -> f64 {
    if condition { yes } else { no }
}

/// Places between the middles of texels in parts of 2^quotient_bits.
#[inline(always)]
fn places(unit: &AddressUnit, side: &Each<f64>, forward: &Each<f64>, whole: usize) -> Each<i32> {
    let q = unit.quotient_bits as u32;
    let scale = f64::from(1_u32 << q);
    let largest = (1_i32 << q) - 1;
    let half = if unit.weight_bits == 0 { 0 } else { 1 << (q - 1) };
    let inner = unit.geometry.inner() as i32;
    let first = ((unit.geometry.guard as i32) << q) + inner / 2 - half;
    let mut out = [0; BATCH];
    for i in 0..whole {
        let quotient = (forward[i] + side[i]) * scale / (2.0 * forward[i]);
        out[i] = first + (quotient as i32).min(largest) * inner;
    }
    out
}

#[inline(always)]
fn footprints(unit: &AddressUnit, face: &Each<i32>, places: [&Each<i32>; 2], [whole, count]: [usize; 2]) -> Batch {
    let q = unit.quotient_bits as u32;
    let size = unit.geometry.texels as i32;
    let last = if unit.weight_bits == 0 { size - 1 } else { size - 2 };
    let below = (unit.quotient_bits - unit.weight_bits) as u32;
    let part = (1_u32 << q) - 1;
    let rounding = (1_u32 << below) >> 1;
    let mut all =
        Batch { count, index: [0; BATCH], right: [0; BATCH], down: [0; BATCH], leaves: [0; BATCH], is_left: false };
    let mut left = 0;
    for i in 0..whole {
        let [across, down] = [places[0][i], places[1][i]];
        let column = across >> q;
        let row = down >> q;
        // The sign of a number below 0, or of what is left up to the last.
        let leaves = (column | row | (last - column) | (last - row)) >> 31;
        left |= leaves;
        all.leaves[i] = leaves;
        all.index[i] = (((face[i] * size + row) * size + column) & !leaves) as u32;
        all.right[i] = ((across as u32 & part) + rounding) >> below;
        all.down[i] = ((down as u32 & part) + rounding) >> below;
    }
    all.is_left = left != 0;
    all
}

/// The colours of footprints, weighed; `reach` texels down lies the next row, or none where nothing is interpolated.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(crate) fn mixed(colours: &[u32], batch: &Batch, reach: usize, weight_bits: u32, out: &mut [u32]) {
    if weight_bits == 0 {
        for (out, first) in out.iter_mut().zip(&batch.index) {
            *out = colours[*first as usize];
        }
        return;
    }
    let count = out.len().min(BATCH);
    let mut four = [[0; BATCH]; 4];
    for i in 0..count {
        let first = batch.index[i] as usize;
        let upper = &colours[first..first + 2];
        let lower = &colours[first + reach..first + reach + 2];
        four[0][i] = upper[0];
        four[1][i] = upper[1];
        four[2][i] = lower[0];
        four[3][i] = lower[1];
    }
    let pixels = if weight_bits <= WEIGHTS_OF_TWO {
        two(&four, batch, weight_bits, count)
    } else {
        each(&four, batch, weight_bits, count)
    };
    out.copy_from_slice(&pixels[..count]);
}

/// Bits of a fraction up to which two parts of a colour, 16 bits apart, are weighed in one product: 255 x 4^4 and half of it are
/// below 2^16.
const WEIGHTS_OF_TWO: u32 = 4;

/// Weighs red and blue together, and green.
#[inline(always)]
fn two(four: &[Each<u32>; 4], batch: &Batch, weight_bits: u32, count: usize) -> Each<u32> {
    let one = 1 << weight_bits;
    let half = (1 << (2 * weight_bits)) >> 1;
    let mut out = [0; BATCH];
    for i in 0..count {
        let [right, down] = [batch.right[i], batch.down[i]];
        let weights = [(one - right) * (one - down), right * (one - down), (one - right) * down, right * down];
        let mut outer = half | half << 16;
        let mut green = half;
        for k in 0..4 {
            outer += (four[k][i] & 0x00FF_00FF) * weights[k];
            green += (four[k][i] >> 8 & 0xFF) * weights[k];
        }
        out[i] = (outer >> (2 * weight_bits) & 0x00FF_00FF) | (green >> (2 * weight_bits)) << 8;
    }
    out
}

/// Weighs red, green and blue each by itself.
#[inline(always)]
fn each(four: &[Each<u32>; 4], batch: &Batch, weight_bits: u32, count: usize) -> Each<u32> {
    let one = 1 << weight_bits;
    let half = (1 << (2 * weight_bits)) >> 1;
    let mut out = [0; BATCH];
    for i in 0..count {
        let [right, down] = [batch.right[i], batch.down[i]];
        let weights = [(one - right) * (one - down), right * (one - down), (one - right) * down, right * down];
        for shift in [16, 8, 0] {
            let mut sum = half;
            for k in 0..4 {
                sum += (four[k][i] >> shift & 0xFF) * weights[k];
            }
            out[i] |= sum >> (2 * weight_bits) << shift;
        }
    }
    out
}
