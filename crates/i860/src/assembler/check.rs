//! Rules that an instruction must keep by itself and with its neighbours. What breaks them is undefined on the part.
//!
//! * a `d.` instruction lies at a multiple of 8
//! * a pair is a floating-point instruction, then a core instruction
//! * the halves of a pair do not write the same register, do not both set CC, and `bc.t`/`bnc.t` does not stand
//!   beside a compare
//! * no branch in the slot of a delayed branch; a `call` slot does not write r1
//! * a pipelined multiply does not have its first source as destination
//! * `bla` has two different registers
//!
//! Pairing is followed in address order, as a reader would; a program that jumps into the middle of a dual stretch
//! is on its own.

use crate::decoded::float_mask;
use crate::instruction::{Flags, Instruction, Op};
use crate::state::Mode;

type Located = (u32, usize, Instruction);

/// All broken rules, as source line and reason.
pub(super) fn faults(program: &[Located]) -> Vec<(usize, String)> {
    let mut faults: Vec<(usize, String)> = program
        .iter()
        .filter_map(|(address, line, i)| alone(*address, i).map(|reason| (*line, reason.to_owned())))
        .collect();
    faults.extend(program.windows(2).filter_map(slot));
    faults.extend(pairs(program));
    faults
}

fn alone(address: u32, i: &Instruction) -> Option<&'static str> {
    let multiplier_first = match i.op {
        Op::Fmul => i.has(Flags::PIPELINED),
        Op::DualOp => matches!(i.imm & 15, 9 | 11 | 13 | 15),
        _ => false,
    };
    match () {
        () if i.is_floating() && i.has(Flags::DUAL) && !address.is_multiple_of(8) => {
            Some("a `d.` instruction must lie at a multiple of 8 (put a nop or .align 8 before it)")
        }
        () if multiplier_first && i.dest >= 2 && i.src1 == i.dest => {
            Some("a pipelined multiply must not have its first source as destination")
        }
        () if i.op == Op::Bla && i.src1 == i.src2 => Some("bla needs two different registers"),
        () => None,
    }
}

fn slot(two: &[Located]) -> Option<(usize, String)> {
    let [(at, _, branch), (next, line, i)] = two else { return None };
    if *next != at.wrapping_add(4) || !branch.is_delayed_branch() || at % 8 == 4 && i.is_floating() {
        return None;
    }
    let call = matches!(branch.op, Op::Call | Op::Calli);
    match () {
        () if i.is_branch() => Some((*line, "a branch in the slot of a delayed branch".to_owned())),
        () if call && writes(i) & 1 << 1 != 0 => Some((*line, "the slot of a call must not write r1".to_owned())),
        () => None,
    }
}

/// Registers written: r in the low word, f in the high.
fn writes(i: &Instruction) -> u64 {
    let base = if i.has(Flags::AUTOINCREMENT) { integer_mask(i.src2) } else { 0 };
    match i.op {
        Op::Fxfr => integer_mask(i.dest),
        _ if i.is_floating() => writable_float_mask(i.dest, if i.has(Flags::RESULT_DOUBLE) { 8 } else { 4 }),
        Op::Fld | Op::Pfld => writable_float_mask(i.dest, i.size) | base,
        Op::Fst | Op::Pst | Op::Flush => base,
        Op::Ixfr => writable_float_mask(i.dest, 4),
        Op::Call | Op::Calli => integer_mask(1),
        Op::Bla => integer_mask(i.src2),
        Op::StB | Op::StS | Op::StL | Op::StC => 0,
        _ if i.is_branch() => 0,
        _ => integer_mask(i.dest),
    }
}

/// f0 and f1 are not written.
fn writable_float_mask(dest: u8, bytes: u8) -> u64 {
    float_mask(dest, bytes) & !(3 << 32)
}

/// r0 is not written.
fn integer_mask(n: u8) -> u64 {
    1 << n & !1
}

/// Follows the mode through the program and checks every pair.
fn pairs(program: &[Located]) -> Vec<(usize, String)> {
    let mut faults = Vec::new();
    let mut mode = Mode::Single;
    let mut at = 0;
    while let Some((address, line, low)) = program.get(at) {
        let high = program.get(at + 1).filter(|(next, ..)| *next == address.wrapping_add(4));
        let d = low.is_floating() && low.has(Flags::DUAL);
        if !mode.is_dual() {
            let enters = d && address % 8 == 0;
            mode = if enters { Mode::DualOnce } else { Mode::Single };
            at += if enters && high.is_some() { 2 } else { 1 };
            continue;
        }
        if address % 8 != 0 {
            faults.push((*line, "dual-instruction mode reaches this instruction at an odd word".to_owned()));
            mode = Mode::Single;
            at += 1;
            continue;
        }
        let Some((_, high_line, high)) = high else {
            faults.push((*line, "a pair lacks its core instruction".to_owned()));
            return faults;
        };
        faults.extend(pair(low, high).map(|(second, reason)| (if second { *high_line } else { *line }, reason)));
        mode = mode.after_pair(d);
        at += 2;
    }
    faults
}

fn fault(second: bool, reason: &str) -> Option<(bool, String)> {
    Some((second, reason.to_owned()))
}

/// The broken rule of a pair, and whether to blame the second half.
fn pair(low: &Instruction, high: &Instruction) -> Option<(bool, String)> {
    let compares = matches!(low.op, Op::Pfgt | Op::Pfle | Op::Pfeq);
    match () {
        () if !low.is_floating() => {
            fault(false, "dual-instruction mode: expected a floating-point instruction or fnop")
        }
        () if high.is_floating() => fault(true, "dual-instruction mode: expected a core instruction"),
        () if writes(low) & writes(high) != 0 => fault(true, "both halves of a pair write the same register"),
        () if compares && high.sets_condition() => fault(true, "both halves of a pair set CC"),
        () if compares && matches!(high.op, Op::BcT | Op::BncT) => fault(true, "bc.t or bnc.t beside a compare"),
        () => None,
    }
}
