use serde::ser::SerializeStruct;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// Statistics of a list of numbers: count, mean, sample standard deviation, minimum and maximum.
///
/// For an empty list, all values except the count are NaN. For a single number, the deviation is NaN. JSON shows NaN as
/// null.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
pub struct Statistics {
    pub n: u64,
    #[serde(deserialize_with = "number_or_nan")]
    pub mean: f64,
    /// Sample standard deviation, with n - 1 as divisor. NaN for fewer than two numbers.
    #[serde(deserialize_with = "number_or_nan")]
    pub sd: f64,
    #[serde(deserialize_with = "number_or_nan")]
    pub min: f64,
    #[serde(deserialize_with = "number_or_nan")]
    pub max: f64,
}

/// Deserializes a number that JSON shows as null if it is NaN. The function is for the attribute `deserialize_with` of
/// serde.
///
/// # Errors
///
/// Fails if the value is neither a number nor null.
pub fn number_or_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// Slightly more than one picosecond, in milliseconds. Times are whole picoseconds. Two numbers that are rounded from
/// equal times therefore differ by less than this value.
const PICOSECOND_MS: f64 = 1.001e-9;

/// Serializes the rounded form that [`Statistics::rounded`] returns.
impl Serialize for Statistics {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Self { n, mean, sd, min, max } = self.rounded();
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
    /// Returns the statistics in the form for reports and tables, without effects of rounding.
    ///
    /// If the numbers differ by at most a picosecond, the deviation becomes 0. The mean is limited to the range from
    /// the minimum to the maximum.
    #[must_use]
    pub fn rounded(self) -> Self {
        if self.n == 0 {
            return self;
        }
        let is_constant = self.max - self.min <= PICOSECOND_MS;
        let sd = if is_constant && !self.sd.is_nan() { 0.0 } else { self.sd };
        // `clamp` would panic if a bound were NaN.
        Self { sd, mean: self.mean.max(self.min).min(self.max), ..self }
    }

    /// Computes the statistics of numbers in any order. The numbers must not be NaN.
    pub fn of(values: impl Iterator<Item = f64>) -> Self {
        let values: Vec<f64> = values.collect();
        if values.is_empty() {
            return Self { n: 0, mean: f64::NAN, sd: f64::NAN, min: f64::NAN, max: f64::NAN };
        }
        let n = values.len() as f64;
        let mean = values.iter().sum::<f64>() / n;
        // Two passes over the values avoid the loss of precision of a sum of squares.
        let squares = values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>();
        Self {
            n: values.len() as u64,
            mean,
            sd: if values.len() > 1 { (squares / (n - 1.0)).sqrt() } else { f64::NAN },
            min: values.iter().copied().fold(f64::INFINITY, f64::min),
            max: values.iter().copied().fold(f64::NEG_INFINITY, f64::max),
        }
    }

    /// Adds a sentence that defines the numbers of these statistics.
    pub fn defined(self, definition: &str) -> DefinedStatistics {
        DefinedStatistics { statistics: self, definition: definition.to_owned() }
    }
}

/// Statistics together with the definition of their numbers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DefinedStatistics {
    #[serde(flatten)]
    pub statistics: Statistics,
    pub definition: String,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_a_known_sample_are_exact() {
        let s = Statistics::of([2.0, 4.0, 4.0, 4.0, 5.0, 5.0, 7.0, 9.0].into_iter());
        assert_eq!((s.n, s.mean, s.min, s.max), (8, 5.0, 2.0, 9.0));
        assert!((s.sd - (32.0f64 / 7.0).sqrt()).abs() < 1e-12);
    }

    #[test]
    fn an_empty_sample_has_no_statistics() {
        let Statistics { n, mean, sd, min, max } = Statistics::of(std::iter::empty());
        assert_eq!(n, 0);
        assert!([mean, sd, min, max].iter().all(|number| number.is_nan()));
    }

    /// Tests equal numbers, whose deviation must be exactly 0. With rounding errors, three times 0.1 would have the
    /// deviation 1.7e-17.
    #[test]
    fn a_constant_is_printed_without_deviation() {
        for values in [[0.1; 3], [30.949_033_339, 30.949_033_340, 30.949_033_340]] {
            let all = Statistics::of(values.into_iter());
            let rounded = all.rounded();
            assert_eq!((rounded.sd, rounded.n, rounded.min, rounded.max), (0.0, 3, all.min, all.max));
            assert!(rounded.min <= rounded.mean && rounded.mean <= rounded.max, "{rounded:?}");
        }
        let varies = Statistics::of([1.0, 1.000_001].into_iter());
        assert_eq!(varies.rounded(), varies);
        assert!(Statistics::of(std::iter::once(1.0)).rounded().sd.is_nan());
    }

    #[test]
    fn one_number_has_no_deviation() {
        let one = Statistics::of(std::iter::once(3.0));
        assert_eq!((one.n, one.mean, one.min, one.max), (1, 3.0, 3.0, 3.0));
        assert!(one.sd.is_nan());
    }
}
