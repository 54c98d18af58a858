//! What the halves of a unit do, chosen once when they are decoded, with operands in one form: no bit of an instruction is looked
//! at again while it executes.

use crate::decoded::Decoded;
use crate::dual_operation::source_widths;
use crate::instruction::{Flags, Instruction, Op};

/// The core half: loads, stores, integer arithmetic. Branches and what moves control registers read their instruction.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CoreAction {
    pub(crate) does: Core,
    pub(crate) op: Op,
    pub(crate) dest: u8,
    /// r0 where the first operand is an immediate.
    pub(crate) first: u8,
    pub(crate) second: u8,
    /// The register that receives the address of an access; r0 where none does.
    pub(crate) increments: u8,
    /// Added to the first register: the immediate, or 0.
    pub(crate) immediate: u32,
}

/// What a core half does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Core {
    Nothing,
    /// Arithmetic, logic, a shift.
    Integer,
    /// An access of an integer register, by its bytes.
    LoadByte,
    LoadShort,
    LoadLong,
    StoreByte,
    StoreShort,
    StoreLong,
    /// An access of one, two or four floating-point registers.
    LoadSingle,
    LoadDouble,
    LoadQuad,
    StoreSingle,
    StoreDouble,
    StoreQuad,
    /// A pipelined load of one or two of them.
    PipelinedLoadSingle,
    PipelinedLoadDouble,
    StorePixels,
    /// What the instruction says.
    System,
    Branch,
}

impl Core {
    fn of(i: &Instruction) -> Core {
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

/// The floating-point half.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FloatingAction {
    pub(crate) does: Floating,
    pub(crate) dest: u8,
    pub(crate) first: u8,
    pub(crate) second: u8,
}

/// What a floating-point half does: first those that read singles, then those that read doubles. Of the frequent ones no result leaves
/// a pipe for a register that is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Floating {
    /// On singles, pipelined.
    PipelinedMultiply,
    PipelinedAdd,
    PipelinedSubtract,
    /// On singles, one at a time.
    Multiply,
    Add,
    Subtract,
    /// Read two singles and do what the instruction says.
    Singles,
    /// On doubles, pipelined.
    PipelinedMultiplyDoubles,
    PipelinedAddDoubles,
    PipelinedSubtractDoubles,
    /// On doubles, one at a time.
    MultiplyDoubles,
    AddDoubles,
    SubtractDoubles,
    /// Read two doubles and do what it says.
    Doubles,
    /// Read what it says, through the pipe if need be, and do what it says.
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
        if d.may_bypass() {
            return Floating::Any;
        }
        let doubles = i.has(Flags::SOURCE_DOUBLE);
        let alike = doubles == i.has(Flags::RESULT_DOUBLE);
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

/// What a unit does.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Action {
    pub(crate) core: CoreAction,
    pub(crate) floating: FloatingAction,
    /// Number of the unit in its block.
    pub(crate) number: u8,
}

impl Action {
    /// What an instruction does, or a pair with its core half.
    pub(crate) fn new(number: u8, first: &Decoded, second: Option<&Decoded>) -> Action {
        let floating = Some(first).filter(|first| first.is_floating() && !first.is_idle());
        let core = second.or((!first.is_floating()).then_some(first)).filter(|core| !core.is_idle());
        Action {
            core: core.map_or(CoreAction::NOTHING, |core| CoreAction::new(&core.instruction)),
            floating: floating.map_or(FloatingAction::NOTHING, FloatingAction::new),
            number,
        }
    }
}
