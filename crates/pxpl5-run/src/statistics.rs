//! Mean and spread of some numbers.

use serde::ser::SerializeStruct;
use serde::{Serialize, Serializer};

/// How many numbers there are, their mean, sample standard deviation, least and greatest. Of none there is none of these, and
/// of one no deviation (NaN; null in JSON).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistics {
    /// How many numbers there are.
    pub n: u64,
    /// Sum of the numbers over how many there are.
    pub mean: f64,
    /// Sample standard deviation (n - 1), of two numbers or more.
    pub sd: f64,
    /// The smallest of the numbers.
    pub min: f64,
    /// The largest of the numbers.
    pub max: f64,
}

/// A picosecond in milliseconds, and a little more: what times that are the same differ by, since they are whole picoseconds.
const PICOSECOND_MS: f64 = 1.001e-9;

/// As it is told: see [`Statistics::told`].
impl Serialize for Statistics {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { n, mean, sd, min, max } = self.told();
        let mut fields = serializer.serialize_struct("Statistics", 5)?;
        fields.serialize_field("n", &n)?;
        fields.serialize_field("mean", &mean)?;
        fields.serialize_field("sd", &sd)?;
        fields.serialize_field("min", &min)?;
        fields.serialize_field("max", &max)?;
        fields.end()
    }
}

impl Statistics {
    /// The same as reports and tables tell it: of numbers that differ by no more than a picosecond the deviation is 0, and a mean lies
    /// between the least and the greatest, whatever the last digits of a sum are.
    #[must_use]
    pub fn told(self) -> Self {
        if self.n == 0 {
            return self;
        }
        let is_constant = self.max - self.min <= PICOSECOND_MS;
        let sd = if is_constant && !self.sd.is_nan() { 0.0 } else { self.sd };
        // Not `clamp`, which panics where a number is none.
        Self { sd, mean: self.mean.max(self.min).min(self.max), ..self }
    }

    /// Of some numbers, in any order, none of them NaN.
    #[must_use]
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.collect();
        if values.is_empty() {
            return Self { n: 0, mean: f64::NAN, sd: f64::NAN, min: f64::NAN, max: f64::NAN };
        }
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        let squares = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
        Self {
            n: values.len() as u64,
            mean,
            sd: if values.len() > 1 { (squares / (n - 1.0)).sqrt() } else { f64::NAN },
            min: values.iter().copied().fold(f64::INFINITY, f64::min),
            max: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// With what they are statistics of.
    #[must_use]
    pub fn defined(self, definition: &str) -> DefinedStatistics {
        DefinedStatistics { statistics: self, definition: definition.to_owned() }
    }
}

/// Statistics with their definition beside them.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DefinedStatistics {
    /// Mean, deviation, least and greatest of what is defined beside.
    #[serde(flatten)]
    pub statistics: Statistics,
    /// What they are of, in a sentence.
    pub definition: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_a_known_sample() {
        let s = Statistics::of([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter());
        assert_eq!((s.n, s.mean, s.min, s.max), (8, 5.0, 2.0, 9.0));
        assert!((s.sd - (32.0f64 / 7.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn of_nothing_there_is_no_number() {
        let Statistics { n, mean, sd, min, max } = Statistics::of(std::iter::empty());
        assert_eq!(n, 0);
        assert!([mean, sd, min, max].iter().all(|number| number.is_nan()));
    }

    /// 0.1 three times has a mean of 0.10000000000000002 and a deviation of 1.7e-17 by the formula.
    #[test]
    fn what_does_not_vary_is_told_without_deviation() {
        for values in [[0.1; 3], [30.949_033_339, 30.949_033_340, 30.949_033_340]] {
            let all = Statistics::of(values.into_iter());
            let told = all.told();
            assert_eq!((told.sd, told.n, told.min, told.max), (0.0, 3, all.min, all.max));
            assert!(told.min <= told.mean && told.mean <= told.max, "{told:?}");
        }
        let varies = Statistics::of([1.0, 1.000_001].into_iter());
        assert_eq!(varies.told(), varies);
        assert!(Statistics::of(std::iter::once(1.0)).told().sd.is_nan());
    }

    #[test]
    fn one_number_has_no_deviation() {
        let one = Statistics::of(std::iter::once(3.0));
        assert_eq!((one.n, one.mean, one.min, one.max), (1, 3.0, 3.0, 3.0));
        assert!(one.sd.is_nan());
    }
}
