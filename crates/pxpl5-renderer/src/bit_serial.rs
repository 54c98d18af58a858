//! Bit-serial reference model of the pixel array: one bit of one instruction per clock, as in the hardware.
//!
//! The array has two modes. The default mode moves all bit planes of all pixels, and defines correct behaviour. The
//! skipping mode (see [`runs`]) leaves out work that changes no bit. Tests check that both modes agree in every bit,
//! clock and fault.

mod arithmetic;
mod collect;
mod delivery;
mod evaluate;
mod evaluator;
mod planes;
mod runs;
mod tile;

use crate::array::{ArrayFault, Executed, FaultKind, OutputRegion, PixelArray, Plane};
use crate::controller::{Controller, FieldBits};
use crate::isa::timing::{CONTROL_CLOCKS, SET_UP_CLOCKS};
use crate::isa::{ArrayInstruction, BACKING_BLOCKS, Operand};
use crate::layout::Layout;
use crate::simd::{PresentVectors, Vectors};
use pxpl5_wire::{REGION_SIZE, Word};
use runs::InstructionRun;
use std::sync::Arc;
use tile::{EMPTY, FULL, HEIGHT, TILES, Tile, TilePlane, WIDTH};

/// Pixel array of 208 bit planes, an Enable plane and serial adders, like the hardware.
///
/// It counts a clock whenever a bit plane moves, which makes the count an independent test of the formulas in
/// [`crate::isa::timing`]. It is the reference model unless [`Self::skipping`] is called.
#[derive(Clone, Debug)]
pub struct BitSerial {
    layout: Layout,
    vectors: PresentVectors,
    controller: Controller,
    tiles: Vec<Tile>,
    /// One entry for each block of the backing store: the stored bit planes of all tiles, or `None` for an unused
    /// block.
    backing: Vec<Option<Vec<TilePlane>>>,
    clock: u64,
    faults: u64,
    skipping: bool,
    run: InstructionRun,
}

impl BitSerial {
    /// Creates an array whose memory is all zero. Only [`PixelArray::read_colour`] uses `layout`, to find the bit field
    /// of the colour.
    pub fn new(layout: &Layout) -> Self {
        Self::with_vectors(layout, Vectors::best())
    }

    /// Creates an array whose memory is all zero. The array computes with the vector instructions `vectors`, or with
    /// portable code if the computer lacks these instructions.
    pub fn with_vectors(layout: &Layout, vectors: Vectors) -> Self {
        Self {
            layout: *layout,
            vectors: PresentVectors::or_portable(vectors),
            controller: Controller::default(),
            tiles: vec![Tile::EMPTY; TILES],
            backing: vec![None; usize::from(BACKING_BLOCKS)],
            clock: 0,
            faults: 0,
            skipping: false,
            run: InstructionRun::default(),
        }
    }

    /// Turns on the skipping mode, which leaves out work that changes no bit.
    ///
    /// Disabled pixels are not simulated. Nor are the adders, if the signs of an expression at the corners of a tile of
    /// 32 x 16 pixels determine the sign in the whole tile. Clocks, faults and all bits stay the same, at about a tenth
    /// of the time.
    #[must_use]
    pub fn skipping(self) -> Self {
        Self { skipping: true, ..self }
    }

    fn run(&mut self, words: &[Word]) -> Result<Executed, ArrayFault> {
        let mut executed = Executed::default();
        let mut position = 0;
        while position < words.len() {
            let skipped = if self.skipping { self.execute_run(words, position, &mut executed) } else { 0 };
            position += if skipped > 0 { skipped } else { self.step(words, position, &mut executed)? };
        }
        Ok(executed)
    }

    fn step(&mut self, words: &[Word], position: usize, executed: &mut Executed) -> Result<usize, ArrayFault> {
        let (instruction, used) = self.controller.fetch(words, position)?;
        self.instruction(&instruction, executed).map_err(|kind| ArrayFault { position, kind })?;
        executed.instructions += 1;
        executed.clocks += u64::from(SET_UP_CLOCKS) + std::mem::take(&mut self.clock);
        Ok(used)
    }

    fn instruction(&mut self, instruction: &ArrayInstruction, executed: &mut Executed) -> Result<(), FaultKind> {
        // Execute the instructions that move no bits here. The functions for Enable and for bit fields execute the
        // others.
        match *instruction {
            ArrayInstruction::Select { context_base, left, top } => {
                self.controller.select(context_base, left, top);
            }
            ArrayInstruction::StoreBlock { field, block } => {
                let bits = self.controller.bits(field)?;
                let planes = self.tiles.iter().flat_map(|tile| &tile.memory[bits.first..bits.end()]);
                self.backing[usize::from(block)] = Some(planes.copied().collect());
            }
            ArrayInstruction::LoadBlock { field, block } => self.load_block(field, block)?,
            ArrayInstruction::Wait => {}
            ArrayInstruction::Output { field, target } => {
                let [_, _, width, height] = target.grid.rectangle(target.region);
                let pixels = self.colour(self.controller.bits(field)?, width, height);
                executed.outputs.push(OutputRegion { target, pixels });
            }
            _ => return self.enable_instruction(instruction),
        }
        // These instructions take constant time. The transfer of a block continues in the background.
        self.clock += u64::from(CONTROL_CLOCKS);
        Ok(())
    }

    fn enable_instruction(&mut self, instruction: &ArrayInstruction) -> Result<(), FaultKind> {
        // A one-bit operand refers to one plane of pixel memory.
        match *instruction {
            ArrayInstruction::EnableAll { .. } => self.each_tile(|tile| tile.enable = FULL),
            ArrayInstruction::EnableNone => self.each_tile(|tile| tile.enable = EMPTY),
            ArrayInstruction::EnableInvert => self.each_tile(|tile| planes::invert(&mut tile.enable)),
            ArrayInstruction::EnableLoad(bit) => {
                let bit = self.controller.bits(bit)?.first;
                self.each_tile(|tile| tile.enable = tile.memory[bit]);
            }
            ArrayInstruction::EnableStore(bit) => {
                let bit = self.controller.bits(bit)?.first;
                self.each_tile(|tile| tile.memory[bit] = tile.enable);
            }
            ArrayInstruction::EnableAnd(bit) => {
                let bit = self.controller.bits(bit)?.first;
                self.each_tile(|tile| planes::and(&mut tile.enable, &tile.memory[bit]));
            }
            ArrayInstruction::Evaluate { expression, usage } => return self.evaluate(&expression, &usage),
            _ => return self.field_instruction(instruction),
        }
        self.clock += u64::from(CONTROL_CLOCKS);
        Ok(())
    }

    fn each_tile(&mut self, f: impl FnMut(&mut Tile)) {
        self.tiles.iter_mut().for_each(f);
    }

    fn field_instruction(&mut self, instruction: &ArrayInstruction) -> Result<(), FaultKind> {
        for tile in self.tiles.iter_mut().filter(|tile| tile.has_work(self.skipping)) {
            tile.clock = 0;
            tile.field_instruction(&self.controller, instruction)?;
        }
        // All tiles take the same number of clocks, so tile 0 gives the number. The skipping mode uses a formula
        // instead, because skipped tiles count no clocks.
        self.clock += if self.skipping { instruction.bit_clocks().into() } else { self.tiles[0].clock };
        Ok(())
    }

    fn load_block(&mut self, field: Operand, block: u8) -> Result<(), FaultKind> {
        let bits = self.controller.bits(field)?;
        let mut planes = self.backing[usize::from(block)].iter().flatten();
        for tile in &mut self.tiles {
            let field = &mut tile.memory[bits.first..bits.end()];
            field.fill_with(|| planes.next().copied().unwrap_or(EMPTY));
        }
        Ok(())
    }

    fn colour(&self, field: FieldBits, width: u32, height: u32) -> Arc<[Word]> {
        let size = REGION_SIZE as usize;
        let mut values = vec![0; size * size];
        for (number, tile) in self.tiles.iter().enumerate() {
            let [left, top] = tile::origin(number);
            for y in 0..HEIGHT {
                let row = &mut values[(top + y) * size + left..][..WIDTH];
                for (i, plane) in tile.memory[field.first..field.end()].iter().enumerate() {
                    let bits = (plane[y / 2] >> (WIDTH * (y % 2))) as Word;
                    row.iter_mut().enumerate().for_each(|(x, value)| *value |= (bits >> x & 1) << i);
                }
            }
        }
        let rows = values.chunks(size).take(height as usize);
        rows.flat_map(|row| &row[..size.min(width as usize)]).copied().collect()
    }
}

impl PixelArray for BitSerial {
    fn execute(&mut self, words: &[Word]) -> Result<Executed, ArrayFault> {
        self.run(words).inspect_err(|_| self.faults += 1)
    }

    fn plane(&self, bit: usize) -> Plane {
        tile::join(self.tiles.iter().map(|tile| &tile.memory[bit]))
    }

    fn set_plane(&mut self, bit: usize, plane: &Plane) {
        for (number, tile) in self.tiles.iter_mut().enumerate() {
            tile.memory[bit] = tile::part(plane, number);
        }
    }

    fn enable(&self) -> Plane {
        tile::join(self.tiles.iter().map(|tile| &tile.enable))
    }

    fn set_enable(&mut self, plane: &Plane) {
        for (number, tile) in self.tiles.iter_mut().enumerate() {
            tile.enable = tile::part(plane, number);
        }
    }

    fn read_colour(&self, width: u32, height: u32) -> Arc<[Word]> {
        let colour = self.controller.bits(self.layout.plan().colour);
        colour.map_or_else(|_| Arc::default(), |field| self.colour(field, width, height))
    }

    fn reset(&mut self) {
        let vectors = self.vectors;
        let skipping = self.skipping;
        *self = Self { vectors, skipping, ..Self::new(&self.layout) };
    }

    fn faults(&self) -> u64 {
        self.faults
    }
}
