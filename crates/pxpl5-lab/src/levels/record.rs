//! A stored measurement of the speed and error of all levels of detail.

use pxpl5_run::{Level, Pixels};
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use serde::{Deserialize, Serialize};

/// Name and version of the record's JSON layout.
pub const SCHEMA: &str = "pxpl5-levels/2";

/// Measurement of all levels of detail, with date and host. Missing values are null.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelRecord {
    /// Name and version of the JSON layout.
    pub schema: String,
    /// Number of random experiments that give each [`LevelReport::from_cycle_percent`].
    pub experiments: u64,
    /// Remarks for the reader, such as missing values.
    pub note: Option<String>,
    /// Date of the measurement, such as 2026-11-25.
    pub date: Option<String>,
    /// Computer of the measurement.
    pub host: Option<String>,
    /// Reports of the levels of detail. A level that uses the timing table has two reports, one for each source of the
    /// table's times.
    pub levels: Vec<LevelReport>,
}

/// Errors and speeds of one level of detail.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelReport {
    /// Level of detail of this report.
    pub level: Level,
    /// True if the timing table has times that were measured by executing i860 code, instead of published or fitted
    /// times.
    pub times_of_code: bool,
    /// Mean absolute error in percent over the published figures without fitted parameters.
    pub published_error_percent: Option<f64>,
    /// Absolute deviations from the cycle level, in percent, over random experiments.
    pub from_cycle_percent: Option<Spread>,
    /// Speeds for each choice of computed pixels. The choice does not change simulated times.
    pub speeds: Vec<LevelSpeed>,
}

/// Speed of a level of detail for one choice of computed pixels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LevelSpeed {
    /// Choice of the pixels that are computed.
    pub pixels: Pixels,
    /// Simulated seconds per second of computing time. One thread simulates, and other threads, one for each core,
    /// compute the pixels.
    pub simulated_seconds_per_second: Option<f64>,
}

/// Median, and interval of the middle 90 %, of a set of values.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Median of the values.
    pub median: f64,
    /// 5th percentile of the values.
    pub low_5: f64,
    /// 95th percentile of the values.
    pub high_95: f64,
}

impl Spread {
    /// Computes the median and percentiles of values, with interpolation between neighbours. No value must be NaN. Returns
    /// `None` without values.
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
    /// Parses the text of a record.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] with the expected and the found content.
    pub fn read(text: &str) -> Result<Self, FileError> {
        let wrong =
            |place: &str, expected, found: String| FileError::new(FileErrorKind::Syntax, expected, found).at(place);
        let record: Self =
            serde_json::from_str(text).map_err(|error| wrong("", "a record of levels as JSON", error.to_string()))?;
        if record.schema == SCHEMA {
            return Ok(record);
        }
        Err(wrong("schema", SCHEMA, record.schema))
    }

    /// Returns the table of README.md in Markdown: errors of each level, and its speed without pixels.
    pub fn table(&self) -> String {
        let percent = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.2} %"));
        let row = |level: &LevelReport| {
            let spread = level.from_cycle_percent;
            let off = level.speeds.iter().find(|speed| speed.pixels == Pixels::Off);
            let speed = off.and_then(|speed| speed.simulated_seconds_per_second);
            format!(
                "| {} | {} | {} | {} | {} |\n",
                level.name(),
                percent(spread.map(|spread| spread.median)),
                percent(spread.map(|spread| spread.high_95)),
                percent(level.published_error_percent),
                speed.map_or_else(|| "-".to_owned(), |speed| format!("{speed:.1}"))
            )
        };
        let head = "| level | against the cycle level: median | 95 % point | against the papers | simulated seconds a second |";
        format!("{head}\n|---|---|---|---|---|\n{}", self.levels.iter().map(row).collect::<String>())
    }
}

impl LevelReport {
    /// Returns the name of this level of detail, for tables and charts.
    pub fn name(&self) -> String {
        let times = if self.times_of_code && self.level != Level::Cycle { ", times of code" } else { "" };
        format!("{}{times}", self.level.name())
    }

    /// Returns advice on the use of this level of detail.
    pub const fn advice(&self) -> &'static str {
        match (self.level, self.times_of_code) {
            (Level::Analytic, false) => {
                "for sweeps and first answers on Rendering Control and Slats; not for other pipelines, a tracked head, pixels or single frames"
            }
            (Level::Analytic, true) => {
                "for sweeps over machines with the project's i860 code; not for published figures, and not for pipelines without closed form"
            }
            (Level::Transaction, false) => {
                "the default: latencies, limits and pictures of the published machine; not for the cost of instructions or caches"
            }
            (Level::Transaction, true) => {
                "for long runs with mean times of the project's i860 code; not for scenes that differ from the application scenes, from which the means come"
            }
            (Level::Cycle, _) => {
                "for questions about code, caches and clocks; not for long runs, and not for figures that depend on the original code"
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_has_the_median_and_the_5th_and_95th_percentiles_of_its_values() {
        let spread = Spread::of((0..=20).rev().map(f64::from).collect()).expect("there are some");
        assert_eq!(spread, Spread { median: 10.0, low_5: 1.0, high_95: 19.0 });
        assert_eq!(Spread::of(vec![7.0, 8.0]).map(|spread| spread.median), Some(7.5));
        assert_eq!(Spread::of(Vec::new()), None);
    }

    #[test]
    fn a_record_is_read_as_written_including_missing_values() {
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
        let error = LevelRecord::read(&other).expect_err("another schema").to_string();
        assert_eq!(error, format!("schema: expected {SCHEMA}, found pxpl5-levels/1"));
    }
}
