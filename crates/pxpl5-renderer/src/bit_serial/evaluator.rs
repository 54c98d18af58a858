//! Expression evaluator: trees of serial adders. In each clock, the trees deliver one bit of an expression's value to
//! every pixel.
//!
//! A tree multiplies a coefficient by the index of each column (or row), which is a leaf of the tree. Level `l` delays
//! the coefficient by `l` clocks and adds it to the leaves whose index has bit `l` set. Coefficients enter with the
//! least significant bit first.
//!
//! For a linear expression, every pixel adds the bit streams of its column and its row. For a quadratic one, wider
//! trees multiply by the squares of the indices; each row also has its own coefficient of x, which each pixel
//! multiplies by its column. This circuit is assumed: F89 publishes only the expression.
//!
//! No data flows from the pixels back to the trees. The simulator can therefore compute all clocks of the trees first,
//! and then all clocks of each vector of pixels, with the carries in registers. In vectors for trees, a lane holds 32
//! columns or rows. In vectors for pixels, it holds one row of a tile.

use super::tile::{self, WIDTH};
use crate::isa::{LINEAR_BITS, QUADRATIC_BITS};
use crate::simd::SimdVector;
use pxpl5_wire::{Linear, Quadratic};

const NUMBER_BITS: usize = 7;
const SQUARE_BITS: usize = 14;

/// Set of columns or rows of the array, with one bit for each of the 128. The columns or rows are the leaves of an
/// adder tree.
type Leaves = [u64; 2];

/// For each `l`, the columns (or rows) whose index has bit `l` set.
const NUMBERS: [Leaves; NUMBER_BITS] = leaves(1);
/// For each `l`, the columns (or rows) whose squared index has bit `l` set.
const SQUARES: [Leaves; SQUARE_BITS] = leaves(2);

const fn leaves<const N: usize>(power: u32) -> [Leaves; N] {
    let mut out = [[0; 2]; N];
    let mut number = 0_u32;
    while number < 128 {
        let mut l = 0;
        while l < N {
            if number.pow(power) >> l & 1 == 1 {
                out[l][number as usize / 64] |= 1 << (number % 64);
            }
            l += 1;
        }
        number += 1;
    }
    out
}

/// Output bits of the adder trees in one clock, with one bit for each column or row of pixels. Each 64-bit word holds
/// two lanes of a vector.
type Streams = [u64; 8];

/// Trees of serial adders, side by side in one vector. Each bit of the vector belongs to one leaf of a tree. A leaf is
/// a column or a row of pixels. In each leaf, the tree computes a coefficient times the leaf's index, plus an input bit
/// stream.
pub(super) struct Trees<V, const LEVELS: usize> {
    coefficients: [V; 2],
    leaves: [V; LEVELS],
    /// Delayed bits of the coefficients. Entry `l` holds the bits that entered `l` clocks ago, for level `l` of the
    /// trees.
    late: [V; LEVELS],
    carries: [V; LEVELS],
}

impl<V: SimdVector, const LEVELS: usize> Trees<V, LEVELS> {
    #[inline(always)]
    pub(super) fn new(coefficients: [V; 2], leaves: [V; LEVELS]) -> Self {
        let zeros = [V::splat(0); LEVELS];
        Self { coefficients, leaves, late: zeros, carries: zeros }
    }

    /// Creates two trees, one for 128 columns and one for 128 rows. The two trees use the first eight lanes of a
    /// vector, and the other lanes are unused.
    #[inline(always)]
    fn of_pair(coefficients: [i64; 2], leaves: &[Leaves; LEVELS]) -> Self {
        let mut vectors = [V::splat(0); LEVELS];
        for (vector, [low, high]) in vectors.iter_mut().zip(leaves) {
            *vector = V::load_words(&[*low, *high, *low, *high, 0, 0, 0, 0]);
        }
        Self::new(in_lanes(coefficients), vectors)
    }

    /// Multiplies the coefficient of each tree by the index of each column or row (or by the square of the index). Adds
    /// `stream`, and returns bit `t` of the sums. The trees keep carries between calls, so callers must pass `t` = 0,
    /// 1, 2 and so on.
    #[inline(always)]
    pub(super) fn add(&mut self, mut stream: V, t: usize) -> V {
        for l in (1..LEVELS).rev() {
            self.late[l] = self.late[l - 1];
        }
        self.late[0] = bit_of(self.coefficients, t);
        for l in 0..LEVELS {
            stream = full_add(stream, self.late[l].and(self.leaves[l]), &mut self.carries[l]);
        }
        stream
    }
}

#[inline(always)]
fn in_lanes<V: SimdVector>([first, second]: [i64; 2]) -> [V; 2] {
    [low_halves_in_lanes([first, second]), low_halves_in_lanes([first >> 32, second >> 32])]
}

#[inline(always)]
fn low_halves_in_lanes<V: SimdVector>(numbers: [i64; 2]) -> V {
    let [first, second] = numbers.map(|number| (number as u32 as u64) << 32 | number as u32 as u64);
    V::load_words(&[first, first, second, second, 0, 0, 0, 0])
}

/// Returns, for each lane, bit `t` of a 64-bit number. `low` and `high` hold the lower and upper halves of the numbers.
#[inline(always)]
fn bit_of<V: SimdVector>([low, high]: [V; 2], t: usize) -> V {
    if t < 32 { low.bit(t as u32) } else { high.bit(t as u32 - 32) }
}

/// Returns the lanes of a vector as eight 64-bit words. Words beyond the end of the vector are zero.
#[inline(always)]
fn streams<V: SimdVector>(stream: V) -> Streams {
    let mut words = [0; 8];
    stream.store_words(&mut words);
    words
}

/// Location of a vector of pixels in a tile, and the locations of the vector's column bits and row bits in [`Streams`].
#[derive(Clone, Copy)]
pub(super) struct VectorPlace {
    pub(super) at: usize,
    columns: StreamStart,
    rows: StreamStart,
}

/// Location of a bit in [`Streams`]: a 64-bit word, and a bit of this word. The bit belongs to the first column or row
/// of a vector of pixels.
#[derive(Clone, Copy)]
struct StreamStart {
    word: usize,
    bit: usize,
}

impl VectorPlace {
    #[inline(always)]
    pub(super) const fn in_array(tile: usize, row: usize) -> Self {
        let [left, top] = tile::origin(tile);
        let y = top + row;
        let columns = StreamStart { word: left / 64, bit: left % 64 };
        Self { at: row / 2, columns, rows: StreamStart { word: 2 + y / 64, bit: y % 64 } }
    }

    /// Returns the location of the vector that begins at row `row` of a tile, for trees that span only this tile. In
    /// word `word` of the trees' outputs, the low half holds the column bits and the high half holds the row bits.
    #[inline(always)]
    pub(super) const fn in_tile(word: usize, row: usize) -> Self {
        Self { at: row / 2, columns: StreamStart { word, bit: 0 }, rows: StreamStart { word, bit: WIDTH + row } }
    }

    #[inline(always)]
    fn columns<V: SimdVector>(&self, streams: &Streams) -> V {
        V::splat(self.columns.bits_in(streams) as i32)
    }

    #[inline(always)]
    fn rows<V: SimdVector>(&self, streams: &Streams) -> V {
        V::spread(self.rows.bits_in(streams))
    }
}

impl StreamStart {
    #[inline(always)]
    const fn bits_in(&self, streams: &Streams) -> u64 {
        streams[self.word % streams.len()] >> self.bit
    }
}

/// Serial adders in the pixels, which combine the output bits of the trees into the bits of an expression.
pub(super) trait Evaluator {
    type Carries<V: SimdVector>;

    fn start<V: SimdVector>() -> Self::Carries<V>;

    /// Returns bit `t` of the expression for a vector of pixels. Callers must pass `t` = 0, 1, 2 and so on.
    fn bit<V: SimdVector>(&self, t: usize, place: VectorPlace, carries: &mut Self::Carries<V>) -> V;
}

/// An evaluator whose adder trees span the whole array.
pub(super) trait WholeTrees: Evaluator {
    type Coefficients;

    fn run_trees<V: SimdVector>(coefficients: &Self::Coefficients, bits: usize) -> Self;
}

/// Output bits of the column tree and the row tree for a linear expression. Entry `t` holds the bits of clock `t`.
pub(super) struct LinearStreams(pub(super) [Streams; LINEAR_BITS as usize]);

/// Output bits of the trees for a quadratic expression. Entry `t` holds the bits of clock `t`.
pub(super) struct QuadraticStreams([QuadraticBits; QUADRATIC_BITS as usize]);

#[derive(Clone, Copy, Default)]
struct QuadraticBits {
    /// One bit of two sums: `xx x^2` for each column x, and `one + y y + yy y^2` for each row y.
    sums: Streams,
    /// One bit of the coefficient of x in each row: `x + xy y`. The bit is in the same lane as the row's bit in `sums`.
    coefficients: Streams,
}

pub(super) struct QuadraticCarries<V> {
    /// Bits of the coefficient of x. Entry n holds the bit that arrived n clocks ago. The tree multiplies this bit by
    /// bit n of the column's index.
    late: [V; NUMBER_BITS],
    product: [V; NUMBER_BITS],
    rows_and_columns: V,
    sum: V,
}

impl WholeTrees for LinearStreams {
    type Coefficients = Linear;

    #[inline(always)]
    fn run_trees<V: SimdVector>(e: &Linear, bits: usize) -> Self {
        let constants = in_lanes([0, e.c.into()]);
        let mut trees = Trees::<V, _>::of_pair([e.a.into(), e.b.into()], &NUMBERS);
        let mut out = [[0; 8]; LINEAR_BITS as usize];
        for (t, out) in out[..bits].iter_mut().enumerate() {
            *out = streams(trees.add(bit_of(constants, t), t));
        }
        Self(out)
    }
}

impl Evaluator for LinearStreams {
    type Carries<V: SimdVector> = V;

    #[inline(always)]
    fn start<V: SimdVector>() -> V {
        V::splat(0)
    }

    #[inline(always)]
    fn bit<V: SimdVector>(&self, t: usize, place: VectorPlace, carry: &mut V) -> V {
        full_add(place.columns(&self.0[t]), place.rows(&self.0[t]), carry)
    }
}

impl WholeTrees for QuadraticStreams {
    type Coefficients = Quadratic;

    #[inline(always)]
    fn run_trees<V: SimdVector>(q: &Quadratic, bits: usize) -> Self {
        let mut squares = Trees::<V, _>::of_pair([q.xx, q.yy], &SQUARES);
        let mut numbers = Trees::<V, _>::of_pair([q.xy, q.y], &NUMBERS);
        let constants = in_lanes([q.x, q.one]);
        // The second half of the trees belongs to the rows, and its outputs are added. The first tree of the indices
        // gives the coefficients of x.
        let second = V::spread(0xf0);
        let mut out = [QuadraticBits::default(); QUADRATIC_BITS as usize];
        for (t, out) in out[..bits].iter_mut().enumerate() {
            let numbers = numbers.add(bit_of(constants, t), t);
            out.sums = streams(squares.add(numbers.and(second), t));
            let [low, high, ..] = streams(numbers);
            out.coefficients = [0, 0, low, high, 0, 0, 0, 0];
        }
        Self(out)
    }
}

impl Evaluator for QuadraticStreams {
    type Carries<V: SimdVector> = QuadraticCarries<V>;

    #[inline(always)]
    fn start<V: SimdVector>() -> QuadraticCarries<V> {
        let zero = V::splat(0);
        let zeros = [zero; NUMBER_BITS];
        QuadraticCarries { late: zeros, product: zeros, rows_and_columns: zero, sum: zero }
    }

    #[inline(always)]
    fn bit<V: SimdVector>(&self, t: usize, place: VectorPlace, carries: &mut QuadraticCarries<V>) -> V {
        let QuadraticBits { sums, coefficients } = &self.0[t];
        let [a, b, c, d, e, f, _] = carries.late;
        carries.late = [place.rows(coefficients), a, b, c, d, e, f];
        let mut product = V::splat(0);
        for ((late, [low, high]), carry) in carries.late.iter().zip(&NUMBERS).zip(&mut carries.product) {
            let columns = place.columns(&[*low, *high, 0, 0, 0, 0, 0, 0]);
            product = full_add(product, late.and(columns), carry);
        }
        let rest = full_add(place.columns(sums), place.rows(sums), &mut carries.rows_and_columns);
        full_add(rest, product, &mut carries.sum)
    }
}

#[inline(always)]
pub(super) fn full_add<V: SimdVector>(a: V, b: V, carry: &mut V) -> V {
    let half = a.xor(b);
    let sum = half.xor(*carry);
    *carry = a.and(b).or(carry.and(half));
    sum
}

#[cfg(test)]
mod tests {
    use super::tile::{ACROSS, HEIGHT};
    use super::*;
    use crate::simd::{Baseline, Eight};
    type PortableVector = Eight<Baseline>;

    fn value<E: WholeTrees>(coefficients: &E::Coefficients, bits: u32, x: usize, y: usize) -> i64 {
        let evaluator = E::run_trees::<PortableVector>(coefficients, bits as usize);
        let mut carries = E::start();
        let tile = y / HEIGHT * ACROSS + x / WIDTH;
        let place = VectorPlace::in_array(tile, y % HEIGHT / PortableVector::LANES * PortableVector::LANES);
        // Each vector lane is one row, and each word holds two rows.
        let lane = y % PortableVector::LANES;
        let column = x % WIDTH;
        let value = (0..bits as usize).fold(0, |value, t| {
            let mut words = [0; PortableVector::LANES / 2];
            evaluator.bit::<PortableVector>(t, place, &mut carries).store_words(&mut words);
            value | ((words[lane / 2] >> (WIDTH * (lane % 2) + column) & 1) as i64) << t
        });
        value << (64 - bits) >> (64 - bits)
    }

    #[test]
    fn the_expression_trees_deliver_the_bits_of_a_linear_expression() {
        let e = Linear { a: -123_456, b: 987_654, c: i32::MAX };
        for (x, y) in [(0, 0), (127, 0), (0, 127), (127, 127), (64, 63), (93, 42)] {
            let expected = i64::from(e.at(x, y));
            let found = value::<LinearStreams>(&e, LINEAR_BITS, x as usize, y as usize);
            assert_eq!(found, expected, "({x}, {y})");
        }
    }

    #[test]
    fn the_expression_trees_deliver_the_bits_of_a_quadratic_expression() {
        let q =
            Quadratic { xx: -70_001, xy: 1 << 33, yy: -65_537, x: 123_456_789, y: -987_654_321, one: -(1 << 40) + 17 };
        for (x, y) in [(0, 0), (127, 0), (0, 127), (127, 127), (64, 63), (93, 42)] {
            let unused = 64 - QUADRATIC_BITS;
            let expected = q.at(x, y) << unused >> unused;
            let found = value::<QuadraticStreams>(&q, QUADRATIC_BITS, x as usize, y as usize);
            assert_eq!(found, expected, "({x}, {y})");
        }
    }
}
