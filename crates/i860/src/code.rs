//! The store of decoded basic blocks, which finds a block by its address, and the set of decoded memory words.

use crate::assembler::Program;
use crate::block::Block;
use crate::code_map::CodeMap;
use crate::state::Mode;

/// Number of entries in the simulator's table of decoded blocks, which is unrelated to the processor's instruction
/// cache.
const BLOCKS: usize = 1 << 12;

fn place(pc: u32) -> usize {
    (pc >> 2) as usize % BLOCKS
}

#[derive(Debug)]
pub(crate) struct Code {
    blocks: Box<[Option<Box<Block>>]>,
    pub(crate) words: CodeMap,
    changed: bool,
}

impl Code {
    /// Makes an empty store of decoded blocks, for code that does not come from an assembled program.
    pub(crate) fn new() -> Code {
        Code { blocks: Box::default(), words: CodeMap::new(0..0), changed: false }
    }

    pub(crate) fn of(program: &Program) -> Code {
        let end = program.base.saturating_add(program.bytes.len() as u32);
        Code { words: CodeMap::new(program.base..end), ..Code::new() }
    }

    /// Removes and returns the block that begins at address `pc` in pairing mode `mode`. Returns `None` if the table
    /// does not contain this block.
    #[inline]
    pub(crate) fn take(&mut self, pc: u32, mode: Mode) -> Option<Box<Block>> {
        self.blocks.get_mut(place(pc))?.take().filter(|block| block.begins(pc, mode))
    }

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

    pub(crate) fn clear(&mut self) {
        self.blocks.fill(None);
        self.words.clear();
        self.changed = true;
    }

    /// Returns true if all decoded words come from the assembled program, and no store has changed the program.
    pub(crate) fn is_as_assembled(&self) -> bool {
        !self.changed && self.words.is_as_assembled()
    }
}
