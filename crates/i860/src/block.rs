//! Basic blocks of decoded code. A block extends from an address to the next branch, and includes the delay slot of the
//! branch.

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

/// Maximum number of issues in a block, without the delay slot. An issue is one instruction, or one pair of
/// instructions in dual-instruction mode.
const LONGEST: usize = 32;

/// Code that the processor issues in one clock: an instruction, or a pair of instructions.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Unit {
    pub(crate) pc: u32,
    pub(crate) mode: Mode,
    pub(crate) after: Mode,
    /// The single instruction, or the floating-point half of a pair.
    pub(crate) first: Decoded,
    /// The core half of a pair, or `None` for a single instruction.
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

    /// Returns the core half of a pair, or the single instruction. Only this instruction can access memory or branch.
    #[inline]
    pub(crate) fn core(&self) -> &Decoded {
        self.second.as_ref().unwrap_or(&self.first)
    }

    #[inline]
    pub(crate) fn core_pc(&self) -> u32 {
        self.pc.wrapping_add(if self.second.is_some() { 4 } else { 0 })
    }

    #[inline]
    pub(crate) fn next(&self) -> u32 {
        self.pc.wrapping_add(if self.second.is_some() { 8 } else { 4 })
    }

    pub(crate) fn instructions(&self) -> u64 {
        1 + u64::from(self.second.is_some())
    }

    /// Returns true if the block must end after this instruction. This is the case for `st.c`, which can change the
    /// code or its caching.
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

/// Initial value of [`Block::held_in`], which is not the number of any state of the instruction cache.
const NEVER: u64 = u64::MAX;

/// A basic block of instructions and pairs. It ends at a branch, at an instruction that cannot be executed, or at the
/// greatest length.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) pc: u32,
    mode: Mode,
    /// Pairing mode (single instructions or pairs) after the delay slot.
    pub(crate) after_slot: Mode,
    /// Pairing mode (single instructions or pairs) after the last instruction or pair before a delay slot.
    pub(crate) after: Mode,
    /// Address after the last instruction or pair before a delay slot. A delay slot begins at this address.
    pub(crate) next: u32,
    /// Number of instruction issues in the block. A single instruction and a pair each count as one issue. The delay
    /// slot does not count.
    pub(crate) count: usize,
    /// Number of instructions in the block. A pair counts as two instructions, and the delay slot counts too.
    pub(crate) instructions: u64,
    /// Number of the latest state of the instruction cache in which the cache contained the whole block.
    held_in: u64,
    /// Effects of the instructions and pairs, in the order of execution. The delay slot comes last.
    pub(crate) actions: Box<[Action]>,
    /// Instructions and pairs of the block that load or store data, in the order of execution.
    pub(crate) accessing: Box<[AccessingUnit]>,
    pub(crate) remembered: BlockMemory,
    /// All instructions and pairs of the block, in the order of execution. The delay slot comes last.
    units: Box<[Unit]>,
    /// Index of the first instruction or pair on each cache line of the block.
    lines: Box<[u8]>,
    /// Cause of the trap when the branch at the end executes, because the delay slot cannot be executed.
    pub(crate) wrong_slot: Option<TrapCause>,
}

/// Properties of a load or store that the timing model needs. They do not include the address and the data.
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

#[derive(Clone, Copy, Debug)]
pub(crate) struct AccessingUnit {
    pub(crate) access: Access,
    pub(crate) number: u8,
    pub(crate) is_store: bool,
    /// True if the access always uses the bus, even if the cache contains the data.
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

fn first_on_lines(units: &[Unit]) -> Box<[u8]> {
    let mut line = None;
    let lines = (0..).zip(units);
    let first = lines.filter(|(_, unit)| line.replace(unit.pc / LINE_BYTES) != Some(unit.pc / LINE_BYTES));
    first.map(|(number, _)| number).collect()
}

impl Block {
    /// Decodes the block that begins at address `pc` in pairing mode `mode`.
    ///
    /// # Errors
    /// Returns the cause of the trap if the first instruction or pair cannot be executed.
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
        // A delayed branch also needs a delay slot, which must not be a branch.
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

    #[inline]
    pub(crate) fn executed(&self, execution: Execution) -> &[Unit] {
        self.units.get(..execution.units + usize::from(execution.slot)).unwrap_or_default()
    }

    /// Returns the number of executed instructions of the block. A pair counts as two instructions.
    #[inline]
    pub(crate) fn instructions_of(&self, execution: Execution) -> u64 {
        let executed = self.executed(execution);
        if executed.len() == self.units.len() {
            self.instructions
        } else {
            executed.iter().map(Unit::instructions).sum()
        }
    }

    /// Returns the instruction or pair with index `number` in the block. The delay slot has the last index.
    #[inline]
    pub(crate) fn unit(&self, number: usize) -> &Unit {
        &self.units[number]
    }

    /// Returns an address on the cache line of instruction or pair `number`, and the index of the first instruction or
    /// pair after this cache line.
    #[inline]
    pub(crate) fn line(&self, number: usize) -> (u32, usize) {
        // Find the last line that begins at or before this instruction.
        let next = self.lines.iter().skip(1).position(|first| usize::from(*first) > number);
        let line = next.unwrap_or(self.lines.len() - 1);
        let end = self.lines.get(line + 1).map_or(usize::MAX, |first| usize::from(*first));
        (self.pc.wrapping_add(line as u32 * LINE_BYTES), end)
    }

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

    #[inline]
    pub(crate) fn begins(&self, pc: u32, mode: Mode) -> bool {
        self.pc == pc && self.mode == mode
    }

    /// Returns true if `address` is inside the block, after the first instruction or pair and before the delay slot.
    #[inline]
    pub(crate) fn passes(&self, address: u32) -> bool {
        let offset = address.wrapping_sub(self.pc);
        offset != 0 && offset < self.next.wrapping_sub(self.pc)
    }
}
