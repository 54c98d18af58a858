//! Tag arrays of the caches and the TLB. Contents live in memory: only hits, misses and write-backs matter here.

use crate::timing::ChipSizes;

/// A set-associative tag array with pseudo-random replacement.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Tags {
    /// Line number + 1, 0 for empty; the ways of a set are neighbours.
    tags: Vec<u32>,
    dirty: Vec<bool>,
    line_shift: u32,
    set_mask: u32,
    ways: u32,
    /// Fills and clears so far: while it stays, so does what is held.
    changes: u64,
}

impl Tags {
    pub(crate) fn new(entries: u32, line_bytes: u32, ways: u32) -> Tags {
        Tags {
            tags: vec![0; entries as usize],
            dirty: vec![false; entries as usize],
            line_shift: line_bytes.trailing_zeros(),
            set_mask: entries / ways - 1,
            ways,
            changes: 0,
        }
    }

    /// Those of a cache of this many bytes.
    pub(crate) fn of_cache(bytes: u64) -> Tags {
        let ChipSizes { line_bytes, cache_ways, .. } = ChipSizes::PAPERS;
        Tags::new((bytes / line_bytes) as u32, line_bytes as u32, cache_ways as u32)
    }

    #[inline]
    pub(crate) fn changes(&self) -> u64 {
        self.changes
    }

    fn first_way(&self, line: u32) -> usize {
        ((line & self.set_mask) * self.ways) as usize
    }

    /// The place of an address, if it is held.
    #[inline]
    pub(crate) fn find(&self, address: u32) -> Option<usize> {
        let line = address >> self.line_shift;
        let first = self.first_way(line);
        (first..first + self.ways as usize).find(|at| self.tags[*at] == line + 1)
    }

    #[inline]
    pub(crate) fn mark_dirty(&mut self, at: usize) {
        self.dirty[at] = true;
    }

    /// Takes an address in; an empty way first, else the way chosen by `random`. Gives the address of a dirty
    /// line that had to leave.
    pub(crate) fn fill(&mut self, address: u32, random: u32) -> Option<u32> {
        let line = address >> self.line_shift;
        let first = self.first_way(line);
        let empty = (first..first + self.ways as usize).find(|at| self.tags[*at] == 0);
        self.changes += 1;
        let at = empty.unwrap_or(first + (random % self.ways) as usize);
        let victim = self.dirty[at].then(|| (self.tags[at] - 1) << self.line_shift);
        self.tags[at] = line + 1;
        self.dirty[at] = false;
        victim
    }

    /// Makes a held line clean; tells whether it was dirty.
    pub(crate) fn clean(&mut self, address: u32) -> bool {
        self.find(address).is_some_and(|at| std::mem::take(&mut self.dirty[at]))
    }

    pub(crate) fn clear(&mut self) {
        self.changes += 1;
        self.tags.fill(0);
        self.dirty.fill(false);
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
        let mut tags = Tags::new(256, 32, 2);
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
        let mut tags = Tags::new(2, 32, 2);
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
