//! What was measured of the levels, as a file that is kept.

use pxpl5_run::{Level, Pixels};
use serde::{Deserialize, Serialize};

/// Name and version of the record's layout.
pub const SCHEMA: &str = "pxpl5-levels/2";

/// All levels, and when and where they were measured. What was not measured is null.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelRecord {
    /// Name and version of the layout.
    pub schema: String,
    /// Random experiments behind each [`LevelReport::from_cycle_percent`].
    pub experiments: u64,
    /// What a reader must know of the numbers, such as what is missing.
    pub note: Option<String>,
    /// The day, as 2026-11-25.
    pub date: Option<String>,
    /// The machine that measured.
    pub host: Option<String>,
    /// Each level with each table of times.
    pub levels: Vec<LevelReport>,
}

/// A level's errors and speeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelReport {
    /// The level that was timed and evaluated.
    pub level: Level,
    /// Whether the times of primitives in the table are those of the code, instead of published or fitted ones.
    pub times_of_code: bool,
    /// Mean absolute error of the figures that are free checks, percent.
    pub published_error_percent: Option<f64>,
    /// Absolute deviations of random experiments from the cycle level, percent.
    pub from_cycle_percent: Option<Spread>,
    /// Speeds for each choice of pixels, which changes no time.
    pub speeds: Vec<LevelSpeed>,
}

/// How fast a level is.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelSpeed {
    /// Pixels that are computed.
    pub pixels: Pixels,
    /// Simulated seconds for each second of one thread of the host, with as many threads for pixels as it has.
    pub simulated_seconds_per_second: Option<f64>,
}

/// Median, and the band that nine of ten values lie in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Half of the values are less.
    pub median: f64,
    /// One of 20 values is less.
    pub low_5: f64,
    /// One of 20 values is more.
    pub high_95: f64,
}

impl Spread {
    /// Computes the spread of some values, of which none is not a number; `None` of no value. Between two values it interpolates.
    #[must_use]
    pub fn of(mut values: Vec<f64>) -> Option<Self> {
        values.sort_by(f64::total_cmp);
        let last = values.len().checked_sub(1)?;
        let at = |part: f64| {
            let place = part * last as f64;
            let (below, rest) = (place.floor() as usize, place.fract());
            values[below] + rest * (values[last.min(below + 1)] - values[below])
        };
        Some(Self { median: at(0.5), low_5: at(0.05), high_95: at(0.95) })
    }
}

impl LevelRecord {
    /// Reads a record.
    ///
    /// # Errors
    ///
    /// What is wrong with the text.
    pub fn read(text: &str) -> Result<Self, String> {
        let record: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if record.schema == SCHEMA {
            return Ok(record);
        }
        Err(format!("schema: expected {SCHEMA}, found {}", record.schema))
    }
}

impl LevelReport {
    /// Its name in tables and charts.
    #[must_use]
    pub fn name(&self) -> String {
        let times = if self.times_of_code && self.level != Level::Cycle { ", times of code" } else { "" };
        format!("{}{times}", self.level.name())
    }

    /// What it is for, and where it must not be used.
    #[must_use]
    pub const fn advice(&self) -> &'static str {
        match (self.level, self.times_of_code) {
            (Level::Analytic, false) => {
                "for sweeps and first answers on Rendering Control and Slats; not for other pipelines, a tracked head, pixels or single frames"
            }
            (Level::Analytic, true) => {
                "for sweeps over machines that run our code; not for what was published of theirs, nor where no closed form exists"
            }
            (Level::Transaction, false) => {
                "the default: latencies, limits and pictures of the published machine; not for what an instruction or a cache costs"
            }
            (Level::Transaction, true) => {
                "for long runs of our code, which it knows as means; not for scenes unlike the application scenes that the means come from"
            }
            (Level::Cycle, _) => {
                "for questions about code, caches and clocks; not for long runs, nor for figures that the original code decided"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_has_the_middle_and_the_ends_of_its_values() {
        let spread = Spread::of((0..=20).rev().map(f64::from).collect()).expect("there are some");
        assert_eq!(spread, Spread { median: 10.0, low_5: 1.0, high_95: 19.0 });
        assert_eq!(Spread::of(vec![7.0, 8.0]).map(|spread| spread.median), Some(7.5));
        assert_eq!(Spread::of(Vec::new()), None);
    }

    #[test]
    fn a_record_is_read_as_it_was_written_with_what_is_missing() {
        let report = LevelReport {
            level: Level::Cycle,
            times_of_code: true,
            published_error_percent: Some(3.25),
            from_cycle_percent: None,
            speeds: vec![LevelSpeed { pixels: Pixels::Lazy, simulated_seconds_per_second: None }],
        };
        let record = LevelRecord {
            schema: SCHEMA.to_owned(),
            experiments: 200,
            note: None,
            date: Some("2026-11-25".to_owned()),
            host: None,
            levels: vec![report],
        };
        let text = serde_json::to_string(&record).expect("it is data");
        assert!(text.contains("\"simulated_seconds_per_second\":null"));
        assert_eq!(LevelRecord::read(&text), Ok(record));
        let other = text.replace(SCHEMA, "pxpl5-levels/1");
        assert_eq!(LevelRecord::read(&other), Err(format!("schema: expected {SCHEMA}, found pxpl5-levels/1")));
    }
}
