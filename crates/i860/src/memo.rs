//! Memoization: clocks of repeated runs of code, reused instead of counted again.
//!
//! The idea comes from FastSim (Schnarr and Larus, *Fast Out-Of-Order Processor Simulation Using Memoization*, ASPLOS
//! 1998). A run is a part of a basic block whose instructions and data are all in the caches. A run leaves the bus, the
//! queues and the replacement sequence unchanged. Its clocks depend on three things: the scoreboard before it, the rest
//! of an arriving instruction line, and the branches and traps of its execution.
//!
//! Each distinct scoreboard has a number, so that a run is found by comparing integers. Between two runs, accesses that
//! leave the caches are counted with the full scoreboard.

use crate::profile::Profile;
use crate::scoreboard::{PendingWaits, Scoreboard};
use crate::timing::{FREEZES, N_FREEZES};
use rustc_hash::FxHashMap;

/// Longest remaining wait, in clocks, of a scoreboard that gets a number.
pub(crate) const MOST_CLOCKS: u8 = 15;
/// Greatest number of numbered scoreboards. Code after other scoreboards is counted instruction by instruction.
const MOST_NUMBERS: usize = 1 << 15;

/// The number of a distinct scoreboard state, with a bit that is set while an instruction line arrives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Number(u32);

impl Number {
    const FILLING: u32 = 1 << 31;

    /// Returns true if an instruction line is still arriving.
    #[inline]
    pub(crate) fn is_filling(self) -> bool {
        self.0 & Number::FILLING != 0
    }
}

/// All distinct scoreboard states with their numbers.
#[derive(Clone, Debug, Default)]
pub(crate) struct Numbers {
    numbers: FxHashMap<PendingWaits, Number>,
    leftovers: Vec<PendingWaits>,
}

/// The memory of scoreboard states, and the number of the current state.
#[derive(Clone, Debug)]
pub(crate) struct Memo {
    pub(crate) numbers: Box<Numbers>,
    /// Number of the current scoreboard state while remembered runs follow each other; `None` while the [`Scoreboard`]
    /// itself holds the state.
    present: Option<Number>,
    /// Number of executed instructions whose clocks were reused.
    pub(crate) instructions: u64,
}

impl Memo {
    pub(crate) fn new() -> Memo {
        Memo { numbers: Box::default(), present: None, instructions: 0 }
    }

    /// Returns the number of the current scoreboard state, or `None` while the [`Scoreboard`] itself holds the state.
    #[inline]
    pub(crate) fn present(&self) -> Option<Number> {
        self.present
    }

    /// Returns the number of a scoreboard state, and assigns a new number if there is room.
    pub(crate) fn number_of(&mut self, written: &Scoreboard, now: u64, fill: ArrivingLine) -> Option<Number> {
        if fill.clocks > u64::from(MOST_CLOCKS) {
            return None;
        }
        // The state must fit into a few bits; otherwise it gets no number.
        let left = written.leftover(now, MOST_CLOCKS, [fill.clocks as u8, fill.first])?;
        let Numbers { numbers, leftovers } = &mut *self.numbers;
        if let Some(number) = numbers.get(&left) {
            return Some(*number);
        }
        // A full table assigns no new numbers.
        if leftovers.len() == MOST_NUMBERS {
            return None;
        }
        let filling = if fill.clocks > 0 { Number::FILLING } else { 0 };
        let number = Number(leftovers.len() as u32 | filling);
        leftovers.push(left);
        numbers.insert(left, number);
        Some(number)
    }

    /// Continues with the scoreboard state at the end of a remembered run.
    #[inline]
    pub(crate) fn follow(&mut self, remembered: &RememberedClocks) {
        self.present = Some(remembered.exit);
        self.instructions += u64::from(remembered.instructions);
    }

    /// Stops using the number of the current state. Returns the state that the [`Scoreboard`] must be restored from, or
    /// `None` if the [`Scoreboard`] is up to date.
    #[inline]
    pub(crate) fn leave(&mut self) -> Option<&PendingWaits> {
        self.present.take().map(|number| &self.numbers.leftovers[(number.0 & !Number::FILLING) as usize])
    }
}

const _: () = assert!(size_of::<RememberedClocks>() == 32);

/// The rest of an instruction line that is arriving.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct ArrivingLine {
    /// Clocks to the last transfer; 0 if no line is arriving.
    pub(crate) clocks: u64,
    /// Position, within the line, of the transfer that arrives first.
    pub(crate) first: u8,
}

/// The key of a run of code: a single number, never 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Run(u64);

impl Run {
    /// Makes the key of a run from the scoreboard before it and from its first and last place in the block.
    /// The flags say that its branch was taken, that its last instruction trapped, and that its first fetch is from the
    /// arriving line.
    #[inline]
    pub(crate) fn new(entry: Number, [from, to]: [usize; 2], [taken, trapped, continues]: [bool; 3]) -> Run {
        let flags = u64::from(taken) | u64::from(trapped) << 1 | u64::from(continues) << 2;
        Run(u64::from(entry.0) << 32 | flags << 16 | (from as u64 & 0xFF) << 8 | to as u64 & 0xFF)
    }

    /// Returns the place in the block at which the run ends.
    #[inline]
    pub(crate) fn end(self) -> usize {
        usize::from(self.0 as u8)
    }

    /// Returns a hash of the key.
    #[inline]
    fn hash(self) -> usize {
        (self.0.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as usize
    }
}

/// Clocks waited by cause: the cause in the lower five bits of each entry, zero after the last entry.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct WaitedClocks([u16; WaitedClocks::MOST]);

impl WaitedClocks {
    const CAUSE_BITS: u32 = 5;
    /// Greatest number of causes of waits in one run.
    const MOST: usize = 6;

    /// Returns the clocks waited between two profiles. Returns `None` if there are too many causes or if one has too
    /// many clocks for its entry.
    fn between(before: &Profile, after: &Profile) -> Option<WaitedClocks> {
        let clocks = FREEZES.iter().map(|row| (row.id, after.frozen_by(row.id) - before.frozen_by(row.id)));
        let mut all = WaitedClocks::default();
        for (number, (why, clocks)) in clocks.filter(|(_, clocks)| *clocks != 0).enumerate() {
            *all.0.get_mut(number)? = u16::try_from(clocks << WaitedClocks::CAUSE_BITS | why as u64).ok()?;
        }
        Some(all)
    }

    /// Adds the clocks to `frozen`, which has one sum for each cause.
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

/// The remembered clocks of a run. The size is half a cache line of most hosts.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct RememberedClocks {
    run: Run,
    /// Number of the scoreboard state after the run.
    exit: Number,
    pub(crate) clocks: u16,
    pub(crate) instructions: u16,
    /// Cache line of the last fetch.
    pub(crate) line: u32,
    /// Clocks waited in the run, by cause.
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

    /// Makes the entry of a run from its clocks and from the profiles before and after it. Returns `None` if a number
    /// is too large for its field.
    pub(crate) fn new(run: Run, exit: Number, clocks: u64, line: u32, [before, after]: [&Profile; 2]) -> Option<Self> {
        let waited = WaitedClocks::between(before, after)?;
        let instructions = u16::try_from(after.instructions - before.instructions).ok()?;
        Some(RememberedClocks { run, exit, clocks: u16::try_from(clocks).ok()?, instructions, line, waited })
    }
}

/// The remembered runs of a block, as a hash table. Each run lies within [`BlockMemory::REACH`] entries of its hash.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockMemory(Box<[RememberedClocks]>);

impl BlockMemory {
    /// Smallest and greatest size of the table.
    const LEAST: usize = 8;
    const MOST: usize = 1 << 11;
    /// Number of table entries in which a run may lie.
    const REACH: usize = 4;

    #[inline]
    pub(crate) fn find(&self, run: Run) -> Option<&RememberedClocks> {
        let all = &self.0[..];
        (0..BlockMemory::REACH).find_map(|n| {
            let known = all.get((run.hash() + n) & all.len().wrapping_sub(1))?;
            (known.run == run).then_some(known)
        })
    }

    /// Adds a run that the table does not contain. If a table of the greatest size has no free entry, the run replaces
    /// another one.
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

    /// Puts a run into a free table entry near its hash. Returns false if none is free.
    fn put(&mut self, remembered: RememberedClocks) -> bool {
        let length = self.0.len();
        let mut places = (0..BlockMemory::REACH.min(length)).map(|n| (remembered.run.hash() + n) & (length - 1));
        let free = places.find(|place| self.0[*place].run == Run::default());
        free.map(|place| self.0[place] = remembered).is_some()
    }

    /// Doubles the size of the table. Runs without a free entry in the new table are dropped.
    fn grow(&mut self) {
        let larger = vec![RememberedClocks::NOTHING; (2 * self.0.len()).max(BlockMemory::LEAST)];
        let all = std::mem::replace(&mut self.0, larger.into_boxed_slice());
        for known in all.iter().filter(|known| known.run != Run::default()) {
            self.put(*known);
        }
    }
}
