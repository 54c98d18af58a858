//! Effects of instructions and pairs. A pair is a floating-point and a core instruction that execute together. Each
//! effect is chosen once, at decoding, so execution does not need the instruction bits again.

use crate::decoded::Decoded;
use crate::dual_operation::source_widths;
use crate::instruction::{Flags, Instruction, Op};

/// The effect of a core instruction: a load, a store or an integer operation. Branches and control-register moves have
/// no such effect, because the processor executes them from the decoded instruction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoreAction {
    pub(crate) does: Core,
    pub(crate) op: Op,
    pub(crate) dest: u8,
    /// Number of the first source register, or r0 if the first operand is an immediate.
    pub(crate) first: u8,
    pub(crate) second: u8,
    /// Base register that receives the address of a load or store with auto-increment. It is 0 (r0) for other
    /// instructions.
    pub(crate) increments: u8,
    /// Immediate operand, or displacement that is added to the first source register. The value is 0 if the instruction
    /// has neither an immediate operand nor a displacement.
    pub(crate) immediate: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Core {
    Nothing,
    Integer,
    LoadByte,
    LoadShort,
    LoadLong,
    StoreByte,
    StoreShort,
    StoreLong,
    LoadSingle,
    LoadDouble,
    LoadQuad,
    StoreSingle,
    StoreDouble,
    StoreQuad,
    PipelinedLoadSingle,
    PipelinedLoadDouble,
    StorePixels,
    /// All other core operations, such as control-register moves, `flush`, `trap` and `lock`. The processor executes
    /// these operations from the decoded instruction.
    System,
    Branch,
}

impl Core {
    fn of(i: &Instruction) -> Core {
        // The size of a floating-point access selects a specialized kind.
        match (i.op, i.size) {
            (Op::LdB, _) => Core::LoadByte,
            (Op::LdS, _) => Core::LoadShort,
            (Op::LdL, _) => Core::LoadLong,
            (Op::StB, _) => Core::StoreByte,
            (Op::StS, _) => Core::StoreShort,
            (Op::StL, _) => Core::StoreLong,
            (Op::Fld, 4) => Core::LoadSingle,
            (Op::Fld, 8) => Core::LoadDouble,
            (Op::Fld, _) => Core::LoadQuad,
            (Op::Fst, 4) => Core::StoreSingle,
            (Op::Fst, 8) => Core::StoreDouble,
            (Op::Fst, _) => Core::StoreQuad,
            (Op::Pfld, 8) => Core::PipelinedLoadDouble,
            (Op::Pfld, _) => Core::PipelinedLoadSingle,
            (Op::Pst, _) => Core::StorePixels,
            (op, _) if op <= Op::Intovr => Core::System,
            (op, _) if op >= Op::Addu => Core::Integer,
            _ => Core::Branch,
        }
    }
}

impl CoreAction {
    const NOTHING: CoreAction =
        CoreAction { does: Core::Nothing, op: Op::Shl, dest: 0, first: 0, second: 0, increments: 0, immediate: 0 };

    fn new(i: &Instruction) -> CoreAction {
        let is_integer_store = matches!(i.op, Op::StB | Op::StS | Op::StL);
        let is_immediate = i.has(Flags::IMMEDIATE) || is_integer_store;
        CoreAction {
            does: Core::of(i),
            op: i.op,
            dest: if is_integer_store { i.src1 } else { i.dest },
            first: if is_immediate { 0 } else { i.src1 },
            second: i.src2,
            increments: if i.has(Flags::AUTOINCREMENT) { i.src2 } else { 0 },
            immediate: if is_immediate { i.imm as u32 } else { 0 },
        }
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct FloatingAction {
    pub(crate) does: Floating,
    pub(crate) dest: u8,
    pub(crate) first: u8,
    pub(crate) second: u8,
}

/// The kinds of effect that a floating-point instruction can have. Kinds with single-precision operands come first,
/// then kinds with double-precision operands, then [`Floating::Any`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Floating {
    PipelinedMultiply,
    PipelinedAdd,
    PipelinedSubtract,
    Multiply,
    Add,
    Subtract,
    /// Any other operation that reads two single-precision operands.
    Singles,
    PipelinedMultiplyDoubles,
    PipelinedAddDoubles,
    PipelinedSubtractDoubles,
    MultiplyDoubles,
    AddDoubles,
    SubtractDoubles,
    /// Any other operation that reads two double-precision operands.
    Doubles,
    /// Any operation with mixed precisions, and any operation that can read a result in the clock in which the result
    /// leaves a pipe.
    Any,
    Nothing,
}

impl FloatingAction {
    const NOTHING: FloatingAction = FloatingAction { does: Floating::Nothing, dest: 0, first: 0, second: 0 };

    fn new(d: &Decoded) -> FloatingAction {
        let i = &d.instruction;
        FloatingAction { does: Floating::of(d, i), dest: i.dest, first: i.src1, second: i.src2 }
    }
}

impl Floating {
    fn of(d: &Decoded, i: &Instruction) -> Floating {
        const PIPELINED: bool = true;
        const DOUBLES: bool = true;
        // A source can be the result that leaves the pipe. The kinds for one precision do not support such a source.
        if d.may_bypass() {
            return Floating::Any;
        }
        let doubles = i.has(Flags::SOURCE_DOUBLE);
        let alike = doubles == i.has(Flags::RESULT_DOUBLE);
        // Operations on operands of one precision have their own kinds.
        match (i.op, i.has(Flags::PIPELINED), doubles) {
            (Op::Fmul, PIPELINED, DOUBLES) if alike => Floating::PipelinedMultiplyDoubles,
            (Op::Fadd, PIPELINED, DOUBLES) if alike => Floating::PipelinedAddDoubles,
            (Op::Fsub, PIPELINED, DOUBLES) if alike => Floating::PipelinedSubtractDoubles,
            (Op::Fmul, PIPELINED, _) if alike => Floating::PipelinedMultiply,
            (Op::Fadd, PIPELINED, _) if alike => Floating::PipelinedAdd,
            (Op::Fsub, PIPELINED, _) if alike => Floating::PipelinedSubtract,
            (Op::Fmul, _, DOUBLES) if alike => Floating::MultiplyDoubles,
            (Op::Fadd, _, DOUBLES) if alike => Floating::AddDoubles,
            (Op::Fsub, _, DOUBLES) if alike => Floating::SubtractDoubles,
            (Op::Fmul, _, false) if alike => Floating::Multiply,
            (Op::Fadd, _, false) if alike => Floating::Add,
            (Op::Fsub, _, false) if alike => Floating::Subtract,
            _ => match source_widths(i) {
                (false, false) => Floating::Singles,
                (true, true) => Floating::Doubles,
                _ => Floating::Any,
            },
        }
    }
}

/// The effects of a single instruction, or of a pair (a floating-point and a core instruction that execute together).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Action {
    pub(crate) core: CoreAction,
    pub(crate) floating: FloatingAction,
    pub(crate) number: u8,
}

impl Action {
    /// Chooses the effects of the single instruction `first`, or of the pair of `first` and `second`.
    pub(crate) fn new(number: u8, first: &Decoded, second: Option<&Decoded>) -> Action {
        // Instructions without any effect get no action.
        let floating = Some(first).filter(|first| first.is_floating() && !first.is_idle());
        let core = second.or((!first.is_floating()).then_some(first)).filter(|core| !core.is_idle());
        Action {
            core: core.map_or(CoreAction::NOTHING, |core| CoreAction::new(&core.instruction)),
            floating: floating.map_or(FloatingAction::NOTHING, FloatingAction::new),
            number,
        }
    }
}
