//! Instructions with an expression: the evaluator's bits go to Enable or to pixel memory as they come.

use super::evaluator::{Evaluator, Next};
use super::{BitSerial, planes};
use crate::array::{EMPTY_PLANE, FaultKind, Plane};
use crate::controller::{Bits, Local};
use crate::isa::{Expression, ExpressionUse, LINEAR_BITS, Operand};
use crate::simd::{Kernel, Present, Vector};

/// The bits of an expression on their way to a field.
struct Delivery {
    local: Local,
    shift: usize,
    width: usize,
    vectors: Present,
}

impl Delivery {
    /// Hands the bits that reach the field to `f`, bit 0 first; returns the clocks.
    fn each(&self, mut f: impl FnMut(usize, &mut Plane)) -> u64 {
        let mut evaluator = Evaluator::new(&self.local);
        let mut plane = EMPTY_PLANE;
        let top = self.shift + self.width;
        let clocks = if self.local.bits() == LINEAR_BITS { top } else { self.local.bits() as usize };
        for t in 0..clocks {
            let taken = (self.shift..top).contains(&t);
            self.vectors.run(Next { evaluator: &mut evaluator, t, taken, out: &mut plane });
            if taken {
                f(t - self.shift, &mut plane);
            }
        }
        clocks as u64
    }
}

impl BitSerial {
    pub(super) fn evaluate(&mut self, expression: &Expression, usage: &ExpressionUse) -> Result<(), FaultKind> {
        let local = self.controller.latch(expression);
        match *usage {
            ExpressionUse::DisableNegative => self.disable_negative(local),
            ExpressionUse::Load { field, shift } => self.load(&self.delivery(local, shift, field), field)?,
            ExpressionUse::Add { field, shift } => self.add_expression(&self.delivery(local, shift, field), field)?,
            ExpressionUse::DisableNotLess { field, shift } => {
                self.disable_not_less(&self.delivery(local, shift, field), field)?;
            }
            ExpressionUse::LoadMinus { field, shift, subtrahend, left_shift } => {
                let subtrahend = self.controller.bits(subtrahend)?;
                self.load_minus(&self.delivery(local, shift, field), field, subtrahend, left_shift.into())?;
            }
        }
        Ok(())
    }

    fn delivery(&self, local: Local, shift: u8, field: Operand) -> Delivery {
        Delivery { local, shift: shift.into(), width: field.width.into(), vectors: self.vectors }
    }

    fn disable_negative(&mut self, local: Local) {
        let sign = local.bits() as usize - 1;
        let delivery = Delivery { local, shift: sign, width: 1, vectors: self.vectors };
        let enable = &mut self.enable;
        self.clock += delivery.each(|_, sign| planes::and_not(enable, sign));
    }

    fn load(&mut self, delivery: &Delivery, field: Operand) -> Result<(), FaultKind> {
        let first = self.controller.bits(field)?.first;
        let (memory, enable) = (&mut self.memory[first..], &self.enable);
        self.clock += delivery.each(|i, new| delivery.vectors.run(Store { old: &mut memory[i], new, enable }));
        Ok(())
    }

    fn add_expression(&mut self, delivery: &Delivery, field: Operand) -> Result<(), FaultKind> {
        let first = self.controller.bits(field)?.first;
        let (memory, enable) = (&mut self.memory[first..], &self.enable);
        let mut carry = EMPTY_PLANE;
        self.clock += delivery.each(|i, bit| {
            planes::add(bit, &memory[i], &mut carry);
            planes::store(&mut memory[i], bit, enable);
        });
        Ok(())
    }

    fn disable_not_less(&mut self, delivery: &Delivery, field: Operand) -> Result<(), FaultKind> {
        let first = self.controller.bits(field)?.first;
        let memory = &self.memory[first..];
        let mut less = EMPTY_PLANE;
        self.clock += delivery.each(|i, a| delivery.vectors.run(Borrow { a, b: &memory[i], borrow: &mut less }));
        planes::and(&mut self.enable, &less);
        Ok(())
    }

    fn load_minus(
        &mut self,
        delivery: &Delivery,
        field: Operand,
        subtrahend: Bits,
        left_shift: usize,
    ) -> Result<(), FaultKind> {
        let first = self.controller.bits(field)?.first;
        let source = self.source(subtrahend);
        let (memory, enable) = (&mut self.memory, &self.enable);
        let mut borrow = EMPTY_PLANE;
        let whole = Delivery { shift: 0, width: delivery.shift + delivery.width, ..*delivery };
        self.clock += whole.each(|t, bit| {
            let bits = t.checked_sub(left_shift).map(|i| source.bit(memory, i));
            planes::subtract(bit, &bits.unwrap_or(EMPTY_PLANE), &mut borrow);
            if let Some(i) = t.checked_sub(delivery.shift) {
                planes::store(&mut memory[first + i], bit, enable);
            }
        });
        Ok(())
    }
}

/// One bit into pixel memory.
struct Store<'a> {
    old: &'a mut Plane,
    new: &'a Plane,
    enable: &'a Plane,
}

impl Kernel for Store<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        planes::store(self.old, self.new, self.enable);
    }
}

/// One bit of a comparison.
struct Borrow<'a> {
    a: &'a Plane,
    b: &'a Plane,
    borrow: &'a mut Plane,
}

impl Kernel for Borrow<'_> {
    type Output = ();

    #[inline(always)]
    fn run<V: Vector>(self) {
        planes::borrow(self.a, self.b, self.borrow);
    }
}
