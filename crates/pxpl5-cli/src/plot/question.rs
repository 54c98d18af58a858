//! The columns to plot, and the groups of rows, each of which becomes one point of the plot.

use crate::error::CliError;
use crate::numbers::confidence;
use crate::rows::{ResultRows, Row, RowsKind, value};
use pxpl5::compare::{CONFIDENCE, MeanInterval};
use pxpl5::{Measure, Statistics};
use pxpl5_sim::parameters::nearest;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// The columns to plot.
#[derive(clap::Args, Clone, Debug)]
pub(super) struct Question {
    /// Column for the x axis, with numbers or names.
    #[arg(long, value_name = "COLUMN")]
    pub(super) x: String,
    /// Column for the y axis, with numbers.
    #[arg(long, value_name = "COLUMN")]
    pub(super) y: String,
    /// Draw a separate curve for each value, or combination of values, of these columns.
    #[arg(long, value_name = "COLUMN,...", value_delimiter = ',')]
    pub(super) by: Vec<String>,
    /// Average over these columns, and draw the interval of the mean as a band.
    #[arg(long, value_name = "COLUMN,...", value_delimiter = ',', default_value = "seed")]
    pub(super) band: Vec<String>,
    /// Use only rows with this value in this column; may be repeated.
    #[arg(long = "where", value_name = "COLUMN=VALUE", value_parser = pair)]
    pub(super) only: Vec<(String, String)>,
    /// Confidence of the intervals, between 0 and 1. Rows of a comparison keep the confidence of that comparison.
    #[arg(long, value_name = "SHARE", default_value_t = CONFIDENCE, value_parser = confidence)]
    pub(super) confidence: f64,
}

fn pair(text: &str) -> Result<(String, String), String> {
    let (name, value) = text.split_once('=').ok_or(format!("expected COLUMN=VALUE, found {text}"))?;
    Ok((name.to_owned(), value.to_owned()))
}

#[derive(Clone, Debug)]
pub(super) struct Group {
    /// Values of the columns in `Question::by`, as text.
    pub(super) by: Vec<String>,
    pub(super) x: Value,
    pub(super) n: usize,
    /// Number of rows without a number in the y column, because the run failed or no pixel was evaluated.
    pub(super) missing: usize,
    /// Mean of the numbers in the y column. NaN if `n` is 0.
    pub(super) mean: f64,
    /// Standard deviation of the numbers in the y column. NaN if `n` is below 2 or the rows contain no standard
    /// deviation.
    pub(super) sd: f64,
    /// Confidence interval of the mean. NaN if `sd` is NaN.
    pub(super) interval: (f64, f64),
    pub(super) counts: Counts,
}

/// Sums of counts over all rows of a group. A sum is `None` if no row contains the count.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Counts {
    /// Number of due pictures, each of which had to be shown at a certain retrace.
    pub(super) pictures_due: Option<u64>,
    pub(super) missed_retraces: Option<u64>,
    pub(super) samples: Option<u64>,
}

impl Counts {
    fn of(kind: RowsKind, rows: &[&Row]) -> Self {
        let evaluated = if kind == RowsKind::Sweep { Measure::EVALUATED } else { "error.n" };
        let names = [Measure::PICTURES_DUE, Measure::MISSED_RETRACES, evaluated];
        let [pictures_due, missed_retraces, samples] = names.map(|name| {
            let mut values = rows.iter().filter_map(|row| value(row, name)?.as_f64()).peekable();
            values.peek().is_some().then(|| values.sum::<f64>() as u64)
        });
        Self { pictures_due, missed_retraces, samples }
    }

    pub(super) fn has_missing_pictures(&self) -> bool {
        self.missed_retraces.is_some_and(|missed| missed > 0)
    }
}

impl Question {
    /// Returns the groups of rows in the order of their first rows. Fails if no row has a named column, or if a setting
    /// that is not named varies within a group.
    pub(super) fn groups(&self, results: &ResultRows) -> Result<Vec<Group>, CliError> {
        self.check_names(results)?;
        let counted: Vec<&Row> = results.rows.iter().filter(|row| self.counts(row)).collect();
        if counted.is_empty() {
            return Err(CliError::usage("no row matches --where"));
        }
        let mut places: BTreeMap<(Vec<String>, String), usize> = BTreeMap::new();
        let mut found: Vec<(Vec<String>, Value, Vec<&Row>)> = Vec::new();
        // Rows with the same curve and the same x value share a group.
        for row in counted {
            let by: Vec<String> = self.by.iter().map(|name| value(row, name).map_or_else(String::new, text)).collect();
            let x = value(row, &self.x).cloned().unwrap_or(Value::Null);
            let place = *places.entry((by.clone(), text(&x))).or_insert(found.len());
            if place == found.len() {
                found.push((by, x, Vec::new()));
            }
            found[place].2.push(row);
        }
        found.into_iter().map(|(by, x, rows)| self.group(results, by, x, &rows)).collect()
    }

    fn counts(&self, row: &Row) -> bool {
        self.only.iter().all(|(name, wanted)| value(row, name).is_some_and(|found| text(found) == *wanted))
    }

    fn check_names(&self, results: &ResultRows) -> Result<(), CliError> {
        let columns: BTreeSet<&str> = results.rows.iter().flatten().map(|(key, _)| key.as_str()).collect();
        let only = self.only.iter().map(|(name, _)| name);
        for name in [&self.x, &self.y].into_iter().chain(&self.by).chain(only) {
            // A misspelled column gets the most similar name as advice.
            if !columns.contains(name.as_str()) {
                let near = nearest(name, columns.iter().copied()).unwrap_or("nothing");
                let all = columns.iter().copied().collect::<Vec<_>>().join(", ");
                return Err(CliError::usage(format!("no row has `{name}`; did you mean `{near}`? There are: {all}")));
            }
        }
        Ok(())
    }

    fn group(&self, results: &ResultRows, by: Vec<String>, x: Value, rows: &[&Row]) -> Result<Group, CliError> {
        let numbers: Vec<f64> = rows.iter().filter_map(|row| value(row, &self.y).and_then(Value::as_f64)).collect();
        let missing = rows.len() - numbers.len();
        // A row of a comparison already is a mean over seeds.
        if results.kind == RowsKind::Comparison {
            return Ok(self.of_row(by, x, rows, missing));
        }
        self.check_others(results, rows)?;
        let of_all = MeanInterval::of(&numbers, self.confidence);
        let sd = if numbers.len() < 2 { f64::NAN } else { Statistics::of(numbers.iter().copied()).sd };
        let interval = (of_all.low, of_all.high);
        let counts = Counts::of(results.kind, rows);
        Ok(Group { by, x, n: numbers.len(), missing, mean: of_all.mean, sd, interval, counts })
    }

    /// Returns the group for one row of a comparison. This row already holds a mean over seeds and an interval.
    fn of_row(&self, by: Vec<String>, x: Value, rows: &[&Row], missing: usize) -> Group {
        let row = rows[0];
        let number = |name: &str| value(row, name).and_then(Value::as_f64);
        let mean = number(&self.y).unwrap_or(f64::NAN);
        let beside = |name: &str| self.y.strip_suffix(".mean").and_then(|path| number(&format!("{path}.{name}")));
        let interval = (beside("low").unwrap_or(f64::NAN), beside("high").unwrap_or(f64::NAN));
        let n = beside("n").map_or(usize::from(missing == 0), |n| n as usize);
        let counts = Counts::of(RowsKind::Comparison, rows);
        Group { by, x, n, missing, mean, sd: beside("sd").unwrap_or(f64::NAN), interval, counts }
    }

    /// Returns an error if a setting varies within a group and `--band` does not name this setting.
    fn check_others(&self, results: &ResultRows, rows: &[&Row]) -> Result<(), CliError> {
        let axes = results.about.get("axes").and_then(Value::as_array).into_iter().flatten();
        let paths = axes.filter_map(|axis| axis["paths"].as_array()).flatten().filter_map(Value::as_str);
        let named = |path: &str| path == self.x || self.by.iter().chain(&self.band).any(|name| name == path);
        for path in paths.filter(|path| !named(path)) {
            let values: BTreeSet<String> = rows.iter().filter_map(|row| value(row, path)).map(text).collect();
            if values.len() > 1 {
                let values = values.into_iter().collect::<Vec<_>>().join(", ");
                return Err(CliError::usage(format!(
                    "{path} varies too ({values}): draw a curve for each with --by {path}, choose one with --where {path}=VALUE, or \
                     take the mean over it with --band {path}"
                )));
            }
        }
        Ok(())
    }
}

pub(super) fn text(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        other => other.to_string(),
    }
}
