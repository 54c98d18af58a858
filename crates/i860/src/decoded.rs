//! Decoded instructions, with the properties that the timing model needs.

use crate::dual_operation::source_widths;
use crate::instruction::{Flags, Instruction, Op};

/// Classes of hazards that can delay an instruction, one bit each.
pub(crate) mod hazard {
    pub(crate) const SCALAR: u16 = 1 << 0;
    pub(crate) const DOUBLE_MULTIPLY: u16 = 1 << 1;
    pub(crate) const CONDITION: u16 = 1 << 2;
    pub(crate) const TRANSFER_IN_MISS: u16 = 1 << 3;
    pub(crate) const ACCESS_IN_MISS: u16 = 1 << 4;
    pub(crate) const STORE_HIT: u16 = 1 << 5;
    pub(crate) const GRAPHICS: u16 = 1 << 6;
    pub(crate) const FLUSH: u16 = 1 << 7;
    pub(crate) const STORED: u16 = 1 << 8;
    pub(crate) const COUNT: usize = 9;
}

/// Classes of hazards that an instruction can cause for later instructions, one bit each.
pub(crate) mod arm {
    pub(crate) const LOAD: u16 = 1 << 0;
    pub(crate) const LONG_LOAD: u16 = 1 << 1;
    pub(crate) const CONDITION: u16 = 1 << 2;
    pub(crate) const LOGICAL: u16 = 1 << 3;
    pub(crate) const SCALAR: u16 = 1 << 4;
    pub(crate) const SCALAR_DOUBLE_MULTIPLY: u16 = 1 << 5;
    pub(crate) const DOUBLE_MULTIPLY: u16 = 1 << 6;
    pub(crate) const GRAPHICS: u16 = 1 << 7;
    pub(crate) const FLUSH: u16 = 1 << 8;
    pub(crate) const STORED: u16 = 1 << 9;
    pub(crate) const SEED: u16 = 1 << 10;
    pub(crate) const FLOATING_RESULT: u16 = 1 << 11;
}

/// Register number of an absent operand.
pub(crate) const NONE: u8 = 0xFF;

#[derive(Clone, Copy, Debug)]
pub(crate) struct Decoded {
    pub(crate) reads: u64,
    pub(crate) instruction: Instruction,
    pub(crate) sensitive: u16,
    pub(crate) arms: u16,
    /// First source register if the multiplier reads this register, otherwise [`NONE`].
    pub(crate) multiplier_source: u8,
    marks: u8,
}

/// Bits of `Decoded::marks`. Each bit is one property of the instruction.
mod mark {
    pub(super) const FLOATING: u8 = 1 << 0;
    pub(super) const BRANCH: u8 = 1 << 1;
    pub(super) const DUAL: u8 = 1 << 2;
    pub(super) const FIRST_DOUBLE: u8 = 1 << 3;
    pub(super) const SECOND_DOUBLE: u8 = 1 << 4;
    pub(super) const MAY_BYPASS: u8 = 1 << 5;
    pub(super) const ACCESSES: u8 = 1 << 6;
}

impl Decoded {
    pub(crate) fn new(instruction: Instruction) -> Decoded {
        let i = &instruction;
        Decoded {
            reads: reads(i) & !(1 | 3 << 32),
            instruction,
            sensitive: sensitive(i),
            arms: arms(i),
            multiplier_source: multiplier_source(i),
            marks: marks(i),
        }
    }

    #[inline]
    pub(crate) fn is_floating(&self) -> bool {
        self.marks & mark::FLOATING != 0
    }

    #[inline]
    pub(crate) fn is_branch(&self) -> bool {
        self.marks & mark::BRANCH != 0
    }

    /// Returns true if the instruction has no visible effect: `fnop`, or a shift into r0 that loads no shift count.
    /// `nop` is such a shift.
    pub(crate) fn is_idle(&self) -> bool {
        let Instruction { op, dest, .. } = self.instruction;
        op == Op::Fnop || dest == 0 && matches!(op, Op::Shl | Op::Shra | Op::Shrd)
    }

    #[inline]
    pub(crate) fn dual(&self) -> bool {
        self.marks & mark::DUAL != 0
    }

    /// Returns true if the instruction accesses data, branches or is `st.c`. The clocks of these instructions depend on
    /// their execution, for example on an address or on a taken branch.
    #[inline]
    pub(crate) fn affects_clock(&self) -> bool {
        self.marks & (mark::ACCESSES | mark::BRANCH) != 0
    }

    /// Returns, for the first and the second source, true if the source is a double-precision number in a pair of
    /// registers.
    #[inline]
    pub(crate) fn source_widths(&self) -> (bool, bool) {
        (self.marks & mark::FIRST_DOUBLE != 0, self.marks & mark::SECOND_DOUBLE != 0)
    }

    /// Returns true if a pipelined operation can have the same register as source and destination. It then reads the
    /// result that leaves the pipe in the same clock.
    #[inline]
    pub(crate) fn may_bypass(&self) -> bool {
        self.marks & mark::MAY_BYPASS != 0
    }
}

fn on(bit: u8, condition: bool) -> u8 {
    if condition { bit } else { 0 }
}

fn marks(i: &Instruction) -> u8 {
    let floating = i.is_floating();
    let (first, second) = source_widths(i);
    let pipelined = i.op == Op::DualOp || i.has(Flags::PIPELINED);
    // Compare register pairs, because doubles occupy two registers.
    let overlaps = i.dest >= 2 && [i.src1, i.src2].iter().any(|n| n & 30 == i.dest & 30);
    on(mark::FLOATING, floating)
        | on(mark::BRANCH, i.is_branch())
        | on(mark::DUAL, floating && i.has(Flags::DUAL))
        | on(mark::FIRST_DOUBLE, floating && first)
        | on(mark::SECOND_DOUBLE, floating && second)
        | on(mark::MAY_BYPASS, floating && pipelined && overlaps)
        | on(mark::ACCESSES, i.op <= Op::Pst || matches!(i.op, Op::Flush | Op::StC))
}

/// Returns the mask of the floating-point registers that hold `bytes` bytes, from register `n` on.
pub(crate) fn float_mask(n: u8, bytes: u8) -> u64 {
    let n = u32::from(n);
    let low = match bytes {
        16 => 15 << (n & 28),
        8 => 3 << (n & 30),
        _ => 1 << n,
    };
    low << 32
}

fn reads(i: &Instruction) -> u64 {
    if i.is_floating() {
        return floating_reads(i);
    }
    let a = 1u64 << i.src1;
    let b = 1u64 << i.src2;
    let first = if i.has(Flags::IMMEDIATE) { 0 } else { a };
    match i.op {
        Op::StB | Op::StS | Op::StL | Op::Bla => a | b,
        Op::Fst | Op::Pst => first | b | float_mask(i.dest, i.size),
        Op::Bri | Op::Calli | Op::Ixfr | Op::StC => a,
        Op::LdC | Op::Br | Op::Call | Op::Bc | Op::BcT | Op::Bnc | Op::BncT => 0,
        Op::Lock | Op::Unlock | Op::Intovr | Op::Trap => 0,
        _ => first | b,
    }
}

fn bytes_of(double: bool) -> u8 {
    if double { 8 } else { 4 }
}

fn floating_reads(i: &Instruction) -> u64 {
    let s = i.has(Flags::SOURCE_DOUBLE);
    let a = float_mask(i.src1, bytes_of(s));
    let b = float_mask(i.src2, bytes_of(s));
    match i.op {
        Op::Fnop => 0,
        Op::Frcp | Op::Frsqr => b,
        Op::Fix | Op::Ftrunc | Op::Famov | Op::Form => a,
        Op::Fxfr => float_mask(i.src1, 4),
        Op::DualOp => {
            let (first, second) = source_widths(i);
            float_mask(i.src1, bytes_of(first)) | float_mask(i.src2, bytes_of(second))
        }
        _ => a | b,
    }
}

fn sensitive(i: &Instruction) -> u16 {
    use Op::{
        Bc, BcT, Bnc, BncT, Call, Calli, Fld, Flush, Fst, Ixfr, LdB, LdC, LdL, LdS, Pfld, Pst, StB, StC, StL, StS,
    };
    match i.op {
        Op::Fnop => 0,
        _ if i.is_floating() => floating_sensitive(i),
        Bc | BcT | Bnc | BncT => hazard::CONDITION,
        Call | Calli | Ixfr | LdC | StC => hazard::TRANSFER_IN_MISS,
        LdB | LdS | LdL | Fld => hazard::ACCESS_IN_MISS | hazard::STORE_HIT,
        Fst | Pst => hazard::ACCESS_IN_MISS | hazard::SCALAR,
        StB | StS | StL | Pfld => hazard::ACCESS_IN_MISS,
        Flush => hazard::ACCESS_IN_MISS | hazard::FLUSH,
        _ => 0,
    }
}

fn floating_sensitive(i: &Instruction) -> u16 {
    let mut bits = hazard::SCALAR | hazard::GRAPHICS;
    if i.uses_multiplier() {
        bits |= hazard::DOUBLE_MULTIPLY;
    }
    if i.has(Flags::PIPELINED) || i.op == Op::DualOp {
        bits |= hazard::STORED;
    }
    if i.op == Op::Fxfr { bits | hazard::TRANSFER_IN_MISS } else { bits }
}

fn arms(i: &Instruction) -> u16 {
    use Op::{Adds, Addu, Call, Calli, Fld, Flush, Fst, Fxfr, Ixfr, LdB, LdC, LdL, LdS, Pfld, Pst, Subs, Subu};
    match i.op {
        LdB | LdS | LdL | LdC | Call | Calli => arm::LOAD,
        Fld | Pfld | Ixfr => arm::LONG_LOAD,
        Addu | Adds | Subu | Subs => arm::CONDITION,
        Fst | Pst => arm::STORED,
        Flush => arm::FLUSH,
        Fxfr => arm::LOAD,
        Op::Fnop => 0,
        _ if i.is_floating() => floating_arms(i),
        _ if i.sets_condition() => arm::LOGICAL,
        _ => 0,
    }
}

fn floating_arms(i: &Instruction) -> u16 {
    let pipelined = i.has(Flags::PIPELINED) || i.op == Op::DualOp;
    let double = i.has(Flags::SOURCE_DOUBLE);
    // f0 and f1 cannot be written, so no later instruction waits for them.
    let mut bits = if i.dest < 2 { 0 } else { arm::FLOATING_RESULT };
    bits |= match i.op {
        Op::Frcp | Op::Frsqr => arm::SEED,
        Op::Pfgt | Op::Pfle | Op::Pfeq => arm::CONDITION,
        Op::Fmul if double && !pipelined => arm::SCALAR_DOUBLE_MULTIPLY,
        _ if i.uses_graphics() => arm::GRAPHICS,
        _ if !pipelined => arm::SCALAR,
        _ => 0,
    };
    // Row 11: a double-precision multiplication delays the next multiplication, also in a dual operation.
    if double && matches!(i.op, Op::Fmul | Op::Fmul3 | Op::Fmlow | Op::DualOp) {
        bits | arm::DOUBLE_MULTIPLY
    } else {
        bits
    }
}

/// Returns the value of [`Decoded::multiplier_source`]. In four of the sixteen data paths of dual operations, the first
/// source goes to the multiplier.
fn multiplier_source(i: &Instruction) -> u8 {
    // Row 9 applies only to operations whose first source goes to the multiplier.
    let reads_first = match i.op {
        Op::Fmul | Op::Fmul3 | Op::Fmlow => true,
        Op::DualOp => matches!(i.imm & 15, 9 | 11 | 13 | 15),
        _ => false,
    };
    if !reads_first || i.src1 < 2 {
        return NONE;
    }
    if i.has(Flags::SOURCE_DOUBLE) { i.src1 & 30 } else { i.src1 }
}
