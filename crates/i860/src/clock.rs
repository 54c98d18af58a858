//! The clock: issue, freezes, caches, queues. Told of every block what it executed; changes no value.

use crate::block::{Block, Unit};
use crate::bus::Bus;
use crate::cache::{Chance, Tags};
use crate::decoded::{Decoded, hazard};
use crate::dram::{Dram, Transfer};
use crate::instruction::{Instruction, Op};
use crate::memo::{Memo, Passage};
use crate::profile::{AddressProfile, Profile};
use crate::scoreboard::{NO_WAIT, Scoreboard};
use crate::timing::{
    BUS_BYTES, Config, DATA_CACHE, FREEZES, Freeze, FreezeRules, INSTRUCTION_CACHE, PAGE_BYTES, STORE_DEPTH, TLB,
};

/// No line.
const NO_LINE: u32 = u32::MAX;

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

/// What became of a block that was executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Course {
    /// Units executed, not counting the slot.
    pub(crate) units: usize,
    /// Whether the slot was executed.
    pub(crate) slot: bool,
    /// Whether the branch at the end was taken.
    pub(crate) taken: bool,
    /// Whether the last of these units trapped.
    pub(crate) trapped: bool,
}

#[derive(Clone, Debug)]
pub(crate) struct Clock {
    pub(crate) on: bool,
    pub(crate) now: u64,
    /// Clock at which the profile was started; every clock since then is a freeze or an issue.
    profile_start: u64,
    rules: FreezeRules,
    pub(crate) profile: Profile,
    pub(crate) sampler: Option<AddressProfile>,
    board: Scoreboard,
    /// `None` without memoisation.
    memo: Option<Memo>,
    line: u32,
    line_words: [u64; 4],
    line_end: u64,
    instruction_cache: Tags,
    data_cache: Tags,
    tlb: Tags,
    translation: Option<u32>,
    chance: Chance,
    bus: Dram,
    miss_first: u64,
    miss_last: u64,
    loads: [u64; 3],
    stores: [u64; STORE_DEPTH],
    write_back_end: u64,
}

impl Clock {
    pub(crate) fn new(config: &Config) -> Clock {
        let cache = |(bytes, line, ways): (u32, u32, u32)| Tags::new(bytes / line, line, ways);
        Clock {
            on: config.timing,
            now: 0,
            profile_start: 0,
            rules: config.freezes,
            profile: Profile::new(),
            sampler: None,
            board: Scoreboard::new(config),
            memo: config.memoise.then(Memo::new),
            line: NO_LINE,
            line_words: [0; 4],
            line_end: 0,
            instruction_cache: cache(INSTRUCTION_CACHE),
            data_cache: cache(DATA_CACHE),
            tlb: Tags::new(TLB.0, PAGE_BYTES, TLB.1),
            translation: None,
            chance: Chance::new(config.replacement_seed),
            bus: Dram::new(config.dram),
            miss_first: 0,
            miss_last: 0,
            loads: [0; 3],
            stores: [0; STORE_DEPTH],
            write_back_end: 0,
        }
    }

    pub(crate) fn profile(&self) -> Profile {
        let frozen: u64 = self.profile.frozen.iter().sum();
        Profile {
            issue: self.now - self.profile_start - frozen,
            bus_requests: self.bus.transfers,
            page_misses: self.bus.page_misses,
            ..self.profile.clone()
        }
    }

    pub(crate) fn repeated_instructions(&self) -> u64 {
        self.memo.as_ref().map_or(0, |memo| memo.instructions)
    }

    pub(crate) fn clear_profile(&mut self) {
        self.profile = Profile::new();
        self.profile_start = self.now;
        (self.bus.transfers, self.bus.page_misses) = (0, 0);
    }

    /// Stands still until a clock.
    #[inline]
    fn freeze_until(&mut self, until: u64, why: Freeze) {
        if until > self.now {
            self.profile.frozen[why as usize] += until - self.now;
            self.now = until;
        }
    }

    /// Stands still for the constant part of a row.
    #[inline]
    fn charge(&mut self, why: Freeze) {
        self.freeze_until(self.now + self.rules.clocks(why), why);
    }

    // ---- units

    /// Counts the clocks of what a block has executed.
    #[inline]
    pub(crate) fn pass<B: Bus>(&mut self, block: &mut Block, course: Course, accesses: &Accesses, bus: &B) {
        if !self.on {
            self.profile.instructions += block.instructions_of(course);
        } else if let Some(entry) = self.entry(block, accesses) {
            match block.remembered.find(entry, course) {
                Some(passage) => self.repeat(passage),
                None => self.learn(block, entry, course, accesses, bus),
            }
        } else {
            self.count(block, course, accesses, bus);
        }
    }

    /// Counts them one unit after the other.
    fn count<B: Bus>(&mut self, block: &Block, course: Course, accesses: &Accesses, bus: &B) {
        if let Some(left) = self.memo.as_mut().and_then(Memo::leave) {
            self.board.restore(left, self.now);
        }
        let mut accesses = accesses.0.iter();
        let last = course.units + usize::from(course.slot) - 1;
        block.executed(course).enumerate().for_each(|(n, unit)| {
            self.profile.instructions += unit.instructions();
            self.unit(unit, course.taken, course.trapped && n == last, &mut accesses, bus);
        });
    }

    /// The number of the scoreboard when nothing else but it decides the clocks of what a block has executed: all its
    /// instructions and data are in the caches, and nothing of the rest is under way.
    #[inline]
    fn entry(&mut self, block: &mut Block, accesses: &Accesses) -> Option<u32> {
        let memo = self.memo.as_mut()?;
        let apart = self.now < self.line_end || self.translation.is_some() || self.sampler.is_some();
        if apart || !block.in_caches_only {
            return None;
        }
        let instructions = &self.instruction_cache;
        if self.rules.applies(Freeze::InstructionMiss) && !block.is_held(instructions) {
            return None;
        }
        // What is found before the first miss becomes dirty, as it does when counted.
        let is_held = |(n, address): (usize, &u32)| {
            let at = self.data_cache.find(*address)?;
            if block.stores >> n & 1 != 0 {
                self.data_cache.mark_dirty(at);
            }
            Some(())
        };
        accesses.0.iter().enumerate().try_for_each(is_held)?;
        memo.number(&self.board, self.now)
    }

    #[inline]
    fn repeat(&mut self, passage: &Passage) {
        self.now += passage.clocks;
        self.profile.instructions += passage.instructions;
        for (why, clocks) in &passage.frozen {
            self.profile.frozen[*why as usize] += clocks;
        }
        self.line = passage.line;
        if let Some(memo) = &mut self.memo {
            memo.follow(passage);
        }
    }

    #[cold]
    fn learn<B: Bus>(&mut self, block: &mut Block, entry: u32, course: Course, accesses: &Accesses, bus: &B) {
        let (now, before) = (self.now, self.profile.clone());
        self.count(block, course, accesses, bus);
        let Some(exit) = self.memo.as_mut().and_then(|memo| memo.number(&self.board, self.now)) else { return };
        let causes = FREEZES.iter().map(|row| (row.id, self.profile.frozen_by(row.id) - before.frozen_by(row.id)));
        block.remembered.add(Passage {
            entry,
            course,
            exit,
            clocks: self.now - now,
            instructions: self.profile.instructions - before.instructions,
            frozen: causes.filter(|(_, clocks)| *clocks != 0).collect(),
            line: self.line,
        });
    }

    #[inline(always)]
    fn unit<B: Bus>(
        &mut self,
        unit: &Unit,
        taken: bool,
        trapped: bool,
        accesses: &mut std::slice::Iter<'_, u32>,
        bus: &B,
    ) {
        let before = self.now;
        self.fetch(unit.pc, bus);
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
        self.board.retire(&unit.first, self.now);
        if let Some(core) = &unit.second {
            self.board.retire(core, self.now);
        }
        if let Some(sampler) = &mut self.sampler {
            sampler.add(unit.pc, self.now - before);
        }
    }

    fn end_of_branch(&mut self, op: Op, taken: bool) {
        match op {
            Op::Bc | Op::Bnc if taken => self.charge(Freeze::BranchTaken),
            Op::Bte | Op::Btne if taken => self.charge(Freeze::CompareBranchTaken),
            Op::BcT | Op::BncT | Op::Bla if !taken => self.charge(Freeze::DelayedBranchNotTaken),
            Op::Bri | Op::Calli => self.charge(Freeze::IndirectBranch),
            _ => {}
        }
    }

    #[inline]
    fn access<B: Bus>(&mut self, i: &Instruction, accesses: &mut std::slice::Iter<'_, u32>, bus: &B) {
        if i.op == Op::StC {
            return self.charge(Freeze::ControlStore);
        }
        let Some(address) = accesses.next().copied() else { return };
        match i.op {
            Op::LdB | Op::LdS | Op::LdL => self.load_integer(address, i.dest, bus),
            Op::Fld => self.load_floating(address, bus),
            Op::Pfld => self.load_pipelined(address, u32::from(i.size)),
            Op::Flush => self.flush(address),
            Op::Fst | Op::Pst => self.store(address, u32::from(i.size)),
            _ => self.store(address, 4),
        }
    }

    // ---- instruction fetch

    /// Fetches the word or the pair at `pc`.
    #[inline]
    fn fetch<B: Bus>(&mut self, pc: u32, bus: &B) {
        if pc >> 5 != self.line || self.now < self.line_end {
            self.fetch_slowly(pc, bus);
        }
    }

    fn fetch_slowly<B: Bus>(&mut self, pc: u32, bus: &B) {
        if !self.rules.applies(Freeze::InstructionMiss) {
            return;
        }
        if pc >> 5 == self.line {
            let arrival = self.line_words[(pc >> 3 & 3) as usize];
            return self.freeze_until(arrival, Freeze::InstructionMiss);
        }
        self.freeze_until(self.line_end, Freeze::InstructionMiss);
        self.translate(pc);
        self.line = pc >> 5;
        if self.instruction_cache.find(pc).is_none() {
            self.fill_instruction_line(pc, bus);
        }
    }

    fn fill_instruction_line<B: Bus>(&mut self, pc: u32, bus: &B) {
        self.profile.instruction_misses += 1;
        let behind_data = self.now < self.miss_last;
        if bus.is_cacheable(pc) {
            self.request_instruction_line(pc);
        } else {
            let word = self.bus.read(self.now, pc, 1);
            self.line = NO_LINE;
            self.freeze_until(word.first, Freeze::InstructionMiss);
        }
        if behind_data {
            self.charge(Freeze::InstructionMissBehindData);
        }
    }

    fn request_instruction_line(&mut self, pc: u32) {
        let random = self.chance.next();
        self.instruction_cache.fill(pc, random);
        let line = self.bus.read(self.now, pc, 4);
        let step = (line.last - line.first) / 3;
        for beat in 0..4 {
            self.line_words[((pc >> 3) as usize + beat) & 3] = line.first + beat as u64 * step;
        }
        self.line_end = line.last;
        self.freeze_until(line.first, Freeze::InstructionMiss);
    }

    pub(crate) fn empty_caches(&mut self) {
        self.invalidate_instruction_cache();
        self.data_cache.clear();
    }

    pub(crate) fn invalidate_instruction_cache(&mut self) {
        self.instruction_cache.clear();
        self.tlb.clear();
        self.line = NO_LINE;
    }

    /// Page tables at this address, or none. Addresses stay what they are; only TLB misses are charged.
    pub(crate) fn set_translation(&mut self, directory: Option<u32>) {
        self.translation = directory;
    }

    /// Charges a TLB miss: the constant part, a read of the directory, a read of a page table (the tables are
    /// taken to lie behind the directory).
    #[inline]
    fn translate(&mut self, address: u32) {
        if let Some(directory) = self.translation
            && self.rules.applies(Freeze::TlbMiss)
            && self.tlb.find(address).is_none()
        {
            let random = self.chance.next();
            self.tlb.fill(address, random);
            self.charge(Freeze::TlbMiss);
            let table = directory.wrapping_add((1 + (address >> 22)) * PAGE_BYTES);
            let first = self.bus.read(self.now, directory + (address >> 20 & 0xFFC), 1).first;
            let second = self.bus.read(first, table.wrapping_add(address >> 10 & 0xFFC), 1).first;
            self.freeze_until(second, Freeze::TlbMiss);
        }
    }

    // ---- issue

    /// Issues one instruction after its freezes.
    #[inline]
    fn issue(&mut self, d: &Decoded) {
        if self.board.may_wait(d) {
            let wait = self.board.wait(d, self.now);
            self.freeze_until(wait.until, wait.why);
        }
        self.now += 1;
    }

    /// Issues a pair: both halves wait for the longer freeze.
    #[inline]
    fn issue_pair(&mut self, floating: &Decoded, core: &Decoded) {
        let mut longest = NO_WAIT;
        for d in [floating, core] {
            if self.board.may_wait(d) {
                let wait = self.board.wait(d, self.now);
                if wait.until > longest.until {
                    longest = wait;
                }
            }
        }
        self.freeze_until(longest.until, longest.why);
        self.now += 1;
    }

    // ---- data accesses

    /// Waits for room in the address pipe, then gives the clock of the request.
    fn request(&mut self) -> u64 {
        if self.rules.applies(Freeze::AddressPipeFull) {
            self.freeze_until(self.bus.accepts_at(), Freeze::AddressPipeFull);
        }
        self.now
    }

    /// Brings a line in, the needed word first; a dirty line that leaves is written after it.
    fn fill_data_line(&mut self, address: u32) -> Transfer {
        self.profile.data_misses += 1;
        let at = self.request();
        let transfer = self.bus.read(at, address, 4);
        let random = self.chance.next();
        if let Some(victim) = self.data_cache.fill(address, random) {
            self.write_back_end = self.bus.write(transfer.last, victim, 4).last;
        }
        transfer
    }

    fn read_around_cache(&mut self, address: u32, beats: u32) -> Transfer {
        let at = self.request();
        self.bus.read(at, address, beats)
    }

    fn start_miss<B: Bus>(&mut self, address: u32, bus: &B) -> Option<Transfer> {
        self.translate(address);
        if self.data_cache.find(address).is_some() {
            return None;
        }
        let transfer = match bus.is_cacheable(address) {
            true => self.fill_data_line(address),
            false => self.read_around_cache(address, 1),
        };
        (self.miss_first, self.miss_last) = (transfer.first, transfer.last);
        let surcharge = self.rules.clocks(Freeze::TransferDuringMiss);
        if self.rules.applies(Freeze::TransferDuringMiss) {
            self.board.set_hazard_until(
                hazard::TRANSFER_IN_MISS,
                transfer.first + surcharge,
                Freeze::TransferDuringMiss,
            );
        }
        let surcharge = self.rules.clocks(Freeze::AccessDuringMiss);
        if self.rules.applies(Freeze::AccessDuringMiss) {
            self.board.set_hazard_until(hazard::ACCESS_IN_MISS, transfer.last + surcharge, Freeze::AccessDuringMiss);
        }
        Some(transfer)
    }

    /// An integer load: a miss does not block, its destination becomes ready later.
    #[inline]
    fn load_integer<B: Bus>(&mut self, address: u32, dest: u8, bus: &B) {
        self.board.forget(dest);
        if let Some(transfer) = self.start_miss(address, bus) {
            let until = transfer.first + self.rules.clocks(Freeze::LoadMissUse);
            if self.rules.applies(Freeze::LoadMissUse) {
                self.board.set_ready(1 << dest, until, Freeze::LoadMissUse);
            }
        }
    }

    /// A floating-point load: a miss blocks until the needed word is there.
    #[inline]
    fn load_floating<B: Bus>(&mut self, address: u32, bus: &B) {
        if let Some(transfer) = self.start_miss(address, bus)
            && self.rules.applies(Freeze::FloatingLoadMiss)
        {
            let until = transfer.first + self.rules.clocks(Freeze::FloatingLoadMiss);
            self.freeze_until(until, Freeze::FloatingLoadMiss);
        }
    }

    /// A store: into a held line, or through the store pipe to the bus (no allocation on a write miss).
    #[inline]
    fn store(&mut self, address: u32, size: u32) {
        self.translate(address);
        if let Some(at) = self.data_cache.find(address) {
            self.data_cache.mark_dirty(at);
            self.board.set_hazard(hazard::STORE_HIT, Freeze::LoadAfterStoreHit, self.now);
            return;
        }
        self.store_through(address, size);
    }

    fn store_through(&mut self, address: u32, size: u32) {
        if self.rules.applies(Freeze::StorePipeFull) {
            let surcharge = self.rules.clocks(Freeze::StorePipeFull);
            let blocked = self.stores[0].max(self.write_back_end);
            if blocked > self.now {
                self.freeze_until(blocked + surcharge, Freeze::StorePipeFull);
            }
        }
        let beats = size.div_ceil(BUS_BYTES);
        let end = self.bus.write(self.now, address, beats).last;
        let [_, second, third] = self.stores;
        self.stores = [second, third, end];
    }

    /// A pipelined load goes around the cache; its data come three `pfld` later.
    fn load_pipelined(&mut self, address: u32, size: u32) {
        self.translate(address);
        let [oldest, second, third] = self.loads;
        if oldest > self.now && self.rules.applies(Freeze::LoadPipeFull) {
            self.freeze_until(oldest + self.rules.clocks(Freeze::LoadPipeFull), Freeze::LoadPipeFull);
        }
        let arrival = match self.data_cache.find(address) {
            Some(_) => self.pipelined_hit(),
            None => self.read_around_cache(address, size.div_ceil(BUS_BYTES)).first,
        };
        self.loads = [second, third, arrival];
    }

    fn pipelined_hit(&mut self) -> u64 {
        if self.rules.applies(Freeze::PipelinedLoadHit) {
            let until = self.bus.idle_at().max(self.now) + self.rules.clocks(Freeze::PipelinedLoadHit);
            self.freeze_until(until, Freeze::PipelinedLoadHit);
        }
        self.now
    }

    /// Writes a dirty line back.
    fn flush(&mut self, address: u32) {
        if self.data_cache.clean(address) {
            self.write_back_end = self.bus.write(self.now, address, 4).last;
        }
    }
}
