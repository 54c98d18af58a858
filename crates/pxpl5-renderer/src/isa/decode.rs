//! Decoder of words into instructions.

use super::encode::{AGAIN, opcode};
use super::{ArithmeticOp, ArrayInstruction, BACKING_BLOCKS, Expression, ExpressionUse, MEMORY_BITS, Operand, Test};
use pxpl5_wire::{
    CopyTarget, FieldParity, Linear, Lines, NodeId, PictureNumber, Quadratic, RegionGrid, RegionId, Word,
};

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("word {position} ({word:#010x}): {kind}")]
pub struct DecodeError {
    /// Index of the illegal instruction's first word in the list of words.
    pub position: usize,
    /// First word of the illegal instruction.
    pub word: Word,
    pub kind: DecodeErrorKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum DecodeErrorKind {
    #[error("no instruction has this opcode")]
    UnknownOpcode,
    #[error("the instruction needs {expected} words, the list has {found} left")]
    Truncated {
        expected: usize,
        /// Number of words from the start of the instruction to the end of the list.
        found: usize,
    },
    #[error("bits are set that must be zero")]
    ReservedBits,
    /// A bit field of pixel memory extends beyond the end of pixel memory.
    #[error("{} bits at address {} reach beyond the {} bits of pixel memory", .0.width, .0.address, MEMORY_BITS)]
    FieldOutOfRange(Operand),
    /// A bit field of pixel memory has a width that this instruction does not allow.
    #[error("the field at address {} has {} bits, expected {expected}", .field.address, .field.width)]
    Width {
        field: Operand,
        /// Required width of the bit field in bits. For expressions and quotients, this number is the largest width.
        expected: u32,
    },
    /// An operand has the wrong signedness. Some instructions need unsigned operands. Comparisons, minima and maxima
    /// need two operands of the same signedness.
    #[error("signedness of the operands does not fit")]
    Signedness,
    /// The number of a block of the backing store is 128 or more.
    #[error("backing store block {0}, expected less than {max}", max = BACKING_BLOCKS)]
    UnknownBlock(u8),
    /// The lines, the region or the grid of regions of an output instruction are invalid.
    #[error("the copy's target is no region of a frame")]
    BadTarget,
    /// The first instruction has the label of a command, but the instructions differ from this command's program in the
    /// layout.
    #[error("labelled as command {0}, but not its program in this layout")]
    NotTheCommand(u8),
}

impl ArrayInstruction {
    /// Decodes the instruction at word `position`. Returns the instruction and its length in words.
    ///
    /// # Errors
    /// Returns a [`DecodeError`] if the words are not an instruction. The function never panics.
    pub fn decode(words: &[Word], position: usize) -> Result<(Self, usize), DecodeError> {
        let rest = words.get(position..).unwrap_or(&[]);
        let word = rest.first().copied().unwrap_or(0);
        decode(rest).map_err(|kind| DecodeError { position, word, kind })
    }

    /// Decodes all instructions of a list.
    ///
    /// # Errors
    /// Returns [`DecodeError`] for the first invalid instruction.
    pub fn decode_all(words: &[Word]) -> Result<Vec<Self>, DecodeError> {
        let mut out = Vec::new();
        let mut position = 0;
        while position < words.len() {
            let (instruction, used) = Self::decode(words, position)?;
            out.push(instruction);
            position += used;
        }
        Ok(out)
    }
}

/// First word of an instruction, split into its bit fields, and the words after the first word.
struct EncodedInstruction<'a> {
    opcode: u8,
    modifier: u8,
    operand: u32,
    tail: &'a [Word],
}

impl EncodedInstruction<'_> {
    fn tail<const N: usize>(&self) -> Result<[Word; N], DecodeErrorKind> {
        self.tail
            .first_chunk()
            .copied()
            .ok_or(DecodeErrorKind::Truncated { expected: N + 1, found: self.tail.len() + 1 })
    }

    fn field(&self) -> Result<Operand, DecodeErrorKind> {
        checked_field(self.operand)
    }

    /// Returns the operand in the low 16 bits of the first word, which must be one bit wide.
    fn bit(&self) -> Result<Operand, DecodeErrorKind> {
        width(self.field()?, 1)
    }

    /// Returns the operand in the upper half of the second word. The lower half must be zero.
    fn source(&self) -> Result<Operand, DecodeErrorKind> {
        let [word] = self.tail()?;
        must_be_zero(word & 0xffff)?;
        checked_field(word >> 16)
    }

    fn pair(&self) -> Result<(Operand, Operand), DecodeErrorKind> {
        let [word] = self.tail()?;
        Ok((checked_field(word >> 16)?, checked_field(word & 0xffff)?))
    }

    fn no_modifier(&self) -> Result<(), DecodeErrorKind> {
        must_be_zero(u32::from(self.modifier))
    }
}

fn must_be_zero(bits: u32) -> Result<(), DecodeErrorKind> {
    if bits == 0 { Ok(()) } else { Err(DecodeErrorKind::ReservedBits) }
}

fn checked_field(bits: u32) -> Result<Operand, DecodeErrorKind> {
    let field = Operand::from_bits(bits);
    let end = u32::from(field.address) + u32::from(field.width);
    if end <= MEMORY_BITS { Ok(field) } else { Err(DecodeErrorKind::FieldOutOfRange(field)) }
}

fn width(field: Operand, expected: u32) -> Result<Operand, DecodeErrorKind> {
    if u32::from(field.width) == expected { Ok(field) } else { Err(DecodeErrorKind::Width { field, expected }) }
}

fn unsigned(fields: &[Operand]) -> Result<(), DecodeErrorKind> {
    if fields.iter().any(|field| field.signed) { Err(DecodeErrorKind::Signedness) } else { Ok(()) }
}

fn alike(a: Operand, b: Operand) -> Result<(), DecodeErrorKind> {
    if a.signed == b.signed { Ok(()) } else { Err(DecodeErrorKind::Signedness) }
}

fn decode(words: &[Word]) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    let Some((&first, tail)) = words.split_first() else {
        return Err(DecodeErrorKind::Truncated { expected: 1, found: 0 });
    };
    // Split the first word. Each group of opcodes then checks its own fields.
    let encoded = EncodedInstruction {
        opcode: (first >> 24) as u8,
        modifier: (first >> 16) as u8,
        operand: first & 0xffff,
        tail,
    };
    match encoded.opcode {
        opcode::ENABLE_ALL..=opcode::SELECT => control(&encoded),
        opcode::LINEAR..=0x14 | opcode::QUADRATIC..=0x24 => evaluate(&encoded),
        opcode::SHIFT_RIGHT..=opcode::SQUARE_ROOT => one_source(&encoded),
        opcode::ARITHMETIC..=0x3c => arithmetic(&encoded),
        opcode::COMPARE..=0x43 => compare(&encoded),
        opcode::COMPARE_CONSTANT..=0x4b | opcode::LOAD_CONSTANT | opcode::MULTIPLY_CONSTANT => constant(&encoded),
        opcode::STORE_BLOCK | opcode::LOAD_BLOCK | opcode::WAIT => backing(&encoded),
        opcode::OUTPUT => output(&encoded),
        _ => Err(DecodeErrorKind::UnknownOpcode),
    }
}

fn control(encoded: &EncodedInstruction<'_>) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    // Only EnableAll and Select use the modifier. Only EnableLoad, EnableStore and EnableAnd use the operand.
    if matches!(encoded.opcode, opcode::ENABLE_ALL | opcode::SELECT) {
        must_be_zero(encoded.operand)?;
    } else {
        encoded.no_modifier()?;
    }
    Ok(match encoded.opcode {
        opcode::ENABLE_ALL => (ArrayInstruction::EnableAll { label: encoded.modifier }, 1),
        opcode::ENABLE_LOAD => (ArrayInstruction::EnableLoad(encoded.bit()?), 1),
        opcode::ENABLE_STORE => (ArrayInstruction::EnableStore(encoded.bit()?), 1),
        opcode::ENABLE_AND => (ArrayInstruction::EnableAnd(encoded.bit()?), 1),
        opcode::SELECT => {
            let [origin] = encoded.tail()?;
            let left = origin as u16;
            let top = (origin >> 16) as u16;
            (ArrayInstruction::Select { context_base: encoded.modifier, left, top }, 2)
        }
        other => {
            must_be_zero(encoded.operand)?;
            let all = other == opcode::ENABLE_NONE;
            (if all { ArrayInstruction::EnableNone } else { ArrayInstruction::EnableInvert }, 1)
        }
    })
}

fn evaluate(encoded: &EncodedInstruction<'_>) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    let quadratic = encoded.opcode >= opcode::QUADRATIC;
    let use_code = encoded.opcode & 15;
    let (usage, used) = expression_use(encoded, use_code)?;
    // Coefficients follow, unless the evaluator reuses the coefficients of its last expression.
    let rest = EncodedInstruction { tail: encoded.tail.get(used - 1..).unwrap_or(&[]), ..*encoded };
    let truncated =
        DecodeErrorKind::Truncated { expected: used + if quadratic { 12 } else { 3 }, found: encoded.tail.len() + 1 };
    let (expression, more) = match (quadratic, encoded.modifier & AGAIN != 0) {
        (false, true) => (Expression::LinearAgain, 0),
        (true, true) => (Expression::QuadraticAgain, 0),
        (false, false) => (Expression::Linear(linear(rest.tail().map_err(|_| truncated)?)), 3),
        (true, false) => (Expression::Quadratic(quadratic_of(rest.tail().map_err(|_| truncated)?)), 12),
    };
    check_use(&usage, expression.bits())?;
    Ok((ArrayInstruction::Evaluate { expression, usage }, used + more))
}

fn expression_use(encoded: &EncodedInstruction<'_>, code: u8) -> Result<(ExpressionUse, usize), DecodeErrorKind> {
    must_be_zero(u32::from(encoded.modifier & 0x40))?;
    // Bit 7 (*again*) belongs to the expression. Bit 6 is unused.
    let shift = encoded.modifier & 63;
    Ok(match code {
        0 => {
            must_be_zero(encoded.operand | u32::from(shift))?;
            (ExpressionUse::DisableNegative, 1)
        }
        1 => (ExpressionUse::Load { field: encoded.field()?, shift }, 1),
        2 => (ExpressionUse::Add { field: encoded.field()?, shift }, 1),
        3 => (ExpressionUse::DisableNotLess { field: encoded.field()?, shift }, 1),
        _ => {
            let [word] = encoded.tail()?;
            must_be_zero(word & 0xffc0)?;
            let field = encoded.field()?;
            // The second word holds the field to subtract, and its left shift.
            let subtrahend = checked_field(word >> 16)?;
            let left_shift = (word & 63) as u8;
            (ExpressionUse::LoadMinus { field, shift, subtrahend, left_shift }, 2)
        }
    })
}

fn check_use(usage: &ExpressionUse, bits: u32) -> Result<(), DecodeErrorKind> {
    match *usage {
        ExpressionUse::DisableNegative => Ok(()),
        ExpressionUse::Load { field, shift }
        | ExpressionUse::Add { field, shift }
        | ExpressionUse::DisableNotLess { field, shift }
        | ExpressionUse::LoadMinus { field, shift, .. } => {
            let room = bits.saturating_sub(u32::from(shift));
            if u32::from(field.width) <= room { Ok(()) } else { Err(DecodeErrorKind::Width { field, expected: room }) }
        }
    }
}

fn linear(words: [Word; 3]) -> Linear {
    let [a, b, c] = words.map(|word| word as i32);
    Linear { a, b, c }
}

fn quadratic_of(words: [Word; 12]) -> Quadratic {
    Quadratic {
        xx: long_coefficient(&words, 0),
        xy: long_coefficient(&words, 1),
        yy: long_coefficient(&words, 2),
        x: long_coefficient(&words, 3),
        y: long_coefficient(&words, 4),
        one: long_coefficient(&words, 5),
    }
}

/// Returns coefficient `i` of 64 bits, from two words. The low word comes first.
fn long_coefficient(words: &[Word; 12], i: usize) -> i64 {
    (u64::from(words[2 * i + 1]) << 32 | u64::from(words[2 * i])) as i64
}

fn one_source(encoded: &EncodedInstruction<'_>) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    let destination = encoded.field()?;
    let source = encoded.source()?;
    let by = encoded.modifier;
    let instruction = match encoded.opcode {
        opcode::SHIFT_RIGHT => ArrayInstruction::ShiftRight { destination, source, by },
        opcode::SHIFT_LEFT => ArrayInstruction::ShiftLeft { destination, source, by },
        opcode::SATURATE => {
            encoded.no_modifier()?;
            ArrayInstruction::Saturate { destination, source }
        }
        _ => {
            encoded.no_modifier()?;
            unsigned(&[source])?;
            // A root of w bits needs a radicand of 2 w bits.
            width(source, 2 * u32::from(destination.width))?;
            ArrayInstruction::SquareRoot { destination, radicand: source }
        }
    };
    must_be_zero(u32::from(by & 0xc0))?;
    Ok((instruction, 2))
}

fn arithmetic(encoded: &EncodedInstruction<'_>) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    encoded.no_modifier()?;
    let destination = encoded.field()?;
    let (a, b) = encoded.pair()?;
    let op = ArithmeticOp::ALL[usize::from(encoded.opcode - opcode::ARITHMETIC)];
    match op {
        ArithmeticOp::Divide => {
            unsigned(&[a, b])?;
            if destination.width > a.width {
                return Err(DecodeErrorKind::Width { field: destination, expected: u32::from(a.width) });
            }
        }
        ArithmeticOp::Minimum | ArithmeticOp::Maximum => alike(a, b)?,
        _ => {}
    }
    Ok((ArrayInstruction::Arithmetic { op, destination, a, b }, 2))
}

fn compare(encoded: &EncodedInstruction<'_>) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    must_be_zero(u32::from(encoded.modifier) | encoded.operand)?;
    let (a, b) = encoded.pair()?;
    alike(a, b)?;
    let test = Test::ALL[usize::from(encoded.opcode - opcode::COMPARE)];
    Ok((ArrayInstruction::Compare { test, a, b }, 2))
}

fn constant(encoded: &EncodedInstruction<'_>) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    let destination = encoded.field()?;
    if encoded.opcode == opcode::MULTIPLY_CONSTANT {
        let source = encoded.source()?;
        let [_, factor] = encoded.tail()?;
        must_be_zero(u32::from(encoded.modifier & 0xe0))?;
        let factor = factor as i32;
        let factor_bits = encoded.modifier + 1;
        return Ok((ArrayInstruction::MultiplyConstant { destination, source, factor, factor_bits }, 3));
    }
    encoded.no_modifier()?;
    let [value] = encoded.tail()?;
    if encoded.opcode == opcode::LOAD_CONSTANT {
        return Ok((ArrayInstruction::LoadConstant { destination, value }, 2));
    }
    let test = Test::ALL[usize::from(encoded.opcode - opcode::COMPARE_CONSTANT)];
    Ok((ArrayInstruction::CompareConstant { test, a: destination, value }, 2))
}

fn backing(encoded: &EncodedInstruction<'_>) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    if encoded.opcode == opcode::WAIT {
        must_be_zero(u32::from(encoded.modifier) | encoded.operand)?;
        return Ok((ArrayInstruction::Wait, 1));
    }
    let field = width(encoded.field()?, 32)?;
    let block = encoded.modifier;
    if block >= BACKING_BLOCKS {
        return Err(DecodeErrorKind::UnknownBlock(block));
    }
    Ok(if encoded.opcode == opcode::STORE_BLOCK {
        (ArrayInstruction::StoreBlock { field, block }, 1)
    } else {
        (ArrayInstruction::LoadBlock { field, block }, 1)
    })
}

fn output(encoded: &EncodedInstruction<'_>) -> Result<(ArrayInstruction, usize), DecodeErrorKind> {
    encoded.no_modifier()?;
    let field = width(encoded.field()?, 24)?;
    let target = target(encoded.tail()?)?;
    Ok((ArrayInstruction::Output { field, target }, 9))
}

fn target(words: [Word; 8]) -> Result<CopyTarget, DecodeErrorKind> {
    let [place, how, width, height, region_width, region_height, low, high] = words;
    // The second word holds the lines in its upper bits, and the buffer in its lowest byte.
    let lines = match how >> 8 {
        0 => Lines::Frame,
        1 => Lines::Field(FieldParity::Even),
        2 => Lines::Field(FieldParity::Odd),
        _ => return Err(DecodeErrorKind::BadTarget),
    };
    let target = CopyTarget {
        frame_buffer: NodeId((place >> 16) as u16),
        buffer: how as u8,
        lines,
        grid: RegionGrid { width, height, region_width, region_height },
        region: RegionId(place as u16),
        picture: PictureNumber::from_words(low, high),
    };
    if is_valid_target(&target) { Ok(target) } else { Err(DecodeErrorKind::BadTarget) }
}

/// Returns true if the region of `target` exists in its grid, is not larger than the array, and has coordinates of at
/// most 16 bits.
fn is_valid_target(target: &CopyTarget) -> bool {
    let grid = &target.grid;
    let picture = 1..=1 << 16;
    let region = 1..=pxpl5_wire::REGION_SIZE;
    picture.contains(&grid.width)
        && picture.contains(&grid.height)
        && region.contains(&grid.region_width)
        && region.contains(&grid.region_height)
        && u32::from(target.region.0) < grid.regions()
}
