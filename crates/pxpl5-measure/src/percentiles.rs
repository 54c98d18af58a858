//! Mean and percentiles.

use serde::Serialize;

/// Mean and percentiles of some numbers, all zero for none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Percentiles {
    /// Mean.
    pub mean: f64,
    /// Median.
    pub p50: f64,
    /// 90 of 100 are at most this.
    pub p90: f64,
    /// 99 of 100 are at most this.
    pub p99: f64,
    /// Greatest.
    pub max: f64,
}

impl Percentiles {
    /// Of some numbers, none of them NaN. A percentile is the smallest number that so many do not exceed.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let mut values: Vec<f64> = values.collect();
        values.sort_by(f64::total_cmp);
        let Some(max) = values.last().copied() else { return Self::default() };
        let at = |percent: usize| values[(values.len() * percent).div_ceil(100).max(1) - 1];
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        Self { mean, p50: at(50), p90: at(90), p99: at(99), max }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_of_one_to_a_hundred() {
        let p = Percentiles::of((1..=100).rev().map(f64::from));
        assert_eq!((p.mean, p.p50, p.p90, p.p99, p.max), (50.5, 50.0, 90.0, 99.0, 100.0));
        assert_eq!(Percentiles::of(std::iter::empty()), Percentiles::default());
    }
}
