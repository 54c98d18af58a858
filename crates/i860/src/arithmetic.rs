//! IEEE arithmetic on bit patterns, rounded to nearest even. The results are the same on every computer.
//!
//! The operations of `f32` and `f64` are correctly rounded on every computer. Only the bits of NaN results differ
//! between computers. The model therefore replaces a NaN result by the first NaN operand, converted to a quiet NaN. If
//! no operand is NaN, the result is the default NaN, whose sign is set as on other Intel processors.

use crate::state::PipeStage;

const NAN32: u32 = 0xFFC0_0000;
const NAN64: u64 = 0xFFF8_0000_0000_0000;
const QUIET32: u32 = 0x0040_0000;
const QUIET64: u64 = 0x0008_0000_0000_0000;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operation {
    Add,
    Subtract,
    Multiply,
}

#[cold]
fn nan32(a: f32, b: f32) -> u32 {
    match (a.is_nan(), b.is_nan()) {
        (true, _) => a.to_bits() | QUIET32,
        (_, true) => b.to_bits() | QUIET32,
        _ => NAN32,
    }
}

#[cold]
fn nan64(a: f64, b: f64) -> u64 {
    match (a.is_nan(), b.is_nan()) {
        (true, _) => a.to_bits() | QUIET64,
        (_, true) => b.to_bits() | QUIET64,
        _ => NAN64,
    }
}

#[inline]
pub(crate) fn single(operation: Operation, a: f32, b: f32, flush: bool) -> u32 {
    let result = match operation {
        Operation::Add => a + b,
        Operation::Subtract => a - b,
        Operation::Multiply => a * b,
    };
    match () {
        () if result.is_nan() => nan32(a, b),
        () if flush && result.is_subnormal() => result.to_bits() & 0x8000_0000,
        () => result.to_bits(),
    }
}

#[inline]
pub(crate) fn double(operation: Operation, a: f64, b: f64, flush: bool) -> u64 {
    let result = match operation {
        Operation::Add => a + b,
        Operation::Subtract => a - b,
        Operation::Multiply => a * b,
    };
    match () {
        () if result.is_nan() => nan64(a, b),
        () if flush && result.is_subnormal() => result.to_bits() & (1 << 63),
        () => result.to_bits(),
    }
}

/// Converts the bits of a single-precision number to the bits of a double-precision number.
#[inline]
pub(crate) fn widen(bits: u32) -> u64 {
    let value = f32::from_bits(bits);
    if value.is_nan() { widen_nan(bits) } else { f64::from(value).to_bits() }
}

#[cold]
fn widen_nan(bits: u32) -> u64 {
    let sign = u64::from(bits >> 31) << 63;
    sign | 0x7FF0_0000_0000_0000 | u64::from(bits & 0x007F_FFFF) << 29 | QUIET64
}

/// Converts the bits of a double-precision number to the bits of a single-precision number, rounded to nearest even.
#[inline]
pub(crate) fn narrow(bits: u64, flush: bool) -> u32 {
    let value = f64::from_bits(bits);
    if value.is_nan() {
        return (bits >> 32) as u32 & 0x8000_0000 | 0x7FC0_0000 | (bits >> 29) as u32 & 0x003F_FFFF;
    }
    let result = value as f32;
    if flush && result.is_subnormal() { result.to_bits() & 0x8000_0000 } else { result.to_bits() }
}

/// Computes one floating-point operation on bit patterns. If `source` (the S bit) is true, the operands are in double
/// precision. If `result` (the R bit) is true, the result is in double precision.
#[inline]
pub(crate) fn operate(operation: Operation, a: u64, b: u64, source: bool, result: bool, flush: bool) -> PipeStage {
    if !source && !result {
        let bits = single(operation, f32::from_bits(a as u32), f32::from_bits(b as u32), flush);
        return PipeStage { bits: u64::from(bits), double: false };
    }
    let (a, b) = if source { (a, b) } else { (widen(a as u32), widen(b as u32)) };
    let bits = double(operation, f64::from_bits(a), f64::from_bits(b), flush);
    PipeStage { bits, double: true }
}

/// Returns the bits of a value that leaves a pipe, in double precision if `double` is true, otherwise in single
/// precision.
#[inline]
pub(crate) fn convert(value: PipeStage, double: bool, flush: bool) -> u64 {
    match (value.double, double) {
        (false, true) => widen(value.bits as u32),
        (true, false) => u64::from(narrow(value.bits, flush)),
        _ => value.bits,
    }
}

/// Rounds a number to an integer. `mode` is the bit field RM of the register fsr: 0 to nearest even, 1 down, 2 up, 3
/// towards zero.
pub(crate) fn round(value: f64, mode: u32) -> f64 {
    match mode {
        0 => value.round_ties_even(),
        1 => value.floor(),
        2 => value.ceil(),
        _ => value.trunc(),
    }
}

/// Converts a rounded number to a 32-bit integer, which is the low word of the result of `fix` or `ftrunc`. The real
/// chip traps if the number does not fit in 32 bits. The model then returns the nearest 32-bit integer, or 0 for NaN.
pub(crate) fn to_integer(rounded: f64) -> u32 {
    rounded as i32 as u32
}

/// Returns the low 53 bits of the product of two significands, like the instruction `fmlow`.
pub(crate) fn multiply_low(a: u64, b: u64) -> u64 {
    const FRACTION: u64 = (1 << 53) - 1;
    (a & FRACTION).wrapping_mul(b & FRACTION) & FRACTION
}
