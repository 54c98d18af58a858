//! The results of frcp (reciprocal) and frsqr (reciprocal square root): approximations from which programs begin Newton
//! steps (*seeds*).
//!
//! The chip's table is not public. Known is only that the error of the fraction is below 2^-7, so you choose one of
//! three tables. Because programs refine the seeds, the choice affects only the last one or two bits of their results,
//! and never the number of clocks.

use crate::arithmetic::{narrow, widen};

/// The table from which `frcp` and `frsqr` take their results.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SeedTable {
    /// The correctly rounded result in double precision, with its fraction cut to 8 bits. The relative error is below
    /// 2^-8, and the magnitude is never too great. Assumed, because emulators without timing usually compute this
    /// result.
    Truncated8,
    /// The result for the middle of the interval that contains the operand, rounded to 8 fraction bits. The first 8
    /// fraction bits of the operand determine the interval. A ROM of 256 entries can hold these results (512 for frsqr,
    /// because of the parity of the exponent). Assumed.
    Midpoint8,
    /// The correctly rounded result.
    Exact,
}

impl SeedTable {
    /// Returns the name of this table of approximations, for lists of settings.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Truncated8 => "truncated-8",
            Self::Midpoint8 => "midpoint-8",
            Self::Exact => "exact",
        }
    }
}

const FRACTION: u64 = (1 << 52) - 1;
const DROPPED: u32 = 52 - 8;

fn cut(bits: u64) -> u64 {
    bits >> DROPPED << DROPPED
}

fn round8(bits: u64) -> u64 {
    cut(bits + (1 << (DROPPED - 1)))
}

fn is_finite_nonzero(x: f64) -> bool {
    x.is_finite() && x != 0.0
}

fn midpoint(x: f64) -> f64 {
    f64::from_bits(cut(x.to_bits()) | 1 << (DROPPED - 1))
}

impl SeedTable {
    /// Returns an upper bound of the relative error of the approximations in this table.
    pub fn relative_error_bound(self) -> f64 {
        match self {
            SeedTable::Truncated8 | SeedTable::Midpoint8 => 1.0 / 256.0,
            SeedTable::Exact => f64::EPSILON,
        }
    }

    fn apply(self, x: f64, exact: impl Fn(f64) -> f64) -> u64 {
        let value = exact(x);
        // Zero, infinity, NaN and denormal results are returned unchanged.
        if !is_finite_nonzero(value) || value.to_bits() & !(1 << 63) <= FRACTION {
            return value.to_bits();
        }
        match self {
            SeedTable::Truncated8 => cut(value.to_bits()),
            SeedTable::Midpoint8 => round8(exact(midpoint(x)).to_bits()),
            SeedTable::Exact => value.to_bits(),
        }
    }

    /// Returns the double-precision result of `frcp`. Operand and result are bit patterns.
    pub fn reciprocal(self, bits: u64) -> u64 {
        quiet(bits, self.apply(f64::from_bits(bits), |x| 1.0 / x))
    }

    /// Returns the double-precision result of `frsqr`. Operand and result are bit patterns.
    pub fn reciprocal_root(self, bits: u64) -> u64 {
        quiet(bits, self.apply(f64::from_bits(bits), |x| 1.0 / x.sqrt()))
    }

    /// Returns the single-precision result of `frcp`. Operand and result are bit patterns.
    pub fn reciprocal32(self, bits: u32) -> u32 {
        narrow(self.reciprocal(widen(bits)), false)
    }

    /// Returns the single-precision result of `frsqr`. Operand and result are bit patterns.
    pub fn reciprocal_root32(self, bits: u32) -> u32 {
        narrow(self.reciprocal_root(widen(bits)), false)
    }
}

/// Returns `result` unless it is NaN. For NaN, returns a quiet NaN: the NaN of `operand`, or the default NaN if
/// `operand` is not NaN.
fn quiet(operand: u64, result: u64) -> u64 {
    match (f64::from_bits(result).is_nan(), f64::from_bits(operand).is_nan()) {
        (true, true) => operand | 0x0008_0000_0000_0000,
        (true, false) => 0xFFF8_0000_0000_0000,
        _ => result,
    }
}

#[cfg(test)]
mod tests {
    use super::SeedTable;

    fn worst(table: SeedTable, root: bool) -> f64 {
        let octaves = (0..50_000).map(|n| 1.0 + 3.0 * f64::from(n) / 50_000.0);
        octaves.map(|x| error(table, root, x)).fold(0.0, f64::max)
    }

    fn error(table: SeedTable, root: bool, x: f64) -> f64 {
        let (got, want) = match root {
            true => (table.reciprocal_root(x.to_bits()), 1.0 / x.sqrt()),
            false => (table.reciprocal(x.to_bits()), 1.0 / x),
        };
        (f64::from_bits(got) / want - 1.0).abs()
    }

    #[test]
    fn every_table_keeps_its_error_bound_over_two_octaves() {
        for table in [SeedTable::Truncated8, SeedTable::Midpoint8, SeedTable::Exact] {
            for root in [false, true] {
                assert!(worst(table, root) <= table.relative_error_bound(), "{table:?} root {root}");
            }
        }
    }

    #[test]
    fn the_seed_of_zero_is_infinite_and_of_a_negative_root_is_nan() {
        let table = SeedTable::Truncated8;
        assert_eq!(table.reciprocal32(0), f32::INFINITY.to_bits());
        assert!(f32::from_bits(table.reciprocal_root32((-1.0f32).to_bits())).is_nan());
    }

    #[test]
    fn a_power_of_two_has_an_exact_truncated_seed() {
        assert_eq!(SeedTable::Truncated8.reciprocal32(4.0f32.to_bits()), 0.25f32.to_bits());
        assert_eq!(SeedTable::Truncated8.reciprocal_root32(16.0f32.to_bits()), 0.25f32.to_bits());
    }
}
