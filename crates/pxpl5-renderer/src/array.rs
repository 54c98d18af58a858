//! What every pixel array does, whatever its inside.

use crate::isa::{DecodeErrorKind, Operand};
use pxpl5_wire::{CommandContent, CopyTarget, REGION_SIZE, Word};
use std::sync::Arc;

/// Pixels of the array: 128 x 128 (F89).
pub const PIXELS: usize = (REGION_SIZE * REGION_SIZE) as usize;

/// One bit of every pixel: pixel (x, y) is bit `x % 64` of word `2 y + x / 64`.
pub type Plane = [u64; PIXELS / 64];

/// A plane of zeros.
pub const EMPTY_PLANE: Plane = [0; PIXELS / 64];

/// A 128 x 128 array of one-bit processors with 208 bits of memory each.
///
/// All arrays agree in every bit of pixel memory and Enable after every instruction, and in [`Executed`].
pub trait PixelArray {
    /// Runs a list of instructions.
    ///
    /// # Errors
    /// [`ArrayFault`] at the first illegal word or operand. What stands before it has been executed; it and the rest of the
    /// list have not. Faults are counted.
    fn execute(&mut self, words: &[Word]) -> Result<Executed, ArrayFault>;

    /// Executes what of a list touches the region, and gives what was copied. A fault stops it, as on the hardware; what was drawn
    /// before stays. What pixel memory holds is as after [`Self::execute`], Enable is not. `room` is for words.
    fn draw(&mut self, commands: &CommandContent, room: &mut Vec<Word>) -> Vec<OutputRegion> {
        room.clear();
        commands.append_touching(room);
        self.execute(room).map_or_else(|_| Vec::new(), |executed| executed.outputs)
    }

    /// Bit `bit` (0 to 207) of all pixels.
    ///
    /// # Panics
    /// If `bit` is 208 or more.
    fn plane(&self, bit: usize) -> Plane;

    /// Overwrites bit `bit` (0 to 207) of all pixels.
    ///
    /// # Panics
    /// If `bit` is 208 or more.
    fn set_plane(&mut self, bit: usize, plane: &Plane);

    /// The Enable register of all pixels.
    fn enable(&self) -> Plane;

    /// Overwrites the Enable register of all pixels.
    fn set_enable(&mut self, plane: &Plane);

    /// The colour of the selected context, 0x00RRGGBB, row by row, of the left top `width` x `height` pixels (at most
    /// 128 x 128).
    fn read_colour(&self, width: u32, height: u32) -> Arc<[Word]>;

    /// Everything to zero: pixel memory, Enable, backing store, selected region, count of faults.
    fn reset(&mut self);

    /// Faults since the last reset.
    fn faults(&self) -> u64;
}

/// What a list of instructions did besides changing pixels.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Executed {
    /// Instructions that were executed.
    pub instructions: u32,
    /// Clocks in which the array was busy.
    pub clocks: u64,
    /// Regions that were sent to a frame buffer.
    pub outputs: Vec<OutputRegion>,
}

/// The pixels of an output instruction.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputRegion {
    /// Frame buffer, region and picture that the pixels are for.
    pub target: CopyTarget,
    /// One word a pixel, 0x00RRGGBB, row by row of the region's rectangle.
    pub pixels: Arc<[Word]>,
}

/// An instruction that cannot be executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("word {position}: {kind}")]
pub struct ArrayFault {
    /// Index of the instruction's first word in the list.
    pub position: usize,
    /// Why it cannot be executed.
    pub kind: FaultKind,
}

/// Why an instruction cannot be executed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FaultKind {
    /// The words are no instruction.
    #[error("{0}")]
    Illegal(DecodeErrorKind),
    /// A relative field ends beyond pixel memory in the selected context.
    #[error("{} bits at {base} + {} reach beyond pixel memory", .operand.width, .operand.address)]
    FieldOutOfRange {
        /// The field as the instruction names it: address from the base, width in bits.
        operand: Operand,
        /// Bit of pixel memory that the selected context begins with.
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
