//! Groups of published figures by topic: peak rates, just-in-time pixels, trackers. Each figure is measured by
//! simulation with events, even at the analytic level. The mean error of the main table does not include these figures.

use super::measured::{FigureValue, Result};
use super::{Basis, Bench, Figure, FigureRow};
use crate::error::StudyError;
use crate::intervals::{photodiode_line, variations};
use crate::parallel;
use pxpl5_sim::figures::column::{DETAILS, ERROR, EXPERIMENT, INTERVAL, NUMBER, PUBLISHED, SIMULATED, STATEMENT};
use pxpl5_sim::figures::{TableColumn, table};
use serde::Serialize;
use std::fmt::Write as _;

/// Published figures of one topic, with the model's values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FigureGroup {
    /// Name of the topic.
    pub title: &'static str,
    /// Conditions that all experiments of the group share, including conditions that the papers do not state.
    pub about: &'static str,
    /// Table rows of the figures.
    pub rows: Vec<FigureRow>,
}

/// A published figure, with the experiment that measures it.
pub(super) struct Measurement {
    pub(super) figure: Figure,
    pub(super) measure: fn(&Bench) -> Result<FigureValue>,
    /// Paths of the parameters that determine the figure's interval. One parameter at a time is set to each end of its
    /// range.
    pub(super) moved_by: &'static [&'static str],
}

pub(super) struct Topic {
    pub(super) title: &'static str,
    pub(super) about: &'static str,
    pub(super) measurements: Vec<Measurement>,
}

/// Creates a figure to which no parameter was fitted.
pub(super) const fn free(
    (id, paper, section): (&'static str, &'static str, &'static str),
    statement: &'static str,
    (value, unit, spread): (f64, &'static str, Option<f64>),
    experiment: &'static str,
    cause: &'static str,
) -> Figure {
    Figure { id, paper, section, statement, value, unit, spread, experiment, basis: Basis::Free, cause }
}

const MARK: TableColumn<FigureRow> = ("", |row| if row.is_met { "met" } else { "**miss**" }.to_owned());

const COLUMNS: [TableColumn<FigureRow>; 7] = [NUMBER, STATEMENT, PUBLISHED, SIMULATED, ERROR, INTERVAL, MARK];

impl FigureGroup {
    pub(super) fn of(topic: &Topic, bench: &Bench) -> std::result::Result<Self, StudyError> {
        let rows = parallel::map(&topic.measurements, |measurement| measurement.row(bench));
        let rows = rows.into_iter().collect::<std::result::Result<Vec<_>, _>>()?;
        Ok(Self { title: topic.title, about: topic.about, rows })
    }

    /// Returns this group's section of ACCURACY.md.
    pub fn markdown(&self) -> String {
        let missed: Vec<&FigureRow> = self.rows.iter().filter(|row| !row.is_met).collect();
        let mut text = format!(
            "\n## {}\n\n{}\n\nThe model misses {} of {} rows of the following table.\n\n{}",
            self.title,
            self.about,
            missed.len(),
            self.rows.len(),
            table(&COLUMNS, &self.rows),
        );
        // Each miss is followed by its known cause.
        for row in missed {
            let _ = writeln!(text, "\n- Row **{}** is a miss. {}", row.id, row.cause_or_unknown());
        }
        // The experiments come last, for readers who want to repeat them.
        text + "\n" + &table(&[NUMBER, EXPERIMENT, DETAILS], &self.rows)
    }
}

impl Measurement {
    fn measured(&self, bench: &Bench) -> Result<FigureValue> {
        bench.stop.check()?;
        (self.measure)(bench)
    }

    pub(super) fn row(&self, bench: &Bench) -> std::result::Result<FigureRow, StudyError> {
        let measured = self.measured(bench).map_err(StudyError::of_figure(self.figure.id))?;
        let interval = self.interval(bench, measured.value);
        Ok(FigureRow { interval, ..self.figure.row(measured) })
    }

    /// Returns the minimum and maximum of the figure if one parameter at a time is set to each end of its range. The
    /// value `nominal` for the presets is included, and also replaces the result of a failed experiment. Returns `None`
    /// if no parameter varies, or if `bench` leaves out intervals.
    fn interval(&self, bench: &Bench, nominal: f64) -> Option<[f64; 2]> {
        if !bench.intervals {
            return None;
        }
        let all = variations().into_iter().chain(photodiode_line());
        let moved = all.filter(|variation| self.moved_by.contains(&variation.path.as_str()));
        // Each parameter is set to the low and to the high end of its range.
        let ends: Vec<_> = moved.flat_map(|v| [(v.path.clone(), v.range.0), (v.path, v.range.1)]).collect();
        let values = parallel::map(&ends, |end| {
            let changes = bench.changes.iter().cloned().chain([end.clone()]).collect();
            let moved = Bench { changes, ..bench.clone() };
            // The end of a range can be the value that all machines have.
            if bench.has_machines_of(&moved) {
                return nominal;
            }
            self.measured(&moved).map_or(nominal, |measured| measured.value)
        });
        let bounds = values.into_iter().fold([nominal; 2], |[low, high], value: f64| [low.min(value), high.max(value)]);
        (!ends.is_empty()).then_some(bounds)
    }
}
