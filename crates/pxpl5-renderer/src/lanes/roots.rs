//! Integer square roots and quotients. The results are computed in floating point, then corrected to the exact integer.
//!
//! IEEE 754 requires correctly rounded square roots and quotients, so the results are the same on every computer. All
//! operands fit in the 24-bit mantissa of a single-precision number, so they are exact.

/// Returns the integer nearest to a number from 0 to 2^22. A cast with `as` would take longer, because it checks each
/// lane for overflow.
#[inline(always)]
fn nearest(v: f32) -> u32 {
    // The sum with 2^23 has no fraction bits, so its mantissa holds the integer.
    (v + 8_388_608.0).to_bits() & 0x7f_ffff
}

/// Returns the square root of a 24-bit number, rounded down.
#[inline(always)]
pub(super) fn square_root_24(v: u32) -> u32 {
    let root = nearest((v as i32 as f32).sqrt());
    root - u32::from(root * root > v)
}

/// Returns the quotient of `a` (23 bits) and `b` (12 bits), limited to 1023, and the remainder.
///
/// The quotient of a division by 0 is 1023.
#[inline(always)]
pub(super) fn divide_10(a: u32, b: u32) -> (u32, u32) {
    let ratio = a as i32 as f32 / b.max(1) as i32 as f32;
    let quotient = nearest(if ratio < 1024.0 { ratio } else { 1024.0 });
    let quotient = quotient - u32::from(quotient * b > a);
    let quotient = if b == 0 { 1023 } else { quotient.min(1023) };
    (quotient, a - quotient * b)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_root_of_24_bits_is_the_floor() {
        for v in 0..1 << 24 {
            assert_eq!(square_root_24(v), v.isqrt());
        }
    }

    #[test]
    fn quotients_next_to_every_multiple_are_exact() {
        for b in 0..1_u32 << 12 {
            for q in (0..1100_u32).step_by(7) {
                for a in [(q * b).saturating_sub(1), q * b, q * b + 1] {
                    let expected = a.checked_div(b).unwrap_or(1023).min(1023);
                    assert_eq!(divide_10(a, b), (expected, a - expected * b), "{a} / {b}");
                }
            }
        }
        assert_eq!(divide_10((1 << 23) - 1, 1), (1023, (1 << 23) - 1024));
    }
}
