//! The expression evaluator: trees of serial adders that deliver one bit of the expression a clock to every pixel.
//!
//! A tree multiplies a coefficient by the number of each column (or row): level `l` adds the coefficient, `l` clocks
//! late, to the leaves whose number has bit `l`. Coefficients enter least significant bit first. For a linear
//! expression every pixel adds its column's stream to its row's. For a quadratic one, wider trees multiply by the
//! squares of the numbers, each row gets its own coefficient of x, and each pixel multiplies that by its column
//! (assumed; F89 publishes the expression, not the circuit).
//!
//! Nothing flows back from the pixels, so the trees run all their clocks first; then each vector of pixels runs all of
//! its own, with its carries in registers.

use crate::simd::Vector;
use pxpl5_wire::{Linear, Quadratic};

/// Bits of a column's number.
const NUMBER_BITS: usize = 7;
/// Bits of the square of a column's number.
const SQUARE_BITS: usize = 14;

/// One bit for each of 128 columns or rows.
type Leaves = [u64; 2];

/// Leaves whose number has bit `l`.
const NUMBERS: [Leaves; NUMBER_BITS] = leaves(1);
/// Leaves the square of whose number has bit `l`.
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

/// One bit for each leaf of two trees side by side: those of the columns, then those of the rows.
type Pair = [u64; 4];

/// Serial adders of two trees that add a coefficient times a number to the stream of each leaf. A leaf is a bit of a
/// vector; the trees are its first two rows, what its other rows hold counts for nothing.
struct Trees<V, const N: usize> {
    coefficients: [i64; 2],
    leaves: &'static [Leaves; N],
    /// The last bits of both coefficients, two a clock, for the late levels.
    late: u64,
    carries: [V; N],
}

impl<V: Vector, const N: usize> Trees<V, N> {
    #[inline(always)]
    fn new(coefficients: [i64; 2], leaves: &'static [Leaves; N]) -> Self {
        Self { coefficients, leaves, late: 0, carries: [V::splat(0); N] }
    }

    /// Bit `t` of the sums; `t` counts up from 0.
    #[inline(always)]
    fn add(&mut self, mut stream: V, t: usize) -> V {
        self.late = self.late << 2 | both(self.coefficients, t);
        for (l, (leaves, carry)) in self.leaves.iter().zip(&mut self.carries).enumerate() {
            let addend = V::rows(self.late >> (2 * l)).and(V::columns(*leaves));
            stream = full_add(stream, addend, carry);
        }
        stream
    }
}

/// Bit `t` of two numbers.
#[inline(always)]
const fn both([first, second]: [i64; 2], t: usize) -> u64 {
    (first >> t & 1 | (second >> t & 1) << 1) as u64
}

/// The first two rows of a vector.
#[inline(always)]
fn pair<V: Vector>(stream: V) -> Pair {
    let mut words = [0; 8];
    stream.store_words(&mut words);
    [words[0], words[1], words[2], words[3]]
}

/// An expression: what the trees deliver, and what pixels do with it.
pub(super) trait Evaluator {
    /// Its coefficients.
    type Coefficients;
    /// What the adders of a vector of pixels hold from clock to clock.
    type Carries<V: Vector>;

    /// Runs the trees for the first `bits` of the expression.
    fn run_trees<V: Vector>(coefficients: &Self::Coefficients, bits: usize) -> Self;

    /// All zeros.
    fn start<V: Vector>() -> Self::Carries<V>;

    /// Bit `t` of the expression in a vector of pixels whose first row is `row`; `t` counts up from 0.
    fn bit<V: Vector>(&self, t: usize, row: usize, carries: &mut Self::Carries<V>) -> V;
}

/// A linear expression: what each column and row delivers, clock by clock.
#[derive(Debug)]
pub(super) struct LinearTrees(Vec<Pair>);

/// A quadratic expression.
#[derive(Debug)]
pub(super) struct QuadraticTrees(Vec<QuadraticBits>);

/// What the trees of a quadratic deliver in one clock.
#[derive(Debug)]
struct QuadraticBits {
    /// xx x^2 of each column; one + y y + yy y^2 of each row.
    sums: Pair,
    /// x + xy y: each row's coefficient of x.
    coefficient: Leaves,
}

/// Carries of a quadratic in some pixels.
pub(super) struct QuadraticCarries<V> {
    /// The last bits of the coefficient, for the late levels of the product.
    late: [V; NUMBER_BITS],
    product: [V; NUMBER_BITS],
    rows_and_columns: V,
    sum: V,
}

impl Evaluator for LinearTrees {
    type Coefficients = Linear;
    type Carries<V: Vector> = V;

    #[inline(always)]
    fn run_trees<V: Vector>(e: &Linear, bits: usize) -> Self {
        let constants = [0, e.c.into()];
        let mut trees = Trees::new([e.a.into(), e.b.into()], &NUMBERS);
        let mut out = Vec::with_capacity(bits);
        for t in 0..bits {
            out.push(pair(trees.add(V::rows(both(constants, t)), t)));
        }
        Self(out)
    }

    #[inline(always)]
    fn start<V: Vector>() -> V {
        V::splat(0)
    }

    #[inline(always)]
    fn bit<V: Vector>(&self, t: usize, row: usize, carry: &mut V) -> V {
        columns_and_rows(&self.0[t], row, carry)
    }
}

/// The sum of what the columns and the rows deliver.
#[inline(always)]
fn columns_and_rows<V: Vector>([low, high, rows @ ..]: &Pair, row: usize, carry: &mut V) -> V {
    full_add(V::columns([*low, *high]), rows_of(rows, row), carry)
}

impl Evaluator for QuadraticTrees {
    type Coefficients = Quadratic;
    type Carries<V: Vector> = QuadraticCarries<V>;

    #[inline(always)]
    fn run_trees<V: Vector>(q: &Quadratic, bits: usize) -> Self {
        let mut squares = Trees::new([q.xx, q.yy], &SQUARES);
        let mut numbers = Trees::new([q.xy, q.y], &NUMBERS);
        // The second trees belong together; the first of the numbers stands beside them.
        let second = V::rows(0b10);
        let mut out = Vec::with_capacity(bits);
        for t in 0..bits {
            let numbers = numbers.add(V::rows(both([q.x, q.one], t)), t);
            let sums = pair(squares.add(numbers.and(second), t));
            let [low, high, ..] = pair(numbers);
            out.push(QuadraticBits { sums, coefficient: [low, high] });
        }
        Self(out)
    }

    #[inline(always)]
    fn start<V: Vector>() -> QuadraticCarries<V> {
        let zero = V::splat(0);
        let zeros = [zero; NUMBER_BITS];
        QuadraticCarries { late: zeros, product: zeros, rows_and_columns: zero, sum: zero }
    }

    #[inline(always)]
    fn bit<V: Vector>(&self, t: usize, row: usize, carries: &mut QuadraticCarries<V>) -> V {
        let QuadraticBits { sums, coefficient } = &self.0[t];
        let [a, b, c, d, e, f, _] = carries.late;
        carries.late = [rows_of(coefficient, row), a, b, c, d, e, f];
        let mut product = V::splat(0);
        for ((late, columns), carry) in carries.late.iter().zip(&NUMBERS).zip(&mut carries.product) {
            product = full_add(product, late.and(V::columns(*columns)), carry);
        }
        let rest = columns_and_rows(sums, row, &mut carries.rows_and_columns);
        full_add(rest, product, &mut carries.sum)
    }
}

/// One clock of a serial adder in each pixel of a vector.
#[inline(always)]
pub(super) fn full_add<V: Vector>(a: V, b: V, carry: &mut V) -> V {
    let half = a.xor(b);
    let sum = half.xor(*carry);
    *carry = a.and(b).or(carry.and(half));
    sum
}

/// The bits of the rows from `first` on, each in all pixels of its row.
#[inline(always)]
fn rows_of<V: Vector>(rows: &Leaves, first: usize) -> V {
    V::rows(rows[first / 64 % 2] >> (first % 64))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::isa::{LINEAR_BITS, QUADRATIC_BITS};
    use crate::simd::Eight;

    fn value<E: Evaluator>(coefficients: &E::Coefficients, bits: u32, x: usize, y: usize) -> i64 {
        let evaluator = E::run_trees::<Eight>(coefficients, bits as usize);
        let mut carries = E::start();
        // Eight 32-bit lanes are two rows.
        let value = (0..bits as usize).fold(0, |value, t| {
            let mut words = [0; 4];
            evaluator.bit::<Eight>(t, y / 2 * 2, &mut carries).store_words(&mut words);
            value | ((words[2 * (y % 2) + x / 64] >> (x % 64) & 1) as i64) << t
        });
        value << (64 - bits) >> (64 - bits)
    }

    #[test]
    fn the_trees_deliver_a_linear_expression_bit_by_bit() {
        let e = Linear { a: -123_456, b: 987_654, c: i32::MAX };
        for (x, y) in [(0, 0), (127, 0), (0, 127), (127, 127), (64, 63), (93, 42)] {
            let expected = i64::from(e.at(x, y));
            let found = value::<LinearTrees>(&e, LINEAR_BITS, x as usize, y as usize);
            assert_eq!(found, expected, "({x}, {y})");
        }
    }

    #[test]
    fn the_trees_deliver_a_quadratic_expression_bit_by_bit() {
        let q =
            Quadratic { xx: -70_001, xy: 1 << 33, yy: -65_537, x: 123_456_789, y: -987_654_321, one: -(1 << 40) + 17 };
        for (x, y) in [(0, 0), (127, 0), (0, 127), (127, 127), (64, 63), (93, 42)] {
            let unused = 64 - QUADRATIC_BITS;
            let expected = q.at(x, y) << unused >> unused;
            let found = value::<QuadraticTrees>(&q, QUADRATIC_BITS, x as usize, y as usize);
            assert_eq!(found, expected, "({x}, {y})");
        }
    }
}
