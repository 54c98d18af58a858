//! The instruction set as a type: operation, fields, and what each operation touches.

/// Every operation of the XR part. Precision, addressing form and pipelining are in [`Flags`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Op {
    /// Load byte, sign extended.
    LdB,
    /// Load 16 bits, sign extended.
    LdS,
    /// `ld.l`: load 32 bits.
    LdL,
    /// `st.b`: store the low 8 bits.
    StB,
    /// `st.s`: store the low 16 bits.
    StS,
    /// `st.l`: store 32 bits.
    StL,
    /// Load one, two or four floating-point registers.
    Fld,
    /// Store one, two or four floating-point registers.
    Fst,
    /// Pipelined load: the result of the third `pfld` before this one arrives.
    Pfld,
    /// Store the pixels selected by psr.PM.
    Pst,
    /// Read a control register.
    LdC,
    /// Write a control register.
    StC,
    /// Integer register to floating-point register.
    Ixfr,
    /// Write back a data-cache line.
    Flush,
    /// `trap`: take the instruction trap.
    Trap,
    /// Begin an interlocked sequence.
    Lock,
    /// End an interlocked sequence.
    Unlock,
    /// Call through a register.
    Calli,
    /// Trap when epsr.OF is set.
    Intovr,
    /// Branch through a register.
    Bri,
    /// Branch if equal, no delay slot.
    Bte,
    /// Branch if not equal, no delay slot.
    Btne,
    /// `br`: branch after the slot.
    Br,
    /// Call, delayed; r1 receives the return address.
    Call,
    /// `bc`: branch if CC is set, without a slot.
    Bc,
    /// Branch if CC, delayed; skips the slot when not taken.
    BcT,
    /// Branch if not CC.
    Bnc,
    /// Branch if not CC, delayed; skips the slot when not taken.
    BncT,
    /// Branch on LCC and add, delayed.
    Bla,
    /// `addu`: add; OF and CC are the carry.
    Addu,
    /// `subu`: src1 - src2; CC says src2 <= src1.
    Subu,
    /// `adds`: add; CC says src2 < -src1.
    Adds,
    /// `subs`: src1 - src2; CC says src2 > src1.
    Subs,
    /// `shl`: shift left; r0 by r0 is `nop`.
    Shl,
    /// Shift right logical; loads psr.SC.
    Shr,
    /// Double shift right by psr.SC.
    Shrd,
    /// `shra`: shift right, the sign kept.
    Shra,
    /// `and`: bitwise and; CC says that nothing is left.
    And,
    /// And with the immediate in the high half.
    Andh,
    /// And with the complement of the first operand.
    Andnot,
    /// The same with the immediate in the high half.
    Andnoth,
    /// `or`: bitwise or; CC says that the result is 0.
    Or,
    /// Or with the immediate in the high half.
    Orh,
    /// `xor`: bitwise exclusive or; CC says that the result is 0.
    Xor,
    /// Exclusive or with the immediate in the high half.
    Xorh,
    /// No operation of the floating-point half of a pair.
    Fnop,
    /// `fmul`, `pfmul`: floating-point multiply.
    Fmul,
    /// `pfmul3`: pipelined multiply of doubles through three stages, for handlers that fill a pipe again.
    Fmul3,
    /// Low bits of the product of two significands.
    Fmlow,
    /// `frcp`: first approximation of a reciprocal.
    Frcp,
    /// `frsqr`: first approximation of a reciprocal root.
    Frsqr,
    /// `fadd`, `pfadd`: floating-point add.
    Fadd,
    /// `fsub`, `pfsub`: floating-point subtract.
    Fsub,
    /// `fix`: to an integer, rounded as fsr.RM says.
    Fix,
    /// Adder move, converts precision.
    Famov,
    /// Compare greater, sets CC.
    Pfgt,
    /// Compare less or equal, clears CC when it holds.
    Pfle,
    /// Compare equal, sets CC.
    Pfeq,
    /// To integer, towards zero.
    Ftrunc,
    /// Floating-point register to integer register.
    Fxfr,
    /// Long-integer add in the graphics unit.
    Fiadd,
    /// Long-integer subtract in the graphics unit.
    Fisub,
    /// Add with pixel merge.
    Faddp,
    /// Add with Z merge.
    Faddz,
    /// `fzchkl`: compare two 32-bit depths, keep the smaller.
    Fzchkl,
    /// `form`: or with MERGE, which becomes 0.
    Form,
    /// `fzchks`: compare four 16-bit depths, keep the smaller.
    Fzchks,
    /// Dual operation (pfam, pfsm, pfmam, pfmsm); the immediate holds bit 4 = subtract, bits 3:0 = DPC.
    DualOp,
}

/// Modifier bits of an instruction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Flags(pub u8);

impl Flags {
    /// The first source is an immediate.
    pub const IMMEDIATE: Flags = Flags(1);
    /// The base register receives the effective address.
    pub const AUTOINCREMENT: Flags = Flags(2);
    /// Pipelined form (for a dual operation: pfam/pfsm rather than pfmam/pfmsm).
    pub const PIPELINED: Flags = Flags(4);
    /// The D bit, which begins and keeps up dual-instruction mode.
    pub const DUAL: Flags = Flags(8);
    /// The S bit: sources are double-precision.
    pub const SOURCE_DOUBLE: Flags = Flags(16);
    /// The R bit: the result is double-precision.
    pub const RESULT_DOUBLE: Flags = Flags(32);

    /// Whether all bits of `other` are set.
    #[must_use]
    pub fn has(self, other: Flags) -> bool {
        self.0 & other.0 == other.0
    }

    /// The union of two sets when `condition` holds, else `self`.
    #[must_use]
    pub fn with(self, other: Flags, condition: bool) -> Flags {
        Flags(self.0 | if condition { other.0 } else { 0 })
    }
}

/// One decoded instruction.
///
/// `dest`, `src1`, `src2` are register numbers 0..=31 as encoded; which file they name follows from `op`. For stores
/// of integer registers the stored register is `src1`, for `fst`/`pst` it is `dest`. `imm` holds the immediate, the
/// displacement in bytes, or for branches the offset in words. `size` is the operand size in bytes of fld, fst, pfld
/// and pst (0 for the rest).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Instruction {
    /// Which operation, in all its forms.
    pub op: Op,
    /// Number of the destination register, r or f.
    pub dest: u8,
    /// First source register (control register for ld.c and st.c is `src2`).
    pub src1: u8,
    /// Second source register, the base of an address.
    pub src2: u8,
    /// Operand size in bytes of floating-point loads and stores.
    pub size: u8,
    /// Precision, pipe and addressing bits.
    pub flags: Flags,
    /// Immediate, displacement in bytes, or branch offset in words.
    pub imm: i32,
}

impl Instruction {
    /// An instruction with all fields zero.
    #[must_use]
    pub fn new(op: Op) -> Instruction {
        Instruction { op, dest: 0, src1: 0, src2: 0, size: 0, flags: Flags(0), imm: 0 }
    }

    /// Whether modifier bits are set.
    #[must_use]
    pub fn has(&self, flags: Flags) -> bool {
        self.flags.has(flags)
    }

    /// Whether the operation goes to the floating-point half of a pair.
    #[must_use]
    pub fn is_floating(&self) -> bool {
        self.op >= Op::Fnop
    }

    /// Whether the operation transfers control after the next instruction or pair.
    #[must_use]
    pub fn is_delayed_branch(&self) -> bool {
        use Op::{BcT, Bla, BncT, Br, Bri, Call, Calli};
        matches!(self.op, Br | Call | Bri | Calli | Bla | BcT | BncT)
    }

    /// Whether the operation transfers control.
    #[must_use]
    pub fn is_branch(&self) -> bool {
        self.is_delayed_branch() || matches!(self.op, Op::Bc | Op::Bnc | Op::Bte | Op::Btne)
    }

    /// Whether the operation sets psr.CC.
    #[must_use]
    pub fn sets_condition(&self) -> bool {
        use Op::{Addu, And, Andh, Andnot, Andnoth, Or, Orh, Pfeq, Pfgt, Pfle, Subs, Subu, Xor, Xorh};
        let logical = matches!(self.op, And | Andh | Andnot | Andnoth | Or | Orh | Xor | Xorh);
        logical || matches!(self.op, Addu | Subu | Op::Adds | Subs | Pfgt | Pfle | Pfeq)
    }

    /// Whether the operation uses the multiplier.
    #[must_use]
    pub fn uses_multiplier(&self) -> bool {
        matches!(self.op, Op::Fmul | Op::Fmul3 | Op::Fmlow | Op::Frcp | Op::Frsqr | Op::DualOp)
    }

    /// Whether the operation uses the adder.
    #[must_use]
    pub fn uses_adder(&self) -> bool {
        use Op::{DualOp, Fadd, Famov, Fix, Fsub, Ftrunc, Pfeq, Pfgt, Pfle};
        matches!(self.op, Fadd | Fsub | Fix | Famov | Pfgt | Pfle | Pfeq | Ftrunc | DualOp)
    }

    /// Whether the operation belongs to the graphics unit (`fxfr` is handled there too).
    #[must_use]
    pub fn uses_graphics(&self) -> bool {
        self.op >= Op::Fxfr && self.op < Op::DualOp
    }
}

/// `fnop`, the shrd of three r0; bit 9 is its D bit.
pub(crate) const FNOP: u32 = 0xB000_0000;
