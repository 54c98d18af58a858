//! Fixed-point formats of expression coefficients and of bit fields in pixel memory.
//!
//! All formats are **assumed**. The papers give the number of bits of pixel memory (208), the number of bits of a
//! colour (24) and the time of a triangle. These figures fit a 24-bit Z and 8-bit colour components. The numbers of
//! fraction bits are choices of this project.

/// Number of fraction bits of a vertex position on the screen. Positions are multiples of 1/16 pixel.
pub const SUBPIXEL_BITS: u32 = 4;

/// Number of bits of a depth value in pixel memory. Depth 0 is the near plane, 2^24 - 1 the far plane.
pub const Z_BITS: u32 = 24;

/// Number of fraction bits of a depth expression. The 24-bit depth of a pixel is `Linear::at(x, y) >> Z_FRACTION_BITS`.
pub const Z_FRACTION_BITS: u32 = 8;

/// Number of bits of one colour component in pixel memory.
pub const COLOUR_BITS: u32 = 8;

pub const COLOUR_FRACTION_BITS: u32 = 12;

/// Number of bits of one component of a normal in pixel memory, in two's complement. The integer
/// `1 << NORMAL_ONE_BITS` stands for 1.0.
pub const NORMAL_BITS: u32 = 12;

/// Number of fraction bits of a normal component in pixel memory: 1.0 is stored as `1 << NORMAL_ONE_BITS`. The range of
/// a component is therefore -2 to 2.
pub const NORMAL_ONE_BITS: u32 = 10;

pub const NORMAL_FRACTION_BITS: u32 = 10;
