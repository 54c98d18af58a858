//! The expression evaluator: trees of serial adders that deliver one bit of the expression a clock to every pixel.
//!
//! A tree multiplies a coefficient by the number of each column (or row): level `l` adds the coefficient, `l` clocks
//! late, to the leaves whose number has bit `l`. Coefficients enter least significant bit first. For a linear
//! expression every pixel adds its column's stream to its row's. For a quadratic one, wider trees multiply by the
//! squares of the numbers, each row gets its own coefficient of x, and each pixel multiplies that by its column
//! (assumed; F89 publishes the expression, not the circuit).

use crate::array::{EMPTY_PLANE, Plane};
use crate::controller::Local;
use crate::simd::{Kernel, Vector};
use pxpl5_wire::{Linear, Quadratic};

/// One bit for each of 128 columns or rows.
type Leaves = u128;

/// Bits of a column's number.
const NUMBER_BITS: usize = 7;
/// Bits of the square of a column's number.
const SQUARE_BITS: usize = 14;

/// Leaves whose number has bit `l`.
const NUMBERS: [Leaves; NUMBER_BITS] = leaves(1);
/// Leaves the square of whose number has bit `l`.
const SQUARES: [Leaves; SQUARE_BITS] = leaves(2);

const fn leaves<const N: usize>(power: u32) -> [Leaves; N] {
    let mut out = [0; N];
    let mut number = 0_u32;
    while number < 128 {
        let mut l = 0;
        while l < N {
            if number.pow(power) >> l & 1 == 1 {
                out[l] |= 1 << number;
            }
            l += 1;
        }
        number += 1;
    }
    out
}

/// Serial adders that add a coefficient times a number to the stream of each leaf.
#[derive(Clone, Copy, Debug)]
struct Tree<const N: usize> {
    coefficient: i64,
    leaves: &'static [Leaves; N],
    carries: [Leaves; N],
}

impl<const N: usize> Tree<N> {
    const fn new(coefficient: i64, leaves: &'static [Leaves; N]) -> Self {
        Self { coefficient, leaves, carries: [0; N] }
    }

    /// Bit `t` of the sum.
    fn add(&mut self, mut stream: Leaves, t: usize) -> Leaves {
        for l in 0..N.min(t + 1) {
            let addend = bit(self.coefficient, t - l) & self.leaves[l];
            (stream, self.carries[l]) = full_add(stream, addend, self.carries[l]);
        }
        stream
    }
}

/// Bit `t` of a coefficient, for all leaves.
const fn bit(coefficient: i64, t: usize) -> Leaves {
    if coefficient >> t & 1 == 1 { Leaves::MAX } else { 0 }
}

const fn full_add(a: Leaves, b: Leaves, carry: Leaves) -> (Leaves, Leaves) {
    (a ^ b ^ carry, a & b | carry & (a ^ b))
}

/// An evaluator at work on one expression.
#[derive(Debug)]
pub(super) enum Evaluator {
    Linear(Box<LinearTrees>),
    Quadratic(Box<QuadraticTrees>),
}

#[derive(Debug)]
pub(super) struct LinearTrees {
    constant: i64,
    columns: Tree<NUMBER_BITS>,
    rows: Tree<NUMBER_BITS>,
    carry: Plane,
}

#[derive(Debug)]
pub(super) struct QuadraticTrees {
    constants: [i64; 2],
    /// xx x^2.
    columns: Tree<SQUARE_BITS>,
    /// one + y y + yy y^2.
    rows: Tree<NUMBER_BITS>,
    row_squares: Tree<SQUARE_BITS>,
    /// x + xy y: each row's coefficient of x.
    row_coefficients: Tree<NUMBER_BITS>,
    /// The last bits of the row coefficients, for the late levels.
    late: [Leaves; NUMBER_BITS],
    /// Carries of each pixel's product and of its two sums.
    product: [Plane; NUMBER_BITS],
    carry: Plane,
    sum: Plane,
}

impl Evaluator {
    pub(super) fn new(expression: &Local) -> Self {
        match expression {
            Local::Linear(e) => Self::Linear(Box::new(LinearTrees::new(e))),
            Local::Quadratic(q) => Self::Quadratic(Box::new(QuadraticTrees::new(q))),
        }
    }

    /// Bit `t` of the expression in every pixel; call it with t = 0, 1, 2, ... A bit that nobody takes may be missing.
    #[inline(always)]
    pub(super) fn next(&mut self, t: usize, taken: bool, out: &mut Plane) {
        match self {
            Self::Linear(trees) if !taken => trees.skip(t),
            Self::Linear(trees) => trees.next(t, out),
            Self::Quadratic(trees) => trees.next(t, out),
        }
    }
}

impl LinearTrees {
    fn new(e: &Linear) -> Self {
        Self {
            constant: e.c.into(),
            columns: Tree::new(e.a.into(), &NUMBERS),
            rows: Tree::new(e.b.into(), &NUMBERS),
            carry: EMPTY_PLANE,
        }
    }

    #[inline(always)]
    fn next(&mut self, t: usize, out: &mut Plane) {
        let (columns, row) = self.streams(t);
        for_each_pair(row, out, &mut self.carry, |row, out, carry| {
            for k in 0..4 {
                let half = columns[k] ^ row[k];
                out[k] = half ^ carry[k];
                carry[k] = columns[k] & row[k] | carry[k] & half;
            }
        });
    }

    /// The same where nobody takes the bit.
    #[inline(always)]
    fn skip(&mut self, t: usize) {
        let (columns, row) = self.streams(t);
        let carries = self.carry.chunks_exact_mut(4).enumerate();
        for (pair, carry) in carries {
            let row = pair_of(row, pair);
            for k in 0..4 {
                carry[k] = columns[k] & row[k] | carry[k] & (columns[k] ^ row[k]);
            }
        }
    }

    #[inline(always)]
    fn streams(&mut self, t: usize) -> ([u64; 4], [u64; 2]) {
        let row = self.rows.add(bit(self.constant, t), t);
        (columns_of(self.columns.add(0, t)), [row as u64, (row >> 64) as u64])
    }
}

/// Runs `f` on the words of two rows at a time, with the rows' bits.
#[inline(always)]
fn for_each_pair(
    row: [u64; 2],
    out: &mut Plane,
    carry: &mut Plane,
    f: impl Fn([u64; 4], &mut [u64; 4], &mut [u64; 4]),
) {
    let words = out.as_chunks_mut::<4>().0.iter_mut().zip(carry.as_chunks_mut::<4>().0);
    for (pair, (out, carry)) in words.enumerate() {
        f(pair_of(row, pair), out, carry);
    }
}

/// The bits of rows 2 i and 2 i + 1, each in all pixels of its row.
#[inline(always)]
fn pair_of(row: [u64; 2], pair: usize) -> [u64; 4] {
    let half = row[pair / 32];
    let last = 63 - 2 * (pair as u32 % 32);
    let spread = |at: u32| (half << at) as i64 >> 63;
    [spread(last) as u64, spread(last) as u64, spread(last - 1) as u64, spread(last - 1) as u64]
}

impl QuadraticTrees {
    fn new(q: &Quadratic) -> Self {
        Self {
            constants: [q.one, q.x],
            columns: Tree::new(q.xx, &SQUARES),
            rows: Tree::new(q.y, &NUMBERS),
            row_squares: Tree::new(q.yy, &SQUARES),
            row_coefficients: Tree::new(q.xy, &NUMBERS),
            late: [0; NUMBER_BITS],
            product: [EMPTY_PLANE; NUMBER_BITS],
            carry: EMPTY_PLANE,
            sum: EMPTY_PLANE,
        }
    }

    #[inline(always)]
    fn next(&mut self, t: usize, out: &mut Plane) {
        let column = self.columns.add(0, t);
        let row = self.rows.add(bit(self.constants[0], t), t);
        let row = self.row_squares.add(row, t);
        self.late.rotate_right(1);
        self.late[0] = self.row_coefficients.add(bit(self.constants[1], t), t);
        *out = rows_of(row);
        add_to(out, &columns_of(column), &mut self.sum);
        let mut product = EMPTY_PLANE;
        let levels = self.late.iter().zip(&NUMBERS).zip(&mut self.product);
        for ((late, columns), carry) in levels {
            let mut addend = rows_of(*late);
            and_with(&mut addend, &columns_of(*columns));
            add_to(&mut product, &addend, carry);
        }
        add_to(out, &product, &mut self.carry);
    }
}

/// Each row's bit in all of its pixels.
#[inline(always)]
fn rows_of(row: Leaves) -> Plane {
    let mut out = EMPTY_PLANE;
    let row = [row as u64, (row >> 64) as u64];
    for (pair, words) in out.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        *words = pair_of(row, pair);
    }
    out
}

/// Each column's bit in all of its pixels.
#[inline(always)]
fn columns_of(column: Leaves) -> [u64; 4] {
    let (low, high) = (column as u64, (column >> 64) as u64);
    [low, high, low, high]
}

/// Something that has a word for each of a plane's words.
trait Words {
    fn quad(&self, i: usize) -> [u64; 4];
}

impl Words for Plane {
    #[inline(always)]
    fn quad(&self, i: usize) -> [u64; 4] {
        let at = 4 * i;
        [self[at], self[at + 1], self[at + 2], self[at + 3]]
    }
}

impl Words for [u64; 4] {
    #[inline(always)]
    fn quad(&self, _: usize) -> [u64; 4] {
        *self
    }
}

#[inline(always)]
fn and_with(sum: &mut Plane, other: &impl Words) {
    for (i, s) in sum.chunks_exact_mut(4).enumerate() {
        let b = other.quad(i);
        (0..4).for_each(|k| s[k] &= b[k]);
    }
}

/// One clock of a serial adder in every pixel.
#[inline(always)]
fn add_to(sum: &mut Plane, addend: &impl Words, carry: &mut Plane) {
    let words = sum.chunks_exact_mut(4).zip(carry.chunks_exact_mut(4)).enumerate();
    for (i, (s, c)) in words {
        let b = addend.quad(i);
        for k in 0..4 {
            let half = s[k] ^ b[k];
            let next = s[k] & b[k] | c[k] & half;
            s[k] = half ^ c[k];
            c[k] = next;
        }
    }
}

/// Bit `t` of an expression as a vectorised kernel.
pub(super) struct Next<'a> {
    pub(super) evaluator: &'a mut Evaluator,
    pub(super) t: usize,
    pub(super) taken: bool,
    pub(super) out: &'a mut Plane,
}

impl Kernel for Next<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        self.evaluator.next(self.t, self.taken, self.out);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::isa::{LINEAR_BITS, QUADRATIC_BITS};

    fn value(local: &Local, bits: u32, x: usize, y: usize) -> i64 {
        let mut evaluator = Evaluator::new(local);
        let mut plane = EMPTY_PLANE;
        let mut value = 0;
        for t in 0..bits as usize {
            evaluator.next(t, true, &mut plane);
            value |= ((plane[2 * y + x / 64] >> (x % 64) & 1) as i64) << t;
        }
        value << (64 - bits) >> (64 - bits)
    }

    #[test]
    fn the_trees_deliver_a_linear_expression_bit_by_bit() {
        let e = Linear { a: -123_456, b: 987_654, c: i32::MAX };
        for (x, y) in [(0, 0), (127, 0), (0, 127), (127, 127), (64, 63), (93, 42)] {
            let expected = i64::from(e.at(x, y));
            let found = value(&Local::Linear(e), LINEAR_BITS, x as usize, y as usize);
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
            let found = value(&Local::Quadratic(q), QUADRATIC_BITS, x as usize, y as usize);
            assert_eq!(found, expected, "({x}, {y})");
        }
    }
}
