//! Mean and percentiles of a set of numbers.

use pxpl5_run::number_or_nan;
use serde::{Deserialize, Serialize};

/// Count, mean, percentiles and maximum of a set of numbers.
///
/// For an empty set, all numbers except the count are NaN (null in JSON).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Percentiles {
    /// Number of numbers in the set.
    pub n: u64,
    /// Arithmetic mean of the numbers.
    #[serde(deserialize_with = "number_or_nan")]
    pub mean: f64,
    /// Median: the smallest value that is at least as large as half of the values.
    #[serde(deserialize_with = "number_or_nan")]
    pub p50: f64,
    /// 90th percentile: the smallest value that is at least as large as 90 % of the values.
    #[serde(deserialize_with = "number_or_nan")]
    pub p90: f64,
    /// 95th percentile: the smallest value that is at least as large as 95 % of the values.
    #[serde(deserialize_with = "number_or_nan")]
    pub p95: f64,
    /// 99th percentile: the smallest value that is at least as large as 99 % of the values.
    #[serde(deserialize_with = "number_or_nan")]
    pub p99: f64,
    /// Largest number of the set.
    #[serde(deserialize_with = "number_or_nan")]
    pub max: f64,
}

impl Default for Percentiles {
    fn default() -> Self {
        let none = f64::NAN;
        Self { n: 0, mean: none, p50: none, p90: none, p95: none, p99: none, max: none }
    }
}

impl Percentiles {
    /// Computes the statistics of `values`. No value must be NaN.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let Some(max) = values.last().copied() else { return Self::default() };
        let at = |percent: usize| values[(values.len() * percent).div_ceil(100).max(1) - 1];
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        Self { n: values.len() as u64, mean, p50: at(50), p90: at(90), p95: at(95), p99: at(99), max }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_of_the_numbers_1_to_100_are_exact() {
        let p = Percentiles::of((1..=100).rev().map(f64::from));
        assert_eq!((p.n, p.mean, p.p50, p.p90, p.p95, p.p99, p.max), (100, 50.5, 50.0, 90.0, 95.0, 99.0, 100.0));
    }

    #[test]
    fn an_empty_list_has_no_percentile() {
        let Percentiles { n, mean, p50, p90, p95, p99, max } = Percentiles::of(std::iter::empty());
        assert_eq!(n, 0);
        assert!([mean, p50, p90, p95, p99, max].iter().all(|number| number.is_nan()));
    }
}
