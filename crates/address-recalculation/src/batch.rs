//! Address computation for groups of pixels. Each step is a loop over all pixels, so the compiler can vectorize it.
//!
//! Directions are sums of three products below 2^53, which doubles hold exactly. Quotients need no correction either:
//!
//! - A quotient is a multiple of 1/(2F) and less than 2^q. Here q is the number of bits of a quotient, and F is the
//!   component of the direction along the face's axis. F is below 2^(v + m - 1), where v and m are the numbers of bits
//!   of vector and matrix.
//! - A rounded double near the quotient has an error of at most 2^(q - 54).
//! - With v + m + q <= 53 this error is less than 1/(2F), so rounding never reaches the next integer.

use crate::address::AddressUnit;
use crate::orientation::MatrixWords;
use multiversion::multiversion;

/// Number of pixels per group. The number is large enough to amortize a call, and small enough for the first-level
/// cache.
pub(crate) const BATCH: usize = 64;

type Each<T> = [T; BATCH];

/// Upper left texel and fractions of the footprint of each pixel in a group. A footprint is the four texels around a
/// position.
#[derive(Clone, Debug)]
pub(crate) struct Batch {
    pub(crate) count: usize,
    /// Index of the upper left texel of each pixel. The index is 0 for a footprint that extends beyond one face.
    pub(crate) index: Each<u32>,
    right: Each<u32>,
    down: Each<u32>,
    /// Nonzero for a footprint (four texels) that extends beyond one face. The address unit computes such footprints
    /// one by one.
    leaves: Each<i32>,
    is_left: bool,
    met: Met,
}

/// Intermediate values of a group of pixels: viewing vectors, rotated vectors, components along the face's axes, and
/// positions.
#[derive(Clone, Debug)]
struct Met {
    vectors: [Each<i32>; 3],
    turned: [Each<f64>; 3],
    face: Each<i32>,
    forward: Each<f64>,
    right: Each<f64>,
    down: Each<f64>,
    column: Each<i32>,
    row: Each<i32>,
}

impl Batch {
    pub(crate) const fn new() -> Self {
        let none = [0.0; BATCH];
        let met = Met {
            vectors: [[0; BATCH]; 3],
            turned: [none; 3],
            face: [0; BATCH],
            forward: none,
            right: none,
            down: none,
            column: [0; BATCH],
            row: [0; BATCH],
        };
        let zero = [0; BATCH];
        Self { count: 0, index: zero, right: zero, down: zero, leaves: [0; BATCH], is_left: false, met }
    }

    /// Returns the upper left texel of each footprint (four texels) that lies on a single face.
    pub(crate) fn inside(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.count).filter(|i| self.leaves[*i] == 0).map(|i| self.index[i])
    }

    /// Returns true if the footprint of a pixel (its four texels) extends beyond one face.
    pub(crate) const fn leaves(&self, pixel: usize) -> bool {
        self.leaves[pixel] != 0
    }

    /// Returns true if any footprint (four texels) of the group extends beyond one face.
    pub(crate) const fn is_left(&self) -> bool {
        self.is_left
    }
}

/// Computes the addresses of up to [`BATCH`] directions.
///
/// Every step processes all entries of the arrays, so that loops have a constant length. Unused entries hold values of
/// earlier groups.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(crate) fn addresses(batch: &mut Batch, unit: &AddressUnit, vectors: [&[i32]; 3], matrix: &MatrixWords) {
    batch.count = vectors[0].len().min(BATCH);
    let met = &mut batch.met;
    for (lanes, axis) in met.vectors.iter_mut().zip(vectors) {
        lanes[..batch.count].copy_from_slice(&axis[..batch.count]);
    }
    // Rotate, select faces, divide, and split positions into texels and fractions.
    for (out, row) in met.turned.iter_mut().zip(&matrix.0) {
        turn(out, &met.vectors, row);
    }
    meet(met);
    places(&mut met.column, unit, &met.right, &met.forward);
    places(&mut met.row, unit, &met.down, &met.forward);
    footprints(batch, unit);
}

/// Computes one component of all rotated directions, without rounding errors. `row` is the row of the matrix for this
/// component.
#[inline(always)]
fn turn(out: &mut Each<f64>, [x, y, z]: &[Each<i32>; 3], row: &[i32; 3]) {
    let [a, b, c] = row.map(f64::from);
    for i in 0..BATCH {
        out[i] = a * f64::from(x[i]) + b * f64::from(y[i]) + c * f64::from(z[i]);
    }
}

/// Selects the face of each direction by its longest component. Among equally long components, x precedes y, and y
/// precedes z.
#[inline(always)]
fn meet(met: &mut Met) {
    let Met { turned: [xs, ys, zs], face, forward, right, down, .. } = met;
    for i in 0..BATCH {
        // Comparisons without branches keep the loop vectorizable.
        let [x, y, z] = [xs[i], ys[i], zs[i]];
        let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
        let is_x = (ax >= ay) & (ax >= az);
        let is_y = !is_x & (ay >= az);
        let longest = select(is_x, x, select(is_y, y, z));
        let is_negative = longest < 0.0;
        let axis = if is_y { 2 } else { 4 };
        face[i] = (if is_x { 0 } else { axis }) + i32::from(is_negative);
        forward[i] = longest.abs();
        // The right axes of the positive faces of x, y and z are z, x and -x. Their downward axes are -y, -z and -y.
        let aside = select(is_x, z, -x);
        right[i] = select(is_y, x, select(is_negative, -aside, aside));
        down[i] = select(is_y, select(is_negative, z, -z), -y);
    }
}

#[inline(always)]
const fn select(condition: bool, yes: f64, no: f64) -> f64 {
    if condition { yes } else { no }
}

/// Returns the integer part of a number from 0 to 2^32.
///
/// Adding 2^52 puts the integer into the lowest bits of the double. A cast would compare each number with the limits of
/// the type.
#[inline(always)]
fn whole_part(number: f64) -> i32 {
    (number.floor() + 4_503_599_627_370_496.0).to_bits() as i32
}

/// Computes positions on the face relative to the middles of texels, in units of `2^-quotient_bits`.
#[inline(always)]
fn places(out: &mut Each<i32>, unit: &AddressUnit, side: &Each<f64>, forward: &Each<f64>) {
    let q = unit.quotient_bits as u32;
    let scale = f64::from(1_u32 << q);
    let largest = scale - 1.0;
    let half = if unit.weight_bits == 0 { 0 } else { 1 << (q - 1) };
    let inner = unit.geometry.inner() as i32;
    let first = ((unit.geometry.guard as i32) << q) + inner / 2 - half;
    for i in 0..BATCH {
        let quotient = (forward[i] + side[i]) * scale / (2.0 * forward[i]);
        out[i] = first + whole_part(select(quotient < largest, quotient, largest)) * inner;
    }
}

#[inline(always)]
fn footprints(batch: &mut Batch, unit: &AddressUnit) {
    let q = unit.quotient_bits as u32;
    let size = unit.geometry.texels as i32;
    let last = if unit.weight_bits == 0 { size - 1 } else { size - 2 };
    let below = (unit.quotient_bits - unit.weight_bits) as u32;
    let part = (1_u32 << q) - 1;
    let rounding = (1_u32 << below) >> 1;
    let Batch { count, index, right, down, leaves, met, .. } = batch;
    for i in 0..BATCH {
        let column = met.column[i] >> q;
        let row = met.row[i] >> q;
        // The sign bit is set if a coordinate is below 0 or above the last texel.
        leaves[i] = (column | row | (last - column) | (last - row)) >> 31;
        index[i] = (((met.face[i] * size + row) * size + column) & !leaves[i]) as u32;
        right[i] = ((met.column[i] as u32 & part) + rounding) >> below;
        down[i] = ((met.row[i] as u32 & part) + rounding) >> below;
    }
    batch.is_left = leaves[..*count].iter().fold(0, |any, leaves| any | leaves) != 0;
}

/// Interpolates the four colours of each footprint (four texels) in a group.
///
/// `reach` is the index of the texel below a texel minus the index of this texel, or 0 without interpolation.
#[multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
pub(crate) fn mixed(colours: &[u32], batch: &Batch, reach: usize, weight_bits: u32, out: &mut [u32]) {
    if weight_bits == 0 {
        for (out, first) in out.iter_mut().zip(&batch.index) {
            *out = colours[*first as usize];
        }
        return;
    }
    // Gather the four texels of each footprint.
    let count = out.len().min(BATCH);
    let mut four = [[0; BATCH]; 4];
    for (i, first) in batch.index[..count].iter().enumerate() {
        let first = *first as usize;
        let upper = &colours[first..first + 2];
        let lower = &colours[first + reach..first + reach + 2];
        four[0][i] = upper[0];
        four[1][i] = upper[1];
        four[2][i] = lower[0];
        four[3][i] = lower[1];
    }
    if weight_bits <= MAX_PACKED_WEIGHT_BITS {
        two(&four, batch, weight_bits, &mut out[..count]);
    } else {
        each(&four, batch, weight_bits, &mut out[..count]);
    }
}

/// Largest number of weight bits for which two colour channels, 16 bits apart, fit into one product.
///
/// The reason is that 255 * 4^4 plus half a unit is below 2^16.
const MAX_PACKED_WEIGHT_BITS: u32 = 4;

/// Interpolates colours with two products for each texel: one product for red and blue together, and one product for
/// green.
#[inline(always)]
fn two(four: &[Each<u32>; 4], batch: &Batch, weight_bits: u32, out: &mut [u32]) {
    let one = 1 << weight_bits;
    let half = (1 << (2 * weight_bits)) >> 1;
    let count = out.len().min(BATCH);
    for i in 0..count {
        let [right, down] = [batch.right[i], batch.down[i]];
        let weights = [(one - right) * (one - down), right * (one - down), (one - right) * down, right * down];
        // Red and blue share one word. The added half rounds to nearest.
        let mut outer = half | half << 16;
        let mut green = half;
        for k in 0..4 {
            outer += (four[k][i] & 0x00FF_00FF) * weights[k];
            green += (four[k][i] >> 8 & 0xFF) * weights[k];
        }
        out[i] = (outer >> (2 * weight_bits) & 0x00FF_00FF) | (green >> (2 * weight_bits)) << 8;
    }
}

/// Interpolates colours, with a separate product for each of red, green and blue.
#[inline(always)]
fn each(four: &[Each<u32>; 4], batch: &Batch, weight_bits: u32, out: &mut [u32]) {
    let one = 1 << weight_bits;
    let half = (1 << (2 * weight_bits)) >> 1;
    let count = out.len().min(BATCH);
    for i in 0..count {
        let [right, down] = [batch.right[i], batch.down[i]];
        let weights = [(one - right) * (one - down), right * (one - down), (one - right) * down, right * down];
        let mut pixel = 0;
        for shift in [16, 8, 0] {
            // The added half rounds to nearest.
            let mut sum = half;
            for k in 0..4 {
                sum += (four[k][i] >> shift & 0xFF) * weights[k];
            }
            pixel |= sum >> (2 * weight_bits) << shift;
        }
        out[i] = pixel;
    }
}
