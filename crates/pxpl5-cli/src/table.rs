//! A text table of runs, with one column for each run and one row for each quantity.

use crate::numbers::{count_of, dash};
use crate::terminal::laid_out;
use pxpl5::{DuePictures, Percentiles, Report, Statistics};
use serde::Serialize;

/// A simulated value beside the published one.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Comparison {
    /// Name of the quantity, with its unit.
    pub(crate) quantity: String,
    pub(crate) published: f64,
    pub(crate) simulated: f64,
    pub(crate) error_percent: f64,
    pub(crate) source: String,
}

type TableRow = (&'static str, fn(&Report) -> String);

const ROWS: [TableRow; 14] = [
    ("pipeline", |r| r.pipeline.clone()),
    ("machine", boards),
    ("scene", |r| r.scene.clone()),
    ("primitives", primitives),
    ("fields simulated", |r| r.fields.to_string()),
    ("latency, fields: mean", |r| mean_and_sd(&r.latency_fields.statistics, 2)),
    ("  min to max", |r| range(&r.latency_fields.statistics, 2)),
    ("latency, ms: mean", |r| mean_and_sd(&r.latency_ms.statistics, 1)),
    ("  min to max", |r| range(&r.latency_ms.statistics, 1)),
    ("  50, 95, 99 %", |r| percentiles(&r.percentiles_ms.latency, 1)),
    ("updates per second", |r| r.updates_hz.map_or_else(dash, |hz| format!("{hz:.2}"))),
    ("not shown in time", not_shown),
    ("  late, incompl., missed", ends),
    ("all over periods", window),
];

pub(crate) fn table(runs: &[(&Report, Option<&Comparison>)]) -> String {
    let rows = ROWS.iter().map(|(name, cell)| (*name, runs.iter().map(|(report, _)| cell(report)).collect()));
    let mut rows: Vec<(&str, Vec<String>)> = rows.collect();
    // Rows about published values appear only if a run has one.
    if runs.iter().any(|(_, comparison)| comparison.is_some()) {
        rows.extend(comparison_rows(runs));
    }
    let lines = rows.into_iter().map(|(name, cells)| [vec![name.to_owned()], cells].concat());
    laid_out(&lines.collect::<Vec<_>>(), usize::MAX)
}

fn comparison_rows(runs: &[(&Report, Option<&Comparison>)]) -> [(&'static str, Vec<String>); 4] {
    [
        ("published", comparison_cells(runs, |c| format!("{} {}", c.published, c.quantity))),
        ("  where", comparison_cells(runs, |c| c.source.clone())),
        ("  simulated", comparison_cells(runs, |c| format!("{:.4}", c.simulated))),
        ("  error", comparison_cells(runs, |c| format!("{:+.1} %", c.error_percent))),
    ]
}

/// Returns one cell for each run. The cell is empty if the run has no published value.
fn comparison_cells(runs: &[(&Report, Option<&Comparison>)], cell: impl Fn(&Comparison) -> String) -> Vec<String> {
    runs.iter().map(|(_, comparison)| comparison.map_or_else(String::new, &cell)).collect()
}

/// Returns the number of due pictures that were not shown, and the number of due pictures.
fn not_shown(report: &Report) -> String {
    of_due(report, |due| format!("{} of {} due", due.not_shown(), count_of(due.due, "picture")))
}

fn ends(report: &Report) -> String {
    of_due(report, |due| format!("{}, {}, {}", due.late, due.incomplete, due.missed))
}

fn window(report: &Report) -> String {
    report.window.map_or_else(dash, |window| format!("{} to {}", window.first_period, window.last_period))
}

/// Formats the cell about due pictures. A picture is due at the retrace at which the pipeline must show the picture.
/// The cell is "-" if the pipeline's pictures have no deadlines.
fn of_due(report: &Report, cell: impl Fn(&DuePictures) -> String) -> String {
    report.due.as_ref().map_or_else(dash, cell)
}

fn primitives(report: &Report) -> String {
    match (report.triangles, report.spheres) {
        (triangles, 0) => count_of(triangles, "triangle"),
        (0, spheres) => count_of(spheres, "sphere"),
        (triangles, spheres) => format!("{}, {}", count_of(triangles, "triangle"), count_of(spheres, "sphere")),
    }
}

/// Formats mean, standard deviation and number of values. The mean of no values is "-", and so is the standard
/// deviation of one value.
fn mean_and_sd(s: &Statistics, digits: usize) -> String {
    if s.mean.is_nan() {
        return "-".to_owned();
    }
    let sd = if s.sd.is_nan() { "-".to_owned() } else { format!("{:.digits$}", s.sd) };
    format!("{:.digits$}, sd {sd}, n {}", s.mean, s.n)
}

fn range(s: &Statistics, digits: usize) -> String {
    if s.mean.is_nan() {
        return "-".to_owned();
    }
    format!("{:.digits$} to {:.digits$}", s.min, s.max)
}

/// Formats median, 95 % and 99 % of a set of numbers.
pub(crate) fn percentiles(of: &Percentiles, digits: usize) -> String {
    if of.n == 0 {
        return "-".to_owned();
    }
    format!("{:.digits$}, {:.digits$}, {:.digits$}", of.p50, of.p95, of.p99)
}

fn boards(report: &Report) -> String {
    format!("{} ({}, {})", report.machine, count_of(report.n_gps, "GP"), count_of(report.n_renderers, "renderer"))
}
