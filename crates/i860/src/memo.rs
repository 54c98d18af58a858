//! Memoization: the model stores the clocks of code, and reuses them when the code runs again.
//!
//! The idea comes from FastSim (Schnarr and Larus, *Fast Out-Of-Order Processor Simulation Using Memoization*, ASPLOS
//! 1998). The overview of the crate says what a run is, and on what its clocks depend.
//!
//! Each distinct scoreboard has a number, so a run is found by a comparison of integers. An access that needs the bus
//! ends the run; its clocks are counted with the full scoreboard.

use crate::profile::Profile;
use crate::scoreboard::{PendingWaits, Scoreboard};
use crate::timing::{FREEZES, N_FREEZES};
use rustc_hash::FxHashMap;

/// Longest wait, in clocks, in a numbered scoreboard state. States with longer waits get no number, so their clocks are
/// not memoized.
pub(crate) const MAX_CLOCKS: u8 = 15;
/// Greatest number of scoreboard states that get a number. Code that starts in a state without a number is not
/// memoized.
const MAX_NUMBERS: usize = 1 << 15;

/// The number of a scoreboard state (the remaining waits for registers and units). The highest bit is set if an
/// instruction-cache line is arriving.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number(u32);

impl Number {
    const FILLING: u32 = 1 << 31;

    /// Returns true if, in this scoreboard state, an instruction-cache line is still arriving.
    #[inline]
    pub(crate) fn is_filling(self) -> bool {
        self.0 & Number::FILLING != 0
    }
}

#[derive(Clone, Debug, Default)]
pub(crate) struct Numbers {
    numbers: FxHashMap<PendingWaits, Number>,
    leftovers: Vec<PendingWaits>,
}

#[derive(Clone, Debug)]
pub(crate) struct Memo {
    pub(crate) numbers: Box<Numbers>,
    /// Number of the current scoreboard state. `None` if the [`Scoreboard`] itself contains the state, because the
    /// latest clocks were counted instead of reused.
    present: Option<Number>,
    pub(crate) instructions: u64,
}

impl Memo {
    pub(crate) fn new() -> Memo {
        Memo { numbers: Box::default(), present: None, instructions: 0 }
    }

    #[inline]
    pub(crate) fn present(&self) -> Option<Number> {
        self.present
    }

    /// Returns the number of a scoreboard state, which can be a new number. Returns `None` if a wait is too long or the
    /// table is full.
    pub(crate) fn number_of(&mut self, written: &Scoreboard, now: u64, fill: ArrivingLine) -> Option<Number> {
        if fill.clocks > u64::from(MAX_CLOCKS) {
            return None;
        }
        // The state must fit into a few bits. Otherwise, it gets no number.
        let left = written.leftover(now, MAX_CLOCKS, [fill.clocks as u8, fill.first])?;
        let Numbers { numbers, leftovers } = &mut *self.numbers;
        if let Some(number) = numbers.get(&left) {
            return Some(*number);
        }
        // A full table assigns no new numbers.
        if leftovers.len() == MAX_NUMBERS {
            return None;
        }
        let filling = if fill.clocks > 0 { Number::FILLING } else { 0 };
        let number = Number(leftovers.len() as u32 | filling);
        leftovers.push(left);
        numbers.insert(left, number);
        Some(number)
    }

    /// Sets the current scoreboard state to the state at the end of `remembered`, a memoized part of a block.
    #[inline]
    pub(crate) fn follow(&mut self, remembered: &RememberedClocks) {
        self.present = Some(remembered.exit);
        self.instructions += u64::from(remembered.instructions);
    }

    /// Returns the waits from which the caller must restore the [`Scoreboard`], or `None` if the [`Scoreboard`] is up
    /// to date. Afterwards, the [`Scoreboard`] holds the current state.
    #[inline]
    pub(crate) fn leave(&mut self) -> Option<&PendingWaits> {
        self.present.take().map(|number| &self.numbers.leftovers[(number.0 & !Number::FILLING) as usize])
    }
}

const _: () = assert!(size_of::<RememberedClocks>() == 32);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ArrivingLine {
    /// Number of clocks until the last transfer of the cache line arrives, or 0 if no cache line is arriving.
    pub(crate) clocks: u64,
    /// Index, within the cache line, of the 8-byte transfer that arrives first.
    pub(crate) first: u8,
}

/// Key of a run (a part of a block whose instructions and data are all in the caches). The key is not 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Run(u64);

impl Run {
    /// Makes the key of a run, the part of a block from position `from` to position `to`. `entry` is the number of the
    /// scoreboard state before the run. `taken` is true if the branch was taken, and `trapped` if the last instruction
    /// trapped. `continues` is true if the first fetch is from a cache line that is still arriving.
    #[inline]
    pub(crate) fn new(entry: Number, [from, to]: [usize; 2], [taken, trapped, continues]: [bool; 3]) -> Run {
        let flags = u64::from(taken) | u64::from(trapped) << 1 | u64::from(continues) << 2;
        Run(u64::from(entry.0) << 32 | flags << 16 | (from as u64 & 0xFF) << 8 | to as u64 & 0xFF)
    }

    /// Returns the position in the block at which the run (a part of the block) ends.
    #[inline]
    pub(crate) fn end(self) -> usize {
        usize::from(self.0 as u8)
    }

    /// Returns a hash of the key, from which the place in the hash table follows.
    #[inline]
    fn hash(self) -> usize {
        (self.0.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as usize
    }
}

/// Clocks of delay in a part of a block, by cause. Each entry has the cause in its lower five bits, and the number of
/// clocks in the bits above. Unused entries at the end are zero.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WaitedClocks([u16; WaitedClocks::MOST]);

impl WaitedClocks {
    const CAUSE_BITS: u32 = 5;
    const MOST: usize = 6;

    /// Returns the clocks of delay between the profiles `before` and `after`, by cause. Returns `None` if they do not
    /// fit in the packed format.
    fn between(before: &Profile, after: &Profile) -> Option<WaitedClocks> {
        let clocks = FREEZES.iter().map(|row| (row.id, after.frozen_by(row.id) - before.frozen_by(row.id)));
        let mut all = WaitedClocks::default();
        for (number, (why, clocks)) in clocks.filter(|(_, clocks)| *clocks != 0).enumerate() {
            *all.0.get_mut(number)? = u16::try_from(clocks << WaitedClocks::CAUSE_BITS | why as u64).ok()?;
        }
        Some(all)
    }

    /// Adds the clocks to `frozen`, which has one sum for each row of the freeze table.
    #[inline]
    pub(crate) fn add_to(&self, frozen: &mut [u64; N_FREEZES]) {
        for wait in self.0 {
            if wait == 0 {
                break;
            }
            if let Some(sum) = frozen.get_mut(usize::from(wait) % (1 << WaitedClocks::CAUSE_BITS)) {
                *sum += u64::from(wait >> WaitedClocks::CAUSE_BITS);
            }
        }
    }
}

/// The memoized clocks of a run (a part of a block). The entry has 32 bytes, half a cache line of most present
/// computers.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct RememberedClocks {
    run: Run,
    exit: Number,
    pub(crate) clocks: u16,
    pub(crate) instructions: u16,
    /// Number of the cache line that the run fetched last.
    pub(crate) line: u32,
    pub(crate) waited: WaitedClocks,
}

impl RememberedClocks {
    const NOTHING: RememberedClocks = RememberedClocks {
        run: Run(0),
        exit: Number(0),
        clocks: 0,
        instructions: 0,
        line: 0,
        waited: WaitedClocks([0; WaitedClocks::MOST]),
    };

    /// Makes the entry for a run (a part of a block). The delays are the difference between the profiles before and
    /// after the run. Returns `None` if a number is too large for its bit field.
    pub(crate) fn new(run: Run, exit: Number, clocks: u64, line: u32, [before, after]: [&Profile; 2]) -> Option<Self> {
        let waited = WaitedClocks::between(before, after)?;
        let instructions = u16::try_from(after.instructions - before.instructions).ok()?;
        Some(RememberedClocks { run, exit, clocks: u16::try_from(clocks).ok()?, instructions, line, waited })
    }
}

/// The memoized runs (parts) of a block, as a hash table. A run is in one of [`BlockMemory::REACH`] successive entries,
/// of which its hash selects the first.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockMemory(Box<[RememberedClocks]>);

impl BlockMemory {
    const LEAST: usize = 8;
    const MOST: usize = 1 << 11;
    /// Number of successive entries of the hash table that a search examines.
    const REACH: usize = 4;

    #[inline]
    pub(crate) fn find(&self, run: Run) -> Option<&RememberedClocks> {
        let all = &self.0[..];
        (0..BlockMemory::REACH).find_map(|n| {
            let entry = all.get((run.hash() + n) & all.len().wrapping_sub(1))?;
            (entry.run == run).then_some(entry)
        })
    }

    /// Adds a run (a part of a block) that the table does not contain. If a table of the greatest size has no free
    /// entry, the run replaces another run.
    pub(crate) fn add(&mut self, remembered: RememberedClocks) {
        while !self.put(remembered) {
            if self.0.len() >= BlockMemory::MOST {
                let first = remembered.run.hash() % BlockMemory::MOST;
                self.0[first] = remembered;
                return;
            }
            self.grow();
        }
    }

    /// Puts a run (a part of a block) into a free entry near the place that its hash selects. Returns false if no entry
    /// is free.
    fn put(&mut self, remembered: RememberedClocks) -> bool {
        let length = self.0.len();
        let mut places = (0..BlockMemory::REACH.min(length)).map(|n| (remembered.run.hash() + n) & (length - 1));
        let free = places.find(|place| self.0[*place].run == Run::default());
        free.map(|place| self.0[place] = remembered).is_some()
    }

    /// Doubles the size of the hash table. Runs (parts of a block) that find no free entry in the new table are
    /// discarded.
    fn grow(&mut self) {
        let larger = vec![RememberedClocks::NOTHING; (2 * self.0.len()).max(BlockMemory::LEAST)];
        let all = std::mem::replace(&mut self.0, larger.into_boxed_slice());
        for entry in all.iter().filter(|entry| entry.run != Run::default()) {
            self.put(*entry);
        }
    }
}
