//! The precision that a comparison requires, and an estimate of the number of seeds for this precision. The precision
//! is the greatest width of the confidence interval of a mean error.

use super::interval::{IntervalMethod, MeanInterval};
use pxpl5_sim::parameters::SettingError;
use std::fmt;
use std::str::FromStr;

/// Greatest width of the confidence interval of a mean error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Precision {
    /// Width divided by the mean error, above 0.
    Share(f64),
    /// Width in pixels, above 0.
    Pixels(f64),
}

/// Goal of a comparison that adds seeds to a row until the confidence interval of the row's mean error is narrow
/// enough.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UntilPrecise {
    /// Greatest width of the confidence interval of the mean error.
    pub width: Precision,
    /// Maximum number of seeds for each row of the comparison.
    pub max_seeds: usize,
}

/// Default maximum number of seeds of a row. Assumed: 10 times the default number of seeds.
pub const MAX_SEEDS: usize = 50;

impl UntilPrecise {
    /// Returns true if the interval exists and is narrow enough. An interval over the fields of one seed does not
    /// count, because it leaves out the differences between motions of the head.
    pub fn is_reached(&self, error: &MeanInterval) -> bool {
        let is_over_seeds = error.method != IntervalMethod::StudentTOfParts;
        is_over_seeds && error.width().is_some_and(|width| width <= self.greatest_width(error.mean))
    }

    /// Returns the number of seeds to add to a row. The number is 0 if the interval is narrow enough or `max_seeds` is
    /// reached.
    ///
    /// The width falls with the square root of the number of seeds. A step at most doubles the number of seeds, because
    /// the first widths are uncertain.
    pub fn seeds_to_add(&self, error: &MeanInterval, seeds: usize) -> usize {
        if self.is_reached(error) {
            return 0;
        }
        let ratio = error.width().unwrap_or(f64::INFINITY) / self.greatest_width(error.mean);
        let needed = (seeds as f64 * ratio * ratio).ceil();
        // NaN, or a number that is too large for an integer, counts as more than the doubled number of seeds.
        let needed = if needed <= 2.0 * seeds as f64 { needed as usize } else { 2 * seeds };
        needed.max(seeds + 1).min(self.max_seeds).saturating_sub(seeds)
    }

    fn greatest_width(&self, mean: f64) -> f64 {
        match self.width {
            Precision::Share(share) => share * mean,
            Precision::Pixels(px) => px,
        }
    }
}

impl fmt::Display for Precision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            // The percentage is rounded, because the number for 7 % is a little more than 0.07.
            Self::Share(share) => write!(f, "{}%", (share * 1e8).round() / 1e6),
            Self::Pixels(px) => write!(f, "{px}px"),
        }
    }
}

impl FromStr for Precision {
    type Err = SettingError;

    /// Parses a percentage of the mean (`10%`) or a width in pixels (`0.2px`).
    fn from_str(text: &str) -> Result<Self, SettingError> {
        let number = |digits: &str| digits.trim().parse().ok().filter(|n: &f64| n.is_finite() && *n > 0.0);
        let share = text.strip_suffix('%').and_then(number).map(|percent| Self::Share(percent / 100.0));
        let pixels = || text.strip_suffix("px").and_then(number).map(Self::Pixels);
        share.or_else(pixels).ok_or_else(|| {
            let expected = "a width above 0 of the interval, as a share of the mean (10%) or in pixels (0.2px)";
            SettingError::value("", expected, format_args!("`{text}`"))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TENTH: UntilPrecise = UntilPrecise { width: Precision::Share(0.1), max_seeds: 50 };

    fn error(half: f64) -> MeanInterval {
        let of_two = MeanInterval::of_signed(&[9.0, 11.0], 0.95);
        MeanInterval { mean: 10.0, low: 10.0 - half, high: 10.0 + half, ..of_two }
    }

    #[test]
    fn the_precision_of_a_result_limits_the_whole_width_of_its_interval() {
        assert!(TENTH.is_reached(&error(0.5)) && !TENTH.is_reached(&error(0.51)));
        let pixels = UntilPrecise { width: Precision::Pixels(0.2), max_seeds: 50 };
        assert!(pixels.is_reached(&error(0.0999)) && !pixels.is_reached(&error(0.11)));
        assert!(!TENTH.is_reached(&MeanInterval::of(&[5.0], 0.95)), "one seed has no interval");
        let over_time = MeanInterval { method: IntervalMethod::StudentTOfParts, ..error(0.1) };
        assert!(
            !TENTH.is_reached(&over_time) && TENTH.seeds_to_add(&over_time, 1) > 0,
            "one motion tells nothing of others"
        );
    }

    /// Tests the number of further seeds. If an interval from 5 seeds is 1.2 times too wide, 1.44 times as many seeds
    /// are needed: 7.2, rounded up to 8.
    #[test]
    fn the_number_of_seeds_grows_with_the_square_of_the_width_and_at_most_doubles() {
        assert_eq!(TENTH.seeds_to_add(&error(0.6), 5), 3);
        assert_eq!(TENTH.seeds_to_add(&error(60.0), 5), 5);
        assert_eq!(TENTH.seeds_to_add(&error(60.0), 40), 10);
        assert_eq!(TENTH.seeds_to_add(&error(60.0), 50), 0);
        assert_eq!(TENTH.seeds_to_add(&error(0.1), 5), 0);
    }

    #[test]
    fn a_precision_without_a_unit_is_an_error_that_shows_both_units() {
        assert_eq!(
            ["5%", "0.2px"].map(|text| text.parse().ok()),
            [Some(Precision::Share(0.05)), Some(Precision::Pixels(0.2))]
        );
        assert_eq!(
            ["7%", "29%", "0.5%"].map(|text| text.parse::<Precision>().expect(text).to_string()),
            ["7%", "29%", "0.5%"]
        );
        for text in ["5", "0%", "-1px", "NaN%", "", "infpx"] {
            let error = text.parse::<Precision>().expect_err(text).to_string();
            assert!(error.contains("10%") && error.contains("0.2px") && error.contains(text), "{error}");
        }
    }
}
