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

/// Most instructions or pairs in a block, without the delay slot.
const LONGEST: usize = 32;

/// Code that issues in one clock: an instruction or a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unit {
    pub(crate) pc: u32,
    /// Modes in which this instruction or pair and the next one execute.
    pub(crate) mode: Mode,
    pub(crate) after: Mode,
    /// The single instruction, or the floating-point half of a pair.
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
        // A D bit at an aligned address starts dual-instruction mode after the next instruction.
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
        // The first half must be floating-point, the second must be core or `fnop`.
        if !first.is_floating() || second.is_floating() && second.instruction.op != Op::Fnop {
            return Err(TrapCause::IllegalPair);
        }
        Ok(Unit { pc, mode, after: mode.after_pair(first.dual()), first, second: Some(second) })
    }

    /// Returns the half that may access memory or branch: the core half of a pair, or the single instruction.
    #[inline]
    pub(crate) fn core(&self) -> &Decoded {
        self.second.as_ref().unwrap_or(&self.first)
    }

    /// Returns the address of the core half.
    #[inline]
    pub(crate) fn core_pc(&self) -> u32 {
        self.pc.wrapping_add(if self.second.is_some() { 4 } else { 0 })
    }

    /// Returns the address after the instruction or pair.
    #[inline]
    pub(crate) fn next(&self) -> u32 {
        self.pc.wrapping_add(if self.second.is_some() { 8 } else { 4 })
    }

    pub(crate) fn instructions(&self) -> u64 {
        1 + u64::from(self.second.is_some())
    }

    /// Returns true for `st.c`, which can change code or how it is fetched, so that a block must end after it.
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

/// Initial value of [`Block::held_in`], which is the number of no cache state.
const NEVER: u64 = u64::MAX;

/// A basic block: instructions and pairs up to a branch, up to one that cannot be executed, or up to the greatest
/// length.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    /// Address and mode in which the block begins.
    pub(crate) pc: u32,
    mode: Mode,
    /// Pairing mode (single instructions or pairs) after the delay slot.
    pub(crate) after_slot: Mode,
    /// Mode and address of the code after the block.
    pub(crate) after: Mode,
    pub(crate) next: u32,
    /// Number of instructions or pairs, without the delay slot.
    pub(crate) count: usize,
    /// Number of instructions, including the slot.
    pub(crate) instructions: u64,
    /// Number of the instruction-cache state in which the whole block was last found in the cache.
    held_in: u64,
    /// Effects of the instructions and pairs, and of the delay slot after them.
    pub(crate) actions: Box<[Action]>,
    /// Instructions and pairs that access data, in order.
    pub(crate) accessing: Box<[AccessingUnit]>,
    pub(crate) remembered: BlockMemory,
    /// The instructions and pairs, then the delay slot.
    units: Box<[Unit]>,
    /// Index of the first instruction or pair on each cache line.
    lines: Box<[u8]>,
    /// Cause of the trap if the slot of the final branch cannot be executed.
    pub(crate) wrong_slot: Option<TrapCause>,
}

/// Properties of a data access that the clock needs.
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

/// An instruction or pair that accesses data.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AccessingUnit {
    pub(crate) access: Access,
    /// Index of the instruction or pair in its block.
    pub(crate) number: u8,
    pub(crate) is_store: bool,
    /// True if the access always goes to the bus, regardless of the cache's contents.
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

/// Returns the index of the first instruction or pair on each cache line.
fn first_on_lines(units: &[Unit]) -> Box<[u8]> {
    let mut line = None;
    let lines = (0..).zip(units);
    let first = lines.filter(|(_, unit)| line.replace(unit.pc / LINE_BYTES) != Some(unit.pc / LINE_BYTES));
    first.map(|(number, _)| number).collect()
}

impl Block {
    /// Decodes the block that begins at an address in a mode.
    ///
    /// # Errors
    /// The cause of the trap if the first instruction or pair cannot be executed.
    pub(crate) fn read<B: Bus>(pc: u32, mode: Mode, code: &mut CodeMap, bus: &mut B) -> Result<Block, TrapCause> {
        let mut last = Unit::read(pc, mode, code, bus)?;
        // Decode up to a branch, an `st.c`, an illegal instruction or the greatest length.
        let mut units = vec![last];
        while units.len() < LONGEST && !last.core().is_branch() && !last.ends_block() {
            let Ok(unit) = Unit::read(last.next(), last.after, code, bus) else { break };
            units.push(unit);
            last = unit;
        }
        let count = units.len();
        let mut wrong_slot = None;
        // A delayed branch also needs its slot, in which no branch may stand.
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

    /// Returns the instructions and pairs of the block that were executed.
    #[inline]
    pub(crate) fn executed(&self, execution: Execution) -> &[Unit] {
        self.units.get(..execution.units + usize::from(execution.slot)).unwrap_or_default()
    }

    /// Returns the number of executed instructions. A pair counts as two.
    #[inline]
    pub(crate) fn instructions_of(&self, execution: Execution) -> u64 {
        let executed = self.executed(execution);
        if executed.len() == self.units.len() {
            self.instructions
        } else {
            executed.iter().map(Unit::instructions).sum()
        }
    }

    /// Returns an instruction or pair by its index. The delay slot has the last index.
    #[inline]
    pub(crate) fn unit(&self, number: usize) -> &Unit {
        &self.units[number]
    }

    /// Returns an address on the cache line of an instruction or pair, and the index of the first one after that line.
    #[inline]
    pub(crate) fn line(&self, number: usize) -> (u32, usize) {
        // Find the last line that begins at or before this instruction.
        let next = self.lines.iter().skip(1).position(|first| usize::from(*first) > number);
        let line = next.unwrap_or(self.lines.len() - 1);
        let end = self.lines.get(line + 1).map_or(usize::MAX, |first| usize::from(*first));
        (self.pc.wrapping_add(line as u32 * LINE_BYTES), end)
    }

    /// Returns true if the instruction cache holds the whole block.
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

    /// Returns true if the block begins at this address in this mode.
    #[inline]
    pub(crate) fn begins(&self, pc: u32, mode: Mode) -> bool {
        self.pc == pc && self.mode == mode
    }

    /// Returns true if an address lies after the first instruction or pair and before the end of the block, without its
    /// delay slot.
    #[inline]
    pub(crate) fn passes(&self, address: u32) -> bool {
        let offset = address.wrapping_sub(self.pc);
        offset != 0 && offset < self.next.wrapping_sub(self.pc)
    }
}
