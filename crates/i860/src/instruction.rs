//! The instruction set: operations, bit fields of instructions, and the units and registers that an operation uses.

/// The operations of the i860 XR. Precision, addressing form and pipelining are not part of the operation: they are in
/// [`Flags`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u8)]
pub enum Op {
    /// `ld.b`: loads a byte and sign-extends it to 32 bits.
    LdB,
    /// `ld.s`: loads 16 bits and sign-extends them to 32 bits.
    LdS,
    /// `ld.l`: loads 32 bits.
    LdL,
    /// `st.b`: stores the low 8 bits.
    StB,
    /// `st.s`: stores the low 16 bits.
    StS,
    /// `st.l`: stores 32 bits.
    StL,
    /// `fld`: loads one, two or four floating-point registers.
    Fld,
    /// `fst`: stores one, two or four floating-point registers.
    Fst,
    /// `pfld`: pipelined load. The destination register receives the data of the third previous `pfld`.
    Pfld,
    /// `pst`: stores the pixels whose bits in psr.PM are set.
    Pst,
    /// `ld.c`: reads a control register.
    LdC,
    /// `st.c`: writes a control register.
    StC,
    /// `ixfr`: copies an integer register to a floating-point register.
    Ixfr,
    /// `flush`: writes a dirty data-cache line back to memory.
    Flush,
    /// `trap`: takes the instruction trap.
    Trap,
    /// `lock`: begins an interlocked sequence.
    Lock,
    /// `unlock`: ends an interlocked sequence.
    Unlock,
    /// `calli`: calls the address in a register.
    Calli,
    /// `intovr`: traps if the overflow flag epsr.OF is set.
    Intovr,
    /// `bri`: branches to the address in a register.
    Bri,
    /// `bte`: branches if the operands are equal, without a delay slot.
    Bte,
    /// `btne`: branches if the operands differ, without a delay slot.
    Btne,
    /// `br`: branches unconditionally after the delay slot.
    Br,
    /// `call`: calls after the delay slot. Register r1 receives the return address.
    Call,
    /// `bc`: branches if the condition code CC is set, without a delay slot.
    Bc,
    /// `bc.t`: branches if the condition code CC is set, after the delay slot. If the branch is not taken, the delay
    /// slot is skipped.
    BcT,
    /// `bnc`: branches if the condition code CC is clear, without a delay slot.
    Bnc,
    /// `bnc.t`: branches if the condition code CC is clear, after the delay slot. If the branch is not taken, the delay
    /// slot is skipped.
    BncT,
    /// `bla`: adds two registers, and branches after the delay slot if the loop condition code LCC was set before.
    Bla,
    /// `addu`: unsigned add. The flags OF and CC receive the carry.
    Addu,
    /// `subu`: src1 - src2, unsigned. Sets CC if src2 <= src1.
    Subu,
    /// `adds`: signed add. Sets CC if src2 < -src1.
    Adds,
    /// `subs`: src1 - src2, signed. Sets CC if src2 > src1.
    Subs,
    /// `shl`: shifts left. `nop` is a `shl` whose three registers are all r0.
    Shl,
    /// `shr`: shifts right and fills with zeros, and loads the shift count psr.SC.
    Shr,
    /// `shrd`: shifts a pair of registers right by the shift count psr.SC.
    Shrd,
    /// `shra`: shifts right and fills with the sign bit.
    Shra,
    /// `and`: bitwise and. Sets CC if the result is 0.
    And,
    /// `andh`: bitwise and. An immediate is used as the high half of the operand.
    Andh,
    /// `andnot`: bitwise and with the complement of the first operand.
    Andnot,
    /// `andnoth`: bitwise and with the complement of the first operand. An immediate is used as the high half of this
    /// operand.
    Andnoth,
    /// `or`: bitwise or. Sets CC if the result is 0.
    Or,
    /// `orh`: bitwise or. An immediate is used as the high half of the operand.
    Orh,
    /// `xor`: bitwise exclusive or. Sets CC if the result is 0.
    Xor,
    /// `xorh`: bitwise exclusive or. An immediate is used as the high half of the operand.
    Xorh,
    /// `fnop`: no operation, for the floating-point half of a pair.
    Fnop,
    /// `fmul`, `pfmul`: floating-point multiply.
    Fmul,
    /// `pfmul3`: pipelined multiply of doubles through three stages. Trap handlers use this operation to refill the
    /// pipe.
    Fmul3,
    /// `fmlow`: multiplies two significands and returns the low bits of the product.
    Fmlow,
    /// `frcp`: first approximation of a reciprocal.
    Frcp,
    /// `frsqr`: first approximation of a reciprocal square root.
    Frsqr,
    /// `fadd`, `pfadd`: floating-point add.
    Fadd,
    /// `fsub`, `pfsub`: floating-point subtract.
    Fsub,
    /// `fix`: converts to an integer. The bits RM of the register fsr select the rounding.
    Fix,
    /// `famov`, `pfamov`: moves through the adder and converts the precision.
    Famov,
    /// `pfgt`: sets the condition code CC if the first operand is greater than the second.
    Pfgt,
    /// `pfle`: clears the condition code CC if the first operand is less than or equal to the second.
    Pfle,
    /// `pfeq`: sets the condition code CC if the operands are equal.
    Pfeq,
    /// `ftrunc`: converts to an integer, rounded towards zero.
    Ftrunc,
    /// `fxfr`: copies a floating-point register to an integer register.
    Fxfr,
    /// `fiadd`: adds 32-bit or 64-bit integers in the graphics unit.
    Fiadd,
    /// `fisub`: subtracts 32-bit or 64-bit integers in the graphics unit.
    Fisub,
    /// `faddp`: adds pixels and merges the sum into the register MERGE.
    Faddp,
    /// `faddz`: adds depths and merges the sum into the register MERGE.
    Faddz,
    /// `fzchkl`: compares pairs of 32-bit depths and keeps the smaller depth of each pair.
    Fzchkl,
    /// `form`: bitwise or with the register MERGE. Afterwards, MERGE is 0.
    Form,
    /// `fzchks`: compares pairs of 16-bit depths and keeps the smaller depth of each pair.
    Fzchks,
    /// `pfam`, `pfsm`, `pfmam`, `pfmsm`: dual operations. In the immediate, bit 4 selects subtraction and bits 3:0 are
    /// the bit field DPC (data-path control).
    DualOp,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub struct Flags(pub u8);

impl Flags {
    /// The first source is an immediate.
    pub const IMMEDIATE: Flags = Flags(1);
    /// The base register receives the effective address (auto-increment).
    pub const AUTOINCREMENT: Flags = Flags(2);
    /// The operation is pipelined. In dual operations, the flag selects `pfam` and `pfsm` instead of `pfmam` and
    /// `pfmsm`.
    pub const PIPELINED: Flags = Flags(4);
    /// The D bit, which starts and continues dual-instruction mode.
    pub const DUAL: Flags = Flags(8);
    /// The S bit: the sources are in double precision.
    pub const SOURCE_DOUBLE: Flags = Flags(16);
    /// The R bit: the result is in double precision.
    pub const RESULT_DOUBLE: Flags = Flags(32);

    pub fn has(self, other: Flags) -> bool {
        self.0 & other.0 == other.0
    }

    /// Returns the union of this set and `other` if `condition` is true, otherwise this set.
    pub fn with(self, other: Flags, condition: bool) -> Flags {
        Flags(self.0 | if condition { other.0 } else { 0 })
    }
}

/// One decoded instruction.
///
/// `op` determines the register file. A store of an integer register stores register `src1`, and `fst` and `pst` store
/// register `dest`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Instruction {
    pub op: Op,
    /// Destination: a register number from 0 to 31. The operation determines the register file.
    pub dest: u8,
    /// Register number of the first source. (For ld.c and st.c, `src2` selects the control register.)
    pub src1: u8,
    /// Register number of the second source, or of the base of an address.
    pub src2: u8,
    /// Operand size in bytes for floating-point loads and stores, 0 for other operations.
    pub size: u8,
    pub flags: Flags,
    /// Immediate, address displacement in bytes, or branch offset in words.
    pub imm: i32,
}

impl Instruction {
    /// Makes an instruction whose operands and flags are all zero.
    pub fn new(op: Op) -> Instruction {
        Instruction { op, dest: 0, src1: 0, src2: 0, size: 0, flags: Flags(0), imm: 0 }
    }

    pub fn has(&self, flags: Flags) -> bool {
        self.flags.has(flags)
    }

    /// Returns true if the operation belongs in the floating-point half of a pair.
    pub fn is_floating(&self) -> bool {
        self.op >= Op::Fnop
    }

    /// Returns true if the operation is a branch with a delay slot. Such a branch takes effect after the next
    /// instruction or pair.
    pub fn is_delayed_branch(&self) -> bool {
        use Op::{BcT, Bla, BncT, Br, Bri, Call, Calli};
        matches!(self.op, Br | Call | Bri | Calli | Bla | BcT | BncT)
    }

    /// Returns true if the operation is a branch, call or jump, with or without a delay slot.
    pub fn is_branch(&self) -> bool {
        self.is_delayed_branch() || matches!(self.op, Op::Bc | Op::Bnc | Op::Bte | Op::Btne)
    }

    /// Returns true if the operation sets psr.CC.
    pub fn sets_condition(&self) -> bool {
        use Op::{Addu, And, Andh, Andnot, Andnoth, Or, Orh, Pfeq, Pfgt, Pfle, Subs, Subu, Xor, Xorh};
        let logical = matches!(self.op, And | Andh | Andnot | Andnoth | Or | Orh | Xor | Xorh);
        logical || matches!(self.op, Addu | Subu | Op::Adds | Subs | Pfgt | Pfle | Pfeq)
    }

    pub fn uses_multiplier(&self) -> bool {
        matches!(self.op, Op::Fmul | Op::Fmul3 | Op::Fmlow | Op::Frcp | Op::Frsqr | Op::DualOp)
    }

    pub fn uses_adder(&self) -> bool {
        use Op::{DualOp, Fadd, Famov, Fix, Fsub, Ftrunc, Pfeq, Pfgt, Pfle};
        matches!(self.op, Fadd | Fsub | Fix | Famov | Pfgt | Pfle | Pfeq | Ftrunc | DualOp)
    }

    /// Returns true if the operation belongs to the graphics unit, like `fxfr`.
    pub fn uses_graphics(&self) -> bool {
        self.op >= Op::Fxfr && self.op < Op::DualOp
    }
}

/// Encoding of `fnop`, which is a `shrd` whose registers are all r0. Bit 9 is the D bit.
pub(crate) const FNOP: u32 = 0xB000_0000;
