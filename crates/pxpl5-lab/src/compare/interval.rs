//! A mean with its confidence interval.

use distrs::StudentsT;
use pxpl5_run::{Statistics, number_or_nan};
use serde::{Deserialize, Serialize};

/// Method by which an interval of a mean was computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum IntervalMethod {
    /// No interval, because the runs are too few or too short.
    None,
    /// Interval of Student's t distribution, computed from one mean for each seed.
    StudentT,
    /// Interval of Student's t distribution, computed from one mean for each seed, for the logarithm of the mean (delta
    /// method).
    StudentTOfLogarithm,
    /// Interval of Student's t distribution over the means of successive parts of one motion of the head.
    StudentTOfParts,
}

impl IntervalMethod {
    /// All methods.
    pub const ALL: [Self; 4] = [Self::StudentTOfLogarithm, Self::StudentT, Self::StudentTOfParts, Self::None];

    /// Returns the name of the method in words, for tables.
    pub const fn words(self) -> &'static str {
        match self {
            Self::None => "no interval",
            Self::StudentT => "Student's t over the seeds",
            Self::StudentTOfLogarithm => "Student's t over the seeds, of the logarithm",
            Self::StudentTOfParts => "Student's t over ten parts of the motion",
        }
    }
}

/// A mean over seeds with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MeanInterval {
    /// Mean over the means of all seeds. NaN if there are no seeds.
    #[serde(deserialize_with = "number_or_nan")]
    pub mean: f64,
    /// Lower end of the confidence interval. NaN without an interval.
    #[serde(deserialize_with = "number_or_nan")]
    pub low: f64,
    /// Upper end of the confidence interval. NaN without an interval.
    #[serde(deserialize_with = "number_or_nan")]
    pub high: f64,
    /// Number of seeds.
    pub n: usize,
    /// Method of the interval.
    pub method: IntervalMethod,
}

/// Number of parts into which one motion is divided for an interval (assumed, 8 to 30). With fewer parts Student's t is
/// wide, and the means of more parts depend on each other.
const PARTS: usize = 10;

/// Minimum number of display fields for an interval over parts of a motion (assumed): parts of a sixth of a second.
const MIN_FIELDS: usize = 100;

/// Default confidence of an interval, as a probability.
pub const CONFIDENCE: f64 = 0.95;

impl MeanInterval {
    /// Computes the mean and its interval from one number for each seed, at a confidence between 0 and 1. The quantity
    /// must not be negative.
    ///
    /// The interval is computed for the logarithm of the mean (delta method), so that the lower end stays positive. The
    /// interval reaches from `mean / f` to `mean * f` with `f = exp(t sd / (sqrt(n) mean))`. If a number is 0, the
    /// result is the symmetric interval of [`MeanInterval::of_signed`], cut at 0. If a number is negative, the
    /// symmetric interval is not cut.
    pub fn of(values: &[f64], confidence: f64) -> Self {
        let symmetric = Self::of_signed(values, confidence);
        let least = values.iter().copied().fold(f64::INFINITY, f64::min);
        if symmetric.method == IntervalMethod::None || least < 0.0 {
            return symmetric;
        }
        if least == 0.0 {
            return Self { low: symmetric.low.max(0.0), ..symmetric };
        }
        let factor = ((symmetric.high - symmetric.mean) / symmetric.mean).exp();
        let method = IntervalMethod::StudentTOfLogarithm;
        Self { low: symmetric.mean / factor, high: symmetric.mean * factor, method, ..symmetric }
    }

    /// Computes the mean and its symmetric interval from one number for each seed. The numbers can be negative.
    pub fn of_signed(values: &[f64], confidence: f64) -> Self {
        let statistics = Statistics::of(values.iter().copied());
        let n = values.len();
        let (half, method) = if n < 2 {
            (f64::NAN, IntervalMethod::None)
        } else {
            (quantile_of_t(n - 1, confidence) * statistics.sd / (n as f64).sqrt(), IntervalMethod::StudentT)
        };
        Self { mean: statistics.mean, low: statistics.mean - half, high: statistics.mean + half, n, method }
    }

    /// Computes the mean and its interval from one number for each seed, if all seeds share one motion. `series` has the
    /// mean number of each display field, in the order of time. `is_noisy` is true if the runs have random errors.
    ///
    /// The interval is the wider one of two. The interval over the seeds shows the random errors, such as the noise of the
    /// tracker. The interval over [`PARTS`] parts of the motion shows how the motion varies. One run with random errors has
    /// no interval, because its parts share errors that last: a bias, or the errors of a slow filter.
    pub(super) fn of_one_motion(values: &[f64], series: &[f64], is_noisy: bool, confidence: f64) -> Self {
        let over_seeds = Self::of_either_sign(values, confidence);
        // Equal seeds have no random errors to show.
        let over_seeds = if over_seeds.width() == Some(0.0) { over_seeds.without_interval() } else { over_seeds };
        if values.len() < 2 && is_noisy || series.len() < MIN_FIELDS {
            return over_seeds;
        }
        // Successive fields depend on each other, so only means of long parts count as numbers of their own.
        let parts = series.chunks_exact(series.len() / PARTS).take(PARTS);
        let means: Vec<f64> = parts.map(|part| part.iter().sum::<f64>() / part.len() as f64).collect();
        let Self { mean, low, high, .. } = Self::of_either_sign(&means, confidence);
        if over_seeds.width().is_some_and(|width| width > high - low) {
            return over_seeds;
        }
        let shift = over_seeds.mean - mean;
        Self { low: low + shift, high: high + shift, method: IntervalMethod::StudentTOfParts, ..over_seeds }
    }

    /// Computes the interval of [`Self::of`] for numbers that are not negative, and of [`Self::of_signed`] for others.
    fn of_either_sign(values: &[f64], confidence: f64) -> Self {
        if values.iter().all(|value| *value >= 0.0) {
            Self::of(values, confidence)
        } else {
            Self::of_signed(values, confidence)
        }
    }

    /// Returns true if the interval contains 0, or if there is no interval.
    pub fn may_be_zero(&self) -> bool {
        !(self.low > 0.0 || self.high < 0.0)
    }

    /// Returns the width of the interval, or `None` without an interval.
    pub fn width(&self) -> Option<f64> {
        Some(self.high - self.low).filter(|width| width.is_finite())
    }

    pub(super) const fn without_interval(self) -> Self {
        Self { low: f64::NAN, high: f64::NAN, method: IntervalMethod::None, ..self }
    }
}

/// Returns the quantile of Student's t distribution with `freedom` degrees of freedom, for a two-sided interval.
fn quantile_of_t(freedom: usize, confidence: f64) -> f64 {
    StudentsT::ppf(0.5 + confidence / 2.0, freedom as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_interval_of_five_means_follows_the_t_table() {
        // Mean 3, sample sd sqrt(2.5); t with 4 degrees of freedom is 2.776 (any table).
        let interval = MeanInterval::of_signed(&[1.0, 2.0, 3.0, 4.0, 5.0], CONFIDENCE);
        let half = 2.776_445 * 2.5f64.sqrt() / 5f64.sqrt();
        assert_eq!((interval.mean, interval.n), (3.0, 5));
        assert!((interval.high - 3.0 - half).abs() < 1e-5 && (3.0 - interval.low - half).abs() < 1e-5, "{interval:?}");
    }

    #[test]
    fn the_interval_of_a_positive_quantity_stays_positive() {
        // Mean 10, sample sd sqrt(100 + 100 + 0) / sqrt(2) = 10; t with 2 degrees of freedom is 4.303: the symmetric
        // interval is 10 - 24.8 to 10 + 24.8.
        let values = [0.1, 10.0, 19.9];
        let factor = (4.302_653 * 9.9 / 3f64.sqrt() / 10.0f64).exp();
        let interval = MeanInterval::of(&values, CONFIDENCE);
        assert!(
            (interval.low - 10.0 / factor).abs() < 1e-4 && (interval.high - 10.0 * factor).abs() < 1e-3,
            "{interval:?}"
        );
        assert!(MeanInterval::of_signed(&values, CONFIDENCE).low < 0.0);
    }

    #[test]
    fn a_higher_confidence_gives_a_wider_interval() {
        // t with 4 degrees of freedom: 2.776 at 95 %, 4.604 at 99 % (any table).
        let values = [1.0, 2.0, 3.0, 4.0, 5.0];
        let [usual, wide] = [0.95, 0.99].map(|confidence| MeanInterval::of_signed(&values, confidence));
        let ratio = (wide.high - wide.mean) / (usual.high - usual.mean);
        assert!((ratio - 4.604_095 / 2.776_445).abs() < 1e-4, "{ratio}");
    }

    #[test]
    fn one_seed_has_a_mean_and_no_interval() {
        let interval = MeanInterval::of(&[7.0], CONFIDENCE);
        assert!(interval.mean == 7.0 && interval.low.is_nan() && interval.high.is_nan());
        assert!(MeanInterval::of(&[], CONFIDENCE).mean.is_nan());
    }

    #[test]
    fn an_interval_of_a_quantity_with_a_zero_has_no_negative_end() {
        let interval = MeanInterval::of(&[0.0, 10.0, 0.1], CONFIDENCE);
        assert!(interval.low == 0.0 && interval.high > 10.0, "{interval:?}");
    }

    /// Returns a random number of a normal distribution with mean 0 and variance 1 (sum of twelve uniform numbers).
    fn normal(seed: u64, n: u64) -> f64 {
        let uniform = |k: u64| (pxpl5_sim::mix(pxpl5_sim::mix(seed) ^ (16 * n + k)) >> 11) as f64 / (1u64 << 53) as f64;
        (0..12).map(uniform).sum::<f64>() - 6.0
    }

    /// Simulates comparisons of one motion whose errors are 20 px and noise. The noise of a run depends on itself over
    /// 1/(1 - phi) fields: 1, 5 and 50 fields, as behind no filter, a usual filter and a filter tuned on a steady turn. Of
    /// the intervals of 95 %, at least 93 % must contain 20 px (three standard errors below 95 %).
    #[test]
    fn intervals_of_one_motion_with_noise_contain_the_true_mean_as_often_as_they_say() {
        const ROWS: u64 = 600;
        const SEEDS: u64 = 5;
        for (phi, fields) in [(0.0, 150), (0.8, 150), (0.98, 150), (0.0, 750), (0.8, 750), (0.98, 750)] {
            let covers = |row: u64| {
                let run = |seed: u64| {
                    let seed = row * SEEDS + seed;
                    let mut x = normal(seed, 0);
                    let next = move |n: u64| {
                        x = phi * x + (1.0f64 - phi * phi).sqrt() * normal(seed, n);
                        20.0 + x
                    };
                    (1..=fields).map(next).collect::<Vec<f64>>()
                };
                let runs: Vec<Vec<f64>> = (0..SEEDS).map(run).collect();
                let means: Vec<f64> = runs.iter().map(|run| run.iter().sum::<f64>() / run.len() as f64).collect();
                let field = |n: usize| runs.iter().map(|run| run[n]).sum::<f64>() / SEEDS as f64;
                let series: Vec<f64> = (0..fields as usize).map(field).collect();
                let interval = MeanInterval::of_one_motion(&means, &series, true, CONFIDENCE);
                (interval.low..=interval.high).contains(&20.0)
            };
            let share = (0..ROWS).filter(|row| covers(*row)).count() as f64 / ROWS as f64;
            assert!(share >= 0.93, "phi {phi}, {fields} fields: {share}");
        }
    }

    #[test]
    fn one_run_with_noise_has_no_interval_and_one_without_has_that_of_its_parts() {
        let series: Vec<f64> = (0..400).map(|n| 10.0 + normal(1, n)).collect();
        let [noisy, exact] =
            [true, false].map(|is_noisy| MeanInterval::of_one_motion(&[10.0], &series, is_noisy, CONFIDENCE));
        assert_eq!((noisy.method, exact.method), (IntervalMethod::None, IntervalMethod::StudentTOfParts));
        assert!(noisy.may_be_zero() && !exact.may_be_zero());
    }
}
