//! A table of runs: a column each, a row per quantity.

use pxpl5::{DuePictures, Report, Statistics};

/// What a run is compared with.
#[derive(Clone, Debug)]
pub(crate) struct Comparison {
    /// The quantity.
    pub(crate) quantity: String,
    /// As published.
    pub(crate) published: f64,
    /// As simulated.
    pub(crate) simulated: f64,
    /// The paper, or which figure.
    pub(crate) source: String,
}

impl Comparison {
    pub(crate) fn error_percent(&self) -> f64 {
        (self.simulated / self.published - 1.0) * 100.0
    }
}

/// The table as text.
pub(crate) fn table(runs: &[(&Report, Option<&Comparison>)]) -> String {
    let mut rows: Vec<(&str, Vec<String>)> = Vec::new();
    let mut row = |name, cell: &dyn Fn(&Report) -> String| {
        rows.push((name, runs.iter().map(|(report, _)| cell(report)).collect()));
    };
    row("pipeline", &|r| r.pipeline.clone());
    row("machine", &|r| boards(r));
    row("scene", &|r| r.scene.clone());
    row("primitives", &|r| primitives(r));
    row("fields simulated", &|r| r.fields.to_string());
    row("latency, fields: mean", &|r| mean_and_sd(&r.latency_fields.statistics, 2));
    row("  min to max", &|r| range(&r.latency_fields.statistics, 2));
    row("latency, ms: mean", &|r| mean_and_sd(&r.latency_ms.statistics, 1));
    row("  min to max", &|r| range(&r.latency_ms.statistics, 1));
    row("updates per second", &|r| r.updates_hz.map_or_else(|| "-".to_owned(), |hz| format!("{hz:.2}")));
    row("not shown in time", &not_shown);
    row("  late, incompl., missed", &ends);
    row("  counted in periods", &window);
    if runs.iter().any(|(_, comparison)| comparison.is_some()) {
        rows.extend(comparison_rows(runs));
    }
    laid_out(&rows)
}

fn comparison_rows(runs: &[(&Report, Option<&Comparison>)]) -> [(&'static str, Vec<String>); 3] {
    let cells = |cell: &dyn Fn(&Comparison) -> String| {
        runs.iter().map(|(_, comparison)| comparison.map_or_else(String::new, cell)).collect()
    };
    [
        ("published", cells(&|c| format!("{} {}", c.published, c.quantity))),
        ("  where", cells(&|c| c.source.clone())),
        ("  error", cells(&|c| format!("{:+.1} %", c.error_percent()))),
    ]
}

/// Pictures that were due and not shown, and of how many.
fn not_shown(report: &Report) -> String {
    of_due(report, |due| format!("{} of {} pictures due", due.not_shown(), due.due))
}

fn ends(report: &Report) -> String {
    of_due(report, |due| format!("{}, {}, {}", due.late, due.incomplete, due.missed))
}

fn window(report: &Report) -> String {
    of_due(report, |due| format!("{} to {}", due.first_period, due.last_period))
}

/// Where no picture is ever due, nothing.
fn of_due(report: &Report, cell: impl Fn(&DuePictures) -> String) -> String {
    report.due.as_ref().map_or_else(|| "-".to_owned(), cell)
}

fn primitives(report: &Report) -> String {
    match (report.triangles, report.spheres) {
        (triangles, 0) => format!("{triangles} triangles"),
        (0, spheres) => format!("{spheres} spheres"),
        (triangles, spheres) => format!("{triangles} triangles, {spheres} spheres"),
    }
}

/// Of nothing there are no statistics, and of one picture there is no deviation.
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

fn laid_out(rows: &[(&str, Vec<String>)]) -> String {
    let columns = rows.iter().map(|(_, cells)| cells.len()).max().unwrap_or(0);
    let width = |column: usize| rows.iter().filter_map(|(_, cells)| cells.get(column)).map(String::len).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let line = |(name, cells): &(&str, Vec<String>)| {
        let padded = cells.iter().zip(&widths).map(|(cell, width)| format!("  {cell:<width$}"));
        let line = format!("{name:<25}{}", padded.collect::<String>());
        format!("{}\n", line.trim_end())
    };
    rows.iter().map(line).collect()
}

fn boards(report: &Report) -> String {
    let plural = |n: usize, name: &str| format!("{n} {name}{}", if n == 1 { "" } else { "s" });
    format!("{} ({}, {})", report.machine, plural(report.n_gps, "GP"), plural(report.n_renderers, "renderer"))
}
