//! State that all parts of the clock share: the current clock, the profile, the bus and the pseudo-random numbers.

use crate::cache::Chance;
use crate::dram::{Dram, Transfer};
use crate::freeze::Costs;
use crate::profile::Profile;
use crate::timing::{Config, Freeze};

#[derive(Clone, Debug)]
pub(crate) struct Common {
    pub(crate) now: u64,
    /// Clock at which the profile was started. Every later clock is either a freeze clock or an issue clock.
    profile_start: u64,
    /// All counts of the profile except issue clocks, which [`Common::profile`] computes from the other clocks.
    pub(crate) profile: Profile,
    pub(crate) costs: Costs,
    pub(crate) bus: Dram,
    pub(crate) chance: Chance,
    /// Clock at which the latest line fill of the data cache ends. A miss of the instruction cache takes more clocks if
    /// it begins before this clock (row 1b of the freeze table).
    pub(crate) data_fill_end: u64,
    /// Clock at which the latest line fill of the instruction cache ends. A freeze that begins earlier lasts at least
    /// until this clock.
    pub(crate) instruction_fill_end: u64,
}

impl Common {
    pub(crate) fn new(config: &Config) -> Common {
        Common {
            now: 0,
            profile_start: 0,
            profile: Profile::new(),
            costs: Costs::new(&config.freezes),
            bus: Dram::new(config.dram),
            chance: Chance::new(config.replacement_seed),
            data_fill_end: 0,
            instruction_fill_end: 0,
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
        self.bus.transfers = 0;
        self.bus.page_misses = 0;
    }

    /// Freezes the processor until clock `until`, or until the arrival of a whole instruction-cache line if this is
    /// later (row 1 of the freeze table).
    #[inline]
    pub(crate) fn freeze_until(&mut self, until: u64, why: Freeze) {
        if until > self.now {
            let is_filling = self.is_filling();
            self.stand_still(until, why);
            if is_filling {
                self.stand_still(self.instruction_fill_end, Freeze::InstructionMiss);
            }
        }
    }

    /// Freezes the processor until an instruction arrives at clock `until`. The profile counts these clocks in row 1a
    /// of the freeze table.
    #[inline]
    pub(crate) fn await_instruction(&mut self, until: u64) {
        self.stand_still(until, Freeze::InstructionMiss);
    }

    /// Freezes the processor for the additional clocks of an instruction-cache miss during a line fill of the data
    /// cache (row 1b of the freeze table).
    pub(crate) fn await_instruction_behind_data(&mut self) {
        let until = self.now + self.costs.clocks(Freeze::InstructionMissBehindData);
        self.stand_still(until, Freeze::InstructionMissBehindData);
    }

    #[inline]
    pub(crate) fn is_filling(&self) -> bool {
        self.now < self.instruction_fill_end
    }

    #[inline]
    fn stand_still(&mut self, until: u64, why: Freeze) {
        if until > self.now {
            self.profile.frozen[why as usize] += until - self.now;
            self.now = until;
        }
    }

    /// Freezes the processor for the constant part of the delay in row `why` of the freeze table.
    #[inline]
    pub(crate) fn charge(&mut self, why: Freeze) {
        self.freeze_until(self.now + self.costs.clocks(why), why);
    }

    /// Reads `beats` transfers of 8 bytes for the data cache. The read starts as soon as the address pipe of the bus
    /// has room.
    pub(crate) fn read_data(&mut self, address: u32, beats: u32) -> Transfer {
        self.await_address_pipe();
        self.bus.read(self.now, address, beats)
    }

    /// Freezes the processor while three bus requests are outstanding.
    pub(crate) fn await_address_pipe(&mut self) {
        if self.costs.applies(Freeze::AddressPipeFull) {
            self.freeze_until(self.bus.accepts_at(), Freeze::AddressPipeFull);
        }
    }
}
