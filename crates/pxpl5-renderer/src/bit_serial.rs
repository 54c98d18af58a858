//! `BitSerial`: the array as it was built, one bit of one instruction a clock. This is the definition.

mod arithmetic;
mod evaluate;
mod evaluator;
mod planes;

use crate::array::{EMPTY_PLANE, Executed, Fault, FaultKind, OutputRegion, PixelArray, Plane};
use crate::controller::{Bits, Controller};
use crate::isa::timing::{CONTROL_CLOCKS, SET_UP_CLOCKS};
use crate::isa::{BACKING_BLOCKS, Instruction, MEMORY_BITS, Operand};
use crate::layout::Layout;
use crate::simd::{Present, Vectors};
use pxpl5_wire::Word;
use std::sync::Arc;

/// 208 bit planes, an Enable plane, and serial adders: what the hardware has, and nothing else.
///
/// Clocks are counted as the planes move, so that [`crate::isa::timing`] is checked and not assumed here.
#[derive(Clone, Debug)]
pub struct BitSerial {
    layout: Layout,
    vectors: Present,
    controller: Controller,
    memory: Vec<Plane>,
    enable: Plane,
    backing: Vec<Option<Vec<Plane>>>,
    clock: u64,
    faults: u64,
}

impl BitSerial {
    /// An array of zeros. The layout only says where [`PixelArray::read_colour`] finds the colour.
    #[must_use]
    pub fn new(layout: &Layout) -> Self {
        Self::with_vectors(layout, Vectors::best())
    }

    /// The same on a chosen vector unit, or the portable one where the processor lacks it.
    #[must_use]
    pub fn with_vectors(layout: &Layout, vectors: Vectors) -> Self {
        Self {
            layout: *layout,
            vectors: Present::or_portable(vectors),
            controller: Controller::default(),
            memory: vec![EMPTY_PLANE; MEMORY_BITS as usize],
            enable: EMPTY_PLANE,
            backing: vec![None; usize::from(BACKING_BLOCKS)],
            clock: 0,
            faults: 0,
        }
    }

    fn run(&mut self, words: &[Word]) -> Result<Executed, Fault> {
        let mut executed = Executed::default();
        let mut position = 0;
        while position < words.len() {
            let (instruction, used) = Instruction::decode(words, position)
                .map_err(|error| Fault { position, kind: FaultKind::Illegal(error.kind) })?;
            self.controller
                .check(&instruction)
                .and_then(|()| self.instruction(&instruction, &mut executed))
                .map_err(|kind| Fault { position, kind })?;
            executed.instructions += 1;
            executed.clocks += u64::from(SET_UP_CLOCKS) + std::mem::take(&mut self.clock);
            position += used;
        }
        Ok(executed)
    }

    fn instruction(&mut self, instruction: &Instruction, executed: &mut Executed) -> Result<(), FaultKind> {
        match *instruction {
            Instruction::Select { context_base, left, top } => {
                self.controller.select(context_base, left, top);
            }
            Instruction::StoreBlock { field, block } => {
                let bits = self.controller.bits(field)?;
                let planes = self.memory[bits.first..bits.end()].to_vec();
                self.backing[usize::from(block)] = Some(planes);
            }
            Instruction::LoadBlock { field, block } => self.load_block(field, block)?,
            Instruction::Wait => {}
            Instruction::Output { field, target } => {
                let [_, _, width, height] = target.grid.rectangle(target.region);
                let pixels = self.colour(self.controller.bits(field)?, width, height);
                executed.outputs.push(OutputRegion { target, pixels });
            }
            _ => return self.enable_instruction(instruction),
        }
        self.clock += u64::from(CONTROL_CLOCKS);
        Ok(())
    }

    fn enable_instruction(&mut self, instruction: &Instruction) -> Result<(), FaultKind> {
        let first = |operand| self.controller.bits(operand).map(|bits| bits.first);
        match *instruction {
            Instruction::EnableAll { .. } => self.enable = [u64::MAX; 256],
            Instruction::EnableNone => self.enable = EMPTY_PLANE,
            Instruction::EnableInvert => self.enable.iter_mut().for_each(|e| *e = !*e),
            Instruction::EnableLoad(bit) => self.enable = self.memory[first(bit)?],
            Instruction::EnableStore(bit) => {
                let bit = first(bit)?;
                self.memory[bit] = self.enable;
            }
            Instruction::EnableAnd(bit) => {
                let bit = first(bit)?;
                planes::and(&mut self.enable, &self.memory[bit]);
            }
            _ => return self.field_instruction(instruction),
        }
        self.clock += u64::from(CONTROL_CLOCKS);
        Ok(())
    }

    fn load_block(&mut self, field: Operand, block: u8) -> Result<(), FaultKind> {
        let bits = self.controller.bits(field)?;
        match &self.backing[usize::from(block)] {
            Some(planes) => self.memory[bits.first..bits.end()].copy_from_slice(planes),
            None => self.memory[bits.first..bits.end()].fill(EMPTY_PLANE),
        }
        Ok(())
    }

    fn colour(&self, field: Bits, width: u32, height: u32) -> Arc<[Word]> {
        let (width, height) = (width.min(128) as usize, height.min(128) as usize);
        let planes = &self.memory[field.first..field.end()];
        let pixel = |x: usize, y: usize| {
            let bits = planes.iter().enumerate();
            bits.fold(0, |v, (i, p)| v | (p[2 * y + x / 64] >> (x % 64) & 1) << i) as Word
        };
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| pixel(x, y)).collect()
    }
}

impl PixelArray for BitSerial {
    fn execute(&mut self, words: &[Word]) -> Result<Executed, Fault> {
        self.run(words).inspect_err(|_| self.faults += 1)
    }

    fn plane(&self, bit: usize) -> Plane {
        self.memory[bit]
    }

    fn set_plane(&mut self, bit: usize, plane: &Plane) {
        self.memory[bit] = *plane;
    }

    fn enable(&self) -> Plane {
        self.enable
    }

    fn set_enable(&mut self, plane: &Plane) {
        self.enable = *plane;
    }

    fn read_colour(&self, width: u32, height: u32) -> Arc<[Word]> {
        let colour = self.controller.bits(self.layout.plan().colour);
        colour.map_or_else(|_| Arc::default(), |field| self.colour(field, width, height))
    }

    fn reset(&mut self) {
        let vectors = self.vectors;
        *self = Self { vectors, ..Self::new(&self.layout) };
    }

    fn faults(&self) -> u64 {
        self.faults
    }
}
