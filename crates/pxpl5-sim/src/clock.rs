//! Clocks with exact edges. Rounding errors do not accumulate.

use crate::{Span, Time};
use serde::{Deserialize, Serialize};

/// A number of cycles of one clock. The type does not state which clock, so only code near the definition of the clock
/// should use this type.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Cycles(pub u64);

/// A clock whose period is the rational number `numerator_ps / denominator` picoseconds.
///
/// Edge n is at floor(n x period). It is computed from time zero, with 128-bit numbers if 64 bits are too few.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub struct Clock {
    numerator_ps: u64,
    denominator: u64,
}

impl Clock {
    /// Makes a clock whose period is `numerator_ps / denominator` picoseconds. Returns `None` unless both numbers are
    /// positive and the period is at least one picosecond.
    pub const fn new(numerator_ps: u64, denominator: u64) -> Option<Self> {
        if denominator == 0 || numerator_ps < denominator {
            return None;
        }
        Some(Self { numerator_ps, denominator })
    }

    /// Makes a clock from a frequency in hertz. Returns `None` for a frequency of zero or of more than a terahertz.
    pub const fn from_hz(hz: u64) -> Option<Self> {
        Self::new(1_000_000_000_000, hz)
    }

    /// Returns the time of clock edge `n`, or [`Time::END`] if the edge would come after [`Time::END`].
    #[inline]
    pub const fn edge(&self, n: u64) -> Time {
        match n.checked_mul(self.numerator_ps) {
            Some(product) => Time(product / self.denominator),
            None => self.edge_of_long(n),
        }
    }

    /// Returns the time of edge `n` with 128-bit arithmetic. This arithmetic is several times slower than 64-bit
    /// arithmetic, so the function is called only if 64 bits are too few.
    const fn edge_of_long(&self, n: u64) -> Time {
        let exact = n as u128 * self.numerator_ps as u128 / self.denominator as u128;
        if exact < u64::MAX as u128 { Time(exact as u64) } else { Time::END }
    }

    /// Returns the number of the first clock edge at or after `time`.
    pub const fn edge_at_or_after(&self, time: Time) -> u64 {
        // The division rounds down, so the edge may still lie before `time`.
        let mut n = (time.0 as u128 * self.denominator as u128 / self.numerator_ps as u128) as u64;
        while self.edge(n).0 < time.0 {
            n += 1;
        }
        n
    }

    /// Returns the duration of `cycles` clock cycles from edge 0 on, rounded down to a picosecond.
    pub const fn span(&self, cycles: Cycles) -> Span {
        Span(self.edge(cycles.0).0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_retrace_clock_is_exact_after_a_year() {
        let retrace = Clock::new(1_001_000_000_000_000, 60_000).expect("valid");
        let fields_of_a_hundred_days = 60_000 * 8_640_000 / 1_001;
        assert_eq!(retrace.edge(60_000), Time(1_001_000_000_000_000));
        let exact = fields_of_a_hundred_days as u128 * 1_001_000_000_000_000 / 60_000;
        assert_eq!(u128::from(retrace.edge(fields_of_a_hundred_days).0), exact);
        assert_eq!(retrace.edge(1), Time(16_683_333_333));
    }

    #[test]
    fn the_first_edge_at_or_after_an_edge_is_this_edge() {
        for clock in [Clock::from_hz(40_000_000), Clock::new(1_001_000_000_000_000, 60_000), Clock::new(7, 3)] {
            let clock = clock.expect("valid");
            for n in [0, 1, 2, 3, 1_000, 123_457] {
                let edge = clock.edge(n);
                assert_eq!(clock.edge_at_or_after(edge), n);
                assert_eq!(clock.edge_at_or_after(edge + Span(1)), n + 1);
            }
        }
    }

    #[test]
    fn an_edge_beyond_the_end_of_time_is_at_the_end_of_time() {
        let seconds = Clock::from_hz(1).expect("valid");
        // 2^64 ps are a little more than 18,446,744 s.
        assert_eq!(seconds.edge(18_446_744), Time(18_446_744_000_000_000_000));
        assert_eq!((seconds.edge(18_446_745), seconds.edge(u64::MAX)), (Time::END, Time::END));
        assert_eq!(seconds.edge_at_or_after(Time::END), 18_446_745);
    }

    proptest! {
        /// Tests the fast path in 64 bits. About half of the random edges need the 128 bits of the slow path.
        #[test]
        fn edges_are_the_same_in_64_and_128_bits(period_bits in 1u32..64, bits in 0u32..64, seed: [u64; 3]) {
            let [numerator, denominator] = [seed[0] >> (64 - period_bits), seed[1] >> (64 - period_bits)];
            let clock = Clock::new(numerator.max(denominator).max(1), numerator.min(denominator).max(1)).expect("valid");
            let n = seed[2] >> bits;
            prop_assert_eq!(clock.edge(n), clock.edge_of_long(n));
        }
    }

    #[test]
    fn a_clock_without_a_period_is_refused() {
        assert_eq!(Clock::new(0, 1), None);
        assert_eq!(Clock::from_hz(0), None);
        assert_eq!(Clock::from_hz(2_000_000_000_000), None);
    }
}
