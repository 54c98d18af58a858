//! Clocks of blocks that repeat, reused instead of counted again.
//!
//! The idea is that of FastSim (Schnarr and Larus, *Fast Out-Of-Order Processor Simulation Using Memoization*, ASPLOS
//! 1998). A block whose instructions and data are all in the caches leaves bus, queues and the replacement's chance as they
//! are, so that its clocks follow from what the scoreboard holds at its beginning and from how it was executed. The scoreboard is
//! known by a number while blocks repeat, and is written out again when one has to be counted.

use crate::execution::Execution;
use crate::scoreboard::{Leftover, Scoreboard};
use crate::timing::Freeze;
use std::collections::BTreeMap;

/// Most clocks that a wait may have to go, so that the rest of a miss gets no number.
const MOST_CLOCKS: u8 = 7;
/// Most scoreboards with a number; the rest is counted.
const MOST_NUMBERS: usize = 1 << 12;
/// Most executions that a block remembers; the oldest one leaves.
const MOST_REMEMBERED: usize = 16;

/// The scoreboards that were met, and which of them is the present one.
#[derive(Clone, Debug)]
pub(crate) struct Memo {
    numbers: BTreeMap<Leftover, u32>,
    leftovers: Vec<Leftover>,
    /// Number of the present scoreboard, where the one written out is out of date.
    present: Option<u32>,
    /// Instructions whose clocks were reused.
    pub(crate) instructions: u64,
}

impl Memo {
    pub(crate) fn new() -> Memo {
        Memo { numbers: BTreeMap::new(), leftovers: Vec::new(), present: None, instructions: 0 }
    }

    /// The number of the present scoreboard, if it has or gets one.
    #[inline]
    pub(crate) fn number(&mut self, written: &Scoreboard, now: u64) -> Option<u32> {
        self.present.or_else(|| self.number_of(written.leftover(now, MOST_CLOCKS)?))
    }

    fn number_of(&mut self, left: Leftover) -> Option<u32> {
        if let Some(number) = self.numbers.get(&left) {
            return Some(*number);
        }
        let number = self.leftovers.len();
        if number == MOST_NUMBERS {
            return None;
        }
        self.leftovers.push(left);
        self.numbers.insert(left, number as u32);
        Some(number as u32)
    }

    /// From now on the scoreboard is that at the end of a remembered execution.
    #[inline]
    pub(crate) fn follow(&mut self, remembered: &RememberedClocks) {
        self.present = Some(remembered.exit);
        self.instructions += remembered.instructions;
    }

    /// From now on the scoreboard is the one written out, which must first be brought up to date by this.
    #[inline]
    pub(crate) fn leave(&mut self) -> Option<&Leftover> {
        self.present.take().map(|number| &self.leftovers[number as usize])
    }
}

/// What an execution of a block once took.
#[derive(Clone, Debug)]
pub(crate) struct RememberedClocks {
    /// Number of the scoreboard before it.
    pub(crate) entry: u32,
    pub(crate) execution: Execution,
    /// Number of the scoreboard after it.
    pub(crate) exit: u32,
    pub(crate) clocks: u64,
    pub(crate) instructions: u64,
    /// Clocks that the block waited, by cause.
    pub(crate) frozen: Vec<(Freeze, u64)>,
    /// Line of the last fetch.
    pub(crate) line: u32,
}

impl RememberedClocks {
    #[inline]
    fn is_of(&self, entry: u32, execution: Execution) -> bool {
        self.entry == entry && self.execution == execution
    }
}

/// What a block remembers.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockMemory {
    all: Vec<RememberedClocks>,
    /// Where the last one was found.
    latest: usize,
    oldest: usize,
}

impl BlockMemory {
    #[inline]
    pub(crate) fn find(&mut self, entry: u32, execution: Execution) -> Option<&RememberedClocks> {
        if !self.all.get(self.latest).is_some_and(|known| known.is_of(entry, execution)) {
            self.latest = self.all.iter().position(|known| known.is_of(entry, execution))?;
        }
        self.all.get(self.latest)
    }

    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    pub(crate) fn add(&mut self, remembered: RememberedClocks) {
        if self.all.len() < MOST_REMEMBERED {
            return self.all.push(remembered);
        }
        self.all[self.oldest] = remembered;
        self.oldest = (self.oldest + 1) % MOST_REMEMBERED;
    }
}
