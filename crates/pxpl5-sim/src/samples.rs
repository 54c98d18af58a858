//! Collections of numbers for statistics. A collection keeps at most a fixed number of samples, so long simulations
//! need no more memory.

use crate::statistics::Statistics;
use std::ops::Deref;

/// Largest number of samples of each measured quantity that a simulation keeps if it only needs statistics.
///
/// The samples of one quantity take 512 KiB.
///
/// Under Slats, one sample belongs to a field, and under any other pipeline to a picture.
pub const KEPT_SAMPLES: usize = 65_536;

/// A collection of numbers in order of arrival, with a limit.
///
/// Up to the limit, all numbers are kept, and the statistics equal those of [`Statistics::of`] bit for bit. Beyond it,
/// only the first ones are kept, and the statistics come from sums with twice the precision of `f64`. They differ from
/// the exact ones at most in the last digits.
///
/// As a slice, the collection contains the kept numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Samples {
    kept: Vec<f64>,
    limit: usize,
    moments: Option<Moments>,
}

impl Default for Samples {
    fn default() -> Self {
        Self::keeping(usize::MAX)
    }
}

impl Samples {
    /// Creates an empty collection that keeps at most `limit` numbers.
    pub const fn keeping(limit: usize) -> Self {
        Self { kept: Vec::new(), limit, moments: None }
    }

    pub fn push(&mut self, value: f64) {
        if let Some(moments) = &mut self.moments {
            moments.push(value);
        } else if self.kept.len() < self.limit {
            self.kept.push(value);
        } else {
            let mut moments = Moments::of(&self.kept);
            moments.push(value);
            self.moments = Some(moments);
        }
    }

    /// Returns the number of all added numbers, whether they are kept or not.
    pub fn count(&self) -> u64 {
        self.moments.as_ref().map_or(self.kept.len() as u64, |moments| moments.n)
    }

    pub fn statistics(&self) -> Statistics {
        self.statistics_in(1.0)
    }

    /// Returns the statistics of all added numbers, each divided by `unit`.
    pub fn statistics_in(&self, unit: f64) -> Statistics {
        match &self.moments {
            None => Statistics::of(self.kept.iter().map(|value| value / unit)),
            Some(moments) => moments.statistics_in(unit),
        }
    }
}

impl Extend<f64> for Samples {
    fn extend<I: IntoIterator<Item = f64>>(&mut self, values: I) {
        values.into_iter().for_each(|value| self.push(value));
    }
}

impl FromIterator<f64> for Samples {
    fn from_iter<I: IntoIterator<Item = f64>>(values: I) -> Self {
        let mut samples = Self::default();
        samples.extend(values);
        samples
    }
}

impl Deref for Samples {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.kept
    }
}

impl IntoIterator for Samples {
    type Item = f64;
    type IntoIter = std::vec::IntoIter<f64>;

    fn into_iter(self) -> Self::IntoIter {
        self.kept.into_iter()
    }
}

/// The sum of the differences between each number and the first number, and the sum of the squares of these
/// differences. The use of differences keeps the precision if all numbers are similar.
#[derive(Clone, Debug, PartialEq)]
struct Moments {
    n: u64,
    origin: f64,
    sum: DoubleSum,
    squares: DoubleSum,
    min: f64,
    max: f64,
}

impl Moments {
    fn of(values: &[f64]) -> Self {
        let origin = values.first().copied().unwrap_or_default();
        let none = DoubleSum::default();
        let mut moments = Self { n: 0, origin, sum: none, squares: none, min: f64::INFINITY, max: f64::NEG_INFINITY };
        values.iter().for_each(|value| moments.push(*value));
        moments
    }

    fn push(&mut self, value: f64) {
        let from_origin = value - self.origin;
        self.n += 1;
        self.sum.add(from_origin);
        self.squares.add(from_origin * from_origin);
        self.min = self.min.min(value);
        self.max = self.max.max(value);
    }

    fn statistics_in(&self, unit: f64) -> Statistics {
        let n = self.n as f64;
        let mean_from_origin = self.sum.value() / n;
        let variance = (self.squares.value() - mean_from_origin * self.sum.value()).max(0.0) / (n - 1.0);
        Statistics {
            n: self.n,
            mean: (self.origin + mean_from_origin) / unit,
            sd: if self.n > 1 { variance.sqrt() / unit } else { f64::NAN },
            min: self.min / unit,
            max: self.max / unit,
        }
    }
}

/// A sum that compensates for rounding errors (Neumaier 1974).
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct DoubleSum {
    sum: f64,
    lost: f64,
}

impl DoubleSum {
    fn add(&mut self, value: f64) {
        let sum = self.sum + value;
        self.lost += if self.sum.abs() >= value.abs() { (self.sum - sum) + value } else { (value - sum) + self.sum };
        self.sum = sum;
    }

    const fn value(self) -> f64 {
        self.sum + self.lost
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn statistics_are_exact_up_to_the_limit_of_stored_numbers() {
        let values: Vec<f64> = (0..100).map(|i| f64::from(i * 7919 % 101) * 0.1).collect();
        let mut samples = Samples::keeping(100);
        samples.extend(values.iter().copied());
        assert_eq!(samples.statistics(), Statistics::of(values.iter().copied()));
        assert_eq!(samples.statistics_in(3.0), Statistics::of(values.iter().map(|value| value / 3.0)));
    }

    #[test]
    fn ten_million_equal_numbers_have_an_exact_mean_and_zero_deviation() {
        let mut samples = Samples::keeping(16);
        (0..10_000_000).for_each(|_| samples.push(16.683_333_333));
        let Statistics { n, mean, sd, min, max } = samples.statistics();
        assert_eq!((n, mean, sd, min, max), (10_000_000, 16.683_333_333, 0.0, 16.683_333_333, 16.683_333_333));
        assert_eq!(samples.len(), 16, "no more are kept");
    }

    proptest! {
        #[test]
        fn beyond_the_limit_statistics_differ_only_in_the_last_digits(
            values in proptest::collection::vec(0.0f64..200.0, 3..400), limit in 0usize..300,
        ) {
            let mut samples = Samples::keeping(limit);
            samples.extend(values.iter().copied());
            let all = Statistics::of(values.iter().copied());
            let found = samples.statistics();
            prop_assert_eq!((found.n, found.min, found.max), (all.n, all.min, all.max));
            prop_assert!((found.mean - all.mean).abs() < 1e-12 * all.mean.max(1.0), "{found:?} {all:?}");
            prop_assert!((found.sd - all.sd).abs() < 1e-10 * all.sd.max(1.0), "{found:?} {all:?}");
            prop_assert!(samples.len() <= limit);
        }
    }
}
