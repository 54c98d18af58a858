//! Instructions with an expression: the evaluator's bits go to Enable or to pixel memory as they come.

use super::BitSerial;
use super::arithmetic::Source;
use super::evaluator::{Evaluator, LinearTrees, QuadraticTrees, full_add};
use crate::array::{FaultKind, Plane};
use crate::controller::Local;
use crate::isa::{Expression, ExpressionUse, Operand};
use crate::simd::{Kernel, Vector};
use std::ops::Range;

/// Where the bits of an expression go.
trait Sink {
    /// Takes bit `t` of the expression in the pixels from word `at` of a plane on; `carry` begins with zeros.
    fn take<V: Vector>(&mut self, at: usize, t: usize, bit: V, carry: &mut V);

    /// Takes the carry behind the last bit.
    fn end<V: Vector>(&mut self, _at: usize, _carry: V) {}
}

/// The bits of an expression on their way to all pixels.
struct Deliver<'a, E: Evaluator, S> {
    coefficients: &'a E::Coefficients,
    /// Clocks whose bits the sink takes.
    taken: Range<usize>,
    sink: S,
}

impl<E: Evaluator, S: Sink> Kernel for Deliver<'_, E, S> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(mut self) {
        let evaluator = E::run_trees::<V>(self.coefficients, self.taken.end);
        // A word is two lanes, a row two words.
        for at in (0..size_of::<Plane>() / 8).step_by(V::LANES / 2) {
            let (mut carries, mut carry) = (E::start::<V>(), V::splat(0));
            for t in 0..self.taken.start {
                evaluator.bit(t, at / 2, &mut carries);
            }
            for t in self.taken.clone() {
                let bit = evaluator.bit(t, at / 2, &mut carries);
                self.sink.take(at, t, bit, &mut carry);
            }
            self.sink.end(at, carry);
        }
    }
}

impl BitSerial {
    pub(super) fn evaluate(&mut self, expression: &Expression, usage: &ExpressionUse) -> Result<(), FaultKind> {
        let local = self.controller.latch(expression);
        match *usage {
            ExpressionUse::DisableNegative => {
                let sign = local.bits() as usize - 1;
                self.deliver(&local, sign..sign + 1, |array| Disable { enable: &mut array.enable });
            }
            ExpressionUse::Load { field, shift } => {
                let (taken, first) = self.taken(field, shift)?;
                self.deliver(&local, taken.clone(), |array| Load {
                    field: &mut array.memory[first..first + taken.len()],
                    shift: taken.start,
                    enable: &array.enable,
                });
            }
            ExpressionUse::Add { field, shift } => {
                let (taken, first) = self.taken(field, shift)?;
                self.deliver(&local, taken.clone(), |array| Add {
                    field: &mut array.memory[first..first + taken.len()],
                    shift: taken.start,
                    enable: &array.enable,
                });
            }
            ExpressionUse::DisableNotLess { field, shift } => {
                let (taken, first) = self.taken(field, shift)?;
                self.deliver(&local, taken.clone(), |array| DisableNotLess {
                    field: &array.memory[first..first + taken.len()],
                    shift: taken.start,
                    enable: &mut array.enable,
                });
            }
            ExpressionUse::LoadMinus { field, shift, subtrahend, left_shift } => {
                let (taken, first) = self.taken(field, shift)?;
                let source = self.source(self.controller.bits(subtrahend)?);
                self.deliver(&local, 0..taken.end, |array| LoadMinus {
                    memory: &mut array.memory,
                    first,
                    shift: taken.start,
                    source: &source,
                    left_shift: left_shift.into(),
                    enable: &array.enable,
                });
            }
        }
        Ok(())
    }

    /// Clocks whose bits reach a field, and the field's first bit.
    fn taken(&self, field: Operand, shift: u8) -> Result<(Range<usize>, usize), FaultKind> {
        let bits = self.controller.bits(field)?;
        let shift = usize::from(shift);
        Ok((shift..shift + bits.width, bits.first))
    }

    /// Runs the evaluator: a linear expression until the last bit is taken, a quadratic one always to its end.
    fn deliver<'a, S: Sink>(&'a mut self, local: &Local, taken: Range<usize>, sink: impl FnOnce(&'a mut Self) -> S) {
        let vectors = self.vectors;
        match local {
            Local::Linear(e) => {
                self.clock += taken.end as u64;
                vectors.run(Deliver::<LinearTrees, _> { coefficients: e, taken, sink: sink(self) });
            }
            Local::Quadratic(q) => {
                self.clock += u64::from(local.bits());
                vectors.run(Deliver::<QuadraticTrees, _> { coefficients: q, taken, sink: sink(self) });
            }
        }
    }
}

/// Overwrites one bit where enabled.
#[inline(always)]
fn store<V: Vector>(plane: &mut Plane, at: usize, new: V, enable: &Plane) {
    let old = V::load_words(&plane[at..]);
    let changed = old.xor(new).and(V::load_words(&enable[at..]));
    old.xor(changed).store_words(&mut plane[at..]);
}

/// E := 0 where the bit is set.
struct Disable<'a> {
    enable: &'a mut Plane,
}

impl Sink for Disable<'_> {
    #[inline(always)]
    fn take<V: Vector>(&mut self, at: usize, _: usize, bit: V, _: &mut V) {
        let enable = V::load_words(&self.enable[at..]);
        enable.and(bit).xor(enable).store_words(&mut self.enable[at..]);
    }
}

/// field := bits from `shift` on.
struct Load<'a> {
    field: &'a mut [Plane],
    shift: usize,
    enable: &'a Plane,
}

impl Sink for Load<'_> {
    #[inline(always)]
    fn take<V: Vector>(&mut self, at: usize, t: usize, bit: V, _: &mut V) {
        store(&mut self.field[t - self.shift], at, bit, self.enable);
    }
}

/// field := field + bits from `shift` on.
struct Add<'a> {
    field: &'a mut [Plane],
    shift: usize,
    enable: &'a Plane,
}

impl Sink for Add<'_> {
    #[inline(always)]
    fn take<V: Vector>(&mut self, at: usize, t: usize, bit: V, carry: &mut V) {
        let plane = &mut self.field[t - self.shift];
        let sum = full_add(bit, V::load_words(&plane[at..]), carry);
        store(plane, at, sum, self.enable);
    }
}

/// E := 0 unless bits from `shift` on are less than the field.
struct DisableNotLess<'a> {
    field: &'a [Plane],
    shift: usize,
    enable: &'a mut Plane,
}

impl Sink for DisableNotLess<'_> {
    #[inline(always)]
    fn take<V: Vector>(&mut self, at: usize, t: usize, bit: V, borrow: &mut V) {
        subtract(bit, V::load_words(&self.field[t - self.shift][at..]), borrow);
    }

    #[inline(always)]
    fn end<V: Vector>(&mut self, at: usize, less: V) {
        V::load_words(&self.enable[at..]).and(less).store_words(&mut self.enable[at..]);
    }
}

/// field := bits from `shift` on of the difference from a source.
struct LoadMinus<'a> {
    memory: &'a mut [Plane],
    first: usize,
    shift: usize,
    source: &'a Source,
    left_shift: usize,
    enable: &'a Plane,
}

impl Sink for LoadMinus<'_> {
    #[inline(always)]
    fn take<V: Vector>(&mut self, at: usize, t: usize, bit: V, borrow: &mut V) {
        let subtrahend = match t.checked_sub(self.left_shift) {
            Some(i) => V::load_words(&self.source.plane(self.memory, i)[at..]),
            None => V::splat(0),
        };
        let difference = subtract(bit, subtrahend, borrow);
        if let Some(i) = t.checked_sub(self.shift) {
            store(&mut self.memory[self.first + i], at, difference, self.enable);
        }
    }
}

/// One clock of a serial subtracter in each pixel of a vector: a - b = not (not a + b).
#[inline(always)]
fn subtract<V: Vector>(a: V, b: V, borrow: &mut V) -> V {
    let ones = V::splat(-1);
    full_add(a.xor(ones), b, borrow).xor(ones)
}
