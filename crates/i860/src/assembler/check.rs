//! Assembler rules for instructions and their neighbours. A program that breaks a rule has undefined results on the
//! real chip.
//!
//! * A pair consists of a floating-point instruction, then a core instruction.
//! * The two instructions of a pair write different registers, and only one of them sets CC. A pair does not contain a
//!   compare together with `bc.t` or `bnc.t`.
//! * A delayed branch has no branch in its delay slot, and the delay slot of a `call` does not write r1.
//! * The two source registers of `bla` are different.
//!
//! Some working programs break three more rules ([`Rule`]). The assembler reports these as warnings:
//!
//! * A `d.` instruction has an address that is a multiple of 8. Other assemblers also accept `d.` in the second word of
//!   a pair.
//! * A pipelined multiply does not have its first source as destination.
//! * No result is read from a pipe after a scalar operation has destroyed the contents of the pipe. Programs that empty
//!   a pipe read destroyed results and ignore these results.
//!
//! Pairs are checked in address order, without following jumps into the middle of paired code.

use crate::decoded::float_mask;
use crate::dual_operation::{MULTIPLIER_ROUTES, ROUTES, Source};
use crate::instruction::{Flags, Instruction, Op};
use crate::state::Mode;
use std::collections::BTreeSet;

type Located = (u32, usize, Instruction);

/// A rule that some working programs break. A violation causes only a warning.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rule {
    /// Rule: a `d.` instruction has an address that is a multiple of 8.
    Alignment,
    /// Rule: a pipelined multiply does not have its first source as destination.
    MultiplySource,
    /// Rule: no result is read from a pipe after a scalar operation has destroyed the contents of the pipe.
    LostResult,
}

impl Rule {
    /// All rules, with the names by which a user turns off their warnings.
    pub const NAMES: [(&'static str, Self); 3] =
        [("alignment", Self::Alignment), ("multiply-source", Self::MultiplySource), ("lost-result", Self::LostResult)];

    /// Returns the name by which a user turns off the warnings of this rule.
    pub fn name(self) -> &'static str {
        Self::NAMES.iter().find(|(_, rule)| *rule == self).map_or("", |(name, _)| name)
    }
}

/// Returns all violations of rules that are errors: the source line and the reason.
pub(super) fn faults(program: &[Located]) -> Vec<(usize, String)> {
    // Check the rules of single instructions first, then of delay slots, then of pairs.
    let same = |i: &Instruction| i.op == Op::Bla && i.src1 == i.src2;
    let bla = program.iter().filter(|(.., i)| same(i));
    let mut faults: Vec<(usize, String)> =
        bla.map(|(_, line, _)| (*line, "bla needs two different registers".to_owned())).collect();
    faults.extend(program.windows(2).filter_map(slot));
    faults.extend(pairs(program));
    faults
}

/// Returns all violations of rules that are warnings: the source line, the rule and the reason. `labels` are the
/// addresses to which the program may jump.
pub(super) fn warnings(program: &[Located], labels: &BTreeSet<u32>) -> Vec<(usize, Rule, String)> {
    let each = program.iter().flat_map(|(address, line, i)| {
        alone(*address, i).into_iter().map(|(rule, reason)| (*line, rule, reason.to_owned()))
    });
    let lost = lost_results(program, labels).into_iter().map(|(line, reason)| (line, Rule::LostResult, reason));
    each.chain(lost).collect()
}

/// Number of operations that entered a pipe since a scalar operation destroyed the older contents of the pipe. `None`
/// if the contents are unknown.
#[derive(Clone, Copy, Default)]
struct PipeFill(Option<usize>);

impl PipeFill {
    /// Returns true if a scalar operation has destroyed the result that leaves the pipe next. `stages` is the number of
    /// stages of the pipe.
    fn is_result_lost(self, stages: usize) -> bool {
        self.0.is_some_and(|operations| operations < stages)
    }

    fn push(&mut self) {
        self.0 = self.0.map(|operations| operations + 1);
    }
}

/// Effects of an instruction on the pipes of the adder (index 0) and the multiplier (index 1).
#[derive(Clone, Copy, Default)]
struct PipeUse {
    scalar: [bool; 2],
    pushes: [bool; 2],
    takes: [bool; 2],
}

impl PipeUse {
    fn of(i: &Instruction) -> PipeUse {
        match i.op {
            Op::DualOp => PipeUse::of_dual_operation(i),
            _ if !i.is_floating() => PipeUse::default(),
            Op::Frcp | Op::Frsqr | Op::Fmlow => PipeUse { scalar: [false, true], ..PipeUse::default() },
            _ => PipeUse::of_operation(i, [i.uses_adder(), i.uses_multiplier()]),
        }
    }

    fn of_operation(i: &Instruction, units: [bool; 2]) -> PipeUse {
        match i.has(Flags::PIPELINED) {
            true => PipeUse { scalar: [false; 2], pushes: units, takes: units.map(|unit| unit && i.dest >= 2) },
            false => PipeUse { scalar: units, ..PipeUse::default() },
        }
    }

    fn of_dual_operation(i: &Instruction) -> PipeUse {
        // The destination receives the adder's result, or the multiplier's result for pfmam and pfmsm.
        let to_adder = i.has(Flags::PIPELINED);
        let route = &(if to_adder { &ROUTES } else { &MULTIPLIER_ROUTES })[(i.imm & 15) as usize];
        let uses = |source| route.multiplier.contains(&source) || route.adder.contains(&source);
        let is_kept = i.dest >= 2;
        let takes = [uses(Source::A) || is_kept && to_adder, uses(Source::M) || is_kept && !to_adder];
        PipeUse { scalar: [false; 2], pushes: [true; 2], takes }
    }
}

/// Finds instructions that take a result out of a pipe (adder or multiplier) after a scalar operation in the same pipe
/// has destroyed the result. After each label and branch, the function assumes nothing about the contents of the pipes.
fn lost_results(program: &[Located], labels: &BTreeSet<u32>) -> Vec<(usize, String)> {
    let mut faults = Vec::new();
    let mut pipes = [PipeFill::default(); 2];
    for (address, line, i) in program {
        // The contents of the pipes are unknown after a jump.
        if labels.contains(address) || i.is_branch() {
            pipes = [PipeFill::default(); 2];
        }
        let used = PipeUse::of(i);
        let double = i.has(Flags::SOURCE_DOUBLE);
        // A multiplication of doubles uses only two stages, except `pfmul3`.
        for (unit, stages) in [(0, 3), (1, if double && i.op != Op::Fmul3 { 2 } else { 3 })] {
            if used.takes[unit] && pipes[unit].is_result_lost(stages) {
                let name = ["adder", "multiplier"][unit];
                faults.push((
                    *line,
                    format!("takes a result out of the {name}'s pipe that a scalar operation destroyed"),
                ));
            }
            if used.pushes[unit] {
                pipes[unit].push();
            }
            if used.scalar[unit] {
                pipes[unit] = PipeFill(Some(0));
            }
        }
    }
    faults
}

fn alone(address: u32, i: &Instruction) -> Option<(Rule, &'static str)> {
    let multiplier_first = match i.op {
        Op::Fmul | Op::Fmul3 => i.has(Flags::PIPELINED),
        Op::DualOp => matches!(i.imm & 15, 9 | 11 | 13 | 15),
        _ => false,
    };
    match () {
        () if i.is_floating() && i.has(Flags::DUAL) && !address.is_multiple_of(8) => {
            Some((Rule::Alignment, "a `d.` instruction must lie at a multiple of 8 (put a nop or .align 8 before it)"))
        }
        () if multiplier_first && i.dest >= 2 && i.src1 == i.dest => {
            Some((Rule::MultiplySource, "a pipelined multiply must not have its first source as destination"))
        }
        () => None,
    }
}

fn slot(two: &[Located]) -> Option<(usize, String)> {
    let [(at, _, branch), (next, line, i)] = two else { return None };
    // The delay slot is the instruction directly after a delayed branch.
    if *next != at.wrapping_add(4) || !branch.is_delayed_branch() || at % 8 == 4 && i.is_floating() {
        return None;
    }
    // A call writes the return address to r1 before its delay slot executes.
    let call = matches!(branch.op, Op::Call | Op::Calli);
    match () {
        () if i.is_branch() => Some((*line, "a branch in the slot of a delayed branch".to_owned())),
        () if call && writes(i) & 1 << 1 != 0 => Some((*line, "the slot of a call must not write r1".to_owned())),
        () => None,
    }
}

/// Returns the registers that an instruction writes, as a mask: integer registers in the low word, floating-point
/// registers in the high word.
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

/// Returns the mask of the floating-point registers that a destination of `bytes` bytes occupies, from register `dest`
/// on. f0 and f1 are left out, because they are always 0.
fn writable_float_mask(dest: u8, bytes: u8) -> u64 {
    float_mask(dest, bytes) & !(3 << 32)
}

/// Returns the bit of integer register `n` in a mask of written registers, or 0 for r0, because writes to r0 have no
/// effect.
fn integer_mask(n: u8) -> u64 {
    1 << n & !1
}

/// Checks the rules for all pairs of a program, in address order. Returns the errors with their source lines.
fn pairs(program: &[Located]) -> Vec<(usize, String)> {
    let mut faults = Vec::new();
    let mut mode = Mode::Single;
    let mut at = 0;
    while let Some((address, line, low)) = program.get(at) {
        let high = program.get(at + 1).filter(|(next, ..)| *next == address.wrapping_add(4));
        let d = low.is_floating() && low.has(Flags::DUAL);
        // In single-instruction mode, only a D bit at an aligned address has an effect: pairs begin after the next
        // instruction.
        if !mode.is_dual() {
            let enters = d && address % 8 == 0;
            mode = if enters { Mode::DualOnce } else { Mode::Single };
            at += if enters && high.is_some() { 2 } else { 1 };
            continue;
        }
        // A pair at an odd word cannot be executed.
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

/// Returns the description of the rule that a pair breaks, or `None`. The boolean is true if the second instruction of
/// the pair causes the error.
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
