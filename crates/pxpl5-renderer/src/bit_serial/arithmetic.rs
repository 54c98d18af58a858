//! Bit-serial execution of the instructions that compute with bit fields of pixel memory.

use super::planes;
use super::tile::{EMPTY, FULL, Tile, TilePlane};
use crate::array::FaultKind;
use crate::controller::{Controller, FieldBits};
use crate::isa::{ArithmeticOp, ArrayInstruction, Test};

/// An operand whose bits are read in sequence from bit 0 (the least significant bit). Beyond its last bit, an unsigned
/// operand continues with zeros, and a signed operand continues with copies of its sign bit.
///
/// The sign bit is saved at the start, because the result can overwrite the operand.
pub(super) struct SerialOperand {
    bits: FieldBits,
    extension: TilePlane,
}

impl SerialOperand {
    fn bit(&self, memory: &[TilePlane], i: usize) -> TilePlane {
        *self.plane(memory, i)
    }

    pub(super) fn plane<'a>(&'a self, memory: &'a [TilePlane], i: usize) -> &'a TilePlane {
        if i < self.bits.width { &memory[self.bits.first + i] } else { &self.extension }
    }
}

enum Factor<'a> {
    Field(&'a SerialOperand),
    Constant(i32),
}

impl Tile {
    pub(super) fn field_instruction(
        &mut self,
        controller: &Controller,
        instruction: &ArrayInstruction,
    ) -> Result<(), FaultKind> {
        // The controller resolves each operand to absolute bits before the adders run.
        match *instruction {
            ArrayInstruction::ShiftRight { destination, source, by } => {
                self.shift_right(controller.bits(destination)?, controller.bits(source)?, by.into());
            }
            ArrayInstruction::ShiftLeft { destination, source, by } => {
                self.shift_left(controller.bits(destination)?, controller.bits(source)?, by.into());
            }
            ArrayInstruction::Saturate { destination, source } => {
                self.saturate(controller.bits(destination)?, controller.bits(source)?)
            }
            ArrayInstruction::SquareRoot { destination, radicand } => {
                self.square_root(controller.bits(destination)?, controller.bits(radicand)?);
            }
            ArrayInstruction::Arithmetic { op, destination, a, b } => {
                self.arithmetic(op, controller.bits(destination)?, controller.bits(a)?, controller.bits(b)?);
            }
            ArrayInstruction::Compare { test, a, b } => {
                let a = controller.bits(a)?;
                let b = controller.bits(b)?;
                let source = self.source(b);
                self.compare(test, a, a.width.max(b.width), |memory, i| source.bit(memory, i));
            }
            ArrayInstruction::CompareConstant { test, a, value } => {
                let a = controller.bits(a)?;
                self.compare(test, a, a.width, |_, i| constant_bit(value, i, a.signed));
            }
            ArrayInstruction::LoadConstant { destination, value } => {
                let field = controller.bits(destination)?;
                self.each_bit(field, |_, i| constant_bit(value, i, field.signed));
            }
            ArrayInstruction::MultiplyConstant { destination, source, factor, factor_bits } => {
                let factor = Factor::Constant(factor);
                self.multiply(
                    controller.bits(destination)?,
                    controller.bits(source)?,
                    &factor,
                    factor_bits.into(),
                    true,
                );
            }
            _ => {}
        }
        Ok(())
    }

    pub(super) fn source(&self, bits: FieldBits) -> SerialOperand {
        let extension = if bits.signed { self.memory[bits.end() - 1] } else { EMPTY };
        SerialOperand { bits, extension }
    }

    fn store(&mut self, bit: usize, new: &TilePlane) {
        planes::store(&mut self.memory[bit], new, &self.enable);
    }

    /// Computes a bit field from bit 0 upwards. The function `f` returns the value of each bit in all pixels of a tile.
    /// Each bit takes one clock.
    fn each_bit(&mut self, field: FieldBits, mut f: impl FnMut(&[TilePlane], usize) -> TilePlane) {
        for i in 0..field.width {
            let new = f(&self.memory, i);
            self.store(field.first + i, &new);
            self.clock += 1;
        }
    }

    fn shift_right(&mut self, destination: FieldBits, source: FieldBits, by: usize) {
        let source = self.source(source);
        self.each_bit(destination, |memory, i| source.bit(memory, i + by));
    }

    /// Shifts a bit field left. The most significant bit moves first, so the source and the destination can be the same
    /// bit field.
    fn shift_left(&mut self, destination: FieldBits, source: FieldBits, by: usize) {
        let source = self.source(source);
        for i in (0..destination.width).rev() {
            let bit = i.checked_sub(by).map(|i| source.bit(&self.memory, i));
            self.store(destination.first + i, &bit.unwrap_or(EMPTY));
            self.clock += 1;
        }
    }

    fn saturate(&mut self, destination: FieldBits, source: FieldBits) {
        let w = destination.width;
        let wa = source.width;
        let source = self.source(source);
        let mut over = EMPTY;
        // If the sign bit is set, set `over` too. The second step below then replaces negative values by 0.
        for i in w..wa {
            planes::or(&mut over, &source.bit(&self.memory, i));
        }
        self.clock += wa.saturating_sub(w).max(1) as u64;
        self.each_bit(destination, |memory, i| {
            let limited = planes::combine(&source.bit(memory, i), &over, |bit, over| bit | over);
            planes::combine(&limited, &source.extension, |bit, negative| bit & !negative)
        });
    }

    fn arithmetic(&mut self, op: ArithmeticOp, destination: FieldBits, a: FieldBits, b: FieldBits) {
        let x = self.source(a);
        let y = self.source(b);
        let mut carry = EMPTY;
        match op {
            ArithmeticOp::And => self.combine_bits(destination, &x, &y, |a, b| a & b),
            ArithmeticOp::Or => self.combine_bits(destination, &x, &y, |a, b| a | b),
            ArithmeticOp::Xor => self.combine_bits(destination, &x, &y, |a, b| a ^ b),
            ArithmeticOp::Add | ArithmeticOp::Subtract => self.each_bit(destination, |memory, i| {
                let mut sum = x.bit(memory, i);
                planes::step(op == ArithmeticOp::Subtract, &mut sum, &y.bit(memory, i), &mut carry);
                sum
            }),
            ArithmeticOp::Multiply => self.multiply(destination, a, &Factor::Field(&y), b.width, b.signed),
            ArithmeticOp::Divide => self.divide(destination, a, b),
            ArithmeticOp::Minimum | ArithmeticOp::Maximum => {
                // The comparison comes first. Its result then selects each bit of the result.
                let mut less = self.less(a, a.width.max(b.width), |memory, i| y.bit(memory, i));
                if op == ArithmeticOp::Maximum {
                    planes::invert(&mut less);
                }
                self.each_bit(destination, |memory, i| {
                    let mut first = x.bit(memory, i);
                    planes::and(&mut first, &less);
                    let second = planes::combine(&y.bit(memory, i), &less, |bit, less| bit & !less);
                    planes::combine(&first, &second, |first, second| first | second)
                });
            }
        }
    }

    fn combine_bits(&mut self, field: FieldBits, a: &SerialOperand, b: &SerialOperand, f: fn(u64, u64) -> u64) {
        self.each_bit(field, |memory, i| planes::combine(&a.bit(memory, i), &b.bit(memory, i), f));
    }

    /// Returns the pixels in which a < b. The function subtracts b from a, over `clocks` bits, and returns the pixels
    /// in which the subtraction ends with a borrow.
    fn less(&mut self, a: FieldBits, clocks: usize, b: impl Fn(&[TilePlane], usize) -> TilePlane) -> TilePlane {
        let x = self.source(a);
        let mut borrow = EMPTY;
        for i in 0..clocks {
            planes::borrow(&x.bit(&self.memory, i), &b(&self.memory, i), &mut borrow);
        }
        self.clock += clocks as u64;
        if a.signed {
            // If two's complement numbers have different signs, the negative number is less, so the last borrow is
            // inverted.
            let last = clocks - 1;
            let signs = planes::combine(&x.bit(&self.memory, last), &b(&self.memory, last), |a, b| a ^ b);
            borrow = planes::combine(&borrow, &signs, |borrow, signs| borrow ^ signs);
        }
        borrow
    }

    fn compare(&mut self, test: Test, a: FieldBits, clocks: usize, b: impl Fn(&[TilePlane], usize) -> TilePlane) {
        // Find the pixels where a < b, or the pixels where a and b differ. The test decides which of the two.
        let holds = match test {
            Test::Less | Test::NotLess => self.less(a, clocks, b),
            Test::Equal | Test::NotEqual => {
                let x = self.source(a);
                let mut differ = EMPTY;
                for i in 0..clocks {
                    let bit = planes::combine(&x.bit(&self.memory, i), &b(&self.memory, i), |a, b| a ^ b);
                    planes::or(&mut differ, &bit);
                }
                self.clock += clocks as u64;
                differ
            }
        };
        // Keep Enable only where the comparison is true.
        match test {
            Test::Less | Test::NotEqual => planes::and(&mut self.enable, &holds),
            Test::NotLess | Test::Equal => planes::and_not(&mut self.enable, &holds),
        }
    }

    /// Computes `destination := a * b` by adding `a << j` for each bit `j` of `b` that is set.
    ///
    /// Each addition takes one more clock for the carry. For the sign bit of a signed `b`, `a` is subtracted instead.
    /// The bits of the destination above the product become copies of the product's sign bit.
    fn multiply(&mut self, destination: FieldBits, a: FieldBits, b: &Factor<'_>, b_width: usize, b_signed: bool) {
        let x = self.source(a);
        // Add one shifted copy of `a` for each bit of `b`.
        for j in 0..b_width.min(destination.width) {
            let gate = match b {
                Factor::Field(field) => field.bit(&self.memory, j),
                Factor::Constant(constant) if constant >> j & 1 == 1 => FULL,
                Factor::Constant(_) => EMPTY,
            };
            self.add_product(destination, &x, j, &gate, b_signed && j + 1 == b_width);
        }
        // Fill the bits above the product.
        let sign_at = a.width + b_width - 1;
        for i in sign_at + 1..destination.width {
            let signed = a.signed || b_signed;
            let sign = if signed { self.memory[destination.first + sign_at] } else { EMPTY };
            self.store(destination.first + i, &sign);
            self.clock += 1;
        }
    }

    /// Adds `x << j` to `destination` in the pixels where `gate` is set. Subtracts `x << j` instead if `negative` is
    /// true.
    fn add_product(&mut self, destination: FieldBits, x: &SerialOperand, j: usize, gate: &TilePlane, negative: bool) {
        let top = j + x.bits.width;
        // The partial product is sign-extended if the destination has a bit at position `top`.
        let extends = x.bits.signed && top < destination.width;
        let extension = if extends { self.memory[destination.first + top - 1] } else { EMPTY };
        let mut carry = EMPTY;
        for i in j..destination.width.min(top + 1) {
            let mut sum = match i {
                _ if j == 0 => EMPTY,
                _ if i == top => extension,
                _ => self.memory[destination.first + i],
            };
            let addend = planes::combine(&x.bit(&self.memory, i - j), gate, |bit, gate| bit & gate);
            planes::step(negative, &mut sum, &addend, &mut carry);
            self.store(destination.first + i, &sum);
            self.clock += 1;
        }
    }

    /// Divides `a` by `b`, one binary digit at a time, from the highest digit. Each step compares the remainder with
    /// the divisor, and subtracts the divisor unless the divisor is larger.
    fn divide(&mut self, destination: FieldBits, a: FieldBits, b: FieldBits) {
        let divisor = self.source(b);
        for j in (0..destination.width).rev() {
            let rest = FieldBits { first: a.first + j, width: a.width - j, signed: false };
            let mut digit = self.less(rest, rest.width.max(b.width), |memory, i| divisor.bit(memory, i));
            planes::invert(&mut digit);
            self.store(destination.first + j, &digit);
            self.subtract_gated(rest, &digit, |memory, i| divisor.bit(memory, i));
        }
    }

    fn subtract_gated(&mut self, rest: FieldBits, gate: &TilePlane, b: impl Fn(&[TilePlane], usize) -> TilePlane) {
        let mut borrow = EMPTY;
        self.each_bit(rest, |memory, i| {
            let mut difference = memory[rest.first + i];
            let gated = planes::combine(&b(memory, i), gate, |bit, gate| bit & gate);
            planes::subtract(&mut difference, &gated, &mut borrow);
            difference
        });
    }

    /// Computes a square root, one binary digit at a time, from the highest digit.
    ///
    /// Each step compares the remainder with the digits of the root so far, followed by the bits 01. The comparison
    /// covers all bits that the remainder can occupy.
    fn square_root(&mut self, destination: FieldBits, radicand: FieldBits) {
        let n = destination.width;
        for i in (0..n).rev() {
            let digits = n - 1 - i;
            let width = (digits + 3).min(radicand.width - 2 * i);
            let rest = FieldBits { first: radicand.first + 2 * i, width, signed: false };
            let root = FieldBits { first: destination.first + i + 1, width: digits, signed: false };
            let mut digit = self.less(rest, width, |memory, k| trial_bit(root, memory, k));
            planes::invert(&mut digit);
            self.store(destination.first + i, &digit);
            self.subtract_gated(rest, &digit, |memory, k| trial_bit(root, memory, k));
        }
    }
}

fn trial_bit(root: FieldBits, memory: &[TilePlane], k: usize) -> TilePlane {
    match k {
        0 => FULL,
        2.. if k - 2 < root.width => memory[root.first + k - 2],
        _ => EMPTY,
    }
}

pub(super) fn constant_bit(value: u32, i: usize, signed: bool) -> TilePlane {
    let at = if i < 32 { i } else { 31 };
    let set = value >> at & 1 == 1 && (i < 32 || signed);
    if set { FULL } else { EMPTY }
}
