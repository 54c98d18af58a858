//! Tag arrays of the caches and the TLB, which decide between hit, miss and write-back. Data always come from memory.

use crate::timing::ChipSizes;

/// A set-associative tag array with pseudo-random replacement. All sizes of the array are powers of two.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Tags<const SETS: usize, const WAYS: usize, const LINE_BYTES: u32> {
    /// Tags of all sets. A tag is the address of a cache line with [`VALID`] and [`DIRTY`] in its low bits. It is 0 if
    /// the way (place in a set) is empty.
    sets: Box<[[u32; WAYS]; SETS]>,
    /// Number of changes to the array. While this number stays the same, the array contains the same cache lines.
    changes: u64,
}

/// Flag in the low bits of a tag: the tag belongs to a cache line.
const VALID: u32 = 1;
const DIRTY: u32 = 2;

type CacheTags<const SETS: usize> = Tags<SETS, CACHE_WAYS, { ChipSizes::PAPERS.line_bytes as u32 }>;
const CACHE_WAYS: usize = ChipSizes::PAPERS.cache_ways as usize;

const fn sets(cache_bytes: u64) -> usize {
    (cache_bytes / ChipSizes::PAPERS.line_bytes) as usize / CACHE_WAYS
}

pub(crate) type InstructionTags = CacheTags<{ sets(ChipSizes::PAPERS.instruction_cache_bytes) }>;
pub(crate) type DataTags = CacheTags<{ sets(ChipSizes::PAPERS.data_cache_bytes) }>;

impl<const SETS: usize, const WAYS: usize, const LINE_BYTES: u32> Tags<SETS, WAYS, LINE_BYTES> {
    pub(crate) fn new() -> Self {
        const { assert!(SETS.is_power_of_two() && LINE_BYTES.is_power_of_two() && LINE_BYTES > VALID + DIRTY) };
        Tags { sets: Box::new([[0; WAYS]; SETS]), changes: 0 }
    }

    #[inline]
    pub(crate) fn changes(&self) -> u64 {
        self.changes
    }

    /// Changes the number of the array's state to a number above `latest`, from which later states count on.
    pub(crate) fn number_changes_from(&mut self, latest: u64) {
        self.changes = self.changes.max(latest) + 1;
    }

    #[inline]
    fn set(address: u32) -> usize {
        (address / LINE_BYTES) as usize % SETS
    }

    /// Returns the tag of the cache line that contains `address`, while the line is clean.
    #[inline]
    fn tag(address: u32) -> u32 {
        address & !(LINE_BYTES - 1) | VALID
    }

    #[inline]
    pub(crate) fn holds(&self, address: u32) -> bool {
        self.sets[Self::set(address)].iter().any(|held| held & !DIRTY == Self::tag(address))
    }

    /// Returns true if the array contains the cache line of `address`. If `stores` is true, also marks the line as
    /// dirty.
    #[inline]
    pub(crate) fn access(&mut self, address: u32, stores: bool) -> bool {
        let ways = &mut self.sets[Self::set(address)];
        let tag = Self::tag(address);
        for held in ways {
            if *held & !DIRTY == tag {
                if stores {
                    *held |= DIRTY;
                }
                return true;
            }
        }
        false
    }

    /// Adds the cache line of `address` to its set. If no way (place) of the set is empty, `random` selects the way
    /// whose line is replaced. Returns the address of a replaced line if this line was dirty.
    pub(crate) fn fill(&mut self, address: u32, random: u32) -> Option<u32> {
        self.changes += 1;
        let ways = &mut self.sets[Self::set(address)];
        // Fill empty ways first.
        let way = ways.iter().position(|tag| *tag == 0).unwrap_or(random as usize % WAYS);
        let left = std::mem::replace(&mut ways[way], Self::tag(address));
        (left & DIRTY != 0).then_some(left & !(VALID | DIRTY))
    }

    /// Marks the cache line of `address` as clean. Returns true if the array contained the line and the line was dirty.
    pub(crate) fn clean(&mut self, address: u32) -> bool {
        let dirty = Self::tag(address) | DIRTY;
        let way = self.sets[Self::set(address)].iter_mut().find(|held| **held == dirty);
        way.map(|held| *held &= !DIRTY).is_some()
    }

    pub(crate) fn clear(&mut self) {
        self.changes += 1;
        self.sets.fill([0; WAYS]);
    }
}

/// A 16-bit shift register of maximal length. Its pseudo-random numbers choose the cache lines to replace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chance(u16);

impl Chance {
    pub(crate) fn new(seed: u16) -> Chance {
        Chance(seed.max(1))
    }

    pub(crate) fn next(&mut self) -> u32 {
        let bit = (self.0 ^ self.0 >> 2 ^ self.0 >> 3 ^ self.0 >> 5) & 1;
        self.0 = self.0 >> 1 | bit << 15;
        u32::from(self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{Chance, Tags};

    #[test]
    fn a_third_line_of_a_set_replaces_one_of_its_two_lines() {
        let mut tags = Tags::<128, 2, 32>::new();
        let a = 0x1000;
        let b = 0x2000;
        let c = 0x3000;
        assert_eq!((tags.fill(a, 0), tags.fill(b, 0)), (None, None));
        assert!(tags.holds(a + 31) && tags.holds(b) && !tags.holds(a + 32));
        tags.fill(c, 0);
        assert!(!tags.holds(a) && tags.holds(b) && tags.holds(c));
    }

    #[test]
    fn a_replaced_dirty_line_returns_its_address_once() {
        let mut tags = Tags::<1, 2, 32>::new();
        tags.fill(0x40, 0);
        assert!(tags.access(0x40, true) && !tags.access(0x60, true));
        tags.fill(0x80, 0);
        assert_eq!(tags.fill(0xC0, 0), Some(0x40));
        assert_eq!(tags.fill(0x100, 0), None);
    }

    #[test]
    fn the_shift_register_has_the_full_period() {
        let mut chance = Chance::new(1);
        let period = (1..=70_000).find(|_| chance.next() == 1);
        assert_eq!(period, Some(65_535));
    }
}
