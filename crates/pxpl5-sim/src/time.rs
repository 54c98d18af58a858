//! Instants and durations of simulated time.
//!
//! Time ends after 2^64 ps (213 days). Arithmetic never wraps around: any later instant becomes [`Time::END`], which no
//! simulation reaches, so events there never happen.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::ops::{Add, AddAssign, Div, Mul, Sub};

/// An instant of simulated time, in picoseconds since the machine was switched on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Time(pub u64);

/// A duration of simulated time, in picoseconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct Span(pub u64);

impl Time {
    pub const ZERO: Self = Self(0);

    /// The end of simulated time (213 days), which no simulation reaches.
    pub const END: Self = Self(u64::MAX);

    /// Returns the duration from `earlier` to this instant, or zero if `earlier` is later.
    #[inline]
    pub const fn since(self, earlier: Self) -> Span {
        Span(self.0.saturating_sub(earlier.0))
    }
}

impl Span {
    pub const ZERO: Self = Self(0);

    #[inline]
    pub const fn from_ns(ns: u64) -> Self {
        Self(ns.saturating_mul(1_000))
    }

    #[inline]
    pub const fn from_us(us: u64) -> Self {
        Self(us.saturating_mul(1_000_000))
    }

    /// Returns the duration in milliseconds, rounded to the precision of `f64`. Use the result only in reports.
    pub fn as_ms(self) -> f64 {
        self.0 as f64 * 1e-9
    }
}

impl Add<Span> for Time {
    type Output = Self;
    #[inline]
    fn add(self, span: Span) -> Self {
        Self(self.0.saturating_add(span.0))
    }
}

impl AddAssign<Span> for Time {
    #[inline]
    fn add_assign(&mut self, span: Span) {
        *self = *self + span;
    }
}

impl Sub for Time {
    type Output = Span;
    #[inline]
    fn sub(self, earlier: Self) -> Span {
        debug_assert!(self >= earlier, "{earlier} is not before {self}");
        self.since(earlier)
    }
}

impl Add for Span {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self(self.0.saturating_add(other.0))
    }
}

impl AddAssign for Span {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Sub for Span {
    type Output = Self;
    #[inline]
    fn sub(self, other: Self) -> Self {
        debug_assert!(self >= other, "{other} is more than {self}");
        Self(self.0.saturating_sub(other.0))
    }
}

impl Mul<u64> for Span {
    type Output = Self;
    #[inline]
    fn mul(self, n: u64) -> Self {
        Self(self.0.saturating_mul(n))
    }
}

impl Div<u64> for Span {
    type Output = Self;
    #[inline]
    fn div(self, n: u64) -> Self {
        Self(self.0 / n)
    }
}

impl std::iter::Sum for Span {
    fn sum<I: Iterator<Item = Self>>(spans: I) -> Self {
        spans.fold(Self::ZERO, Add::add)
    }
}

impl fmt::Display for Time {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{:06} us", self.0 / 1_000_000, self.0 % 1_000_000)
    }
}

impl fmt::Display for Span {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        Time(self.0).fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_print_in_microseconds_to_the_picosecond() {
        assert_eq!(Time(12_345_678).to_string(), "12.345678 us");
        assert_eq!((Time(5) + Span::from_ns(2)).0, 2_005);
    }

    #[test]
    fn spans_follow_integer_arithmetic() {
        assert_eq!((Time(17) - Time(5), Span(17) - Span(5), Span(17) / 5), (Span(12), Span(12), Span(3)));
        assert_eq!([Span(1), Span(20), Span(300)].into_iter().sum::<Span>(), Span(321));
        let mut span = Span(17);
        span += Span(5);
        assert_eq!(span, Span(22));
    }

    #[test]
    fn a_field_converts_to_milliseconds_and_prints_in_microseconds() {
        let field = Span(1_001_000_000_000_000 / 60_000);
        assert!((field.as_ms() - 1_001.0 / 60.0).abs() < 1e-9, "{}", field.as_ms());
        assert_eq!(field.to_string(), "16683.333333 us");
    }

    #[test]
    fn times_saturate_at_the_end_of_time() {
        let late = Time(u64::MAX - 1);
        assert_eq!(late + Span(2), Time::END);
        assert_eq!((Span(u64::MAX) + Span(1), Span(1 << 40) * (1 << 40)), (Span(u64::MAX), Span(u64::MAX)));
        assert_eq!((Span::from_ns(u64::MAX / 999), Span::from_us(1 << 60)), (Span(u64::MAX), Span(u64::MAX)));
        let mut time = late;
        time += Span(u64::MAX);
        assert_eq!(time, Time::END);
    }
}
