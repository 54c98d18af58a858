//! Fixed-point formats of coefficients and pixel fields.
//!
//! All formats are **assumed**. The papers give the bits of pixel memory (208), the bits of colour (24) and the time of
//! a triangle. A 24-bit Z and 8-bit colours are the sizes that fit these figures. The numbers of fraction bits are
//! choices of this project.

/// Fraction bits of a vertex on the screen: positions are multiples of 1/16 pixel.
pub const SUBPIXEL_BITS: u32 = 4;

/// Bits of a depth value in pixel memory; 0 is the near plane, 2^24 - 1 the far plane.
pub const Z_BITS: u32 = 24;

/// Fraction bits of a depth expression: the 24-bit depth of a pixel is `Linear::at(x, y) >> Z_FRACTION_BITS`.
pub const Z_FRACTION_BITS: u32 = 8;

/// Bits of one colour component in pixel memory.
pub const COLOUR_BITS: u32 = 8;

/// Fraction bits of a colour component's expression.
pub const COLOUR_FRACTION_BITS: u32 = 12;

/// Bits of one component of a normal in pixel memory, two's complement; 1.0 is `1 << NORMAL_ONE_BITS`.
pub const NORMAL_BITS: u32 = 12;

/// A normal component of 1.0 is `1 << NORMAL_ONE_BITS` in pixel memory (so the range is -2 to 2).
pub const NORMAL_ONE_BITS: u32 = 10;

/// Fraction bits of the expression of a normal component.
pub const NORMAL_FRACTION_BITS: u32 = 10;

/// Fraction bits of a sphere's quadratic expression, whose unit is the square pixel.
pub const QUADRATIC_FRACTION_BITS: u32 = 16;
