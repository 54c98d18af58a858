//! Straight runs of code, decoded once: from an address to the next branch with its slot.

use crate::action::Action;
use crate::bus::Bus;
use crate::cache::CacheTags;
use crate::code_map::CodeMap;
use crate::decode::decode;
use crate::decoded::Decoded;
use crate::execution::Execution;
use crate::instruction::Op;
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
    /// What it changes that a program can see.
    pub(crate) action: Action,
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
        Ok(Unit { pc, mode, after, first, second: None, action: Action::new(&first, None) })
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
        let action = Action::new(&first, Some(&second));
        Ok(Unit { pc, mode, after: mode.after_pair(first.dual()), first, second: Some(second), action })
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
    pub(crate) units: Vec<Unit>,
    /// What follows a delayed branch that ends the block.
    pub(crate) slot: Option<Result<Unit, TrapCause>>,
    /// Instructions, the slot included.
    pub(crate) instructions: u64,
    /// Bytes of the units, without the slot.
    bytes: u32,
    /// The units that access data, in order, each once.
    pub(crate) accessing: Box<[AccessingUnit]>,
    /// The first unit on each line of the cache.
    lines: Box<[u8]>,
    /// State of the instruction cache in which all of it was held.
    held_in: u64,
    pub(crate) remembered: BlockMemory,
}

/// A unit that accesses data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AccessingUnit {
    /// Its number in the block.
    pub(crate) number: u8,
    pub(crate) is_store: bool,
    /// Whether it goes past the cache, whatever that holds.
    pub(crate) leaves_cache: bool,
}

impl AccessingUnit {
    fn new((number, op): (u8, Op)) -> Option<AccessingUnit> {
        let accesses = op <= Op::Pst || op == Op::Flush;
        accesses.then(|| AccessingUnit {
            number,
            is_store: is_store(op),
            leaves_cache: matches!(op, Op::Pfld | Op::Flush),
        })
    }
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
        let is_delayed = last.core().instruction.is_delayed_branch();
        let slot = is_delayed.then(|| match Unit::read(last.next(), last.after, code, bus) {
            Ok(unit) if unit.core().is_branch() => Err(TrapCause::BranchInSlot),
            read => read,
        });
        let mut block = Block {
            units,
            slot,
            instructions: 0,
            bytes: last.next().wrapping_sub(pc),
            accessing: Box::default(),
            lines: Box::default(),
            held_in: NEVER,
            remembered: BlockMemory::default(),
        };
        block.sum_up();
        Ok(block)
    }

    fn sum_up(&mut self) {
        self.instructions = self.units_and_slot().map(Unit::instructions).sum();
        self.accessing = (0..).zip(self.ops()).filter_map(AccessingUnit::new).collect();
        let mut line = None;
        let lines = (0..).zip(self.units_and_slot());
        let first = lines.filter(|(_, unit)| line.replace(unit.pc / LINE_BYTES) != Some(unit.pc / LINE_BYTES));
        self.lines = first.map(|(number, _)| number).collect();
    }

    fn units_and_slot(&self) -> impl Iterator<Item = &Unit> {
        self.units.iter().chain(self.slot.iter().flatten())
    }

    fn ops(&self) -> impl Iterator<Item = Op> {
        self.units_and_slot().map(|unit| unit.core().instruction.op)
    }

    /// The units that were executed.
    #[inline]
    pub(crate) fn executed(&self, execution: Execution) -> impl Iterator<Item = &Unit> {
        self.units[..execution.units].iter().chain(self.slot.iter().flatten().take(usize::from(execution.slot)))
    }

    /// How many instructions those are.
    #[inline]
    pub(crate) fn instructions_of(&self, execution: Execution) -> u64 {
        if execution.units == self.units.len() && execution.slot == self.slot.is_some() {
            self.instructions
        } else {
            self.executed(execution).map(Unit::instructions).sum()
        }
    }

    /// A unit by its number; the slot has the one behind the last.
    #[inline]
    pub(crate) fn unit(&self, number: usize) -> &Unit {
        match (self.units.get(number), &self.slot) {
            (Some(unit), _) | (None, Some(Ok(unit))) => unit,
            _ => unreachable!("it was executed"),
        }
    }

    /// Number of the first unit that is not on the same line of the cache as another one.
    pub(crate) fn end_of_line(&self, number: usize) -> usize {
        let next = self.lines.iter().find(|first| usize::from(**first) > number);
        next.map_or(usize::MAX, |first| usize::from(*first))
    }

    /// Whether the instruction cache holds all of it.
    #[inline]
    pub(crate) fn is_held(&mut self, cache: &CacheTags) -> bool {
        self.held_in == cache.changes() || self.look_up(cache)
    }

    fn look_up(&mut self, cache: &CacheTags) -> bool {
        let held = self.lines.iter().all(|first| cache.find(self.unit(usize::from(*first)).pc).is_some());
        if held {
            self.held_in = cache.changes();
        }
        held
    }

    /// Whether it is that of an address and a mode.
    #[inline]
    pub(crate) fn begins(&self, pc: u32, mode: Mode) -> bool {
        let first = &self.units[0];
        first.pc == pc && first.mode == mode
    }

    /// Whether an address lies behind its first unit and before its end; the slot is behind its end.
    #[inline]
    pub(crate) fn passes(&self, address: u32) -> bool {
        let offset = address.wrapping_sub(self.units[0].pc);
        offset != 0 && offset < self.bytes
    }
}
