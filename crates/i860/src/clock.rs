//! The clock: issue, freezes, caches, queues. Told of every block what it executed; changes no value.

use crate::block::{Block, Unit};
use crate::bus::Bus;
use crate::common::Common;
use crate::data_cache::DataCache;
use crate::decoded::{Decoded, hazard};
use crate::dram::Transfer;
use crate::execution::Execution;
use crate::fetch::Fetch;
use crate::instruction::{Instruction, Op};
use crate::load_pipe::LoadPipe;
use crate::memo::{Memo, RememberedClocks};
use crate::profile::{AddressProfile, Profile};
use crate::scoreboard::{NO_WAIT, Scoreboard};
use crate::store_pipe::StorePipe;
use crate::timing::{ChipSizes, Config, FREEZES, Freeze};
use crate::translation::Translation;

const BUS_BYTES: u32 = ChipSizes::PAPERS.bus_bytes as u32;

/// Addresses of data accesses, in order; at most one for each unit of a block.
#[derive(Clone, Debug, Default)]
pub(crate) struct Accesses(Vec<u32>);

impl Accesses {
    pub(crate) fn clear(&mut self) {
        self.0.clear();
    }

    #[inline]
    pub(crate) fn push(&mut self, address: u32) {
        self.0.push(address);
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Clock {
    on: bool,
    pub(crate) sampler: Option<AddressProfile>,
    common: Common,
    board: Scoreboard,
    fetch: Fetch,
    translation: Translation,
    data: DataCache,
    stores: StorePipe,
    loads: LoadPipe,
    /// Blocks whose clocks were counted before; `None` without memoisation.
    memo: Option<Memo>,
}

impl Clock {
    pub(crate) fn new(config: &Config) -> Clock {
        Clock {
            on: config.timing,
            sampler: None,
            common: Common::new(config),
            board: Scoreboard::new(config),
            fetch: Fetch::new(),
            translation: Translation::new(),
            data: DataCache::new(),
            stores: StorePipe::default(),
            loads: LoadPipe::default(),
            memo: config.memoise.then(Memo::new),
        }
    }

    #[inline]
    pub(crate) fn now(&self) -> u64 {
        self.common.now
    }

    #[inline]
    pub(crate) fn instructions(&self) -> u64 {
        self.common.profile.instructions
    }

    pub(crate) fn repeated_instructions(&self) -> u64 {
        self.memo.as_ref().map_or(0, |memo| memo.instructions)
    }

    pub(crate) fn profile(&self) -> Profile {
        self.common.profile()
    }

    pub(crate) fn clear_profile(&mut self) {
        self.common.clear_profile();
    }

    pub(crate) fn empty_caches(&mut self) {
        self.invalidate_instruction_cache();
        self.data.clear();
    }

    pub(crate) fn invalidate_instruction_cache(&mut self) {
        self.fetch.clear();
        self.translation.clear();
    }

    /// Page tables at this address, or none.
    pub(crate) fn set_translation(&mut self, directory: Option<u32>) {
        self.translation.set_directory(directory);
    }

    // ---- blocks

    /// Counts the clocks of what a block has executed.
    #[inline]
    pub(crate) fn pass<B: Bus>(&mut self, block: &mut Block, execution: Execution, accesses: &Accesses, bus: &B) {
        if !self.on {
            self.common.profile.instructions += block.instructions_of(execution);
        } else if let Some(entry) = self.entry(block, accesses) {
            match block.remembered.find(entry, execution) {
                Some(clocks) => self.repeat(clocks),
                None => self.learn(block, entry, execution, accesses, bus),
            }
        } else {
            self.count(block, execution, accesses, bus);
        }
    }

    /// Counts them one unit after the other.
    fn count<B: Bus>(&mut self, block: &Block, execution: Execution, accesses: &Accesses, bus: &B) {
        if let Some(left) = self.memo.as_mut().and_then(Memo::leave) {
            self.board.restore(left, self.common.now);
        }
        let mut accesses = accesses.0.iter();
        let last = execution.units + usize::from(execution.slot) - 1;
        block.executed(execution).enumerate().for_each(|(n, unit)| {
            self.common.profile.instructions += unit.instructions();
            self.unit(unit, execution.taken, execution.trapped && n == last, &mut accesses, bus);
        });
    }

    /// The number of the scoreboard when nothing else but it decides the clocks of what a block has executed: all its
    /// instructions and data are in the caches, and nothing of the rest is under way.
    #[inline]
    fn entry(&mut self, block: &mut Block, accesses: &Accesses) -> Option<u32> {
        let memo = self.memo.as_mut()?;
        let apart = self.common.is_filling() || self.translation.is_on() || self.sampler.is_some();
        if apart || !block.in_caches_only {
            return None;
        }
        if self.common.costs.applies(Freeze::InstructionMiss) && !self.fetch.holds(block) {
            return None;
        }
        if !self.data.holds_all(&accesses.0, block.stores) {
            return None;
        }
        memo.number(&self.board, self.common.now)
    }

    #[inline]
    fn repeat(&mut self, remembered: &RememberedClocks) {
        self.common.now += remembered.clocks;
        self.common.profile.instructions += remembered.instructions;
        for (why, clocks) in &remembered.frozen {
            self.common.profile.frozen[*why as usize] += clocks;
        }
        self.fetch.continue_in(remembered.line);
        if let Some(memo) = &mut self.memo {
            memo.follow(remembered);
        }
    }

    #[cold]
    fn learn<B: Bus>(&mut self, block: &mut Block, entry: u32, execution: Execution, accesses: &Accesses, bus: &B) {
        let began = self.common.now;
        let before = self.common.profile.clone();
        self.count(block, execution, accesses, bus);
        let Some(exit) = self.memo.as_mut().and_then(|memo| memo.number(&self.board, self.common.now)) else { return };
        let profile = &self.common.profile;
        let causes = FREEZES.iter().map(|row| (row.id, profile.frozen_by(row.id) - before.frozen_by(row.id)));
        block.remembered.add(RememberedClocks {
            entry,
            execution,
            exit,
            clocks: self.common.now - began,
            instructions: profile.instructions - before.instructions,
            frozen: causes.filter(|(_, clocks)| *clocks != 0).collect(),
            line: self.fetch.line(),
        });
    }

    // ---- units

    #[inline(always)]
    fn unit<B: Bus>(
        &mut self,
        unit: &Unit,
        taken: bool,
        trapped: bool,
        accesses: &mut std::slice::Iter<'_, u32>,
        bus: &B,
    ) {
        let before = self.common.now;
        self.fetch.fetch(unit.pc, &mut self.translation, &mut self.common, bus);
        match &unit.second {
            None => self.issue(&unit.first),
            Some(core) => self.issue_pair(&unit.first, core),
        }
        if trapped {
            return;
        }
        let core = unit.core();
        if core.is_told() {
            match core.is_branch() {
                true => self.end_of_branch(core.instruction.op, taken),
                false => self.access(&core.instruction, accesses, bus),
            }
        }
        self.board.retire(&unit.first, self.common.now);
        if let Some(core) = &unit.second {
            self.board.retire(core, self.common.now);
        }
        if let Some(sampler) = &mut self.sampler {
            sampler.add(unit.pc, self.common.now - before);
        }
    }

    fn end_of_branch(&mut self, op: Op, taken: bool) {
        match op {
            Op::Bc | Op::Bnc if taken => self.common.charge(Freeze::BranchTaken),
            Op::Bte | Op::Btne if taken => self.common.charge(Freeze::CompareBranchTaken),
            Op::BcT | Op::BncT | Op::Bla if !taken => self.common.charge(Freeze::DelayedBranchNotTaken),
            Op::Bri | Op::Calli => self.common.charge(Freeze::IndirectBranch),
            _ => {}
        }
    }

    /// Issues one instruction after its freezes.
    #[inline]
    fn issue(&mut self, d: &Decoded) {
        if self.board.may_wait(d) {
            let wait = self.board.wait(d, self.common.now);
            self.common.freeze_until(wait.until, wait.why);
        }
        self.common.now += 1;
    }

    /// Issues a pair: both halves wait for the longer freeze.
    #[inline]
    fn issue_pair(&mut self, floating: &Decoded, core: &Decoded) {
        let mut longest = NO_WAIT;
        for d in [floating, core] {
            if self.board.may_wait(d) {
                let wait = self.board.wait(d, self.common.now);
                if wait.until > longest.until {
                    longest = wait;
                }
            }
        }
        self.common.freeze_until(longest.until, longest.why);
        self.common.now += 1;
    }

    // ---- data accesses

    #[inline]
    fn access<B: Bus>(&mut self, i: &Instruction, accesses: &mut std::slice::Iter<'_, u32>, bus: &B) {
        if i.op == Op::StC {
            return self.common.charge(Freeze::ControlStore);
        }
        let Some(address) = accesses.next().copied() else { return };
        match i.op {
            Op::LdB | Op::LdS | Op::LdL => self.load_integer(address, i.dest, bus),
            Op::Fld => self.load_floating(address, i.size, bus),
            Op::Pfld => self.load_pipelined(address, u32::from(i.size)),
            Op::Flush => self.data.flush(address, &mut self.stores, &mut self.common),
            Op::Fst | Op::Pst => self.store(address, u32::from(i.size)),
            _ => self.store(address, 4),
        }
    }

    /// An integer load: a miss does not block, its destination becomes ready later.
    #[inline]
    fn load_integer<B: Bus>(&mut self, address: u32, dest: u8, bus: &B) {
        self.board.forget(dest);
        if let Some(transfer) = self.load(address, BUS_BYTES, bus)
            && self.common.costs.applies(Freeze::LoadMissUse)
        {
            let until = transfer.first + self.common.costs.clocks(Freeze::LoadMissUse);
            self.board.set_ready(1 << dest, until, Freeze::LoadMissUse);
        }
    }

    /// A floating-point load: a miss blocks until all that is needed is there, 16 bytes in two transfers.
    #[inline]
    fn load_floating<B: Bus>(&mut self, address: u32, size: u8, bus: &B) {
        if let Some(transfer) = self.load(address, u32::from(size), bus)
            && self.common.costs.applies(Freeze::FloatingLoadMiss)
        {
            let needed = u32::from(size).div_ceil(BUS_BYTES);
            let until = transfer.arrival(needed - 1) + self.common.costs.clocks(Freeze::FloatingLoadMiss);
            self.common.freeze_until(until, Freeze::FloatingLoadMiss);
        }
    }

    /// Looks `size` bytes up; gives the transfer of a miss.
    fn load<B: Bus>(&mut self, address: u32, size: u32, bus: &B) -> Option<Transfer> {
        self.translation.translate(address, &mut self.common);
        let transfer = self.data.load(address, size, &mut self.stores, &mut self.common, bus)?;
        self.hold_up(hazard::TRANSFER_IN_MISS, transfer.first, Freeze::TransferDuringMiss);
        self.hold_up(hazard::ACCESS_IN_MISS, transfer.last, Freeze::AccessDuringMiss);
        Some(transfer)
    }

    /// What comes before a clock in the course of a miss waits by the rule of a row, if that applies.
    fn hold_up(&mut self, hazard: u16, until: u64, why: Freeze) {
        if self.common.costs.applies(why) {
            self.board.set_hazard_until(hazard, until + self.common.costs.clocks(why), why);
        }
    }

    /// A store: into a held line, or through the store pipe to the bus (no allocation on a write miss).
    #[inline]
    fn store(&mut self, address: u32, size: u32) {
        self.translation.translate(address, &mut self.common);
        if self.data.store(address) {
            self.board.set_hazard(hazard::STORE_HIT, Freeze::LoadAfterStoreHit, self.common.now);
        } else {
            self.stores.store(address, size, &mut self.common);
        }
    }

    fn load_pipelined(&mut self, address: u32, size: u32) {
        self.translation.translate(address, &mut self.common);
        let is_in_cache = self.data.holds(address);
        self.loads.load(address, size, is_in_cache, &mut self.common);
    }
}
