//! Counting of the clocks of a basic block in parts. Those of a *run*, whose instructions and data are all in the
//! caches, are memoized and reused. Those of accesses between two runs, which need the bus, are counted each time.
//!
//! A *place* is a position in a block: three times the index of an instruction or pair, plus 1 after its fetch or plus
//! 2 after its issue. A run ends before an access that needs the bus, before a cache line that is not in the
//! instruction cache, or at the end of the executed code. The next one begins with the scoreboard after that access.

use crate::block::{AccessingUnit, Block, Execution};
use crate::bus::Bus;
use crate::clock::Clock;
use crate::memo::{Memo, Number, RememberedClocks, Run};
use crate::timing::Freeze;

/// Number of positions of each instruction or pair: before its fetch, before its issue, and after its issue.
const PLACES: usize = 3;
const FETCHED: usize = 1;
const ISSUED: usize = 2;

/// Progress of the clock in a block: the executed part, and the position up to which clocks are counted.
struct Course<'a> {
    execution: Execution,
    units: usize,
    last: usize,
    accesses: &'a [u32],
    accessed: usize,
    /// Position up to which clocks are counted. Each instruction or pair has [`PLACES`] positions.
    at: usize,
}

impl Course<'_> {
    /// Returns the three flags in the key of a run, the part of a block up to position `to`. The flags are: the branch
    /// was taken, the last instruction trapped, and the first fetch is from a cache line that is still arriving
    /// (`continues`).
    #[inline]
    fn flags(&self, to: usize, continues: bool) -> [bool; 3] {
        let ends = to == PLACES * self.units || to > PLACES * self.last;
        [ends && self.execution.taken, ends && self.execution.trapped, continues]
    }
}

impl Clock {
    /// Reuses the memoized clocks of a whole block whose data accesses all hit the cache. Returns false if the block is
    /// not in the instruction cache, or if the clocks of the whole block are not memoized.
    #[inline]
    pub(crate) fn reuse_block_clocks(&mut self, block: &mut Block, execution: Execution) -> bool {
        let Some(entry) = self.memo.as_ref().and_then(Memo::present) else { return false };
        if !self.holds(block) {
            return false;
        }
        // The whole block is one run, from its first place to its last.
        let to = PLACES * (execution.units + usize::from(execution.slot));
        let continues = entry.is_filling() && self.fetch.is_in_line(block.pc);
        let run = Run::new(entry, [0, to], [execution.taken, execution.trapped, continues]);
        let Some(clocks) = block.remembered.find(run) else { return false };
        self.repeat(clocks);
        true
    }

    /// Returns true if fetches from the block add no clocks, because the block is in the instruction cache or because
    /// fetches take no time.
    #[inline]
    fn holds(&self, block: &mut Block) -> bool {
        !self.common.costs.applies(Freeze::InstructionMiss) || self.fetch.holds(block)
    }

    /// Counts the clocks of a block. Accesses that need the bus divide the block into parts, whose memoized clocks are
    /// reused.
    #[inline]
    pub(crate) fn go<B: Bus>(&mut self, block: &mut Block, execution: Execution, accesses: &[u32], bus: &B) {
        let units = execution.units + usize::from(execution.slot);
        let last = block.count - 1;
        let mut course = Course { execution, units, last, accesses, accessed: 0, at: 0 };
        let whole = self.holds(block);
        while course.at < PLACES * units {
            match self.number() {
                // If the state has a number, the next run can be memoized. Otherwise, one instruction or pair is
                // counted.
                Some(entry) => self.next_run(block, &mut course, entry, whole, bus),
                None => {
                    let to = (course.at / PLACES + 1) * PLACES;
                    self.advance(block, &mut course, to, bus);
                }
            }
        }
    }

    #[inline]
    fn number(&mut self) -> Option<Number> {
        let memo = self.memo.as_mut()?;
        memo.present().or_else(|| memo.number_of(&self.board, self.common.now, self.fetch.filling(&self.common)))
    }

    /// Writes the current state into the scoreboard. While memoized clocks were reused, the model knew only the number
    /// of this state.
    #[inline]
    pub(crate) fn write_board(&mut self) {
        if let Some(left) = self.memo.as_mut().and_then(Memo::leave) {
            self.board.restore(left, self.common.now);
        }
    }

    /// Counts the clocks up to the end of the current run (a part of the block). Also counts the clocks of the access
    /// or cache miss that ends the run.
    #[inline]
    fn next_run<B: Bus>(&mut self, block: &mut Block, course: &mut Course<'_>, entry: Number, whole: bool, bus: &B) {
        let number = course.at / PLACES;
        let is_unfetched = course.at.is_multiple_of(PLACES);
        // If the whole block is in the cache, cache lines matter only if the run begins with a fetch while a line is
        // arriving.
        let (line, end) = match whole && !(entry.is_filling() && is_unfetched) {
            true => (0, usize::MAX),
            false => block.line(number),
        };
        if !whole && is_unfetched && self.fetch.misses(line) {
            return self.miss(block, course, bus);
        }
        let limit = if whole { course.units } else { end.min(course.units) };
        // Find the access that ends the run, then reuse or count the clocks up to it.
        let (held, missing) = self.data.held(course.accesses, &block.accessing, course.accessed, limit);
        let to = missing.map_or(PLACES * limit, |unit| PLACES * unit + ISSUED);
        let continues = entry.is_filling() && is_unfetched && self.fetch.is_in_line(line);
        let run = Run::new(entry, [course.at, to], course.flags(to, continues));
        match block.remembered.find(run) {
            Some(clocks) => {
                self.repeat(clocks);
                course.accessed = held;
                course.at = to;
            }
            None => self.learn(block, course, run, bus),
        }
        // The access that ended the run needs the bus, so its clocks are counted.
        if missing.is_some() {
            let address = course.accesses[course.accessed];
            self.count_cache_exit(&block.accessing[course.accessed], address, bus);
            course.accessed += 1;
        }
    }

    #[inline]
    fn count_cache_exit<B: Bus>(&mut self, unit: &AccessingUnit, address: u32, bus: &B) {
        if !unit.is_store {
            self.write_board();
            return self.access(unit.access, address, bus);
        }
        // A store that misses the cache adds no wait to the scoreboard. If the store itself does not wait, the
        // scoreboard stays the same.
        let before = self.common.now;
        self.access(unit.access, address, bus);
        if self.common.now != before
            && let Some(left) = self.memo.as_mut().and_then(Memo::leave)
        {
            self.board.restore(left, before);
        }
    }

    fn miss<B: Bus>(&mut self, block: &Block, course: &mut Course<'_>, bus: &B) {
        self.write_board();
        let unit = block.unit(course.at / PLACES);
        self.fetch(unit, bus);
        course.at += FETCHED;
        if !self.fetch.is_in_line(unit.pc) {
            // Memory that is not cacheable fills no cache line, so this instruction or pair is counted alone.
            let to = (course.at / PLACES + 1) * PLACES;
            self.advance(block, course, to, bus);
        }
    }

    /// Counts clocks up to position `to` in the block. If counting starts after the issue of an instruction, the data
    /// access of this instruction was already counted.
    fn advance<B: Bus>(&mut self, block: &Block, course: &mut Course<'_>, to: usize, bus: &B) {
        self.write_board();
        let from = course.at;
        let mut accesses = course.accesses[course.accessed..].iter();
        while course.at < to {
            let number = course.at / PLACES;
            let unit = block.unit(number);
            // Fetch, issue and completion each advance the place by one.
            match course.at % PLACES {
                0 => self.fetch(unit, bus),
                FETCHED => self.issue(unit),
                _ if course.execution.trapped && number + 1 == course.units => {}
                _ => {
                    if course.at != from {
                        self.end(unit, course.execution.taken, &mut accesses, bus);
                    }
                    self.retire(unit);
                }
            }
            course.at += 1;
        }
        course.accessed = course.accesses.len() - accesses.len();
    }

    #[inline]
    fn repeat(&mut self, remembered: &RememberedClocks) {
        self.common.now += u64::from(remembered.clocks);
        self.common.profile.instructions += u64::from(remembered.instructions);
        remembered.waited.add_to(&mut self.common.profile.frozen);
        self.fetch.continue_in(remembered.line);
        if let Some(memo) = &mut self.memo {
            memo.follow(remembered);
        }
    }

    /// Counts the clocks of a run (a part of the block), and memoizes them for later executions.
    #[cold]
    fn learn<B: Bus>(&mut self, block: &mut Block, course: &mut Course<'_>, run: Run, bus: &B) {
        // Count the run with all rules, and compare the profiles before and after.
        let began = self.common.now;
        let before = self.common.profile.clone();
        self.advance(block, course, run.end(), bus);
        let Some(exit) = self.number() else { return };
        let clocks = self.common.now - began;
        let profiles = [&before, &self.common.profile];
        if let Some(remembered) = RememberedClocks::new(run, exit, clocks, self.fetch.line(), profiles) {
            block.remembered.add(remembered);
        }
    }
}
