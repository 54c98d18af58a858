//! Use of the bits of an expression by the pixels of a tile (32 x 16 pixels). One bit arrives in each clock and takes
//! effect immediately.

use super::arithmetic::SerialOperand;
use super::evaluator::{Evaluator, VectorPlace, full_add};
use super::tile::{Tile, TilePlane};
use crate::controller::FieldBits;
use crate::simd::SimdVector;
use std::ops::Range;

trait BitSink {
    /// Uses bit `t` of an expression in one vector of pixels. In a bit plane of the tile, word `at` is the first word
    /// of the vector.
    ///
    /// `carry` holds the carry of each pixel, which bit `t + 1` uses. It must be zero for bit 0.
    fn take<V: SimdVector>(&self, tile: &mut Tile, at: usize, t: usize, bit: V, carry: &mut V);

    /// Uses the carry of the last bit of the expression.
    fn end<V: SimdVector>(&self, _: &mut Tile, _at: usize, _carry: V) {}
}

#[derive(Clone, Debug)]
pub(super) struct Delivery {
    /// Range of the expression's bits that the pixels use. Bit `t` arrives in clock `t`.
    pub(super) taken: Range<usize>,
    pub(super) effect: ExpressionEffect,
}

/// An operation that each pixel performs with every arriving bit of an expression. `first` is the address of a bit
/// field's first bit in pixel memory.
#[derive(Clone, Copy, Debug)]
pub(super) enum ExpressionEffect {
    DisableNegative,
    Load { first: usize },
    Add { first: usize },
    DisableNotLess { first: usize },
    LoadMinus { first: usize, shift: usize, subtrahend: FieldBits, left_shift: usize },
}

impl Delivery {
    /// Evaluates an expression bit by bit in one vector of pixels, and uses each bit as the field `effect` states.
    #[inline(always)]
    pub(super) fn run_pixels<V: SimdVector, E: Evaluator>(&self, evaluator: &E, tile: &mut Tile, place: VectorPlace) {
        let shift = self.taken.start;
        match self.effect {
            ExpressionEffect::DisableNegative => self.run::<V, E, _>(evaluator, &ClearEnable, tile, place),
            ExpressionEffect::Load { first } => {
                self.run::<V, E, _>(evaluator, &StoreBits { first, shift }, tile, place)
            }
            ExpressionEffect::Add { first } => self.run::<V, E, _>(evaluator, &AddBits { first, shift }, tile, place),
            ExpressionEffect::DisableNotLess { first } => {
                self.run::<V, E, _>(evaluator, &CompareBits { first, shift }, tile, place);
            }
            ExpressionEffect::LoadMinus { first, shift, subtrahend, left_shift } => {
                let source = tile.source(subtrahend);
                self.run::<V, E, _>(evaluator, &StoreDifference { first, shift, source, left_shift }, tile, place);
            }
        }
    }

    #[inline(always)]
    fn run<V: SimdVector, E: Evaluator, S: BitSink>(
        &self,
        evaluator: &E,
        sink: &S,
        tile: &mut Tile,
        place: VectorPlace,
    ) {
        let at = place.at;
        let mut carries = E::start::<V>();
        let mut carry = V::splat(0);
        // The pixels do not use the first bits, but the carries of these bits influence the later bits.
        for t in 0..self.taken.start {
            evaluator.bit(t, place, &mut carries);
        }
        for t in self.taken.clone() {
            let bit = evaluator.bit(t, place, &mut carries);
            sink.take(tile, at, t, bit, &mut carry);
        }
        sink.end(tile, at, carry);
    }
}

#[inline(always)]
fn store<V: SimdVector>(plane: &mut TilePlane, at: usize, new: V, enable: &TilePlane) {
    let old = V::load_words(&plane[at..]);
    let changed = old.xor(new).and(V::load_words(&enable[at..]));
    old.xor(changed).store_words(&mut plane[at..]);
}

struct ClearEnable;

impl BitSink for ClearEnable {
    #[inline(always)]
    fn take<V: SimdVector>(&self, tile: &mut Tile, at: usize, _: usize, bit: V, _: &mut V) {
        let enable = V::load_words(&tile.enable[at..]);
        enable.and(bit).xor(enable).store_words(&mut tile.enable[at..]);
    }
}

/// Stores an expression, without its lowest `shift` bits, in a bit field of pixel memory.
struct StoreBits {
    first: usize,
    shift: usize,
}

impl BitSink for StoreBits {
    #[inline(always)]
    fn take<V: SimdVector>(&self, tile: &mut Tile, at: usize, t: usize, bit: V, _: &mut V) {
        store(&mut tile.memory[self.first + t - self.shift], at, bit, &tile.enable);
    }
}

/// Adds an expression, without its lowest `shift` bits, to a bit field of pixel memory.
struct AddBits {
    first: usize,
    shift: usize,
}

impl BitSink for AddBits {
    #[inline(always)]
    fn take<V: SimdVector>(&self, tile: &mut Tile, at: usize, t: usize, bit: V, carry: &mut V) {
        let plane = &mut tile.memory[self.first + t - self.shift];
        let sum = full_add(bit, V::load_words(&plane[at..]), carry);
        store(plane, at, sum, &tile.enable);
    }
}

/// Compares an expression, without its lowest `shift` bits, with a bit field. Pixels in which the expression is not
/// less than the bit field become disabled.
struct CompareBits {
    first: usize,
    shift: usize,
}

impl BitSink for CompareBits {
    #[inline(always)]
    fn take<V: SimdVector>(&self, tile: &mut Tile, at: usize, t: usize, bit: V, borrow: &mut V) {
        let field = &tile.memory[self.first + t - self.shift];
        subtract(bit, V::load_words(&field[at..]), borrow);
    }

    #[inline(always)]
    fn end<V: SimdVector>(&self, tile: &mut Tile, at: usize, less: V) {
        V::load_words(&tile.enable[at..]).and(less).store_words(&mut tile.enable[at..]);
    }
}

/// Subtracts the bit field `source`, shifted left, from an expression. The lowest `shift` bits of the difference are
/// not stored.
struct StoreDifference {
    first: usize,
    shift: usize,
    source: SerialOperand,
    left_shift: usize,
}

impl BitSink for StoreDifference {
    #[inline(always)]
    fn take<V: SimdVector>(&self, tile: &mut Tile, at: usize, t: usize, bit: V, borrow: &mut V) {
        let subtrahend = match t.checked_sub(self.left_shift) {
            Some(i) => V::load_words(&self.source.plane(&tile.memory, i)[at..]),
            None => V::splat(0),
        };
        let difference = subtract(bit, subtrahend, borrow);
        if let Some(i) = t.checked_sub(self.shift) {
            store(&mut tile.memory[self.first + i], at, difference, &tile.enable);
        }
    }
}

/// Simulates one clock of a serial subtracter in each pixel of a vector, by the equation a - b = not (not a + b).
#[inline(always)]
fn subtract<V: SimdVector>(a: V, b: V, borrow: &mut V) -> V {
    let ones = V::splat(-1);
    full_add(a.xor(ones), b, borrow).xor(ones)
}
