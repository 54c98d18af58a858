//! Operations on the content of a bit field in one pixel, extended to 64 bits. Signed bit fields are sign-extended, and
//! unsigned bit fields are zero-extended.

use crate::isa::{ArithmeticOp, Test};

pub(super) const fn low(value: u64, width: usize) -> u64 {
    value & (u64::MAX >> (64 - width))
}

/// Computes `a op b` in 64 bits, except divisions (see [`divide`]). The caller cuts the result to the destination's
/// width.
pub(super) fn arithmetic(op: ArithmeticOp, a: u64, b: u64, signed: bool) -> u64 {
    match op {
        ArithmeticOp::Add => a.wrapping_add(b),
        ArithmeticOp::Subtract => a.wrapping_sub(b),
        ArithmeticOp::Multiply => a.wrapping_mul(b),
        ArithmeticOp::And => a & b,
        ArithmeticOp::Or => a | b,
        ArithmeticOp::Xor => a ^ b,
        ArithmeticOp::Minimum if less(a, b, signed) => a,
        ArithmeticOp::Minimum => b,
        ArithmeticOp::Maximum if less(a, b, signed) => b,
        ArithmeticOp::Maximum => a,
        ArithmeticOp::Divide => divide(a, b, 64).0,
    }
}

/// Returns true if a < b, as two's complement numbers if `signed` is true, otherwise as unsigned numbers.
pub(super) const fn less(a: u64, b: u64, signed: bool) -> bool {
    if signed { (a as i64) < b as i64 } else { a < b }
}

pub(super) const fn holds(test: Test, a: u64, b: u64, signed: bool) -> bool {
    match test {
        Test::Less => less(a, b, signed),
        Test::NotLess => !less(a, b, signed),
        Test::Equal => a == b,
        Test::NotEqual => a != b,
    }
}

/// Returns the quotient, limited to `width` bits, and the remainder a - quotient * b. For b = 0, all bits of the
/// quotient are 1.
pub(super) fn divide(a: u64, b: u64, width: usize) -> (u64, u64) {
    let largest = u64::MAX >> (64 - width);
    let quotient = a.checked_div(b).unwrap_or(largest).min(largest);
    (quotient, a - quotient.wrapping_mul(b))
}

pub(super) fn saturate(value: u64, signed: bool, width: usize) -> u64 {
    if signed && (value as i64) < 0 { 0 } else { value.min(u64::MAX >> (64 - width)) }
}

/// Shifts a value right. The upper bits become copies of the sign if `signed` is true, otherwise zeros.
pub(super) const fn shift_right(value: u64, by: u8, signed: bool) -> u64 {
    if signed { (value as i64 >> by) as u64 } else { value >> by }
}

/// Sign-extends the low `width` bits of `value` to 64 bits if `signed` is true, otherwise zero-extends them.
pub(super) const fn extend(value: u64, width: u32, signed: bool) -> u64 {
    let unused = 64 - width;
    if signed { ((value << unused) as i64 >> unused) as u64 } else { value << unused >> unused }
}
