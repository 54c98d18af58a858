//! Tag arrays of the caches and the TLB. Contents live in memory: only hits, misses and write-backs matter here.

use crate::timing::ChipSizes;

/// A tag array of so many ways with pseudo-random replacement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Tags<const WAYS: usize> {
    /// Line number + 1, 0 for empty.
    sets: Vec<[u32; WAYS]>,
    dirty: Vec<[bool; WAYS]>,
    line_shift: u32,
    set_mask: u32,
    /// Fills and clears so far: while it stays, so does what is held.
    changes: u64,
}

/// The tags of a cache.
pub(crate) type CacheTags = Tags<{ ChipSizes::PAPERS.cache_ways as usize }>;

/// Where a line is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Place {
    set: usize,
    way: usize,
}

impl CacheTags {
    /// Those of a cache of this many bytes.
    pub(crate) fn of_cache(bytes: u64) -> CacheTags {
        let line_bytes = ChipSizes::PAPERS.line_bytes;
        Tags::new((bytes / line_bytes) as u32, line_bytes as u32)
    }
}

impl<const WAYS: usize> Tags<WAYS> {
    pub(crate) fn new(entries: u32, line_bytes: u32) -> Tags<WAYS> {
        let sets = entries as usize / WAYS;
        Tags {
            sets: vec![[0; WAYS]; sets],
            dirty: vec![[false; WAYS]; sets],
            line_shift: line_bytes.trailing_zeros(),
            set_mask: sets as u32 - 1,
            changes: 0,
        }
    }

    #[inline]
    pub(crate) fn changes(&self) -> u64 {
        self.changes
    }

    /// The place of an address, if it is held.
    #[inline]
    pub(crate) fn find(&self, address: u32) -> Option<Place> {
        let line = address >> self.line_shift;
        let set = (line & self.set_mask) as usize;
        let ways = &self.sets[set];
        (0..WAYS).find(|way| ways[*way] == line + 1).map(|way| Place { set, way })
    }

    #[inline]
    pub(crate) fn mark_dirty(&mut self, at: Place) {
        self.dirty[at.set][at.way] = true;
    }

    /// Takes an address in; an empty way first, else the way chosen by `random`. Gives the address of a dirty
    /// line that had to leave.
    pub(crate) fn fill(&mut self, address: u32, random: u32) -> Option<u32> {
        let line = address >> self.line_shift;
        let set = (line & self.set_mask) as usize;
        self.changes += 1;
        let ways = &mut self.sets[set];
        let way = ways.iter().position(|tag| *tag == 0).unwrap_or(random as usize % WAYS);
        let was_dirty = std::mem::take(&mut self.dirty[set][way]);
        let left = std::mem::replace(&mut ways[way], line + 1);
        was_dirty.then(|| (left - 1) << self.line_shift)
    }

    /// Makes a held line clean; tells whether it was dirty.
    pub(crate) fn clean(&mut self, address: u32) -> bool {
        self.find(address).is_some_and(|at| std::mem::take(&mut self.dirty[at.set][at.way]))
    }

    pub(crate) fn clear(&mut self) {
        self.changes += 1;
        self.sets.fill([0; WAYS]);
        self.dirty.fill([false; WAYS]);
    }
}

/// A 16-bit maximal-length shift register, the replacement's source of chance.
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
    fn two_ways_hold_two_lines_of_a_set_and_a_third_drives_one_out() {
        let mut tags = Tags::<2>::new(256, 32);
        let a = 0x1000;
        let b = 0x2000;
        let c = 0x3000;
        assert_eq!((tags.fill(a, 0), tags.fill(b, 0)), (None, None));
        assert!(tags.find(a + 31).is_some() && tags.find(b).is_some() && tags.find(a + 32).is_none());
        tags.fill(c, 0);
        assert!(tags.find(a).is_none() && tags.find(b).is_some() && tags.find(c).is_some());
    }

    #[test]
    fn a_dirty_line_that_leaves_gives_its_address_once() {
        let mut tags = Tags::<2>::new(2, 32);
        tags.fill(0x40, 0);
        let at = tags.find(0x40).expect("just filled");
        tags.mark_dirty(at);
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
