//! Code as it was decoded: blocks by their addresses, and which words they were read from.

use crate::assembler::Program;
use crate::block::Block;
use crate::code_map::CodeMap;
use crate::state::Mode;

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
    /// Whether some of it was forgotten because memory may hold something else.
    changed: bool,
}

impl Code {
    /// Of whatever lies in memory.
    pub(crate) fn new() -> Code {
        Code { blocks: Box::default(), words: CodeMap::new(0..0), changed: false }
    }

    /// Of a program.
    pub(crate) fn of(program: &Program) -> Code {
        let end = program.base.saturating_add(program.bytes.len() as u32);
        Code { words: CodeMap::new(program.base..end), ..Code::new() }
    }

    /// Takes the block out that begins at an address in a mode, if it is known.
    #[inline]
    pub(crate) fn take(&mut self, pc: u32, mode: Mode) -> Option<Box<Block>> {
        self.blocks.get_mut(place(pc))?.take().filter(|block| block.begins(pc, mode))
    }

    /// Puts the block of an address back.
    #[inline]
    pub(crate) fn put(&mut self, pc: u32, block: Box<Block>) {
        match self.blocks.get_mut(place(pc)) {
            Some(place) => *place = Some(block),
            None => self.put_first(pc, block),
        }
    }

    #[cold]
    fn put_first(&mut self, pc: u32, block: Box<Block>) {
        self.blocks = vec![None; BLOCKS].into_boxed_slice();
        self.blocks[place(pc)] = Some(block);
    }

    /// Forgets all of it, because memory may hold something else.
    pub(crate) fn clear(&mut self) {
        self.blocks.fill(None);
        self.words.clear();
        self.changed = true;
    }

    /// Whether nothing stored into its program, and it was read from there only.
    pub(crate) fn is_as_assembled(&self) -> bool {
        !self.changed && self.words.is_as_assembled()
    }
}
