//! The interface of all pixel arrays, and the results of executed instructions.

use crate::isa::{DecodeErrorKind, Operand};
use pxpl5_wire::{CommandContent, CopyTarget, REGION_SIZE, Word};
use std::sync::Arc;

/// Pixels of the array: 128 x 128 (F89).
pub const PIXELS: usize = (REGION_SIZE * REGION_SIZE) as usize;

/// One bit of every pixel.
///
/// The bit of pixel (x, y) is bit `x % 64` of word `2 y + x / 64`.
pub type Plane = [u64; PIXELS / 64];

pub const EMPTY_PLANE: Plane = [0; PIXELS / 64];

/// A 128 x 128 array of one-bit processors with 208 bits of memory each.
///
/// Each pixel has one bit in the *Enable* register, and an instruction writes only to pixels whose bit is set.
///
/// All implementations give the same result after every instruction: the same bits of pixel memory and of Enable, and
/// the same [`Executed`].
pub trait PixelArray {
    /// Executes a list of instructions.
    ///
    /// # Errors
    /// Returns [`ArrayFault`] for the first illegal word or operand. The instructions before the fault are executed.
    /// The illegal instruction and the rest of the list are not executed. Faults are counted.
    fn execute(&mut self, words: &[Word]) -> Result<Executed, ArrayFault>;

    /// Executes a list of commands, and can skip commands that change no pixel of the region. Returns one entry for
    /// each region that the list copies to a frame buffer.
    ///
    /// An illegal instruction ends the execution, as on the hardware; what was drawn before it stays. Pixel memory ends
    /// as after [`Self::execute`], but the Enable register can differ. `room` is scratch space for the words of the
    /// commands.
    fn draw(&mut self, commands: &CommandContent, room: &mut Vec<Word>) -> Vec<OutputRegion> {
        room.clear();
        commands.append_visible(room);
        self.execute(room).map_or_else(|_| Vec::new(), |executed| executed.outputs)
    }

    /// Returns bit number `bit` (0 to 207) of all pixels.
    ///
    /// # Panics
    /// Panics if `bit` is 208 or more.
    fn plane(&self, bit: usize) -> Plane;

    /// Overwrites bit number `bit` (0 to 207) of all pixels.
    ///
    /// # Panics
    /// Panics if `bit` is 208 or more.
    fn set_plane(&mut self, bit: usize, plane: &Plane);

    /// Returns the Enable register: one bit for each pixel, which allows writes to the pixel's memory.
    fn enable(&self) -> Plane;

    /// Overwrites the Enable register: one bit for each pixel, which allows writes to the pixel's memory.
    fn set_enable(&mut self, plane: &Plane);

    /// Returns the colours of the upper left `width` x `height` pixels (at most 128 x 128), in the format 0x00RRGGBB
    /// and row by row. The colours come from the selected context, the part of pixel memory that holds one region.
    fn read_colour(&self, width: u32, height: u32) -> Arc<[Word]>;

    /// Sets pixel memory, the Enable register, the backing store, the selected region and the count of faults to zero.
    fn reset(&mut self);

    /// Returns the number of illegal instructions since the last call of [`Self::reset`].
    fn faults(&self) -> u64;
}

/// Busy time and output of an executed list of instructions. The changes of pixel memory are not part of this type.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Executed {
    pub instructions: u32,
    /// Number of clocks during which the array was busy.
    pub clocks: u64,
    /// Pixels sent to frame buffers, one entry for each executed output instruction.
    pub outputs: Vec<OutputRegion>,
}

/// Pixels that one output instruction sends to a frame buffer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct OutputRegion {
    /// Destination of the pixels: the frame buffer, the region and the picture.
    pub target: CopyTarget,
    /// Colours of the region's pixels: one word 0x00RRGGBB for each pixel, row by row.
    pub pixels: Arc<[Word]>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("word {position}: {kind}")]
pub struct ArrayFault {
    /// Index, in the list of words, of the first word of the illegal instruction.
    pub position: usize,
    pub kind: FaultKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum FaultKind {
    #[error("{0}")]
    Illegal(DecodeErrorKind),
    /// An operand or the destination extends beyond the end of pixel memory. Its address is relative to the selected
    /// context, the part of pixel memory that holds one region.
    #[error("{} bits at {base} + {} reach beyond pixel memory", .operand.width, .operand.address)]
    FieldOutOfRange {
        /// The bit field as encoded in the instruction: address relative to the context's first bit, and width in bits.
        operand: Operand,
        /// First bit, in pixel memory, of the selected context (the part that holds one region).
        base: u8,
    },
    /// An operand and the destination share bits of pixel memory, and the instruction does not allow this overlap.
    #[error("the operand at bit {operand} overlaps the destination at bit {destination}")]
    Overlap {
        /// First bit, in pixel memory, of the bit field that receives the result.
        destination: u8,
        /// First bit, in pixel memory, of the operand's bit field.
        operand: u8,
    },
}
