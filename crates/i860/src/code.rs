//! Code as it was decoded: blocks by their addresses, and which words they were read from.

use crate::block::Block;
use crate::code_map::CodeMap;
use crate::state::Mode;
use std::ops::Range;

/// Entries of the table of blocks (a host matter, not the part's instruction cache).
const BLOCKS: usize = 1 << 12;

fn place(pc: u32) -> usize {
    (pc >> 2) as usize % BLOCKS
}

/// What was decoded of the code in memory.
#[derive(Debug)]
pub(crate) struct Code {
    blocks: Box<[Option<Box<Block>>]>,
    pub(crate) words: CodeMap,
    /// Whether it was changed since it was loaded.
    changed: bool,
}

impl Code {
    pub(crate) fn new() -> Code {
        Code { blocks: vec![None; BLOCKS].into_boxed_slice(), words: CodeMap::new(), changed: false }
    }

    /// Takes the block out that begins at an address in a mode, if it is known.
    #[inline]
    pub(crate) fn take(&mut self, pc: u32, mode: Mode) -> Option<Box<Block>> {
        self.blocks[place(pc)].take().filter(|block| block.begins(pc, mode))
    }

    /// Puts the block of an address back.
    #[inline]
    pub(crate) fn put(&mut self, pc: u32, block: Box<Block>) {
        self.blocks[place(pc)] = Some(block);
    }

    /// Forgets all of it, because memory may hold something else.
    pub(crate) fn clear(&mut self) {
        self.blocks.fill(None);
        self.words.clear();
        self.changed = true;
    }

    /// Whether it was never changed and was read from these addresses only.
    pub(crate) fn is_as_loaded(&self, extent: &Range<u32>) -> bool {
        !self.changed && self.words.is_within(extent)
    }
}
