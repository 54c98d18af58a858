//! The controller of the array. It selects the region and the context (part of pixel memory), stores coefficients, and
//! checks operands.

use crate::array::{ArrayFault, FaultKind};
use crate::isa::{ArithmeticOp, ArrayInstruction, Expression, ExpressionUse, MEMORY_BITS, Operand, QUADRATIC_BITS};
use pxpl5_wire::{Linear, Quadratic, Word};

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct FieldBits {
    pub(crate) first: usize,
    pub(crate) width: usize,
    pub(crate) signed: bool,
}

impl FieldBits {
    pub(crate) const fn end(&self) -> usize {
        self.first + self.width
    }

    const fn overlaps(&self, other: &Self) -> bool {
        self.first < other.end() && other.first < self.end()
    }
}

#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Controller {
    pub(crate) base: u8,
    pub(crate) left: u16,
    pub(crate) top: u16,
    linear: Linear,
    quadratic: Quadratic,
}

/// A linear or quadratic expression in coordinates of the array: the array's upper left pixel is (0, 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LocalExpression {
    Linear(Linear),
    Quadratic(Quadratic),
}

impl Controller {
    pub(crate) fn select(&mut self, base: u8, left: u16, top: u16) {
        self.base = base;
        self.left = left;
        self.top = top;
    }

    /// Decodes the instruction at word `position` and checks its operands. Returns the instruction and its length in
    /// words.
    pub(crate) fn fetch(&self, words: &[Word], position: usize) -> Result<(ArrayInstruction, usize), ArrayFault> {
        let (instruction, used) = ArrayInstruction::decode(words, position)
            .map_err(|error| ArrayFault { position, kind: FaultKind::Illegal(error.kind) })?;
        self.check(&instruction).map_err(|kind| ArrayFault { position, kind })?;
        Ok((instruction, used))
    }

    /// Stores the coefficients of `expression`, and converts it to coordinates of the array (origin at the array's
    /// upper left pixel).
    ///
    /// If it has no coefficients, those of the last linear or quadratic expression are used.
    pub(crate) fn latch(&mut self, expression: &Expression) -> LocalExpression {
        match expression {
            Expression::Linear(linear) => self.linear = *linear,
            Expression::Quadratic(quadratic) => self.quadratic = *quadratic,
            Expression::LinearAgain | Expression::QuadraticAgain => {}
        }
        if expression.is_quadratic() {
            LocalExpression::Quadratic(self.localise_quadratic())
        } else {
            LocalExpression::Linear(self.localise(&self.linear))
        }
    }

    /// Returns the column and the row of the array's upper left pixel in the picture.
    pub(crate) fn origin(&self) -> [i32; 2] {
        [self.left.into(), self.top.into()]
    }

    /// Converts an expression from coordinates of the picture to coordinates of the array. The origins are the upper
    /// left pixels of the picture and of the array.
    #[inline(always)]
    pub(crate) fn localise(&self, e: &Linear) -> Linear {
        Linear { c: e.at(i32::from(self.left), i32::from(self.top)), ..*e }
    }

    /// Stores linear coefficients, which a later instruction can reuse. Arrays call this function for commands that
    /// they execute in one step instead of instruction by instruction.
    pub(crate) fn hold(&mut self, linear: Linear) {
        self.linear = linear;
    }

    /// Stores quadratic coefficients, which a later instruction can reuse. Arrays call this function for commands that
    /// they execute in one step instead of instruction by instruction.
    pub(crate) fn hold_quadratic(&mut self, quadratic: Quadratic) {
        self.quadratic = quadratic;
    }

    pub(crate) fn localise_quadratic(&self) -> Quadratic {
        let q = self.quadratic;
        let x = i64::from(self.left);
        let y = i64::from(self.top);
        Quadratic {
            x: q.x.wrapping_add(q.xx.wrapping_mul(2 * x)).wrapping_add(q.xy.wrapping_mul(y)),
            y: q.y.wrapping_add(q.yy.wrapping_mul(2 * y)).wrapping_add(q.xy.wrapping_mul(x)),
            one: q.at(i32::from(self.left), i32::from(self.top)),
            ..q
        }
    }

    /// Returns the bits of pixel memory to which an operand refers in the selected context (part of pixel memory for
    /// one region).
    ///
    /// # Errors
    /// Returns [`FaultKind::FieldOutOfRange`] if the bit field ends beyond pixel memory.
    pub(crate) fn bits(&self, operand: Operand) -> Result<FieldBits, FaultKind> {
        let base = if operand.relative { self.base } else { 0 };
        let bits = FieldBits {
            first: usize::from(base) + usize::from(operand.address),
            width: usize::from(operand.width),
            signed: operand.signed,
        };
        if bits.end() <= MEMORY_BITS as usize {
            Ok(bits)
        } else {
            Err(FaultKind::FieldOutOfRange { operand, base: self.base })
        }
    }

    /// Checks all operands of an instruction. Each bit field must lie in pixel memory. Only some instructions allow bit
    /// fields that overlap.
    pub(crate) fn check(&self, instruction: &ArrayInstruction) -> Result<(), FaultKind> {
        // Shifts can work in place. Products and roots must not overlap their operands.
        match *instruction {
            ArrayInstruction::EnableLoad(bit)
            | ArrayInstruction::EnableStore(bit)
            | ArrayInstruction::EnableAnd(bit) => self.bits(bit).map(drop),
            ArrayInstruction::Evaluate { usage, .. } => self.check_use(&usage),
            ArrayInstruction::ShiftRight { destination, source, .. }
            | ArrayInstruction::ShiftLeft { destination, source, .. }
            | ArrayInstruction::Saturate { destination, source } => self.aligned(destination, source),
            ArrayInstruction::SquareRoot { destination, radicand: source }
            | ArrayInstruction::MultiplyConstant { destination, source, .. } => self.apart(destination, source),
            ArrayInstruction::Arithmetic { op, destination, a, b } => self.check_arithmetic(op, destination, a, b),
            ArrayInstruction::Compare { a, b, .. } => self.bits(a).and(self.bits(b)).map(drop),
            ArrayInstruction::CompareConstant { a, .. } => self.bits(a).map(drop),
            ArrayInstruction::LoadConstant { destination: field, .. }
            | ArrayInstruction::StoreBlock { field, .. }
            | ArrayInstruction::LoadBlock { field, .. }
            | ArrayInstruction::Output { field, .. } => self.bits(field).map(drop),
            _ => Ok(()),
        }
    }

    fn check_use(&self, usage: &ExpressionUse) -> Result<(), FaultKind> {
        match *usage {
            ExpressionUse::DisableNegative => Ok(()),
            ExpressionUse::Load { field, .. }
            | ExpressionUse::Add { field, .. }
            | ExpressionUse::DisableNotLess { field, .. } => self.bits(field).map(drop),
            ExpressionUse::LoadMinus { field, subtrahend, .. } => self.apart(field, subtrahend),
        }
    }

    fn check_arithmetic(
        &self,
        op: ArithmeticOp,
        destination: Operand,
        a: Operand,
        b: Operand,
    ) -> Result<(), FaultKind> {
        match op {
            ArithmeticOp::Multiply => self.apart(destination, a).and(self.apart(destination, b)),
            ArithmeticOp::Divide => self.apart(destination, a).and(self.apart(destination, b)).and(self.apart(a, b)),
            _ => self.aligned(destination, a).and(self.aligned(destination, b)),
        }
    }

    fn apart(&self, destination: Operand, operand: Operand) -> Result<(), FaultKind> {
        let d = self.bits(destination)?;
        let o = self.bits(operand)?;
        if d.overlaps(&o) { Err(overlap(&d, &o)) } else { Ok(()) }
    }

    fn aligned(&self, destination: Operand, operand: Operand) -> Result<(), FaultKind> {
        let d = self.bits(destination)?;
        let o = self.bits(operand)?;
        if d.overlaps(&o) && d.first != o.first { Err(overlap(&d, &o)) } else { Ok(()) }
    }
}

const fn overlap(destination: &FieldBits, operand: &FieldBits) -> FaultKind {
    FaultKind::Overlap { destination: destination.first as u8, operand: operand.first as u8 }
}

impl LocalExpression {
    /// Returns the expression's value at column `x` and row `y`. A linear value is sign-extended from 32 bits, a
    /// quadratic value from 48 bits.
    pub(crate) fn at(&self, x: i32, y: i32) -> i64 {
        match self {
            Self::Linear(e) => i64::from(e.at(x, y)),
            Self::Quadratic(q) => {
                let unused = 64 - QUADRATIC_BITS;
                q.at(x, y) << unused >> unused
            }
        }
    }

    pub(crate) const fn bits(&self) -> u32 {
        match self {
            Self::Linear(_) => crate::isa::LINEAR_BITS,
            Self::Quadratic(_) => QUADRATIC_BITS,
        }
    }
}
