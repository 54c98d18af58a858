//! Execution times of instructions, in clocks. The array is SIMD, so no time depends on data.
//!
//! | quantity | unit | value | provenance |
//! |---|---|---|---|
//! | [`CLOCK_HZ`] | Hz | 40,000,000 | published (F89) |
//! | [`SET_UP_CLOCKS`] | clocks an instruction | 4 | derived, see the constant |
//! | [`CONTROL_CLOCKS`] | clocks | 2 | assumed (1 to 4) |
//!
//! The backing store works in parallel with the array. `RendererTiming::backing_block_clocks` is the time of a
//! transfer.
//!
//! Each bit of a bit field takes one clock. Assumed: each pixel has one full adder, which reads its operands and writes
//! its result in the same clock. An expression arrives with its least significant bit first. A bit field of `w` bits
//! therefore takes `s + w` clocks if the lowest `s` bits of the expression are left out.

use super::{ArithmeticOp, ArrayInstruction, Expression, ExpressionUse, LINEAR_BITS, QUADRATIC_BITS};

/// Clock rate of the array in Hz. Published: 40 MHz (F89).
pub const CLOCK_HZ: u64 = 40_000_000;

/// Number of clocks to fetch an instruction and to fill the pipeline of the expression evaluator.
///
/// Derived: 4 is the only whole number for which a Gouraud triangle takes at least the 256 clocks of its published steps,
/// and a Phong triangle at most the 292 clocks of its steps.
///
/// The bits of the number formats need 222 clocks in 9 instructions: 2 (enable), 3 x 32 (edges), 32 (compare Z), 32
/// (store Z) and 3 x 20 (colour). With normals, the formats need 2 + 160 + 3 x 22 (normals) + 24 (object's colour) =
/// 252 clocks in 10 instructions. For n clocks of set-up, this gives 222 + 9 n >= 256 and 252 + 10 n <= 292.
///
/// The design rate of 150,000 Phong triangles per second is 267 clocks for each triangle (F89). With 2 clocks of set-up, a
/// Phong triangle would take 272 clocks, but then a Gouraud triangle would take fewer than its published steps. Plausible
/// values of this constant are 2 to 4.
pub const SET_UP_CLOCKS: u32 = 4;

/// Number of clocks of an instruction that moves no bit field. The value 2 is assumed, with a range of 1 to 4. It
/// equals the time of the instruction "enable all" in the published steps of a triangle.
pub const CONTROL_CLOCKS: u32 = 2;

/// Returns the number of clocks of a square root with a result of `n` bits.
///
/// Each binary digit takes a trial comparison and a subtraction over the bits that the remainder can occupy. The
/// remainder has 2 bits for the first digit and `j + 3` for digit `j`.
pub const fn square_root_clocks(n: u32) -> u32 {
    // The sum over all digits is 2 (2 + sum of j + 3 for j = 1 .. n - 1).
    match n {
        0 => 0,
        _ => 2 * (2 + (n - 1) * (n + 6) / 2),
    }
}

/// Returns the number of clocks of a product of an `a`-bit factor and a `b`-bit factor, with a result of `w` bits.
///
/// For each bit of the second factor, an addition takes one clock for each bit of the first and one for the carry,
/// except for bits beyond the result. If the result has more than `a + b` bits, each further bit takes one clock.
pub fn multiply_clocks(w: u32, a: u32, b: u32) -> u32 {
    let additions: u32 = (0..b.min(w)).map(|j| (a + 1).min(w - j)).sum();
    additions + w.saturating_sub(a + b)
}

/// Returns the number of clocks of a division with a quotient of `w` bits.
///
/// Each binary digit takes a comparison over the bits of the divisor and a subtraction over the bits of the remainder.
pub fn divide_clocks(w: u32, a: u32, b: u32) -> u32 {
    (0..w).map(|j| (a - j).max(b) + (a - j)).sum()
}

impl ArrayInstruction {
    /// Returns the number of clocks for which the instruction occupies the array and its controller.
    pub fn clocks(&self) -> u32 {
        SET_UP_CLOCKS + self.bit_clocks()
    }

    /// Returns the number of clocks for which bits move: all clocks except [`SET_UP_CLOCKS`].
    pub fn bit_clocks(&self) -> u32 {
        match *self {
            Self::Evaluate { expression, usage } => evaluate_clocks(&expression, &usage),
            Self::ShiftRight { destination, .. }
            | Self::ShiftLeft { destination, .. }
            | Self::LoadConstant { destination, .. } => w(destination),
            Self::Saturate { destination, source } => w(destination) + w(source).saturating_sub(w(destination)).max(1),
            Self::SquareRoot { destination, .. } => square_root_clocks(w(destination)),
            Self::Arithmetic { op, destination, a, b } => arithmetic_clocks(op, w(destination), w(a), w(b)),
            Self::Compare { a, b, .. } => w(a).max(w(b)),
            Self::CompareConstant { a, .. } => w(a),
            Self::MultiplyConstant { destination, source, factor_bits, .. } => {
                multiply_clocks(w(destination), w(source), u32::from(factor_bits))
            }
            _ => CONTROL_CLOCKS,
        }
    }
}

const fn w(operand: super::Operand) -> u32 {
    operand.width as u32
}

fn arithmetic_clocks(op: ArithmeticOp, w: u32, a: u32, b: u32) -> u32 {
    match op {
        ArithmeticOp::Multiply => multiply_clocks(w, a, b),
        ArithmeticOp::Divide => divide_clocks(w, a, b),
        ArithmeticOp::Minimum | ArithmeticOp::Maximum => w + a.max(b),
        _ => w,
    }
}

fn evaluate_clocks(expression: &Expression, usage: &ExpressionUse) -> u32 {
    if expression.is_quadratic() {
        return QUADRATIC_BITS;
    }
    match *usage {
        ExpressionUse::DisableNegative => LINEAR_BITS,
        ExpressionUse::Load { field, shift }
        | ExpressionUse::Add { field, shift }
        | ExpressionUse::DisableNotLess { field, shift }
        | ExpressionUse::LoadMinus { field, shift, .. } => u32::from(shift) + w(field),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_root_of_twelve_bits_takes_the_sum_of_the_clocks_of_its_digits() {
        let digits: u32 = (0..12).map(|j| if j == 0 { 2 } else { j + 3 }).sum();
        assert_eq!(square_root_clocks(12), 2 * digits);
        assert_eq!(square_root_clocks(1), 4);
    }

    #[test]
    fn a_full_product_takes_one_addition_per_bit() {
        assert_eq!(multiply_clocks(24, 12, 12), 12 * 13);
        assert_eq!(multiply_clocks(8, 12, 3), 8 + 7 + 6);
        assert_eq!(multiply_clocks(18, 8, 9), 9 * 9 + 1);
    }
}
