//! Which words of memory were decoded.

use std::ops::Range;

/// Words of code that were decoded, so that a store into them is noticed.
#[derive(Debug)]
pub(crate) struct CodeMap {
    /// Lowest and highest address of them.
    range: (u32, u32),
    /// A bit for each word, by its number modulo [`CodeMap::BITS`].
    words: Box<[u64]>,
}

impl CodeMap {
    const BITS: usize = 1 << 14;

    pub(crate) fn new() -> CodeMap {
        CodeMap { range: (u32::MAX, 0), words: vec![0; CodeMap::BITS / 64].into_boxed_slice() }
    }

    fn bit(address: u32) -> (usize, u64) {
        let word = (address >> 2) as usize % CodeMap::BITS;
        (word / 64, 1 << (word % 64))
    }

    pub(crate) fn mark(&mut self, pc: u32) {
        let (at, bit) = CodeMap::bit(pc);
        self.words[at] |= bit;
        self.range = (self.range.0.min(pc), self.range.1.max(pc | 3));
    }

    /// Whether some of `size` bytes may have been decoded.
    #[inline]
    pub(crate) fn may_hold(&self, address: u32, size: u32) -> bool {
        let last = address.wrapping_add(size - 1);
        last >= self.range.0 && address <= self.range.1 && self.is_marked(address, last)
    }

    fn is_marked(&self, first: u32, last: u32) -> bool {
        [first, last].into_iter().any(|address| {
            let (at, bit) = CodeMap::bit(address);
            self.words[at] & bit != 0
        })
    }

    /// Whether none lies outside some addresses.
    pub(crate) fn is_within(&self, extent: &Range<u32>) -> bool {
        let (lowest, highest) = self.range;
        lowest > highest || extent.contains(&lowest) && extent.contains(&highest)
    }

    pub(crate) fn clear(&mut self) {
        self.words.fill(0);
        self.range = (u32::MAX, 0);
    }
}
