//! The set of decoded memory words.

use std::ops::Range;

/// The set of decoded memory words, with which the processor detects stores that can change decoded code.
#[derive(Debug)]
pub(crate) struct CodeMap {
    /// Address range of the assembled program. Empty if the code does not come from an assembled program.
    program: Range<u32>,
    is_stored_to: bool,
    /// Lowest and highest address of the assembled program and all decoded words.
    range: (u32, u32),
    /// Set of decoded words, as bits. Word `n` of memory is bit `n` modulo [`CodeMap::BITS`], so several words share a
    /// bit.
    words: Box<[u64]>,
}

impl CodeMap {
    const BITS: usize = 1 << 14;

    pub(crate) fn new(program: Range<u32>) -> CodeMap {
        let range = CodeMap::ends(&program);
        CodeMap { program, is_stored_to: false, range, words: Box::default() }
    }

    fn ends(program: &Range<u32>) -> (u32, u32) {
        if program.is_empty() { (u32::MAX, 0) } else { (program.start, program.end - 1) }
    }

    fn bit(address: u32) -> (usize, u64) {
        let word = (address >> 2) as usize % CodeMap::BITS;
        (word / 64, 1 << (word % 64))
    }

    pub(crate) fn mark(&mut self, pc: u32) {
        if self.words.is_empty() {
            self.words = vec![0; CodeMap::BITS / 64].into_boxed_slice();
        }
        let (at, bit) = CodeMap::bit(pc);
        self.words[at] |= bit;
        self.range = (self.range.0.min(pc), self.range.1.max(pc | 3));
    }

    /// Records a store of `size` bytes. Returns true if a stored byte can belong to a decoded word.
    #[inline]
    pub(crate) fn note_store(&mut self, address: u32, size: u32) -> bool {
        let last = address.wrapping_add(size - 1);
        last >= self.range.0 && address <= self.range.1 && self.note_near(address, last)
    }

    fn note_near(&mut self, first: u32, last: u32) -> bool {
        // Record every change of the program, even of words that were not decoded.
        self.is_stored_to |= last >= self.program.start && first < self.program.end;
        [first, last].into_iter().any(|address| {
            let (at, bit) = CodeMap::bit(address);
            self.words.get(at).is_some_and(|words| words & bit != 0)
        })
    }

    /// Returns true if all decoded words belong to the assembled program, and no store has changed the program.
    pub(crate) fn is_as_assembled(&self) -> bool {
        !self.is_stored_to && self.range == CodeMap::ends(&self.program)
    }

    pub(crate) fn clear(&mut self) {
        self.words.fill(0);
        self.range = CodeMap::ends(&self.program);
    }
}
