//! Division, square roots and rounding as on the i860, which has no instructions for division and square root.
//!
//! The i860 has the instructions `frcp` and `frsqr`, which give a first approximation with 8 bits of fraction. Newton
//! steps then increase the precision. To round a number, the code adds a large constant and subtracts the constant
//! again. The Rust code of this crate performs the same steps as the i860 kernels, so the Rust code and the kernels
//! give the same words.

/// Mask of the bits that a first approximation in double precision has: sign, exponent and 8 bits of fraction.
const SEED: u64 = !((1 << (52 - 8)) - 1);

/// The constant 1.5 * 2^52. The addition of this constant rounds a double below 2^51 to an integer, ties to even.
pub(crate) const ROUND_DOUBLE: f64 = 6_755_399_441_055_744.0;

fn seed(exact: f64) -> f64 {
    f64::from_bits(exact.to_bits() & SEED)
}

/// Returns the reciprocal of a positive number, by two Newton steps in single precision. The error is at most two units
/// in the last place.
#[inline(always)]
pub(crate) fn reciprocal(w: f32) -> f32 {
    let near = seed(1.0 / f64::from(w)) as f32;
    let better = near * (2.0 - w * near);
    better * (2.0 - w * better)
}

/// Returns the reciprocal of a nonzero number, by three Newton steps in double precision. Returns NaN for 0 and for
/// infinities.
#[inline(always)]
pub(crate) fn reciprocal_double(value: f64) -> f64 {
    (0..3).fold(seed(1.0 / value), |near, _| near * (2.0 - value * near))
}

/// Returns 1 / sqrt(value) of a positive number, by three Newton steps in double precision. Returns NaN for other
/// numbers and for infinity.
pub(crate) fn reciprocal_root(value: f64) -> f64 {
    let half = value * 0.5;
    (0..3).fold(seed(1.0 / value.sqrt()), |near, _| near * (1.5 - half * (near * near)))
}

pub(crate) fn root(value: f64) -> f64 {
    value * reciprocal_root(value)
}

/// Returns the integer nearest to a number below 2^51 in absolute value, ties to even. For larger numbers, the result
/// is meaningless, but the same on every computer.
pub(crate) fn whole(value: f64) -> i64 {
    ((value + ROUND_DOUBLE).to_bits() as i64).wrapping_sub(ROUND_DOUBLE.to_bits() as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_and_reciprocals_are_accurate_to_the_last_places() {
        for n in -1000..1000 {
            let value = 1.7_f64.powf(f64::from(n) * 0.5);
            assert!((root(value) / value.sqrt() - 1.0).abs() < 1e-15, "root of {value}");
            assert!((reciprocal_double(value) * value - 1.0).abs() < 1e-15, "reciprocal of {value}");
        }
        assert!([0.0, -1.0, f64::INFINITY, f64::NAN].into_iter().all(|value| root(value).is_nan()));
    }

    #[test]
    fn rounding_is_to_the_nearest_integer_with_ties_to_even() {
        let values = [0.0, 0.5, 1.5, -0.5, -1.5, 2.4, -2.6, 1e15 + 0.25, -1e15];
        assert_eq!(values.map(whole), [0, 0, 2, 0, -2, 2, -3, 1_000_000_000_000_000, -1_000_000_000_000_000]);
    }
}
