//! Encoder of instructions into words.

use super::{ArithmeticOp, ArrayInstruction, Expression, ExpressionUse, Operand, Test};
use pxpl5_wire::{CopyTarget, FieldParity, Lines, Word};

pub(crate) mod opcode {
    pub(crate) const ENABLE_ALL: u8 = 0x01;
    pub(crate) const ENABLE_NONE: u8 = 0x02;
    pub(crate) const ENABLE_INVERT: u8 = 0x03;
    pub(crate) const ENABLE_LOAD: u8 = 0x04;
    pub(crate) const ENABLE_STORE: u8 = 0x05;
    pub(crate) const ENABLE_AND: u8 = 0x06;
    pub(crate) const SELECT: u8 = 0x07;
    pub(crate) const LINEAR: u8 = 0x10;
    pub(crate) const QUADRATIC: u8 = 0x20;
    pub(crate) const SHIFT_RIGHT: u8 = 0x30;
    pub(crate) const SHIFT_LEFT: u8 = 0x31;
    pub(crate) const SATURATE: u8 = 0x32;
    pub(crate) const SQUARE_ROOT: u8 = 0x33;
    pub(crate) const ARITHMETIC: u8 = 0x34;
    pub(crate) const COMPARE: u8 = 0x40;
    pub(crate) const COMPARE_CONSTANT: u8 = 0x48;
    pub(crate) const LOAD_CONSTANT: u8 = 0x50;
    pub(crate) const MULTIPLY_CONSTANT: u8 = 0x51;
    pub(crate) const STORE_BLOCK: u8 = 0x60;
    pub(crate) const LOAD_BLOCK: u8 = 0x61;
    pub(crate) const WAIT: u8 = 0x62;
    pub(crate) const OUTPUT: u8 = 0x70;
}

/// Bit 7 of the modifier. If it is set, the evaluator reuses the coefficients of the last expression of the same kind.
pub(super) const AGAIN: u8 = 0x80;

pub(crate) const fn head(opcode: u8, modifier: u8, operand: u32) -> Word {
    (opcode as u32) << 24 | (modifier as u32) << 16 | operand
}

const fn pair(a: Operand, b: Operand) -> Word {
    a.to_bits() << 16 | b.to_bits()
}

impl ArrayInstruction {
    pub fn encode(&self, out: &mut Vec<Word>) {
        // Operations and tests have consecutive opcodes, in the order of their enums.
        match *self {
            Self::EnableAll { label } => out.push(head(opcode::ENABLE_ALL, label, 0)),
            Self::EnableNone => out.push(head(opcode::ENABLE_NONE, 0, 0)),
            Self::EnableInvert => out.push(head(opcode::ENABLE_INVERT, 0, 0)),
            Self::EnableLoad(bit) => out.push(head(opcode::ENABLE_LOAD, 0, bit.to_bits())),
            Self::EnableStore(bit) => out.push(head(opcode::ENABLE_STORE, 0, bit.to_bits())),
            Self::EnableAnd(bit) => out.push(head(opcode::ENABLE_AND, 0, bit.to_bits())),
            Self::Select { context_base, left, top } => {
                out.extend([head(opcode::SELECT, context_base, 0), u32::from(top) << 16 | u32::from(left)])
            }
            Self::Evaluate { expression, usage } => encode_evaluate(&expression, &usage, out),
            Self::ShiftRight { destination, source, by } => {
                out.extend(two(opcode::SHIFT_RIGHT, by, destination, source));
            }
            Self::ShiftLeft { destination, source, by } => {
                out.extend(two(opcode::SHIFT_LEFT, by, destination, source));
            }
            Self::Saturate { destination, source } => {
                out.extend(two(opcode::SATURATE, 0, destination, source));
            }
            Self::SquareRoot { destination, radicand } => {
                out.extend(two(opcode::SQUARE_ROOT, 0, destination, radicand));
            }
            Self::Arithmetic { op, destination, a, b } => {
                out.extend([head(opcode::ARITHMETIC + op as u8, 0, destination.to_bits()), pair(a, b)])
            }
            Self::Compare { test, a, b } => {
                out.extend([head(opcode::COMPARE + test as u8, 0, 0), pair(a, b)]);
            }
            Self::CompareConstant { test, a, value } => {
                out.extend([head(opcode::COMPARE_CONSTANT + test as u8, 0, a.to_bits()), value]);
            }
            Self::LoadConstant { destination, value } => {
                out.extend([head(opcode::LOAD_CONSTANT, 0, destination.to_bits()), value]);
            }
            Self::MultiplyConstant { destination, source, factor, factor_bits } => {
                out.extend(two(opcode::MULTIPLY_CONSTANT, factor_bits - 1, destination, source));
                out.push(factor as u32);
            }
            Self::StoreBlock { field, block } => {
                out.push(head(opcode::STORE_BLOCK, block, field.to_bits()));
            }
            Self::LoadBlock { field, block } => {
                out.push(head(opcode::LOAD_BLOCK, block, field.to_bits()));
            }
            Self::Wait => out.push(head(opcode::WAIT, 0, 0)),
            Self::Output { field, target } => {
                out.push(head(opcode::OUTPUT, 0, field.to_bits()));
                encode_target(&target, out);
            }
        }
    }

    pub fn words(&self) -> u32 {
        let mut words = Vec::with_capacity(14);
        self.encode(&mut words);
        words.len() as u32
    }
}

const fn two(opcode: u8, modifier: u8, destination: Operand, source: Operand) -> [Word; 2] {
    [head(opcode, modifier, destination.to_bits()), source.to_bits() << 16]
}

#[inline(always)]
const fn evaluate_head(quadratic: bool, again: bool, usage: &ExpressionUse) -> Word {
    let family = if quadratic { opcode::QUADRATIC } else { opcode::LINEAR };
    let again = if again { AGAIN } else { 0 };
    match *usage {
        ExpressionUse::DisableNegative => head(family, again, 0),
        ExpressionUse::Load { field, shift } => head(family + 1, again | shift, field.to_bits()),
        ExpressionUse::Add { field, shift } => head(family + 2, again | shift, field.to_bits()),
        ExpressionUse::DisableNotLess { field, shift } => head(family + 3, again | shift, field.to_bits()),
        ExpressionUse::LoadMinus { field, shift, .. } => head(family + 4, again | shift, field.to_bits()),
    }
}

fn encode_evaluate(expression: &Expression, usage: &ExpressionUse, out: &mut Vec<Word>) {
    let again = matches!(expression, Expression::LinearAgain | Expression::QuadraticAgain);
    out.push(evaluate_head(expression.is_quadratic(), again, usage));
    if let ExpressionUse::LoadMinus { subtrahend, left_shift, .. } = usage {
        out.push(subtrahend.to_bits() << 16 | u32::from(*left_shift));
    }
    encode_coefficients(expression, out);
}

fn encode_coefficients(expression: &Expression, out: &mut Vec<Word>) {
    match expression {
        Expression::Linear(e) => out.extend([e.a as u32, e.b as u32, e.c as u32]),
        Expression::Quadratic(q) => {
            for coefficient in [q.xx, q.xy, q.yy, q.x, q.y, q.one] {
                out.extend([coefficient as u32, (coefficient >> 32) as u32]);
            }
        }
        Expression::LinearAgain | Expression::QuadraticAgain => {}
    }
}

fn encode_target(target: &CopyTarget, out: &mut Vec<Word>) {
    let lines = match target.lines {
        Lines::Frame => 0,
        Lines::Field(FieldParity::Even) => 1,
        Lines::Field(FieldParity::Odd) => 2,
    };
    let grid = target.grid;
    let [picture_low, picture_high] = target.picture.to_words();
    out.extend([
        u32::from(target.frame_buffer.0) << 16 | u32::from(target.region.0),
        lines << 8 | u32::from(target.buffer),
        grid.width,
        grid.height,
        grid.region_width,
        grid.region_height,
        picture_low,
        picture_high,
    ]);
}

impl ArithmeticOp {
    pub(crate) const ALL: [Self; 9] = [
        Self::Add,
        Self::Subtract,
        Self::Multiply,
        Self::Divide,
        Self::And,
        Self::Or,
        Self::Xor,
        Self::Minimum,
        Self::Maximum,
    ];
}

impl Test {
    pub(crate) const ALL: [Self; 4] = [Self::Less, Self::NotLess, Self::Equal, Self::NotEqual];
}
