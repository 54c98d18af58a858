//! Percentiles of a stream of numbers in limited memory.

use crate::percentiles::Percentiles;
use pxpl5_run::Samples;
use std::collections::BTreeMap;

/// Number of leading fraction bits by which a number is assigned to a bin. A bin is an interval of numbers, whose width
/// is at most 1/1024 of the numbers in it.
const FRACTION_BITS: u32 = 10;
const DROPPED_BITS: u32 = f64::MANTISSA_DIGITS - 1 - FRACTION_BITS;

/// A distribution of non-negative numbers that computes percentiles in limited memory.
///
/// Up to `limit` numbers are kept, and percentiles are exact. Beyond `limit` the numbers are counted in bins, which are
/// intervals of numbers. A percentile is then the middle of a bin, with a relative error of at most 1/2048. Count, mean
/// and maximum are always exact.
#[derive(Clone, Debug, Default)]
pub(crate) struct Distribution {
    samples: Samples,
    limit: usize,
    /// Number of values in each bin, by the leading bits of the values. The map is empty until more than `limit` values
    /// were added.
    bins: BTreeMap<u64, u64>,
}

impl Distribution {
    pub(crate) const fn keeping(limit: usize) -> Self {
        Self { samples: Samples::keeping(limit), limit, bins: BTreeMap::new() }
    }

    pub(crate) fn push(&mut self, value: f64) {
        if self.samples.count() == self.limit as u64 {
            self.samples.iter().for_each(|kept| count(&mut self.bins, *kept));
        }
        if self.samples.count() >= self.limit as u64 {
            count(&mut self.bins, value);
        }
        self.samples.push(value);
    }

    pub(crate) fn kept(&self) -> &[f64] {
        &self.samples
    }

    pub(crate) fn percentiles(&self) -> Percentiles {
        let statistics = self.samples.statistics();
        if statistics.n <= self.limit as u64 {
            return Percentiles::of(self.samples.iter().copied());
        }
        // The percentile has the smallest rank that covers the requested share.
        let at = |percent: u64| self.ranked((statistics.n * percent).div_ceil(100).max(1));
        Percentiles {
            n: statistics.n,
            mean: statistics.mean,
            p50: at(50),
            p90: at(90),
            p95: at(95),
            p99: at(99),
            max: statistics.max,
        }
    }

    /// Returns the middle of the bin that holds the number with the rank `rank`. The smallest number has rank 1.
    fn ranked(&self, rank: u64) -> f64 {
        let mut counted = 0;
        let is_it = |(_, n): &(&u64, &u64)| {
            counted += **n;
            counted >= rank
        };
        self.bins.iter().find(is_it).map_or(f64::NAN, |(bin, _)| middle(*bin))
    }
}

fn count(bins: &mut BTreeMap<u64, u64>, value: f64) {
    *bins.entry(value.to_bits() >> DROPPED_BITS).or_default() += 1;
}

const fn middle(bin: u64) -> f64 {
    f64::from_bits(bin << DROPPED_BITS | 1 << (DROPPED_BITS - 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns `n` numbers from about 1 to 1,000,000 in pseudo-random order.
    fn numbers(n: u64) -> impl Iterator<Item = f64> + Clone {
        (0..n).map(move |i| {
            let place = i * 7_919 % n;
            (place as f64 * 0.37).exp2().min(1e6) + place as f64 * 1e-3
        })
    }

    #[test]
    fn percentiles_are_exact_up_to_the_limit_of_stored_numbers() {
        let mut all = Distribution::keeping(1_000);
        numbers(1_000).for_each(|value| all.push(value));
        assert_eq!(all.percentiles(), Percentiles::of(numbers(1_000)));
        assert_eq!(all.kept().len(), 1_000);
    }

    #[test]
    fn beyond_the_limit_percentiles_have_relative_errors_of_at_most_a_2048th() {
        for limit in [0, 1, 999] {
            let mut counted = Distribution::keeping(limit);
            numbers(1_000).for_each(|value| counted.push(value));
            let found = counted.percentiles();
            let expected = Percentiles::of(numbers(1_000));
            assert_eq!((found.n, found.max), (expected.n, expected.max));
            assert!((found.mean / expected.mean - 1.0).abs() < 1e-12, "{found:?} {expected:?}");
            for (found, expected) in [(found.p50, expected.p50), (found.p90, expected.p90), (found.p99, expected.p99)] {
                assert!((found / expected - 1.0).abs() <= 1.0 / 2_048.0, "{found} {expected}");
            }
            assert_eq!(counted.kept().len(), limit);
        }
    }

    /// Tests that the percentiles of a histogram are middles of bins. The bins are 1/1024 wide between 1 and 2, and
    /// 4/1024 wide between 4 and 8.
    #[test]
    fn the_percentile_of_a_histogram_is_the_middle_of_a_bin() {
        for (value, middle) in [(1.0, 1.0 + 1.0 / 2_048.0), (1.000_9, 1.0 + 1.0 / 2_048.0), (6.0, 6.0 + 4.0 / 2_048.0)]
        {
            let mut counted = Distribution::keeping(0);
            counted.push(value);
            assert_eq!(counted.percentiles().p50, middle, "{value}");
        }
    }

    #[test]
    fn an_empty_distribution_has_no_statistics() {
        assert_eq!(Distribution::keeping(0).percentiles().n, 0);
        assert!(Distribution::keeping(5).percentiles().mean.is_nan());
    }
}
