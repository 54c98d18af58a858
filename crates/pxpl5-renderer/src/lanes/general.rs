//! General path of the fast array: it executes any instruction on all pixels, one bit field after the other.

use super::{Lanes, values};
use crate::array::{Executed, FaultKind, OutputRegion, PIXELS};
use crate::controller::LocalExpression;
use crate::isa::{ArithmeticOp, ArrayInstruction, ExpressionUse, Operand, Test};
use pxpl5_wire::REGION_SIZE;

impl Lanes {
    /// Executes an instruction whose operands were already checked.
    pub(super) fn instruction(
        &mut self,
        instruction: &ArrayInstruction,
        executed: &mut Executed,
    ) -> Result<(), FaultKind> {
        // Execute the instructions that change no bit field here. The functions for Enable and for bit fields execute
        // the others.
        match *instruction {
            ArrayInstruction::Select { context_base, left, top } => {
                self.controller.select(context_base, left, top);
            }
            ArrayInstruction::Evaluate { expression, usage } => {
                let local = self.controller.latch(&expression);
                return self.evaluate(&local, &usage);
            }
            ArrayInstruction::StoreBlock { field, block } => return self.store_block(field, block),
            ArrayInstruction::LoadBlock { field, block } => return self.load_block(field, block),
            ArrayInstruction::Wait => {}
            ArrayInstruction::Output { field, target } => {
                let [_, _, width, height] = target.grid.rectangle(target.region);
                let pixels = self.colour(self.controller.bits(field)?, width, height);
                executed.outputs.push(OutputRegion { target, pixels });
            }
            _ => return self.enable_instruction(instruction),
        }
        Ok(())
    }

    fn enable_instruction(&mut self, instruction: &ArrayInstruction) -> Result<(), FaultKind> {
        match *instruction {
            ArrayInstruction::EnableAll { .. } => self.enable.fill(true),
            ArrayInstruction::EnableNone => self.enable.fill(false),
            ArrayInstruction::EnableInvert => self.enable.pixels_mut().iter_mut().for_each(|e| *e = !*e),
            ArrayInstruction::EnableLoad(bit) => {
                // Enable all pixels, then disable the pixels whose bit is not set.
                self.enable.fill(true);
                self.disable_unless(bit, |v| v & 1 == 1)?;
            }
            ArrayInstruction::EnableAnd(bit) => self.disable_unless(bit, |v| v & 1 == 1)?,
            ArrayInstruction::EnableStore(bit) => {
                let values: Vec<_> = self.enable.pixels().iter().map(|e| u64::from(*e)).collect();
                self.columns.scatter(self.controller.bits(bit)?, &values, &[255; PIXELS]);
            }
            ArrayInstruction::Compare { test, a, b } => self.compare(test, a, b)?,
            ArrayInstruction::CompareConstant { test, a, value } => {
                let constant = values::extend(value.into(), u32::from(a.width).min(32), a.signed);
                self.disable_unless(a, |v| values::holds(test, v, constant, a.signed))?;
            }
            _ => return self.field_instruction(instruction),
        }
        Ok(())
    }

    fn field_instruction(&mut self, instruction: &ArrayInstruction) -> Result<(), FaultKind> {
        // Every operation reads its operands into buffers, computes 64-bit values, and stores the low bits of these
        // values.
        match *instruction {
            ArrayInstruction::ShiftRight { destination, source, by } => {
                self.map(destination, source, |v| values::shift_right(v, by, source.signed))
            }
            ArrayInstruction::ShiftLeft { destination, source, by } => self.map(destination, source, |v| v << by),
            ArrayInstruction::Saturate { destination, source } => {
                let width = usize::from(destination.width);
                self.map(destination, source, |v| values::saturate(v, source.signed, width))
            }
            ArrayInstruction::SquareRoot { destination, radicand } => {
                self.two_results(destination, radicand, |v, _| (v.isqrt(), v - v.isqrt().pow(2)))
            }
            ArrayInstruction::Arithmetic { op: ArithmeticOp::Divide, destination, a, b } => {
                let width = usize::from(destination.width);
                self.gather(1, b)?;
                self.two_results(destination, a, |a, b| values::divide(a, b, width))
            }
            ArrayInstruction::Arithmetic { op, destination, a, b } => self.arithmetic(op, destination, a, b),
            ArrayInstruction::LoadConstant { destination, value } => {
                let constant = values::extend(value.into(), 32, destination.signed);
                self.map(destination, destination, |_| constant)
            }
            ArrayInstruction::MultiplyConstant { destination, source, factor, factor_bits } => {
                let factor = values::extend(factor as u64, factor_bits.into(), true);
                self.map(destination, source, |v| v.wrapping_mul(factor))
            }
            _ => Ok(()),
        }
    }

    fn gather(&mut self, which: usize, operand: Operand) -> Result<(), FaultKind> {
        self.columns.gather(self.controller.bits(operand)?, &mut self.operands[which]);
        Ok(())
    }

    /// Stores the numbers of the first buffer in the bit field `destination` of all enabled pixels. The two buffers of
    /// the array hold one 64-bit number for each pixel.
    fn store(&mut self, destination: Operand) -> Result<(), FaultKind> {
        let field = self.controller.bits(destination)?;
        self.columns.scatter(field, &self.operands[0], self.enable.pixels());
        Ok(())
    }

    fn map(&mut self, destination: Operand, source: Operand, f: impl Fn(u64) -> u64) -> Result<(), FaultKind> {
        self.gather(0, source)?;
        self.operands[0].iter_mut().for_each(|v| *v = f(*v));
        self.store(destination)
    }

    fn arithmetic(&mut self, op: ArithmeticOp, destination: Operand, a: Operand, b: Operand) -> Result<(), FaultKind> {
        self.gather(0, a)?;
        self.gather(1, b)?;
        let [first, second] = &mut self.operands;
        for (v, w) in first.iter_mut().zip(second.iter()) {
            *v = values::arithmetic(op, *v, *w, a.signed);
        }
        self.store(destination)
    }

    /// Computes two results of `f` in each pixel, such as a quotient and a remainder, from the bit field `source` and
    /// the numbers in the second buffer. The first goes to `destination`, and the second to `source`.
    fn two_results(
        &mut self,
        destination: Operand,
        source: Operand,
        f: impl Fn(u64, u64) -> (u64, u64),
    ) -> Result<(), FaultKind> {
        self.gather(0, source)?;
        let [first, second] = &mut self.operands;
        for (a, b) in first.iter_mut().zip(second.iter_mut()) {
            (*a, *b) = f(*a, *b);
        }
        self.store(destination)?;
        self.operands.swap(0, 1);
        self.store(source)
    }

    fn disable_unless(&mut self, a: Operand, f: impl Fn(u64) -> bool) -> Result<(), FaultKind> {
        self.gather(0, a)?;
        for (enable, v) in self.enable.pixels_mut().iter_mut().zip(&self.operands[0]) {
            *enable &= if f(*v) { 255 } else { 0 };
        }
        Ok(())
    }

    fn compare(&mut self, test: Test, a: Operand, b: Operand) -> Result<(), FaultKind> {
        self.gather(1, b)?;
        self.gather(0, a)?;
        let pairs = self.operands[0].iter().zip(&self.operands[1]);
        for (enable, (a_value, b_value)) in self.enable.pixels_mut().iter_mut().zip(pairs) {
            let holds = values::holds(test, *a_value, *b_value, a.signed);
            *enable &= if holds { 255 } else { 0 };
        }
        Ok(())
    }

    fn evaluate(&mut self, local: &LocalExpression, usage: &ExpressionUse) -> Result<(), FaultKind> {
        match *usage {
            ExpressionUse::DisableNegative => {
                // The sign-extended value is negative exactly if the expression's highest bit is set.
                self.expression(local, 0, |e, _, _| e);
                for (enable, v) in self.enable.pixels_mut().iter_mut().zip(&self.operands[0]) {
                    *enable &= if (*v as i64) < 0 { 0 } else { 255 };
                }
                Ok(())
            }
            ExpressionUse::Load { field, shift } => {
                self.expression(local, shift, |e, shift, _| e >> shift);
                self.store(field)
            }
            ExpressionUse::Add { field, shift } => {
                self.gather(1, field)?;
                self.expression(local, shift, |e, shift, old| (e >> shift).wrapping_add(old));
                self.store(field)
            }
            ExpressionUse::DisableNotLess { field, shift } => {
                self.gather(1, Operand { signed: false, ..field })?;
                self.expression(local, shift, |e, shift, _| e >> shift);
                let width = usize::from(field.width);
                let pairs = self.operands[0].iter().zip(&self.operands[1]);
                for (enable, (new, old)) in self.enable.pixels_mut().iter_mut().zip(pairs) {
                    *enable &= if values::low(*new, width) < *old { 255 } else { 0 };
                }
                Ok(())
            }
            ExpressionUse::LoadMinus { field, shift, subtrahend, left_shift } => {
                self.gather(1, subtrahend)?;
                self.expression(local, shift, |e, shift, old| e.wrapping_sub(old << left_shift) >> shift);
                self.store(field)
            }
        }
    }

    /// Computes `f` in each pixel, and stores the results in the first buffer. The arguments of `f` are the value of
    /// the expression at the pixel, `shift`, and the pixel's number in the second buffer.
    fn expression(&mut self, local: &LocalExpression, shift: u8, f: impl Fn(u64, u8, u64) -> u64) {
        let [first, second] = &mut self.operands;
        for (pixel, (out, old)) in first.iter_mut().zip(second.iter()).enumerate() {
            let x = pixel as u32 % REGION_SIZE;
            let y = pixel as u32 / REGION_SIZE;
            *out = f(local.at(x as i32, y as i32) as u64, shift, *old);
        }
    }

    fn store_block(&mut self, field: Operand, block: u8) -> Result<(), FaultKind> {
        self.gather(0, field)?;
        self.backing[usize::from(block)] = Some(self.operands[0].clone().into_boxed_slice());
        Ok(())
    }

    fn load_block(&mut self, field: Operand, block: u8) -> Result<(), FaultKind> {
        let bits = self.controller.bits(field)?;
        let block = &mut self.backing[usize::from(block)];
        let values = block.get_or_insert_with(|| vec![0; PIXELS].into_boxed_slice());
        self.columns.scatter(bits, values, &[255; PIXELS]);
        Ok(())
    }
}
