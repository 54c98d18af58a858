//! The instruction set of the renderer's controller.
//!
//! No list of the machine's instructions survives in public. Published are the ingredients (F89, TR94, LK): bit-serial
//! instructions that a ring message brings, an Enable register that masks pixels, a tree that evaluates linear and
//! quadratic expressions for all pixels at once, 208 bits of pixel memory and a backing store that moves 32-bit
//! blocks in the background. Mnemonics, encodings and operand rules below are **assumed**; they are the least that
//! runs the published recipe of a triangle and shading at the end of a frame.
//!
//! # Words
//!
//! The first word of an instruction is `opcode << 24 | modifier << 16 | operand`. An operand names a *field* of pixel
//! memory in 16 bits: bit 15 signed, bit 14 relative to the context's base, bits 13..8 width - 1, bits 7..0 the
//! address of the least significant bit. Unused bits must be zero.
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
//! | 70 | output | 9 | 2, then in the background | the region's colour field goes to a frame buffer |
//!
//! *n* is 3 words for a linear expression, 12 for a quadratic (six coefficients of 64 bits, low word first) and 0 when
//! bit 7 of the modifier says *again*: the evaluator repeats the coefficients that it holds. *s* stands in bits 5..0
//! of the modifier. Every instruction takes [`timing::SET_UP_CLOCKS`] before its bit clocks.
//!
//! # Rules
//!
//! - Writes to pixel memory and backing-store sources are masked by Enable unless the table says *every*.
//! - Results are taken modulo 2^w. An operand narrower than the result is extended: by its sign where its *signed* bit
//!   is set, by zeros otherwise. A comparison, minimum or maximum needs operands of equal signedness.
//! - Linear expressions are evaluated modulo 2^32, quadratic ones modulo 2^48; both are two's complement.
//! - Expressions hold absolute screen coordinates; the controller applies the region's origin.
//! - An operand may overlap the destination only where both start at the same bit; multiply, divide, square root and load
//!   minus allow no overlap.
//! - Divide: f := min(a / b, 2^w - 1), all ones for b = 0; a := a - f b. Operands are unsigned and w <= wa.
//! - An illegal word or operand is a fault: the instruction and the rest of its list have no effect.

mod decode;
mod encode;
mod operand;
pub mod timing;

pub use decode::{DecodeError, DecodeErrorKind};
pub(crate) use encode::{head, opcode};
pub use operand::Operand;

use pxpl5_wire::{CopyTarget, Linear, Quadratic};

/// Bits of pixel memory (F89, TR94).
pub const MEMORY_BITS: u32 = 208;

/// Bits in which a linear expression is evaluated; assumed: one word a coefficient.
pub const LINEAR_BITS: u32 = 32;

/// Bits in which a quadratic expression is evaluated; assumed: 16 fraction bits and spheres up to 2^15 pixels.
pub const QUADRATIC_BITS: u32 = 48;

/// Blocks of 32 bits in the backing store: 4,096 bits a pixel (F89).
pub const BACKING_BLOCKS: u8 = 128;

/// What the evaluator delivers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expression {
    /// A linear expression whose coefficients follow.
    Linear(Linear),
    /// A quadratic expression whose coefficients follow.
    Quadratic(Quadratic),
    /// The last linear expression again.
    LinearAgain,
    /// The last quadratic expression again.
    QuadraticAgain,
}

impl Expression {
    /// Bits in which it is evaluated.
    #[must_use]
    pub const fn bits(&self) -> u32 {
        match self {
            Self::Linear(_) | Self::LinearAgain => LINEAR_BITS,
            Self::Quadratic(_) | Self::QuadraticAgain => QUADRATIC_BITS,
        }
    }

    /// True for a quadratic.
    #[must_use]
    pub const fn is_quadratic(&self) -> bool {
        matches!(self, Self::Quadratic(_) | Self::QuadraticAgain)
    }
}

/// What happens with the bits of an expression.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExpressionUse {
    /// Disable where the expression is negative.
    DisableNegative,
    /// Store bits `shift ..` of the expression.
    Load {
        /// Field that takes the bits.
        field: Operand,
        /// Low bits left out.
        shift: u8,
    },
    /// Add bits `shift ..` of the expression.
    Add {
        /// Field that takes the bits.
        field: Operand,
        /// Low bits left out.
        shift: u8,
    },
    /// Disable unless bits `shift ..` of the expression are less than the field, unsigned.
    DisableNotLess {
        /// What to compare with.
        field: Operand,
        /// Low bits left out.
        shift: u8,
    },
    /// Store bits `shift ..` of the expression minus `subtrahend << left_shift`.
    LoadMinus {
        /// Field that takes the bits.
        field: Operand,
        /// Low bits left out.
        shift: u8,
        /// Field that is subtracted, extended by its signedness.
        subtrahend: Operand,
        /// By how much the subtrahend is shifted to the left first.
        left_shift: u8,
    },
}

/// Operations on two fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArithmeticOp {
    /// a + b, modulo 2^w.
    Add,
    /// a - b, modulo 2^w.
    Subtract,
    /// a * b, modulo 2^w; no operand may overlap the result.
    Multiply,
    /// a / b; the remainder stays in a.
    Divide,
    /// a and b, bit by bit.
    And,
    /// a or b, bit by bit.
    Or,
    /// a exclusive or b, bit by bit.
    Xor,
    /// The smaller of a and b, which are both signed or both unsigned.
    Minimum,
    /// The larger of a and b, which are both signed or both unsigned.
    Maximum,
}

/// Comparisons that disable a pixel where they do not hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Test {
    /// Holds where a < b.
    Less,
    /// Holds where a >= b.
    NotLess,
    /// Holds where a = b.
    Equal,
    /// Holds where a and b differ.
    NotEqual,
}

/// One instruction of the controller.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ArrayInstruction {
    /// E := 1: enables every pixel.
    EnableAll {
        /// Without effect; commands put their kind here.
        label: u8,
    },
    /// E := 0: disables every pixel.
    EnableNone,
    /// E := not E, in every pixel.
    EnableInvert,
    /// E := bit of pixel memory, a field of one bit.
    EnableLoad(Operand),
    /// bit := E in every pixel.
    EnableStore(Operand),
    /// E := E and bit of pixel memory, a field of one bit.
    EnableAnd(Operand),
    /// Selects the context and the region that the following instructions work on.
    Select {
        /// Address added to relative operands.
        context_base: u8,
        /// Screen x of the array's left column.
        left: u16,
        /// Screen y of the array's top row.
        top: u16,
    },
    /// Evaluates an expression in all pixels.
    Evaluate {
        /// Coefficients, or those that the evaluator holds.
        expression: Expression,
        /// What each pixel does with the bits as they come.
        usage: ExpressionUse,
    },
    /// destination := source >> by (a copy for 0).
    ShiftRight {
        /// Field that takes the result.
        destination: Operand,
        /// Field that is read, extended by its signedness.
        source: Operand,
        /// Bits by which the source is shifted, 0 to 63.
        by: u8,
    },
    /// destination := source << by.
    ShiftLeft {
        /// Field that takes the result.
        destination: Operand,
        /// Field that is read, extended by its signedness.
        source: Operand,
        /// Bits by which the source is shifted, 0 to 63.
        by: u8,
    },
    /// destination := source limited to what fits unsigned.
    Saturate {
        /// Field that takes the result.
        destination: Operand,
        /// Field that is read, extended by its signedness.
        source: Operand,
    },
    /// destination := floor of the square root; radicand := remainder.
    SquareRoot {
        /// Field of the root, 1 to 32 bits.
        destination: Operand,
        /// Twice as wide as the root.
        radicand: Operand,
    },
    /// destination := a op b.
    Arithmetic {
        /// What is done with a and b.
        op: ArithmeticOp,
        /// Field that takes the result.
        destination: Operand,
        /// First operand, extended by its signedness.
        a: Operand,
        /// Second operand, extended by its signedness.
        b: Operand,
    },
    /// Disable unless the test holds between two fields.
    Compare {
        /// What must hold for a pixel to stay enabled.
        test: Test,
        /// First operand, extended by its signedness.
        a: Operand,
        /// Second operand, extended by its signedness.
        b: Operand,
    },
    /// Disable unless the test holds between a field and a constant (of the field's width and signedness).
    CompareConstant {
        /// What must hold for a pixel to stay enabled.
        test: Test,
        /// Field that is compared.
        a: Operand,
        /// Constant; low bits are used; wider fields extend it by the field's signedness.
        value: u32,
    },
    /// destination := value, extended by zeros (by the sign for a signed destination).
    LoadConstant {
        /// Field that takes the result.
        destination: Operand,
        /// Constant that every enabled pixel gets.
        value: u32,
    },
    /// destination := source * factor.
    MultiplyConstant {
        /// Field that takes the result.
        destination: Operand,
        /// Field that is multiplied, extended by its signedness.
        source: Operand,
        /// Constant, of which the low `factor_bits` count, two's complement.
        factor: i32,
        /// Bits of the factor including its sign.
        factor_bits: u8,
    },
    /// Backing store block := 32 bits, every pixel, in the background.
    StoreBlock {
        /// 32 bits of pixel memory.
        field: Operand,
        /// Block of the backing store, 0 to 127.
        block: u8,
    },
    /// 32 bits := backing store block, every pixel, in the background.
    LoadBlock {
        /// 32 bits of pixel memory.
        field: Operand,
        /// Block of the backing store, 0 to 127.
        block: u8,
    },
    /// Waits until the backing store is idle.
    Wait,
    /// Sends a field of 24 bits of the region's pixels to a frame buffer.
    Output {
        /// 24 bits of colour.
        field: Operand,
        /// Frame buffer, region and lines that the pixels are for.
        target: CopyTarget,
    },
}
