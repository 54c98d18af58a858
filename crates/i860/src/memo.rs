//! Clocks of runs of code that repeat, reused instead of counted again.
//!
//! The idea is that of FastSim (Schnarr and Larus, *Fast Out-Of-Order Processor Simulation Using Memoization*, ASPLOS
//! 1998). A run of units whose instructions and data are all in the caches leaves bus, queues and the replacement's chance as
//! they are, so that its clocks follow from what the scoreboard holds at its beginning, from how much of an instruction line is
//! still to come, and from how it was executed. All that is known by a number while runs repeat. What goes past the caches is
//! counted between two runs, for which the scoreboard is written out again.

use crate::profile::Profile;
use crate::scoreboard::{Leftover, Scoreboard};
use crate::timing::{FREEZES, N_FREEZES};
use rustc_hash::FxHashMap;

/// Most clocks that a wait may have to go, so that the rest of a long one gets no number.
pub(crate) const MOST_CLOCKS: u8 = 15;
/// Most scoreboards with a number; the rest is counted.
const MOST_NUMBERS: usize = 1 << 15;

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

/// The scoreboards that were met, by number.
#[derive(Clone, Debug, Default)]
pub(crate) struct Numbers {
    numbers: FxHashMap<Leftover, Number>,
    leftovers: Vec<Leftover>,
}

/// The scoreboards with numbers, and which of them is the present one.
#[derive(Clone, Debug)]
pub(crate) struct Memo {
    pub(crate) numbers: Box<Numbers>,
    /// Number of the present scoreboard, where the one written out is out of date.
    present: Option<Number>,
    /// Instructions whose clocks were reused.
    pub(crate) instructions: u64,
}

impl Memo {
    pub(crate) fn new() -> Memo {
        Memo { numbers: Box::default(), present: None, instructions: 0 }
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
        let Numbers { numbers, leftovers } = &mut *self.numbers;
        if let Some(number) = numbers.get(&left) {
            return Some(*number);
        }
        if leftovers.len() == MOST_NUMBERS {
            return None;
        }
        let filling = if fill.clocks > 0 { Number::FILLING } else { 0 };
        let number = Number(leftovers.len() as u32 | filling);
        leftovers.push(left);
        numbers.insert(left, number);
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
        self.present.take().map(|number| &self.numbers.leftovers[(number.0 & !Number::FILLING) as usize])
    }
}

const _: () = assert!(size_of::<RememberedClocks>() == 32);

/// What is still to come of an instruction line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Filling {
    /// Clocks to its last transfer; 0 when none is coming in.
    pub(crate) clocks: u64,
    /// Place in the line of its first transfer.
    pub(crate) first: u8,
}

/// Which run of a block's execution: one number, which is quickly compared and is never 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Run(u64);

impl Run {
    /// The run with a scoreboard before it, from a place to a later one. Whether the branch in it was taken, whether its last unit
    /// trapped, and whether its first fetch is from the line that is coming in.
    #[inline]
    pub(crate) fn new(entry: Number, [from, to]: [usize; 2], [taken, trapped, continues]: [bool; 3]) -> Run {
        let flags = u64::from(taken) | u64::from(trapped) << 1 | u64::from(continues) << 2;
        Run(u64::from(entry.0) << 32 | flags << 16 | (from as u64 & 0xFF) << 8 | to as u64 & 0xFF)
    }

    /// The place where it ends.
    #[inline]
    pub(crate) fn end(self) -> usize {
        usize::from(self.0 as u8)
    }

    /// The bits of a product that depend on all of it.
    #[inline]
    fn hash(self) -> usize {
        (self.0.wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 40) as usize
    }
}

/// Clocks waited, by cause: the cause in the lower five bits of each, zero behind the last.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Waited([u16; Waited::MOST]);

impl Waited {
    const CAUSE_BITS: u32 = 5;
    /// Most causes.
    const MOST: usize = 6;

    /// What was waited between two profiles; `None` for more causes, or more clocks of one than there is room for.
    fn between(before: &Profile, after: &Profile) -> Option<Waited> {
        let clocks = FREEZES.iter().map(|row| (row.id, after.frozen_by(row.id) - before.frozen_by(row.id)));
        let mut all = Waited::default();
        for (number, (why, clocks)) in clocks.filter(|(_, clocks)| *clocks != 0).enumerate() {
            *all.0.get_mut(number)? = u16::try_from(clocks << Waited::CAUSE_BITS | why as u64).ok()?;
        }
        Some(all)
    }

    /// Adds them up by cause.
    #[inline]
    pub(crate) fn add_to(&self, frozen: &mut [u64; N_FREEZES]) {
        for wait in self.0 {
            if wait == 0 {
                break;
            }
            if let Some(sum) = frozen.get_mut(usize::from(wait) % (1 << Waited::CAUSE_BITS)) {
                *sum += u64::from(wait >> Waited::CAUSE_BITS);
            }
        }
    }
}

/// What a run once took: half a cache line of most hosts.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
pub(crate) struct RememberedClocks {
    run: Run,
    /// Scoreboard after it.
    exit: Number,
    pub(crate) clocks: u16,
    pub(crate) instructions: u16,
    /// Line of the last fetch.
    pub(crate) line: u32,
    /// Clocks that it waited, by cause.
    pub(crate) waited: Waited,
}

impl RememberedClocks {
    const NOTHING: RememberedClocks = RememberedClocks {
        run: Run(0),
        exit: Number(0),
        clocks: 0,
        instructions: 0,
        line: 0,
        waited: Waited([0; Waited::MOST]),
    };

    /// What a run took between two profiles and clocks; `None` for what is not remembered.
    pub(crate) fn new(run: Run, exit: Number, clocks: u64, line: u32, [before, after]: [&Profile; 2]) -> Option<Self> {
        let waited = Waited::between(before, after)?;
        let instructions = u16::try_from(after.instructions - before.instructions).ok()?;
        Some(RememberedClocks { run, exit, clocks: u16::try_from(clocks).ok()?, instructions, line, waited })
    }
}

/// What a block remembers: a table of runs, each within a few places of where it belongs.
#[derive(Clone, Debug, Default)]
pub(crate) struct BlockMemory(Box<[RememberedClocks]>);

impl BlockMemory {
    /// Sizes of the table.
    const LEAST: usize = 8;
    const MOST: usize = 1 << 11;
    /// Places where a run may lie.
    const REACH: usize = 4;

    #[inline]
    pub(crate) fn find(&self, run: Run) -> Option<&RememberedClocks> {
        let all = &self.0[..];
        (0..BlockMemory::REACH).find_map(|n| {
            let known = all.get((run.hash() + n) & all.len().wrapping_sub(1))?;
            (known.run == run).then_some(known)
        })
    }

    /// Remembers a run that it does not know. Where a table of the greatest size has no place for it, another one leaves.
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

    /// Puts a run where it belongs, if one of its places is free.
    fn put(&mut self, remembered: RememberedClocks) -> bool {
        let length = self.0.len();
        let mut places = (0..BlockMemory::REACH.min(length)).map(|n| (remembered.run.hash() + n) & (length - 1));
        let free = places.find(|place| self.0[*place].run == Run::default());
        free.map(|place| self.0[place] = remembered).is_some()
    }

    /// Takes a table of twice the size; what has no place there is forgotten.
    fn grow(&mut self) {
        let larger = vec![RememberedClocks::NOTHING; (2 * self.0.len()).max(BlockMemory::LEAST)];
        let all = std::mem::replace(&mut self.0, larger.into_boxed_slice());
        for known in all.iter().filter(|known| known.run != Run::default()) {
            self.put(*known);
        }
    }
}
