//! Straight runs of code, decoded once: from an address to the next branch with its slot.

use crate::action::Action;
use crate::bus::Bus;
use crate::cache::InstructionTags;
use crate::code_map::CodeMap;
use crate::decode::decode;
use crate::decoded::Decoded;
use crate::execution::Execution;
use crate::instruction::{Instruction, Op};
use crate::memo::BlockMemory;
use crate::state::Mode;
use crate::timing::ChipSizes;
use crate::trap::TrapCause;

/// Most units of a block, its slot not counted.
const LONGEST: usize = 32;

/// What issues at once: an instruction, or a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unit {
    pub(crate) pc: u32,
    /// Mode in which it executes, and that of the unit after it.
    pub(crate) mode: Mode,
    pub(crate) after: Mode,
    /// The instruction, or the floating-point half.
    pub(crate) first: Decoded,
    /// The core half of a pair.
    pub(crate) second: Option<Decoded>,
}

impl Unit {
    fn read<B: Bus>(pc: u32, mode: Mode, code: &mut CodeMap, bus: &mut B) -> Result<Unit, TrapCause> {
        if mode.is_dual() { Unit::pair(pc, mode, code, bus) } else { Unit::single(pc, mode, code, bus) }
    }

    fn single<B: Bus>(pc: u32, mode: Mode, code: &mut CodeMap, bus: &mut B) -> Result<Unit, TrapCause> {
        let first = decode_at(pc, code, bus)?;
        let after = match (pc & 4 != 0, mode) {
            (true, Mode::Entering) => Mode::DualOnce,
            (false, _) if first.dual() => Mode::Entering,
            _ => Mode::Single,
        };
        Ok(Unit { pc, mode, after, first, second: None })
    }

    fn pair<B: Bus>(pc: u32, mode: Mode, code: &mut CodeMap, bus: &mut B) -> Result<Unit, TrapCause> {
        if pc & 4 != 0 {
            return Err(TrapCause::PairAlignment);
        }
        let first = decode_at(pc, code, bus)?;
        let second = decode_at(pc.wrapping_add(4), code, bus)?;
        if !first.is_floating() || second.is_floating() && second.instruction.op != Op::Fnop {
            return Err(TrapCause::IllegalPair);
        }
        Ok(Unit { pc, mode, after: mode.after_pair(first.dual()), first, second: Some(second) })
    }

    /// The half that may access memory or branch: that of a pair, or the instruction.
    #[inline]
    pub(crate) fn core(&self) -> &Decoded {
        self.second.as_ref().unwrap_or(&self.first)
    }

    /// Address of the core half.
    #[inline]
    pub(crate) fn core_pc(&self) -> u32 {
        self.pc.wrapping_add(if self.second.is_some() { 4 } else { 0 })
    }

    /// Address of what follows.
    #[inline]
    pub(crate) fn next(&self) -> u32 {
        self.pc.wrapping_add(if self.second.is_some() { 8 } else { 4 })
    }

    pub(crate) fn instructions(&self) -> u64 {
        1 + u64::from(self.second.is_some())
    }

    /// Whether a block must end behind it because it changes what code is, or how it is fetched.
    fn ends_block(&self) -> bool {
        self.core().instruction.op == Op::StC
    }
}

fn decode_at<B: Bus>(pc: u32, code: &mut CodeMap, bus: &mut B) -> Result<Decoded, TrapCause> {
    code.mark(pc);
    let word = bus.read(pc, 4).map_err(|_| TrapCause::InstructionAccess)? as u32;
    let instruction = decode(word).map_err(|e| TrapCause::Illegal { word: e.0 })?;
    Ok(Decoded::new(instruction))
}

fn is_store(op: Op) -> bool {
    matches!(op, Op::StB | Op::StS | Op::StL | Op::Fst | Op::Pst)
}

const LINE_BYTES: u32 = ChipSizes::PAPERS.line_bytes as u32;

/// No state of an instruction cache.
const NEVER: u64 = u64::MAX;

/// A run of units that ends with a branch, before an instruction that cannot be executed, or at its greatest length.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Where it begins, and in which mode.
    pub(crate) pc: u32,
    mode: Mode,
    /// Mode after its slot.
    pub(crate) after_slot: Mode,
    /// Mode and address of what follows its units.
    pub(crate) after: Mode,
    pub(crate) next: u32,
    /// Number of its units, without the slot.
    pub(crate) count: usize,
    /// Instructions, the slot included.
    pub(crate) instructions: u64,
    /// State of the instruction cache in which all of it was held.
    held_in: u64,
    /// What the units change that a program can see, and the slot behind them.
    pub(crate) actions: Box<[Action]>,
    /// The units that access data, in order, each once.
    pub(crate) accessing: Box<[AccessingUnit]>,
    pub(crate) remembered: BlockMemory,
    /// The units, and the slot behind them.
    units: Box<[Unit]>,
    /// The first unit on each line of the cache.
    lines: Box<[u8]>,
    /// Why what follows a delayed branch that ends the block cannot be executed.
    pub(crate) wrong_slot: Option<TrapCause>,
}

/// What the clock must know of an access.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Access {
    pub(crate) op: Op,
    pub(crate) dest: u8,
    pub(crate) size: u8,
}

impl Access {
    pub(crate) fn of(i: &Instruction) -> Access {
        Access { op: i.op, dest: i.dest, size: i.size }
    }
}

/// A unit that accesses data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AccessingUnit {
    pub(crate) access: Access,
    /// Its number in the block.
    pub(crate) number: u8,
    pub(crate) is_store: bool,
    /// Whether it goes past the cache, whatever that holds.
    pub(crate) leaves_cache: bool,
}

impl AccessingUnit {
    fn new((number, unit): (u8, &Unit)) -> Option<AccessingUnit> {
        let access = Access::of(&unit.core().instruction);
        let op = access.op;
        let accesses = op <= Op::Pst || op == Op::Flush;
        accesses.then(|| AccessingUnit {
            access,
            number,
            is_store: is_store(op),
            leaves_cache: matches!(op, Op::Pfld | Op::Flush),
        })
    }
}

/// The first of some units on each line of the cache.
fn first_on_lines(units: &[Unit]) -> Box<[u8]> {
    let mut line = None;
    let lines = (0..).zip(units);
    let first = lines.filter(|(_, unit)| line.replace(unit.pc / LINE_BYTES) != Some(unit.pc / LINE_BYTES));
    first.map(|(number, _)| number).collect()
}

impl Block {
    /// The block that begins at an address in a mode.
    ///
    /// # Errors
    /// Why its first unit cannot be executed.
    pub(crate) fn read<B: Bus>(pc: u32, mode: Mode, code: &mut CodeMap, bus: &mut B) -> Result<Block, TrapCause> {
        let mut last = Unit::read(pc, mode, code, bus)?;
        let mut units = vec![last];
        while units.len() < LONGEST && !last.core().is_branch() && !last.ends_block() {
            let Ok(unit) = Unit::read(last.next(), last.after, code, bus) else { break };
            units.push(unit);
            last = unit;
        }
        let count = units.len();
        let mut wrong_slot = None;
        if last.core().instruction.is_delayed_branch() {
            match Unit::read(last.next(), last.after, code, bus) {
                Ok(unit) if unit.core().is_branch() => wrong_slot = Some(TrapCause::BranchInSlot),
                Ok(unit) => units.push(unit),
                Err(cause) => wrong_slot = Some(cause),
            }
        }
        Ok(Block {
            pc,
            mode,
            after_slot: units.last().map_or(last.after, |last| last.after),
            after: last.after,
            next: last.next(),
            count,
            instructions: units.iter().map(Unit::instructions).sum(),
            held_in: NEVER,
            actions: (0..).zip(&units).map(|(n, unit)| Action::new(n, &unit.first, unit.second.as_ref())).collect(),
            accessing: (0..).zip(&units).filter_map(AccessingUnit::new).collect(),
            remembered: BlockMemory::default(),
            lines: first_on_lines(&units),
            units: units.into_boxed_slice(),
            wrong_slot,
        })
    }

    /// The units that were executed.
    #[inline]
    pub(crate) fn executed(&self, execution: Execution) -> &[Unit] {
        self.units.get(..execution.units + usize::from(execution.slot)).unwrap_or_default()
    }

    /// How many instructions those are.
    #[inline]
    pub(crate) fn instructions_of(&self, execution: Execution) -> u64 {
        let executed = self.executed(execution);
        if executed.len() == self.units.len() {
            self.instructions
        } else {
            executed.iter().map(Unit::instructions).sum()
        }
    }

    /// A unit by its number; the slot has the one behind the last.
    #[inline]
    pub(crate) fn unit(&self, number: usize) -> &Unit {
        &self.units[number]
    }

    /// An address on the line of the cache that a unit is on, and the number of the first unit behind that line.
    #[inline]
    pub(crate) fn line(&self, number: usize) -> (u32, usize) {
        let next = self.lines.iter().skip(1).position(|first| usize::from(*first) > number);
        let line = next.unwrap_or(self.lines.len() - 1);
        let end = self.lines.get(line + 1).map_or(usize::MAX, |first| usize::from(*first));
        (self.pc.wrapping_add(line as u32 * LINE_BYTES), end)
    }

    /// Whether the instruction cache holds all of it.
    #[inline]
    pub(crate) fn is_held(&mut self, cache: &InstructionTags) -> bool {
        self.held_in == cache.changes() || self.look_up(cache)
    }

    fn look_up(&mut self, cache: &InstructionTags) -> bool {
        let mut addresses = (0..self.lines.len() as u32).map(|line| self.pc.wrapping_add(line * LINE_BYTES));
        let held = addresses.all(|address| cache.holds(address));
        if held {
            self.held_in = cache.changes();
        }
        held
    }

    /// Whether it is that of an address and a mode.
    #[inline]
    pub(crate) fn begins(&self, pc: u32, mode: Mode) -> bool {
        self.pc == pc && self.mode == mode
    }

    /// Whether an address lies behind its first unit and before its end; the slot is behind its end.
    #[inline]
    pub(crate) fn passes(&self, address: u32) -> bool {
        let offset = address.wrapping_sub(self.pc);
        offset != 0 && offset < self.next.wrapping_sub(self.pc)
    }
}
