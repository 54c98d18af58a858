//! Operands of floating-point instructions. An operand can be a result that leaves a pipe in the same clock.

use crate::action::{Floating, FloatingAction};
use crate::block::Unit;
use crate::cpu::Cpu;
use crate::decoded::Decoded;
use crate::dual_operation::first_has_bypass;
use crate::instruction::{Flags, Instruction, Op};
use crate::state::{PipeStage, State};

/// Values of the source operands of a floating-point instruction. In a pair, they are read before the core instruction
/// writes its result. An operand can be a result that leaves a pipe in the same clock.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Operands {
    pub(crate) a: u64,
    pub(crate) b: u64,
}

impl Cpu {
    #[inline(always)]
    pub(crate) fn read_operands<'a>(&self, a: &FloatingAction, unit: impl Fn() -> &'a Unit) -> Operands {
        let state = &self.state;
        if a.does == Floating::Nothing {
            Operands::default()
        } else if a.does <= Floating::Singles {
            Operands { a: u64::from(state.f32_bits(a.first)), b: u64::from(state.f32_bits(a.second)) }
        } else if a.does <= Floating::Doubles {
            Operands { a: state.f64_bits(a.first), b: state.f64_bits(a.second) }
        } else {
            read_any(state, &unit().first)
        }
    }
}

fn read_any(state: &State, d: &Decoded) -> Operands {
    let (first, second) = d.source_widths();
    if d.may_bypass() {
        return read_through(state, &d.instruction, first, second);
    }
    Operands { a: state.f_bits(d.instruction.src1, first), b: state.f_bits(d.instruction.src2, second) }
}

fn read_through(state: &State, i: &Instruction, first: bool, second: bool) -> Operands {
    // A scalar instruction does not move a result out of a pipe.
    let Some(out) = leaving(state, i) else {
        return Operands { a: state.f_bits(i.src1, first), b: state.f_bits(i.src2, second) };
    };
    let b = read_bypassed(state, i.src2, second, i.dest, out);
    let a = match first_has_bypass(i) {
        true => read_bypassed(state, i.src1, first, i.dest, out),
        false => state.f_bits(i.src1, first),
    };
    Operands { a, b }
}

/// Returns the value in the multiplier's last stage, which is the second stage for double-precision sources and the
/// third stage for single-precision sources.
pub(crate) fn last_product(state: &State, source_double: bool) -> PipeStage {
    state.multiplier[if source_double { 1 } else { 2 }]
}

/// Returns the result that a pipelined instruction moves out of its pipe into the destination register. Returns `None`
/// for a scalar instruction.
fn leaving(state: &State, i: &Instruction) -> Option<PipeStage> {
    if i.op == Op::DualOp {
        let product = last_product(state, i.has(Flags::SOURCE_DOUBLE));
        return Some(if i.has(Flags::PIPELINED) { state.adder[2] } else { product });
    }
    if !i.has(Flags::PIPELINED) {
        return None;
    }
    Some(match () {
        () if i.uses_adder() => state.adder[2],
        () if i.op == Op::Fmul3 => state.multiplier[2],
        () if i.uses_multiplier() => last_product(state, i.has(Flags::SOURCE_DOUBLE)),
        () => state.graphics,
    })
}

/// Reads register `n`. If `n` belongs to the destination `dest`, returns the result that leaves the pipe, as if the
/// register already contained it.
fn read_bypassed(state: &State, n: u8, double: bool, dest: u8, leaving: PipeStage) -> u64 {
    if dest & 30 != n & 30 || dest < 2 {
        return state.f_bits(n, double);
    }
    let low = usize::from(dest & 30);
    // Replace the old value of the register or pair by the leaving result.
    let mut pair = [state.f[low], state.f[low + 1]];
    if leaving.double {
        pair = [leaving.bits as u32, (leaving.bits >> 32) as u32];
    } else {
        pair[usize::from(dest & 1)] = leaving.bits as u32;
    }
    match double {
        true => u64::from(pair[1]) << 32 | u64::from(pair[0]),
        false => u64::from(pair[usize::from(n & 1)]),
    }
}
