//! Instruction fetch: from the cache line of the last fetch, from another line of the instruction cache, or from
//! memory.

use crate::block::Block;
use crate::bus::Bus;
use crate::cache::InstructionTags;
use crate::common::Common;
use crate::memo::ArrivingLine;
use crate::timing::{ChipSizes, Freeze};
use crate::translation::Translation;

/// Value of `Fetch::line` if the fetch unit holds no cache line.
const NO_LINE: u32 = u32::MAX;
const LINE_BYTES: u32 = ChipSizes::PAPERS.line_bytes as u32;
const BEATS: u32 = LINE_BYTES / ChipSizes::PAPERS.bus_bytes as u32;

#[derive(Clone, Debug)]
pub(crate) struct Fetch {
    cache: InstructionTags,
    /// Number of the cache line from which the last instruction was fetched.
    line: u32,
    /// Clocks at which the 8-byte transfers of this cache line arrive, in the order of their addresses.
    arrivals: [u64; BEATS as usize],
    /// Index (0 to 3) of the 8 bytes of the cache line that arrive first.
    first: u8,
}

impl Fetch {
    pub(crate) fn new() -> Fetch {
        Fetch { cache: InstructionTags::new(), line: NO_LINE, arrivals: [0; BEATS as usize], first: 0 }
    }

    #[inline]
    pub(crate) fn line(&self) -> u32 {
        self.line
    }

    /// Records `line` as the cache line of the last fetch. The clock calls this function after it has reused memoized
    /// clocks, because it then counts no fetches.
    #[inline]
    pub(crate) fn continue_in(&mut self, line: u32) {
        self.line = line;
    }

    #[inline]
    pub(crate) fn is_in_line(&self, pc: u32) -> bool {
        pc / LINE_BYTES == self.line
    }

    /// Returns true if a fetch from address `pc` misses the instruction cache and uses the bus.
    #[inline]
    pub(crate) fn misses(&self, pc: u32) -> bool {
        !self.is_in_line(pc) && !self.cache.holds(pc)
    }

    /// Returns the part of a cache line that is still arriving from memory.
    #[inline]
    pub(crate) fn filling(&self, common: &Common) -> ArrivingLine {
        let clocks = common.instruction_fill_end.saturating_sub(common.now);
        ArrivingLine { clocks, first: if clocks == 0 { 0 } else { self.first } }
    }

    /// Gives all later states of the instruction cache numbers above `latest`. States of different processors then have
    /// different numbers.
    pub(crate) fn number_states_from(&mut self, latest: u64) {
        self.cache.number_changes_from(latest);
    }

    /// Returns the number of the current state of the instruction cache. It changes with every line fill.
    pub(crate) fn states(&self) -> u64 {
        self.cache.changes()
    }

    #[inline]
    pub(crate) fn holds(&self, block: &mut Block) -> bool {
        block.is_held(&self.cache)
    }

    pub(crate) fn clear(&mut self) {
        self.cache.clear();
        self.line = NO_LINE;
    }

    #[inline]
    pub(crate) fn fetch<B: Bus>(&mut self, pc: u32, translation: &mut Translation, common: &mut Common, bus: &B) {
        if pc / LINE_BYTES != self.line || common.is_filling() {
            self.fetch_new_line(pc, translation, common, bus);
        }
    }

    fn fetch_new_line<B: Bus>(&mut self, pc: u32, translation: &mut Translation, common: &mut Common, bus: &B) {
        if !common.costs.applies(Freeze::InstructionMiss) {
            return;
        }
        // A word of a line that is still arriving waits for the word's own transfer.
        if pc / LINE_BYTES == self.line {
            let arrival = self.arrivals[(pc / 8 % BEATS) as usize];
            return common.await_instruction(arrival);
        }
        // A new line waits for the end of the last fill.
        common.await_instruction(common.instruction_fill_end);
        translation.translate(pc, common);
        self.line = pc / LINE_BYTES;
        if !self.cache.holds(pc) {
            self.miss(pc, common, bus);
        }
    }

    fn miss<B: Bus>(&mut self, pc: u32, common: &mut Common, bus: &B) {
        // Row 1b applies if a fill of the data cache is running at the start of the miss.
        common.profile.instruction_misses += 1;
        let is_behind_data = common.now < common.data_fill_end;
        common.await_address_pipe();
        if bus.is_cacheable(pc) {
            self.fill_line(pc, common);
        } else {
            let word = common.bus.read(common.now, pc, 1);
            self.line = NO_LINE;
            common.await_instruction(word.first);
        }
        if is_behind_data {
            common.await_instruction_behind_data();
        }
    }

    fn fill_line(&mut self, pc: u32, common: &mut Common) {
        let random = common.chance.next();
        self.cache.fill(pc, random);
        let line = common.bus.read(common.now, pc, BEATS);
        // The needed word arrives first. The other words follow in cyclic order.
        for beat in 0..BEATS {
            self.arrivals[((pc / 8 + beat) % BEATS) as usize] = line.arrival(beat);
        }
        self.first = (pc / 8 % BEATS) as u8;
        common.instruction_fill_end = line.last;
        common.await_instruction(line.first);
    }
}
