//! The instruction set of the renderer's controller.
//!
//! No list of the machine's instructions is public. F89, TR94 and LK publish only the principles: bit-serial
//! instructions arrive in ring messages, and an Enable register decides which pixels they change. A tree evaluates
//! linear and quadratic expressions in all pixels together. Each pixel has 208 bits of memory, and a backing store
//! moves 32-bit blocks in the background. Mnemonics, encodings and operand rules are therefore **assumed**. They are
//! the smallest set that can execute the published program of a triangle, and the shading of a region after its last
//! primitive.
//!
//! # Words
//!
//! The first word of an instruction is `opcode << 24 | modifier << 16 | operand`. The operand encodes a *bit field* of
//! pixel memory in 16 bits: bit 15 is set if it is signed. Bit 14 is set if its address counts from the first bit of
//! the selected context (the part of pixel memory with the region). Bits 13..8 are width - 1, and bits 7..0 the address
//! of the least significant bit. Unused bits must be zero.
//!
//! | opcode | instruction | words | bit clocks | effect |
//! |---|---|---|---|---|
//! | 01 | enable all | 1 | 2 | E := 1; the modifier is a label without effect |
//! | 02 | enable none | 1 | 2 | E := 0 |
//! | 03 | enable invert | 1 | 2 | E := not E |
//! | 04 | enable load *f* | 1 | 2 | E := f (1 bit) |
//! | 05 | enable store *f* | 1 | 2 | f := E in **every** pixel |
//! | 06 | enable and *f* | 1 | 2 | E := E and f |
//! | 07 | select | 2 | 2 | context base := modifier; origin of the region := second word, x + y << 16 |
//! | 10 | disable negative *e* | 1 + n | 32 or 48 | E := 0 where e < 0 |
//! | 11 | load *f, e, s* | 1 + n | s + w or 48 | f := bits s .. s + w of e |
//! | 12 | add *f, e, s* | 1 + n | s + w or 48 | f := f + bits s .. s + w of e |
//! | 13 | disable not less *f, e, s* | 1 + n | s + w or 48 | E := 0 unless bits s .. s + w of e < f, unsigned |
//! | 14 | load minus *f, e, s, g, t* | 2 + n | s + w or 48 | f := bits s .. s + w of e - (g << t) |
//! | 20-24 | the same with a quadratic | | | |
//! | 30 | shift right *f, a, s* | 2 | w | f := a >> s |
//! | 31 | shift left *f, a, s* | 2 | w | f := a << s |
//! | 32 | saturate *f, a* | 2 | w + max(wa - w, 1) | f := a limited to 0 .. 2^w - 1 |
//! | 33 | square root *f, a* | 2 | sum, see timing | f := floor(sqrt a), a := a - f^2 |
//! | 34-3A | add, subtract, multiply, divide, and, or, xor *f, a, b* | 2 | w; multiply and divide: sum | f := a op b |
//! | 3B, 3C | minimum, maximum *f, a, b* | 2 | w + max(wa, wb) | f := the smaller, the larger |
//! | 40-43 | disable unless less, not less, equal, not equal *a, b* | 2 | max(wa, wb) | E := 0 unless a op b |
//! | 48-4B | the same with a constant | 2 | wa | E := 0 unless a op constant |
//! | 50 | load constant *f* | 2 | w | f := constant |
//! | 51 | multiply constant *f, a, bits* | 3 | as multiply | f := a * constant |
//! | 60, 61 | store block, load block | 1 | 2, then in the background | 32 bits to or from the backing store, **every** pixel |
//! | 62 | wait | 1 | 2 | until the backing store is idle |
//! | 70 | output | 9 | 2, then in the background | the colour bits of the region go to a frame buffer |
//!
//! *n* is 3 words for a linear expression and 12 words for a quadratic expression (six coefficients of 64 bits, low
//! word first). If bit 7 of the modifier (*again*) is set, *n* is 0, and the evaluator reuses its last coefficients of
//! this kind. *s* is in bits 5..0 of the modifier. Every instruction takes [`timing::SET_UP_CLOCKS`] clocks before its
//! bit clocks.
//!
//! # Rules
//!
//! - An instruction writes only to enabled pixels, unless the table contains the word *every*.
//! - Results are taken modulo 2^w. An operand narrower than the result is sign-extended if its *signed* bit is set,
//!   otherwise zero-extended. A comparison, minimum or maximum needs operands of equal signedness.
//! - Linear expressions are evaluated modulo 2^32, and quadratic expressions modulo 2^48. Both are in two's complement.
//! - Expressions hold absolute screen coordinates. The controller applies the region's origin.
//! - An operand may overlap the destination only if both start at the same bit. Multiply, divide, square root and load
//!   minus allow no overlap.
//! - Divide: f := min(a / b, 2^w - 1), or all ones for b = 0. Then a := a - f b. Operands are unsigned and w <= wa.
//! - An illegal word or operand is a fault. The instruction and the rest of its list then have no effect.

mod decode;
mod encode;
mod operand;
pub mod timing;

pub use decode::{DecodeError, DecodeErrorKind};
pub(crate) use encode::{head, opcode};
pub use operand::Operand;

use pxpl5_wire::{CopyTarget, Linear, Quadratic};

/// Number of bits of memory of each pixel (F89, TR94).
pub const MEMORY_BITS: u32 = 208;

/// Width in bits of a linear expression's value. Assumed: one word for each coefficient.
pub const LINEAR_BITS: u32 = 32;

/// Width in bits of a quadratic expression's value. Assumed: 16 fraction bits, and spheres with a radius of up to 2^15
/// pixels.
pub const QUADRATIC_BITS: u32 = 48;

/// Number of 32-bit blocks of each pixel in the backing store: 4,096 bits per pixel (F89).
pub const BACKING_BLOCKS: u8 = 128;

/// An expression that the evaluator computes for all pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expression {
    Linear(Linear),
    Quadratic(Quadratic),
    /// The last linear expression, whose coefficients the evaluator has stored.
    LinearAgain,
    /// The last quadratic expression, whose coefficients the evaluator has stored.
    QuadraticAgain,
}

impl Expression {
    pub const fn bits(&self) -> u32 {
        match self {
            Self::Linear(_) | Self::LinearAgain => LINEAR_BITS,
            Self::Quadratic(_) | Self::QuadraticAgain => QUADRATIC_BITS,
        }
    }

    pub const fn is_quadratic(&self) -> bool {
        matches!(self, Self::Quadratic(_) | Self::QuadraticAgain)
    }
}

/// The operation that pixels perform with the bits of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpressionUse {
    DisableNegative,
    /// Stores bits `shift` to `shift + w - 1` of the expression in `field`, which has w bits.
    Load {
        field: Operand,
        shift: u8,
    },
    /// Adds bits `shift` to `shift + w - 1` of the expression to `field`, which has w bits.
    Add {
        field: Operand,
        shift: u8,
    },
    /// Disables the pixels in which bits `shift` to `shift + w - 1` of the expression are not less than `field`, as
    /// unsigned numbers. `field` has w bits.
    DisableNotLess {
        field: Operand,
        shift: u8,
    },
    /// Computes the expression minus `subtrahend << left_shift`. Stores bits `shift` to `shift + w - 1` of the result
    /// in `field`, which has w bits.
    LoadMinus {
        field: Operand,
        shift: u8,
        subtrahend: Operand,
        left_shift: u8,
    },
}

/// An operation on two bit fields a and b of pixel memory. The bit field of the result has w bits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArithmeticOp {
    /// a + b, modulo 2^w.
    Add,
    /// a - b, modulo 2^w.
    Subtract,
    /// a * b, modulo 2^w. No operand may overlap the result.
    Multiply,
    /// a / b, rounded down. The remainder replaces a.
    Divide,
    And,
    Or,
    Xor,
    /// The smaller of a and b, which are both signed or both unsigned.
    Minimum,
    /// The larger of a and b, which are both signed or both unsigned.
    Maximum,
}

/// A comparison of a with b. Pixels for which the comparison is false are disabled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    Less,
    NotLess,
    Equal,
    NotEqual,
}

/// One instruction of the controller. E is the Enable bit of a pixel.
///
/// An [`Operand`] is a bit field of pixel memory. Signed operands are sign-extended, and unsigned operands are
/// zero-extended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArrayInstruction {
    /// Enables every pixel: E := 1.
    EnableAll {
        /// A number that the array ignores. In the first instruction of a command, it is the opcode of the command's
        /// kind.
        label: u8,
    },
    /// Disables every pixel: E := 0.
    EnableNone,
    /// Inverts the Enable register in every pixel: E := not E.
    EnableInvert,
    /// E := the bit in a bit field of one bit.
    EnableLoad(Operand),
    /// Stores E in a bit field of one bit, in every pixel.
    EnableStore(Operand),
    /// Disables the pixels in which a bit field of one bit is 0: E := E AND bit.
    EnableAnd(Operand),
    /// Selects the region for the following instructions, and the context (part of pixel memory) that holds it.
    Select {
        /// First bit of the context (part of pixel memory). This number is added to the addresses of relative operands.
        context_base: u8,
        /// x coordinate of the array's left column on the screen, in pixels.
        left: u16,
        /// y coordinate of the array's top row on the screen, counted in drawn lines.
        top: u16,
    },
    Evaluate {
        expression: Expression,
        usage: ExpressionUse,
    },
    /// Computes destination := source >> by. A shift by 0 copies the source.
    ShiftRight {
        destination: Operand,
        source: Operand,
        /// Number of bits to shift, 0 to 63.
        by: u8,
    },
    /// Computes destination := source << by.
    ShiftLeft {
        destination: Operand,
        source: Operand,
        /// Number of bits to shift, 0 to 63.
        by: u8,
    },
    /// Computes destination := source limited to 0 .. 2^w - 1, for a destination of w bits.
    Saturate {
        destination: Operand,
        source: Operand,
    },
    /// Computes destination := floor(sqrt(radicand)). The remainder replaces the radicand.
    SquareRoot {
        /// Operand of 1 to 32 bits.
        destination: Operand,
        /// Operand with twice as many bits as the root.
        radicand: Operand,
    },
    /// Computes destination := a op b, for the operation `op`.
    Arithmetic {
        op: ArithmeticOp,
        destination: Operand,
        a: Operand,
        b: Operand,
    },
    /// Compares two bit fields, and disables the pixels for which the comparison is false.
    Compare {
        test: Test,
        a: Operand,
        b: Operand,
    },
    /// Compares a bit field with a constant, and disables the pixels for which the comparison is false. The constant
    /// has the width and signedness of the bit field.
    CompareConstant {
        test: Test,
        a: Operand,
        /// A bit field of less than 32 bits uses the low bits of this constant. For a bit field of more than 32 bits,
        /// the constant is sign-extended or zero-extended, like the bit field.
        value: u32,
    },
    /// Computes destination := value. For a destination of more than 32 bits, the value is sign-extended if the
    /// destination is signed, otherwise zero-extended.
    LoadConstant {
        destination: Operand,
        value: u32,
    },
    /// Multiplies a bit field by a constant: destination := source * factor.
    MultiplyConstant {
        destination: Operand,
        source: Operand,
        /// Factor in two's complement, of which only the low `factor_bits` bits are used.
        factor: i32,
        /// Number of bits of the factor, including its sign.
        factor_bits: u8,
    },
    /// Stores 32 bits of every pixel in a block of the backing store. The array continues during the transfer.
    StoreBlock {
        field: Operand,
        /// Block of the backing store, 0 to 127.
        block: u8,
    },
    /// Loads 32 bits of every pixel from a block of the backing store. The array continues during the transfer.
    LoadBlock {
        field: Operand,
        /// Block of the backing store, 0 to 127.
        block: u8,
    },
    Wait,
    /// Sends the 24 bits of `field`, from each pixel of the region, to a frame buffer.
    Output {
        field: Operand,
        target: CopyTarget,
    },
}
