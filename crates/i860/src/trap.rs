//! Causes of traps, and reasons why a run of a program ends.

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum TrapCause {
    /// A word that does not encode an XR instruction.
    #[error("{word:08x} is not an i860 XR instruction")]
    Illegal { word: u32 },
    /// A pair that does not consist of a floating-point instruction and then a core instruction.
    #[error("a pair must be one floating-point and one core instruction")]
    IllegalPair,
    /// A branch in a delay slot (undefined on the real chip).
    #[error("branch in a delay slot")]
    BranchInSlot,
    /// A jump in dual-instruction mode to an address that is not a multiple of 8 (undefined on the real chip).
    #[error("dual-instruction mode needs a multiple of 8")]
    PairAlignment,
    /// The instruction `trap` was executed.
    #[error("trap instruction")]
    Instruction,
    /// The instruction `intovr` was executed while the overflow flag epsr.OF was set.
    #[error("intovr with OF set")]
    Overflow,
    /// A fetch from an address at which no memory answers.
    #[error("no memory to fetch an instruction from")]
    InstructionAccess,
    /// A load or store at an address at which no memory or device answers.
    #[error("no memory at {address:#010x}")]
    DataAccess { address: u32 },
    /// A load or store at an address that is not a multiple of the access size.
    #[error("{address:#010x} is not a multiple of {size}")]
    Unaligned { address: u32, size: u32 },
    /// The interrupt pin was raised while psr.IM was set.
    #[error("interrupt")]
    Interrupt,
}

/// A trap that was taken. Register fir contains `pc`, and psr contains the trap bit, PU, PIM, DIM and DS. The next
/// instruction is the first instruction of the trap handler, at [`TRAP_VECTOR`](crate::state::TRAP_VECTOR).
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("trap at {pc:#010x}: {cause}")]
pub struct Trap {
    pub cause: TrapCause,
    /// Address of the instruction or pair that trapped and had no effect. If it was in a delay slot, the branch has
    /// already changed registers, as on the real chip: r1 for a call, LCC and the counter for `bla`.
    pub pc: u32,
}

/// The reason why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RunEnd {
    /// The stop address was reached in single-instruction mode. The instruction at this address was not executed.
    Stopped,
    Trapped(Trap),
    /// The run has executed its budget of instructions.
    Exhausted,
}
