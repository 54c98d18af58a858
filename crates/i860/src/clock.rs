//! The clock of the processor: instruction issue, freezes, caches and queues. It counts the time of every executed
//! block of code, and changes no register or memory.

use crate::block::{Access, Block, Execution, Unit};
use crate::bus::Bus;
use crate::common::Common;
use crate::data_cache::DataCache;
use crate::decoded::{Decoded, hazard};
use crate::dram::Transfer;
use crate::fetch::Fetch;
use crate::instruction::Op;
use crate::load_pipe::LoadPipe;
use crate::memo::{Memo, Numbers};
use crate::profile::{AddressProfile, Profile};
use crate::scoreboard::{NO_WAIT, Scoreboard};
use crate::store_pipe::StorePipe;
use crate::timing::{ChipSizes, Config, Freeze};
use crate::translation::Translation;

const BUS_BYTES: u32 = ChipSizes::PAPERS.bus_bytes as u32;

/// Addresses of the data accesses of a block of code, in program order. Each instruction or pair has at most one
/// access.
#[derive(Clone, Debug)]
pub(crate) struct Accesses {
    all: [u32; Accesses::MOST],
    count: usize,
    /// True if every access of the block so far has hit the data cache. False if some accesses were not checked.
    pub(crate) all_held: bool,
}

impl Accesses {
    /// Greatest number of accesses in the list: a power of two that is greater than the length of a block.
    const MOST: usize = 64;

    pub(crate) fn new() -> Accesses {
        Accesses { all: [0; Accesses::MOST], count: 0, all_held: false }
    }

    /// Discards the accesses of the previous block. If `looks_up` is true, each access of the new block is checked for
    /// a cache hit.
    #[inline]
    pub(crate) fn begin(&mut self, looks_up: bool) {
        self.count = 0;
        self.all_held = looks_up;
    }

    #[inline]
    pub(crate) fn push(&mut self, address: u32) {
        self.all[self.count % Accesses::MOST] = address;
        self.count += 1;
    }

    #[inline]
    fn addresses(&self) -> &[u32] {
        &self.all[..self.count.min(Accesses::MOST)]
    }
}

#[derive(Clone, Debug)]
pub(crate) struct Clock {
    on: bool,
    pub(crate) sampler: Option<AddressProfile>,
    pub(crate) common: Common,
    pub(crate) board: Scoreboard,
    pub(crate) fetch: Fetch,
    translation: Translation,
    pub(crate) data: DataCache,
    stores: StorePipe,
    loads: LoadPipe,
    pub(crate) memo: Option<Memo>,
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

    /// Exchanges the table of numbered scoreboard states with `numbers`, from a shared store of decoded programs. The
    /// memoized clocks in the store refer to states by these numbers.
    pub(crate) fn exchange_numbers(&mut self, numbers: &mut Box<Numbers>) {
        self.write_board();
        if let Some(memo) = &mut self.memo {
            std::mem::swap(&mut memo.numbers, numbers);
        }
    }

    pub(crate) fn set_translation(&mut self, directory: Option<u32>) {
        self.translation.set_directory(directory);
    }

    // ---- blocks

    /// Returns true if memoized clocks can be reused. With address translation or a profile by address, they cannot be
    /// reused, because every instruction must be counted.
    #[inline]
    pub(crate) fn repeats(&self) -> bool {
        self.on && self.memo.is_some() && !self.translation.is_on() && self.sampler.is_none()
    }

    /// Counts the clocks of the executed part of a block. Memoized clocks are reused if possible.
    #[inline]
    pub(crate) fn pass<B: Bus>(&mut self, block: &mut Block, execution: Execution, accesses: &Accesses, bus: &B) {
        if !(accesses.all_held && self.reuse_block_clocks(block, execution)) {
            self.count_block(block, execution, accesses, bus);
        }
    }

    #[inline(never)]
    fn count_block<B: Bus>(&mut self, block: &mut Block, execution: Execution, accesses: &Accesses, bus: &B) {
        if !self.on {
            self.common.profile.instructions += block.instructions_of(execution);
        } else if !self.repeats() {
            self.count(block, execution, accesses, bus);
        } else {
            self.go(block, execution, accesses.addresses(), bus);
        }
    }

    /// Counts the clocks of a block instruction by instruction (or pair by pair), without memoized clocks.
    fn count<B: Bus>(&mut self, block: &Block, execution: Execution, accesses: &Accesses, bus: &B) {
        self.write_board();
        let mut accesses = accesses.addresses().iter();
        let last = execution.units + usize::from(execution.slot) - 1;
        block.executed(execution).iter().enumerate().for_each(|(n, unit)| {
            let before = self.common.now;
            // Each instruction or pair is fetched and issued. If it does not trap, it is also completed.
            self.fetch(unit, bus);
            self.issue(unit);
            if !(execution.trapped && n == last) {
                self.end(unit, execution.taken, &mut accesses, bus);
                self.retire(unit);
                if let Some(sampler) = &mut self.sampler {
                    sampler.add(unit.pc, self.common.now - before);
                }
            }
        });
    }

    // ---- instructions and pairs

    #[inline]
    pub(crate) fn fetch<B: Bus>(&mut self, unit: &Unit, bus: &B) {
        self.common.profile.instructions += unit.instructions();
        self.fetch.fetch(unit.pc, &mut self.translation, &mut self.common, bus);
    }

    #[inline]
    pub(crate) fn issue(&mut self, unit: &Unit) {
        match &unit.second {
            None => self.issue_single(&unit.first),
            Some(core) => self.issue_pair(&unit.first, core),
        }
    }

    /// Counts the clocks that a data access, a branch or `st.c` takes after its issue.
    #[inline]
    pub(crate) fn end<B: Bus>(&mut self, unit: &Unit, taken: bool, accesses: &mut std::slice::Iter<'_, u32>, bus: &B) {
        let core = unit.core();
        if core.affects_clock() {
            match core.instruction.op {
                op if core.is_branch() => self.end_of_branch(op, taken),
                Op::StC => self.common.charge(Freeze::ControlStore),
                _ => {
                    if let Some(address) = accesses.next() {
                        self.access(Access::of(&core.instruction), *address, bus);
                    }
                }
            }
        }
    }

    #[inline]
    pub(crate) fn retire(&mut self, unit: &Unit) {
        self.board.retire(&unit.first, self.common.now);
        if let Some(core) = &unit.second {
            self.board.retire(core, self.common.now);
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

    /// Counts the clocks of all freezes of a single instruction, and the clock of its issue.
    #[inline]
    fn issue_single(&mut self, d: &Decoded) {
        if self.board.may_wait(d) {
            let wait = self.board.wait(d, self.common.now);
            self.common.freeze_until(wait.until, wait.why);
        }
        self.common.now += 1;
    }

    /// Counts the clocks of a pair's freeze, and the clock of its issue. The freeze of a pair is the longer freeze of
    /// its two instructions.
    #[inline]
    fn issue_pair(&mut self, floating: &Decoded, core: &Decoded) {
        // Find the longest wait of both halves.
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
    pub(crate) fn access<B: Bus>(&mut self, i: Access, address: u32, bus: &B) {
        match i.op {
            Op::LdB | Op::LdS | Op::LdL => self.load_integer(address, i.dest, bus),
            Op::Fld => self.load_floating(address, i.size, bus),
            Op::Pfld => self.load_pipelined(address, u32::from(i.size)),
            Op::Flush => self.data.flush(address, &mut self.stores, &mut self.common),
            Op::Fst | Op::Pst => self.store(address, u32::from(i.size)),
            _ => self.store(address, 4),
        }
    }

    /// Counts the clocks of an integer load. After a cache miss, execution continues, and the destination is ready
    /// later.
    #[inline]
    fn load_integer<B: Bus>(&mut self, address: u32, dest: u8, bus: &B) {
        self.board.release(dest);
        if let Some(transfer) = self.load(address, BUS_BYTES, bus)
            && self.common.costs.applies(Freeze::LoadMissUse)
        {
            let until = transfer.first + self.common.costs.clocks(Freeze::LoadMissUse);
            self.board.set_ready(1 << dest, until, Freeze::LoadMissUse);
        }
    }

    /// Counts the clocks of a floating-point load. A cache miss stops the processor until all requested bytes have
    /// arrived. A load of 16 bytes takes two transfers.
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

    /// Looks up `size` bytes in the data cache. Returns the bus transfer after a miss, and `None` after a hit.
    fn load<B: Bus>(&mut self, address: u32, size: u32, bus: &B) -> Option<Transfer> {
        self.translation.translate(address, &mut self.common);
        let transfer = self.data.load(address, size, &mut self.stores, &mut self.common, bus)?;
        // Some instructions wait for the first word of the miss, and others for the last word.
        self.delay_hazard(hazard::TRANSFER_IN_MISS, transfer.first, Freeze::TransferDuringMiss);
        self.delay_hazard(hazard::ACCESS_IN_MISS, transfer.last, Freeze::AccessDuringMiss);
        Some(transfer)
    }

    /// Delays all instructions of the class `hazard` until a cache miss ends at clock `until`. Does nothing if row
    /// `why` of the freeze table is disabled.
    fn delay_hazard(&mut self, hazard: u16, until: u64, why: Freeze) {
        if self.common.costs.applies(why) {
            self.board.set_hazard_until(hazard, until + self.common.costs.clocks(why), why);
        }
    }

    /// Counts the clocks of a store. If the data cache contains the cache line, the line becomes dirty. Otherwise the
    /// data go through the store pipe to the bus, and no line is filled.
    #[inline]
    fn store(&mut self, address: u32, size: u32) {
        self.translation.translate(address, &mut self.common);
        // A store that hits the cache delays only a load directly after the store.
        if self.data.access(address, true) {
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
