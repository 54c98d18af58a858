//! Encoder from [`Instruction`] to instruction words, the inverse of [`decode`](crate::decode()).

use crate::instruction::{FNOP, Flags, Instruction, Op};
use crate::syntax::register_mask;

fn join16(imm: i32) -> u32 {
    let offset = imm as u32;
    (offset & 0xF800) << 5 | (offset & 0x07FF)
}

/// Encodes an instruction. All bit fields must be in range, as they are after [`decode`](crate::decode()) and in the
/// assembler.
pub fn encode(i: &Instruction) -> u32 {
    // Registers have fixed fields. Unused fields stay zero.
    let registers = u32::from(i.src2) << 21 | u32::from(i.dest) << 16 | u32::from(i.src1) << 11;
    if i.op == Op::Fnop {
        return FNOP | u32::from(i.has(Flags::DUAL)) << 9;
    }
    if i.is_floating() {
        return 0x12 << 26 | floating_code(i) | registers & register_mask(i, false);
    }
    let immediate = u32::from(i.has(Flags::IMMEDIATE));
    let (code, low) = core_code(i, immediate);
    code << 26 | low | registers & register_mask(i, immediate != 0)
}

fn core_code(i: &Instruction, immediate: u32) -> (u32, u32) {
    let low16 = i.imm as u32 & 0xFFFF;
    match i.op {
        Op::LdB => (immediate, low16),
        Op::LdS => (0x04 | immediate, low16 & !1),
        Op::LdL => (0x04 | immediate, low16 & !3 | 1),
        Op::StB => (0x03, join16(i.imm)),
        Op::StS => (0x07, join16(i.imm & !1)),
        Op::StL => (0x07, join16(i.imm & !3 | 1)),
        Op::Fld => (0x08 | immediate, low16 | size_bits(i)),
        Op::Fst => (0x0A | immediate, low16 | size_bits(i)),
        Op::Pfld => (0x18 | immediate, low16 | size_bits(i)),
        Op::Pst => (0x0F, low16 | size_bits(i)),
        // Bit 2 is part of the opcode.
        Op::Flush => (0x0D, low16 & !7 | 4 | u32::from(i.has(Flags::AUTOINCREMENT))),
        Op::LdC => (0x0C, 0),
        Op::StC => (0x0E, 0),
        Op::Ixfr => (0x02, 0),
        Op::Lock => (0x13, 1),
        Op::Calli => (0x13, 2),
        Op::Intovr => (0x13, 4),
        Op::Unlock => (0x13, 7),
        Op::Trap => (0x11, 0),
        _ if i.is_branch() => branch_code(i, immediate),
        _ => (integer_code(i.op) | immediate, low16),
    }
}

fn size_bits(i: &Instruction) -> u32 {
    let size = match i.size {
        4 => 2,
        8 => 0,
        _ => 4,
    };
    size | u32::from(i.has(Flags::AUTOINCREMENT))
}

fn branch_code(i: &Instruction, immediate: u32) -> (u32, u32) {
    let long_offset = i.imm as u32 & 0x03FF_FFFF;
    match i.op {
        Op::Bri => (0x10, 0),
        Op::Btne => (0x14 | immediate, join16(i.imm)),
        Op::Bte => (0x16 | immediate, join16(i.imm)),
        Op::Br => (0x1A, long_offset),
        Op::Call => (0x1B, long_offset),
        Op::Bc => (0x1C, long_offset),
        Op::BcT => (0x1D, long_offset),
        Op::Bnc => (0x1E, long_offset),
        Op::BncT => (0x1F, long_offset),
        _ => (0x2D, join16(i.imm)),
    }
}

fn integer_code(op: Op) -> u32 {
    match op {
        Op::Addu => 0x20,
        Op::Subu => 0x22,
        Op::Adds => 0x24,
        Op::Subs => 0x26,
        Op::Shl => 0x28,
        Op::Shr => 0x2A,
        Op::Shrd => 0x2C,
        Op::Shra => 0x2E,
        Op::And => 0x30,
        Op::Andh => 0x32,
        Op::Andnot => 0x34,
        Op::Andnoth => 0x36,
        Op::Or => 0x38,
        Op::Orh => 0x3A,
        Op::Xor => 0x3C,
        _ => 0x3E,
    }
}

fn floating_code(i: &Instruction) -> u32 {
    let code = match i.op {
        Op::DualOp => i.imm as u32 & 0x1F,
        Op::Fmul => 0x20,
        Op::Fmul3 => 0x24,
        Op::Fmlow => 0x21,
        Op::Frcp => 0x22,
        Op::Frsqr => 0x23,
        Op::Fadd => 0x30,
        Op::Fsub => 0x31,
        Op::Fix => 0x32,
        Op::Famov => 0x33,
        Op::Pfgt | Op::Pfle => 0x34,
        Op::Pfeq => 0x35,
        Op::Ftrunc => 0x3A,
        Op::Fxfr => 0x40,
        Op::Fiadd => 0x49,
        Op::Fisub => 0x4D,
        Op::Faddp => 0x50,
        Op::Faddz => 0x51,
        Op::Fzchkl => 0x57,
        Op::Form => 0x5A,
        _ => 0x5F,
    };
    let bits = [(Flags::PIPELINED, 10), (Flags::DUAL, 9), (Flags::SOURCE_DOUBLE, 8), (Flags::RESULT_DOUBLE, 7)];
    bits.into_iter().fold(code, |code, (flag, bit)| code | u32::from(i.has(flag)) << bit)
}
