//! The interface of all pixel arrays, and the results of executing instructions.

use crate::isa::{DecodeErrorKind, Operand};
use pxpl5_wire::{CommandContent, CopyTarget, REGION_SIZE, Word};
use std::sync::Arc;

/// Pixels of the array: 128 x 128 (F89).
pub const PIXELS: usize = (REGION_SIZE * REGION_SIZE) as usize;

/// One bit of every pixel: the bit of pixel (x, y) is bit `x % 64` of word `2 y + x / 64`.
pub type Plane = [u64; PIXELS / 64];

pub const EMPTY_PLANE: Plane = [0; PIXELS / 64];

/// A 128 x 128 array of one-bit processors with 208 bits of memory each.
///
/// All implementations agree in every bit of pixel memory and Enable after every instruction, and in [`Executed`].
pub trait PixelArray {
    /// Executes a list of instructions.
    ///
    /// # Errors
    /// [`ArrayFault`] at the first illegal word or operand. The instructions before the fault have been executed. The
    /// faulty instruction and the rest of the list have not. Faults are counted.
    fn execute(&mut self, words: &[Word]) -> Result<Executed, ArrayFault>;

    /// Executes the commands of a list that touch the region, and returns the pixels that were copied.
    ///
    /// A fault ends the execution, as on the hardware; earlier drawing stays. Pixel memory ends as after
    /// [`Self::execute`], but Enable may differ. `room` is scratch memory for words.
    fn draw(&mut self, commands: &CommandContent, room: &mut Vec<Word>) -> Vec<OutputRegion> {
        room.clear();
        commands.append_visible(room);
        self.execute(room).map_or_else(|_| Vec::new(), |executed| executed.outputs)
    }

    /// Returns bit `bit` (0 to 207) of all pixels.
    ///
    /// # Panics
    /// If `bit` is 208 or more.
    fn plane(&self, bit: usize) -> Plane;

    /// Overwrites bit `bit` (0 to 207) of all pixels.
    ///
    /// # Panics
    /// If `bit` is 208 or more.
    fn set_plane(&mut self, bit: usize, plane: &Plane);

    /// Returns the Enable register of all pixels.
    fn enable(&self) -> Plane;

    /// Overwrites the Enable register of all pixels.
    fn set_enable(&mut self, plane: &Plane);

    /// Returns the colour of the selected context, 0x00RRGGBB, row by row, of the left top `width` x `height` pixels
    /// (at most 128 x 128).
    fn read_colour(&self, width: u32, height: u32) -> Arc<[Word]>;

    /// Sets pixel memory, Enable, backing store, selected region and the count of faults to zero.
    fn reset(&mut self);

    /// Returns the number of faults since the last reset.
    fn faults(&self) -> u64;
}

/// Result of executing a list of instructions, apart from the changes of pixels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Executed {
    pub instructions: u32,
    /// Clocks in which the array was busy.
    pub clocks: u64,
    /// Pixels that were sent to frame buffers, one entry for each output instruction.
    pub outputs: Vec<OutputRegion>,
}

/// The pixels of an output instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputRegion {
    /// Frame buffer, region and picture that receive the pixels.
    pub target: CopyTarget,
    /// One word for each pixel, 0x00RRGGBB, row by row of the region's rectangle.
    pub pixels: Arc<[Word]>,
}

/// An instruction that cannot be executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("word {position}: {kind}")]
pub struct ArrayFault {
    /// Index of the instruction's first word in the list.
    pub position: usize,
    pub kind: FaultKind,
}

/// Reason why an instruction cannot be executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FaultKind {
    /// The words encode no instruction.
    #[error("{0}")]
    Illegal(DecodeErrorKind),
    /// A field, addressed relative to the selected context, ends beyond pixel memory.
    #[error("{} bits at {base} + {} reach beyond pixel memory", .operand.width, .operand.address)]
    FieldOutOfRange {
        /// The field as the instruction names it: address relative to the context's base, width in bits.
        operand: Operand,
        /// First bit of the selected context in pixel memory.
        base: u8,
    },
    /// An operand overlaps the destination in a way that the instruction does not allow.
    #[error("the operand at bit {operand} overlaps the destination at bit {destination}")]
    Overlap {
        /// First bit of the destination.
        destination: u8,
        /// First bit of the operand.
        operand: u8,
    },
}
