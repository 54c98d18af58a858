//! The operands of each kind of instruction: their form in assembler text, and their bit fields in the instruction
//! word.

use crate::instruction::{Instruction, Op};

/// Operands of an instruction, in the order of assembler text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Syntax {
    Bare,
    /// `src1 or immediate, src2, dest`: an integer operation.
    Integer,
    /// `address, dest`: a load into an integer register.
    Load,
    /// `src1, address`: a store from an integer register.
    Store,
    /// `address, fdest`: a load into floating-point registers. The address can have auto-increment, `++`.
    FloatingLoad,
    /// `fdest, address`: a store from floating-point registers. The address can have auto-increment, `++`.
    FloatingStore,
    /// `control, dest`: a read of a control register.
    LoadControl,
    /// `src1, control`: a write of a control register.
    StoreControl,
    /// `src1, fdest`: copies an integer register to a floating-point register.
    ToFloating,
    /// `fsrc1, dest`: copies a floating-point register to an integer register.
    ToInteger,
    /// `address`: the only operand of `flush`. The address can have auto-increment, `++`.
    Flush,
    /// `src1, src2, dest`: the operands of `trap`, which can be left out.
    Trap,
    /// `src1`: one integer register, such as the target address of `bri`.
    Register,
    /// `target`: a label or an address as the branch target.
    Branch,
    /// `src1 or 5-bit constant, src2, target`: a compare-and-branch.
    CompareBranch,
    /// `src1, src2, target`: two integer registers and a branch target.
    LoopBranch,
    /// `fsrc1, fsrc2, fdest`: two floating-point sources and a destination.
    Three,
    /// `fsrc1, fdest`: a single source in the first bit field, and a destination.
    First,
    /// `fsrc2, fdest`: a single source in the second bit field, and a destination.
    Second,
}

impl Syntax {
    pub(crate) fn from_op(op: Op) -> Syntax {
        use Op::{Bc, BcT, Bnc, BncT, Br, Bri, Bte, Btne, Call, Calli, LdB, LdC, LdL, LdS, Pfld, StB, StC, StL, StS};
        match op {
            Op::Lock | Op::Unlock | Op::Intovr | Op::Fnop => Syntax::Bare,
            LdB | LdS | LdL => Syntax::Load,
            StB | StS | StL => Syntax::Store,
            Op::Fld | Pfld => Syntax::FloatingLoad,
            Op::Fst | Op::Pst => Syntax::FloatingStore,
            LdC => Syntax::LoadControl,
            StC => Syntax::StoreControl,
            Op::Ixfr => Syntax::ToFloating,
            Op::Fxfr => Syntax::ToInteger,
            Op::Flush => Syntax::Flush,
            Op::Trap => Syntax::Trap,
            Bri | Calli => Syntax::Register,
            Br | Call | Bc | BcT | Bnc | BncT => Syntax::Branch,
            Bte | Btne => Syntax::CompareBranch,
            Op::Bla => Syntax::LoopBranch,
            Op::Frcp | Op::Frsqr => Syntax::Second,
            Op::Fix | Op::Ftrunc | Op::Famov | Op::Form => Syntax::First,
            _ if op > Op::Fnop => Syntax::Three,
            _ => Syntax::Integer,
        }
    }
}

pub(crate) const CONTROL_REGISTERS: [&str; 6] = ["fir", "psr", "dirbase", "db", "fsr", "epsr"];

/// Returns the mask of the register bit fields that the instruction `i` uses in its word.
pub(crate) fn register_mask(i: &Instruction, immediate: bool) -> u32 {
    const SRC2: u32 = 31 << 21;
    const DEST: u32 = 31 << 16;
    const SRC1: u32 = 31 << 11;
    let first = if immediate { 0 } else { SRC1 };
    match Syntax::from_op(i.op) {
        Syntax::Bare | Syntax::Branch => 0,
        Syntax::Store | Syntax::CompareBranch | Syntax::LoopBranch | Syntax::StoreControl => SRC2 | SRC1,
        Syntax::LoadControl | Syntax::Second => SRC2 | DEST,
        Syntax::Flush => SRC2,
        Syntax::Register => SRC1,
        Syntax::ToFloating | Syntax::ToInteger | Syntax::First => SRC1 | DEST,
        Syntax::Trap | Syntax::Three => SRC2 | DEST | SRC1,
        Syntax::Integer | Syntax::Load | Syntax::FloatingLoad | Syntax::FloatingStore => SRC2 | DEST | first,
    }
}
