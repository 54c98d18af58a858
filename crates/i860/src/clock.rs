//! The clock: issue, freezes, caches, queues. Asked before, during and after every instruction; changes no value.

use crate::bus::Bus;
use crate::cache::{Chance, Tags};
use crate::decoded::{Decoded, arm, float_mask, hazard};
use crate::dram::{Dram, Transfer};
use crate::instruction::{Flags, Instruction, Op};
use crate::profile::{AddressProfile, Profile};
use crate::timing::{
    BUS_BYTES, Config, DATA_CACHE, Freeze, FreezeRules, INSTRUCTION_CACHE, PAGE_BYTES, STORE_DEPTH, TLB,
};

/// No line.
const NO_LINE: u32 = u32::MAX;
/// Matches no source, not even that of an instruction without one.
const NO_RESULT: u8 = 0xFE;

/// A wait that a hazard imposes: until when, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Wait {
    until: u64,
    why: Freeze,
}

const NO_WAIT: Wait = Wait { until: 0, why: Freeze::LoadUse };

#[derive(Clone, Debug)]
pub(crate) struct Clock {
    pub(crate) on: bool,
    /// What instructions leave behind that matters under the rules.
    arms_seen: u16,
    pub(crate) now: u64,
    /// Clock at which the profile was started; every clock since then is a freeze or an issue.
    profile_start: u64,
    rules: FreezeRules,
    pub(crate) profile: Profile,
    pub(crate) sampler: Option<AddressProfile>,
    /// Registers (r in the low word, f in the high) whose value may not be there yet.
    pending: u64,
    ready: [Wait; 64],
    armed: u16,
    hazards: [Wait; hazard::COUNT],
    /// Result of the last floating-point instruction, for row 9.
    last_result: u8,
    last_result_until: u64,
    scalar_double: bool,
    graphics_result: u64,
    stored: u64,
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

fn arms_seen(config: &Config) -> u16 {
    match (config.timing, config.freezes.logicals_delay_branches) {
        (false, _) => 0,
        (true, false) => !arm::LOGICAL,
        (true, true) => !0,
    }
}

impl Clock {
    pub(crate) fn new(config: &Config) -> Clock {
        let cache = |(bytes, line, ways): (u32, u32, u32)| Tags::new(bytes / line, line, ways);
        Clock {
            on: config.timing,
            arms_seen: arms_seen(config),
            now: 0,
            profile_start: 0,
            rules: config.freezes,
            profile: Profile::new(),
            sampler: None,
            pending: 0,
            ready: [NO_WAIT; 64],
            armed: 0,
            hazards: [NO_WAIT; hazard::COUNT],
            last_result: NO_RESULT,
            last_result_until: 0,
            scalar_double: false,
            graphics_result: 0,
            stored: 0,
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
    pub(crate) fn charge(&mut self, why: Freeze) {
        if self.on {
            self.freeze_until(self.now + self.rules.clocks(why), why);
        }
    }

    // ---- instruction fetch

    /// Fetches the word or the pair at `pc`.
    #[inline]
    pub(crate) fn fetch<B: Bus>(&mut self, pc: u32, bus: &B) {
        if self.on && (pc >> 5 != self.line || self.now < self.line_end) {
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
    pub(crate) fn issue(&mut self, d: &Decoded) {
        self.profile.instructions += 1;
        if !self.on {
            return;
        }
        if self.may_wait(d) {
            let wait = self.wait(d);
            self.freeze_until(wait.until, wait.why);
        }
        self.now += 1;
    }

    /// Issues a pair: both halves wait for the longer freeze.
    #[inline]
    pub(crate) fn issue_pair(&mut self, floating: &Decoded, core: &Decoded) {
        self.profile.instructions += 2;
        if !self.on {
            return;
        }
        let mut longest = NO_WAIT;
        for d in [floating, core] {
            if self.may_wait(d) {
                let wait = self.wait(d);
                if wait.until > longest.until {
                    longest = wait;
                }
            }
        }
        self.freeze_until(longest.until, longest.why);
        self.now += 1;
    }

    #[inline]
    fn may_wait(&self, d: &Decoded) -> bool {
        d.reads & self.pending != 0 || d.sensitive & self.armed != 0 || d.multiplier_source == self.last_result
    }

    /// The longest wait of an instruction; forgets hazards that are over.
    fn wait(&mut self, d: &Decoded) -> Wait {
        let mut longest = self.wait_for_registers(d.reads);
        let mut bits = d.sensitive & self.armed;
        while bits != 0 {
            let n = bits.trailing_zeros() as usize;
            bits &= bits - 1;
            let wait = self.wait_for_hazard(n, d);
            if wait.until > longest.until {
                longest = wait;
            }
        }
        if d.multiplier_source == self.last_result && self.last_result_until > longest.until {
            longest = Wait { until: self.last_result_until, why: Freeze::MultiplierFirstSource };
        }
        longest
    }

    fn wait_for_registers(&mut self, reads: u64) -> Wait {
        let mut longest = NO_WAIT;
        let mut bits = reads & self.pending;
        while bits != 0 {
            let wait = self.ready[bits.trailing_zeros() as usize];
            if wait.until <= self.now {
                self.pending &= !(bits & bits.wrapping_neg());
            } else if wait.until > longest.until {
                longest = wait;
            }
            bits &= bits - 1;
        }
        longest
    }

    fn wait_for_hazard(&mut self, n: usize, d: &Decoded) -> Wait {
        let wait = self.hazards[n];
        if wait.until <= self.now {
            self.armed &= !(1 << n);
            return NO_WAIT;
        }
        match 1u16 << n {
            hazard::SCALAR => self.behind_scalar(wait, &d.instruction),
            hazard::GRAPHICS => self.behind_graphics(wait, d),
            hazard::STORED => self.behind_store(wait, &d.instruction),
            _ => wait,
        }
    }

    fn behind_scalar(&self, mut wait: Wait, i: &Instruction) -> Wait {
        let floating = i.is_floating() && i.op != Op::Fxfr;
        if floating && i.has(Flags::SOURCE_DOUBLE) != self.scalar_double {
            wait.until += self.rules.clocks(Freeze::ScalarPrecisionChange);
        }
        let pipelined = i.op == Op::DualOp || i.is_floating() && i.has(Flags::PIPELINED);
        if pipelined && i.dest >= 2 {
            wait.until += self.rules.clocks(Freeze::ScalarThenPipelined);
        }
        wait
    }

    fn behind_graphics(&self, wait: Wait, d: &Decoded) -> Wait {
        let why = if d.instruction.uses_graphics() { Freeze::GraphicsToGraphics } else { Freeze::GraphicsToFloating };
        if d.reads & self.graphics_result == 0 {
            return NO_WAIT;
        }
        Wait { until: wait.until - 1 + self.rules.clocks(why), why }
    }

    fn behind_store(&self, wait: Wait, i: &Instruction) -> Wait {
        let bytes = if i.has(Flags::RESULT_DOUBLE) { 8 } else { 4 };
        if float_mask(i.dest, bytes) & self.stored == 0 || i.dest < 2 { NO_WAIT } else { wait }
    }

    // ---- what an instruction leaves behind

    /// Records the hazards that an instruction leaves. Called once it has executed.
    #[inline]
    pub(crate) fn retire(&mut self, d: &Decoded) {
        match d.arms & self.arms_seen {
            0 => {}
            arm::CONDITION => self.set_hazard(hazard::CONDITION, Freeze::ConditionUse),
            arm::FLOATING_RESULT => self.note_result(&d.instruction),
            _ => self.arm(d),
        }
    }

    #[inline]
    fn note_result(&mut self, i: &Instruction) {
        self.last_result = if i.has(Flags::RESULT_DOUBLE) { i.dest & 30 } else { i.dest };
        self.last_result_until = self.now + self.rules.clocks(Freeze::MultiplierFirstSource);
    }

    fn arm(&mut self, d: &Decoded) {
        let i = &d.instruction;
        if d.arms & arm::FLOATING_RESULT != 0 {
            self.note_result(i);
        } else if d.is_floating() && i.op != Op::Fnop {
            self.last_result = NO_RESULT;
        }
        if d.arms & (arm::LOAD | arm::LONG_LOAD | arm::SEED) != 0 {
            self.arm_destination(d);
        }
        if d.arms & (arm::SCALAR | arm::SCALAR_DOUBLE_MULTIPLY) != 0 {
            self.arm_scalar(d);
        }
        self.arm_short(d);
    }

    #[inline]
    fn set_hazard(&mut self, bit: u16, why: Freeze) {
        self.set_hazard_until(bit, self.now + self.rules.clocks(why), why);
    }

    #[inline]
    fn set_hazard_until(&mut self, bit: u16, until: u64, why: Freeze) {
        self.armed |= bit;
        self.hazards[bit.trailing_zeros() as usize] = Wait { until, why };
    }

    fn set_ready(&mut self, mask: u64, until: u64, why: Freeze) {
        let mut bits = mask & !(1 | 3 << 32);
        self.pending |= bits;
        while bits != 0 {
            self.ready[bits.trailing_zeros() as usize] = Wait { until, why };
            bits &= bits - 1;
        }
    }

    fn arm_destination(&mut self, d: &Decoded) {
        let i = &d.instruction;
        let (mask, why) = match i.op {
            Op::Call | Op::Calli => (1 << 1, Freeze::LoadUse),
            Op::LdB | Op::LdS | Op::LdL | Op::LdC | Op::Fxfr => (1 << i.dest, Freeze::LoadUse),
            Op::Frcp | Op::Frsqr => {
                let bytes = if i.has(Flags::RESULT_DOUBLE) { 8 } else { 4 };
                (float_mask(i.dest, bytes), Freeze::SeedUse)
            }
            _ => (float_mask(i.dest, i.size.max(4)), Freeze::FloatingLoadUse),
        };
        let until = self.now + self.rules.clocks(why);
        let missed = mask & self.pending != 0 && self.ready[mask.trailing_zeros() as usize].until > until;
        if !(missed && why == Freeze::LoadUse) {
            self.set_ready(mask, until, why);
        }
    }

    fn arm_scalar(&mut self, d: &Decoded) {
        let long = d.arms & arm::SCALAR_DOUBLE_MULTIPLY != 0;
        let why = if long { Freeze::ScalarDoubleMultiplyBusy } else { Freeze::ScalarBusy };
        self.scalar_double = d.instruction.has(Flags::RESULT_DOUBLE);
        self.set_hazard(hazard::SCALAR, why);
    }

    fn arm_short(&mut self, d: &Decoded) {
        let logical = d.arms & arm::LOGICAL != 0 && self.rules.logicals_delay_branches;
        if d.arms & arm::CONDITION != 0 || logical {
            self.set_hazard(hazard::CONDITION, Freeze::ConditionUse);
        }
        if d.arms & arm::DOUBLE_MULTIPLY != 0 {
            self.set_hazard(hazard::DOUBLE_MULTIPLY, Freeze::DoubleMultiply);
        }
        if d.arms & arm::GRAPHICS != 0 {
            self.graphics_result = float_mask(d.instruction.dest, 8) & !(3 << 32);
            self.set_hazard_until(hazard::GRAPHICS, self.now + 1, Freeze::GraphicsToFloating);
        }
        if d.arms & arm::FLUSH != 0 {
            self.set_hazard(hazard::FLUSH, Freeze::FlushAfterFlush);
        }
        if d.arms & arm::STORED != 0 {
            self.stored = float_mask(d.instruction.dest, d.instruction.size);
            self.set_hazard(hazard::STORED, Freeze::StoreThenOverwrite);
        }
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
            self.set_hazard_until(hazard::TRANSFER_IN_MISS, transfer.first + surcharge, Freeze::TransferDuringMiss);
        }
        let surcharge = self.rules.clocks(Freeze::AccessDuringMiss);
        if self.rules.applies(Freeze::AccessDuringMiss) {
            self.set_hazard_until(hazard::ACCESS_IN_MISS, transfer.last + surcharge, Freeze::AccessDuringMiss);
        }
        Some(transfer)
    }

    /// An integer load: a miss does not block, its destination becomes ready later.
    #[inline]
    pub(crate) fn load_integer<B: Bus>(&mut self, address: u32, dest: u8, bus: &B) {
        if !self.on {
            return;
        }
        self.pending &= !(1 << dest);
        if let Some(transfer) = self.start_miss(address, bus) {
            let until = transfer.first + self.rules.clocks(Freeze::LoadMissUse);
            if self.rules.applies(Freeze::LoadMissUse) {
                self.set_ready(1 << dest, until, Freeze::LoadMissUse);
            }
        }
    }

    /// A floating-point load: a miss blocks until the needed word is there.
    #[inline]
    pub(crate) fn load_floating<B: Bus>(&mut self, address: u32, bus: &B) {
        if !self.on {
            return;
        }
        if let Some(transfer) = self.start_miss(address, bus)
            && self.rules.applies(Freeze::FloatingLoadMiss)
        {
            let until = transfer.first + self.rules.clocks(Freeze::FloatingLoadMiss);
            self.freeze_until(until, Freeze::FloatingLoadMiss);
        }
    }

    /// A store: into a held line, or through the store pipe to the bus (no allocation on a write miss).
    #[inline]
    pub(crate) fn store(&mut self, address: u32, size: u32) {
        if !self.on {
            return;
        }
        self.translate(address);
        if let Some(at) = self.data_cache.find(address) {
            self.data_cache.mark_dirty(at);
            self.set_hazard(hazard::STORE_HIT, Freeze::LoadAfterStoreHit);
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
    pub(crate) fn load_pipelined(&mut self, address: u32, size: u32) {
        if !self.on {
            return;
        }
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
    pub(crate) fn flush(&mut self, address: u32) {
        if self.on && self.data_cache.clean(address) {
            self.write_back_end = self.bus.write(self.now, address, 4).last;
        }
    }
}
