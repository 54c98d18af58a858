//! Decoder from instruction words to [`Instruction`].

use crate::instruction::{FNOP, Flags, Instruction, Op};
use crate::syntax::register_mask;

/// A word that does not encode an instruction of the i860 XR.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0:08x} is not an i860 XR instruction")]
pub struct IllegalWord(pub u32);

const D_BIT: u32 = 1 << 9;
/// Number of epsr, the last control register of the i860 XR. The later i860 XP has more control registers: bear, ccr
/// and p0 to p3.
const LAST_XR_CONTROL_REGISTER: u8 = 5;

fn field(word: u32, low: u32) -> u8 {
    (word >> low & 31) as u8
}

fn signed16(word: u32) -> i32 {
    i32::from(word as u16 as i16)
}

fn split16(word: u32) -> i32 {
    signed16((word >> 5 & 0xF800) | (word & 0x07FF))
}

/// Decodes one instruction word. Reserved bit fields have no effect, as on the real chip.
///
/// # Errors
/// Returns [`IllegalWord`] for a reserved operation, an XP-only operation, or a precision that the operation does not
/// have.
pub fn decode(word: u32) -> Result<Instruction, IllegalWord> {
    let mut i = Instruction::new(Op::Fnop);
    i.dest = field(word, 16);
    i.src1 = field(word, 11);
    i.src2 = field(word, 21);
    // `fnop` is encoded as a core instruction.
    if word & !D_BIT == FNOP {
        i.flags = Flags(0).with(Flags::DUAL, word & D_BIT != 0);
        return Ok(i);
    }
    // The upper six bits select the group of the operation.
    match word >> 26 {
        0x12 => floating(word, i),
        0x13 => escape(word, i),
        op @ (0x00..=0x0F | 0x18 | 0x19) => memory(word, op, i),
        op @ (0x10 | 0x11 | 0x14..=0x17 | 0x1A..=0x1F | 0x2D) => control(word, op, i),
        op => integer(word, op, i),
    }
    .map(without_reserved_fields)
    .ok_or(IllegalWord(word))
}

fn without_reserved_fields(mut i: Instruction) -> Instruction {
    let mask = register_mask(&i, i.has(Flags::IMMEDIATE));
    i.dest &= field(mask, 16);
    i.src1 &= field(mask, 11);
    i.src2 &= field(mask, 21);
    i
}

fn memory(word: u32, op: u32, mut i: Instruction) -> Option<Instruction> {
    i.op = match op {
        0x00 | 0x01 => Op::LdB,
        0x02 => Op::Ixfr,
        0x03 => Op::StB,
        0x04 | 0x05 => [Op::LdS, Op::LdL][(word & 1) as usize],
        0x07 => [Op::StS, Op::StL][(word & 1) as usize],
        0x08 | 0x09 => Op::Fld,
        0x0A | 0x0B => Op::Fst,
        0x0C => Op::LdC,
        0x0D => Op::Flush,
        0x0E => Op::StC,
        0x0F => Op::Pst,
        0x18 | 0x19 => Op::Pfld,
        _ => return None,
    };
    // The offset of a store is split over two fields. In other instructions, the low bits of the offset encode the
    // size.
    let immediate = (op & 1 == 1 && op != 0x03) || matches!(op, 0x03 | 0x07);
    i.flags = i.flags.with(Flags::IMMEDIATE, immediate);
    match i.op {
        Op::Fld | Op::Fst | Op::Pfld | Op::Pst | Op::Flush => sized(word, &mut i)?,
        Op::LdB => i.imm = signed16(word),
        Op::LdS => i.imm = signed16(word) & !1,
        Op::LdL => i.imm = signed16(word) & !3,
        Op::StB => i.imm = split16(word),
        Op::StS => i.imm = split16(word) & !1,
        Op::StL => i.imm = split16(word) & !3,
        Op::LdC | Op::StC if i.src2 > LAST_XR_CONTROL_REGISTER => return None,
        _ => {}
    }
    if !immediate {
        i.imm = 0;
    }
    Some(i)
}

fn sized(word: u32, i: &mut Instruction) -> Option<()> {
    // The low bits of the offset encode auto-increment and size.
    let low = word & 7;
    i.flags = i.flags.with(Flags::AUTOINCREMENT, low & 1 != 0);
    i.size = match (low >> 1 & 1, low >> 2) {
        (1, _) => 4,
        (_, 0) => 8,
        _ => 16,
    };
    i.imm = signed16(word) & if i.size == 4 { !3 } else { !7 };
    if i.op == Op::Flush {
        i.size = 0;
        i.imm = signed16(word) & !7;
    }
    // Reject forms that the i860 XR does not have.
    let xp_only = i.op == Op::Pfld && i.size == 16;
    let not_d = i.op == Op::Pst && i.size != 8;
    (!xp_only && !not_d).then_some(())
}

fn escape(word: u32, mut i: Instruction) -> Option<Instruction> {
    i.op = match word & 31 {
        1 => Op::Lock,
        2 => Op::Calli,
        4 => Op::Intovr,
        7 => Op::Unlock,
        _ => return None,
    };
    Some(i)
}

fn control(word: u32, op: u32, mut i: Instruction) -> Option<Instruction> {
    // Offsets of br, call and the branches on CC have 26 bits.
    let long_offset = ((word << 6) as i32) >> 6;
    (i.op, i.imm) = match op {
        0x10 => (Op::Bri, 0),
        0x11 => (Op::Trap, 0),
        0x14 | 0x15 => (Op::Btne, split16(word)),
        0x16 | 0x17 => (Op::Bte, split16(word)),
        0x1A => (Op::Br, long_offset),
        0x1B => (Op::Call, long_offset),
        0x1C => (Op::Bc, long_offset),
        0x1D => (Op::BcT, long_offset),
        0x1E => (Op::Bnc, long_offset),
        0x1F => (Op::BncT, long_offset),
        _ => (Op::Bla, split16(word)),
    };
    i.flags = i.flags.with(Flags::IMMEDIATE, matches!(op, 0x15 | 0x17));
    Some(i)
}

fn integer(word: u32, op: u32, mut i: Instruction) -> Option<Instruction> {
    i.op = match op {
        0x20 | 0x21 => Op::Addu,
        0x22 | 0x23 => Op::Subu,
        0x24 | 0x25 => Op::Adds,
        0x26 | 0x27 => Op::Subs,
        0x28 | 0x29 => Op::Shl,
        0x2A | 0x2B => Op::Shr,
        0x2C => Op::Shrd,
        0x2E | 0x2F => Op::Shra,
        0x30 | 0x31 => Op::And,
        0x33 => Op::Andh,
        0x34 | 0x35 => Op::Andnot,
        0x37 => Op::Andnoth,
        0x38 | 0x39 => Op::Or,
        0x3B => Op::Orh,
        0x3C | 0x3D => Op::Xor,
        0x3F => Op::Xorh,
        _ => return None,
    };
    // Odd operation codes have an immediate. The immediate is unsigned for logical operations.
    if op & 1 == 1 {
        i.flags = i.flags.with(Flags::IMMEDIATE, true);
        i.imm = if op >= 0x30 { (word & 0xFFFF) as i32 } else { signed16(word) };
    }
    Some(i)
}

fn bit(word: u32, n: u32) -> bool {
    word >> n & 1 != 0
}

fn floating(word: u32, mut i: Instruction) -> Option<Instruction> {
    let pipelined = bit(word, 10);
    let source = bit(word, 8);
    let result = bit(word, 7);
    i.flags = Flags(0)
        .with(Flags::PIPELINED, pipelined)
        .with(Flags::DUAL, bit(word, 9))
        .with(Flags::SOURCE_DOUBLE, source)
        .with(Flags::RESULT_DOUBLE, result);
    i.op = floating_op(word & 0x7F, result)?;
    i.imm = if i.op == Op::DualOp { (word & 0x1F) as i32 } else { 0 };
    floating_is_legal(&i, pipelined, source, result).then_some(i)
}

fn floating_op(code: u32, result_double: bool) -> Option<Op> {
    Some(match code {
        0x00..=0x1F => Op::DualOp,
        0x20 => Op::Fmul,
        0x24 => Op::Fmul3,
        0x21 => Op::Fmlow,
        0x22 => Op::Frcp,
        0x23 => Op::Frsqr,
        0x30 => Op::Fadd,
        0x31 => Op::Fsub,
        0x32 => Op::Fix,
        0x33 => Op::Famov,
        0x34 if result_double => Op::Pfle,
        0x34 => Op::Pfgt,
        0x35 => Op::Pfeq,
        0x3A => Op::Ftrunc,
        0x40 => Op::Fxfr,
        0x49 => Op::Fiadd,
        0x4D => Op::Fisub,
        0x50 => Op::Faddp,
        0x51 => Op::Faddz,
        0x57 => Op::Fzchkl,
        0x5A => Op::Form,
        0x5F => Op::Fzchks,
        _ => return None,
    })
}

fn floating_is_legal(i: &Instruction, pipelined: bool, source: bool, result: bool) -> bool {
    // Only few operations have double-precision sources and a single-precision result.
    let narrowing = source && !result;
    match i.op {
        Op::Pfgt | Op::Pfle | Op::Pfeq => pipelined,
        Op::Fmul3 => pipelined && source && result,
        Op::Fix | Op::Ftrunc => result,
        Op::Fmlow => !pipelined && source && result,
        Op::Frcp | Op::Frsqr => !pipelined && !narrowing,
        Op::Fxfr => !pipelined,
        Op::Famov | Op::Faddp | Op::Faddz | Op::Fzchkl | Op::Fzchks | Op::Form => true,
        Op::Fiadd | Op::Fisub => source == result,
        Op::DualOp => !narrowing && (pipelined || i.imm & 15 != 15),
        _ => !narrowing,
    }
}
