//! Clocks of runs of code that repeat, reused instead of counted again.
//!
//! The idea is that of FastSim (Schnarr and Larus, *Fast Out-Of-Order Processor Simulation Using Memoization*, ASPLOS
//! 1998). A run of units whose instructions and data are all in the caches leaves bus, queues and the replacement's chance as
//! they are, so that its clocks follow from what the scoreboard holds at its beginning, from how much of an instruction line is
//! still to come, and from how it was executed. All that is known by a number while runs repeat. What goes past the caches is
//! counted between two runs, for which the scoreboard is written out again.

use crate::scoreboard::{Leftover, Scoreboard};
use crate::timing::Freeze;
use rustc_hash::FxHashMap;

/// Most clocks that a wait may have to go, so that the rest of a long one gets no number.
pub(crate) const MOST_CLOCKS: u8 = 15;
/// Most scoreboards with a number; the rest is counted.
const MOST_NUMBERS: usize = 1 << 15;
/// Most executions that are remembered from one place on; the oldest one leaves.
const MOST_REMEMBERED: usize = 16;

/// The number of a scoreboard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number(u32);

impl Number {
    const FILLING: u32 = 1 << 31;

    /// Whether an instruction line is still coming in.
    #[inline]
    pub(crate) fn is_filling(self) -> bool {
        self.0 & Number::FILLING != 0
    }
}

/// The scoreboards that were met, and which of them is the present one.
#[derive(Clone, Debug)]
pub(crate) struct Memo {
    numbers: FxHashMap<Leftover, Number>,
    leftovers: Vec<Leftover>,
    /// Number of the present scoreboard, where the one written out is out of date.
    present: Option<Number>,
    /// Instructions whose clocks were reused.
    pub(crate) instructions: u64,
}

impl Memo {
    pub(crate) fn new() -> Memo {
        Memo { numbers: FxHashMap::default(), leftovers: Vec::new(), present: None, instructions: 0 }
    }

    /// The number of the present scoreboard where that is not the one written out.
    #[inline]
    pub(crate) fn present(&self) -> Option<Number> {
        self.present
    }

    /// The number of a scoreboard, if it has or gets one.
    pub(crate) fn number_of(&mut self, written: &Scoreboard, now: u64, fill: Filling) -> Option<Number> {
        if fill.clocks > u64::from(MOST_CLOCKS) {
            return None;
        }
        let left = written.leftover(now, MOST_CLOCKS, [fill.clocks as u8, fill.first])?;
        if let Some(number) = self.numbers.get(&left) {
            return Some(*number);
        }
        if self.leftovers.len() == MOST_NUMBERS {
            return None;
        }
        let filling = if fill.clocks > 0 { Number::FILLING } else { 0 };
        let number = Number(self.leftovers.len() as u32 | filling);
        self.leftovers.push(left);
        self.numbers.insert(left, number);
        Some(number)
    }

    /// From now on the scoreboard is that at the end of a remembered run.
    #[inline]
    pub(crate) fn follow(&mut self, remembered: &RememberedClocks) {
        self.present = Some(remembered.exit);
        self.instructions += u64::from(remembered.instructions);
    }

    /// From now on the scoreboard is the one written out, which must first be brought up to date by this.
    #[inline]
    pub(crate) fn leave(&mut self) -> Option<&Leftover> {
        self.present.take().map(|number| &self.leftovers[(number.0 & !Number::FILLING) as usize])
    }
}

/// What is still to come of an instruction line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Filling {
    /// Clocks to its last transfer; 0 when none is coming in.
    pub(crate) clocks: u64,
    /// Place in the line of its first transfer.
    pub(crate) first: u8,
}

/// Which run of a block's execution, from a place on: one number, which is quickly compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Run(u64);

impl Run {
    /// The run with a scoreboard before it, to a place. Whether the branch in it was taken, whether its last unit trapped, and
    /// whether its first fetch is from the line that is coming in.
    #[inline]
    pub(crate) fn new(entry: Number, to: usize, [taken, trapped, continues]: [bool; 3]) -> Run {
        let flags = u64::from(taken) | u64::from(trapped) << 1 | u64::from(continues) << 2;
        Run(u64::from(entry.0) << 32 | flags << 16 | (to & 0xFFFF) as u64)
    }

    /// The place where it ends.
    #[inline]
    pub(crate) fn end(self) -> usize {
        usize::from(self.0 as u16)
    }
}

/// What a run once took.
#[derive(Clone, Debug)]
pub(crate) struct RememberedClocks {
    pub(crate) run: Run,
    /// Scoreboard after it.
    pub(crate) exit: Number,
    pub(crate) clocks: u32,
    pub(crate) instructions: u32,
    /// Clocks that it waited, by cause.
    pub(crate) frozen: Box<[(Freeze, u32)]>,
    /// Line of the last fetch.
    pub(crate) line: u32,
}

/// What a block remembers: runs by the place at which they begin.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockMemory(Vec<Remembered>);

#[derive(Clone, Debug, Default)]
struct Remembered {
    all: Vec<RememberedClocks>,
    /// Where the last one was found.
    latest: usize,
    oldest: usize,
}

impl BlockMemory {
    #[inline]
    pub(crate) fn find(&mut self, from: usize, run: Run) -> Option<&RememberedClocks> {
        let Remembered { all, latest, .. } = self.0.get_mut(from)?;
        if all.get(*latest).is_none_or(|known| known.run != run) {
            *latest = all.iter().position(|known| known.run == run)?;
        }
        all.get(*latest)
    }

    pub(crate) fn add(&mut self, from: usize, remembered: RememberedClocks) {
        if self.0.len() <= from {
            self.0.resize_with(from + 1, Remembered::default);
        }
        let Remembered { all, oldest, .. } = &mut self.0[from];
        if all.len() < MOST_REMEMBERED {
            return all.push(remembered);
        }
        all[*oldest] = remembered;
        *oldest = (*oldest + 1) % MOST_REMEMBERED;
    }
}
