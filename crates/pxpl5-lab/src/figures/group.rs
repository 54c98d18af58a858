//! Groups of published figures by topic: peak rates, just-in-time pixels, trackers. Each figure is measured by
//! simulation with events, whichever level of modelling is chosen. The mean error of the main table does not include
//! the figures of groups.

use super::measured::{FigureValue, Result};
use super::{Basis, Bench, Figure, FigureError, FigureRow};
use crate::intervals::{photodiode_line, variations};
use crate::parallel;
use serde::Serialize;
use std::fmt::Write as _;

/// Published figures of one topic, with the model's values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureGroup {
    /// Name of the topic.
    pub title: &'static str,
    /// Conditions of the experiments that all rows of the group share, and conditions that the papers do not state.
    pub about: &'static str,
    /// Rows in the order of the group's table.
    pub rows: Vec<FigureRow>,
}

/// A published figure, with the experiment that measures it.
pub(super) struct Measurement {
    pub(super) figure: Figure,
    pub(super) measure: fn(&Bench) -> Result<FigureValue>,
    /// Paths of the parameters that are varied for the figure's interval. One parameter at a time takes both ends of
    /// its range.
    pub(super) moved_by: &'static [&'static str],
}

/// A topic, with the experiments of its figures.
pub(super) struct Topic {
    pub(super) title: &'static str,
    pub(super) about: &'static str,
    pub(super) measurements: Vec<Measurement>,
}

/// Creates a figure of a group to which no parameter was fitted.
pub(super) const fn free(
    (id, paper, section): (&'static str, &'static str, &'static str),
    statement: &'static str,
    (value, unit, spread): (f64, &'static str, Option<f64>),
    experiment: &'static str,
    cause: &'static str,
) -> Figure {
    Figure { id, paper, section, statement, value, unit, spread, experiment, basis: Basis::Free, cause }
}

impl FigureGroup {
    pub(super) fn of(topic: &Topic, bench: &Bench) -> std::result::Result<Self, FigureError> {
        let rows = parallel::map(&topic.measurements, |measurement| measurement.row(bench));
        let rows = rows.into_iter().collect::<std::result::Result<Vec<_>, _>>()?;
        Ok(Self { title: topic.title, about: topic.about, rows })
    }

    /// Returns the group's section of ACCURACY.md.
    #[must_use]
    pub fn markdown(&self) -> String {
        let missed: Vec<&FigureRow> = self.rows.iter().filter(|row| row.misses()).collect();
        let mut text = format!(
            "\n## {}\n\n{}\n\nThe model misses {} of {} rows of this table.\n\n\
             | # | figure | published | simulated | error | interval | |\n|---|---|---|---|---|---|---|\n",
            self.title,
            self.about,
            missed.len(),
            self.rows.len(),
        );
        self.rows.iter().for_each(|row| text.push_str(&line(row)));
        // Each miss is followed by its known cause.
        for row in missed {
            let _ = writeln!(text, "\n- Row **{}** is a miss. {}", row.id, row.cause);
        }
        // The experiments come last, for readers who want to repeat them.
        let _ = writeln!(text, "\n| # | experiment | other results |\n|---|---|---|");
        for row in &self.rows {
            let also: Vec<_> =
                row.details.iter().map(|d| format!("{} {} {}", d.name, digits(d.value), d.unit)).collect();
            let _ = writeln!(text, "| {} | {} | {} |", row.id, row.experiment, also.join(", "));
        }
        text
    }
}

fn line(row: &FigureRow) -> String {
    let interval = row
        .interval
        .map_or_else(|| "not varied".to_owned(), |[low, high]| format!("{} to {}", digits(low), digits(high)));
    let spread = row.spread.map_or_else(String::new, |spread| format!(" +- {}", digits(spread)));
    let mark = if row.misses() { "**miss**" } else { "met" };
    format!(
        "| {} | {} ({}) | {}{spread} {} | {} {} | {:+.1} % | {interval} | {mark} |\n",
        row.id,
        row.statement,
        row.source,
        digits(row.published),
        row.unit,
        digits(row.simulated),
        row.unit,
        row.error_percent
    )
}

/// Formats a number with four significant digits and without trailing zeros.
fn digits(value: f64) -> String {
    let after = if value == 0.0 { 0 } else { (3 - value.abs().log10().floor() as i32).max(0) as usize };
    let text = format!("{value:.after$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
}

impl Measurement {
    fn row(&self, bench: &Bench) -> std::result::Result<FigureRow, FigureError> {
        let id = self.figure.id;
        let measured = (self.measure)(bench);
        let measured = measured.map_err(|error| FigureError { id: id.to_owned(), reason: error.to_string() })?;
        let interval = self.interval(bench, measured.value);
        Ok(FigureRow { interval, ..FigureRow::new(&self.figure, measured) })
    }

    /// Returns the minimum and maximum of the figure over both ends of each parameter's range, including the value for
    /// the presets. If the experiment yields no value for an end of a range, the figure for the presets counts.
    fn interval(&self, bench: &Bench, nominal: f64) -> Option<[f64; 2]> {
        let all = variations().into_iter().chain(photodiode_line());
        let moved = all.filter(|variation| self.moved_by.contains(&variation.path.as_str()));
        // Each parameter is set to the low and to the high end of its range.
        let ends: Vec<_> = moved.flat_map(|v| [(v.path.clone(), v.range.0), (v.path, v.range.1)]).collect();
        let values = parallel::map(&ends, |end| {
            let changes = bench.changes.iter().cloned().chain([end.clone()]).collect();
            (self.measure)(&Bench { changes, ..bench.clone() }).map_or(nominal, |measured| measured.value)
        });
        let bounds = values.into_iter().fold([nominal; 2], |[low, high], value: f64| [low.min(value), high.max(value)]);
        (!ends.is_empty()).then_some(bounds)
    }
}
