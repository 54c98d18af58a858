//! The table at the head of the page: a row for each experiment.

use super::run::PageRun;
use super::values::{cell, number, number_cell, plain, row, table};
use crate::markup::Element;
use serde_json::Value;

const NAMES: [&str; 7] =
    ["experiment", "primitives", "latency, fields", "latency, ms", "updates, Hz", "missed retraces", "published"];

pub(super) fn summary(runs: &[PageRun]) -> Element {
    table(&NAMES, runs.iter().map(summary_row))
}

fn summary_row(run: &PageRun) -> Element {
    let report = &run.report;
    row([
        cell(&run.name),
        number_cell(number(&report["triangles"]) + number(&report["spheres"])),
        number_cell(spread(&report["latency_fields"])),
        number_cell(spread(&report["latency_ms"])),
        number_cell(rate(&report["updates_hz"])),
        number_cell(number(&report["missed_retraces"])),
        cell(published(&run.published)),
    ])
}

/// Of fewer than two pictures there is no rate.
fn rate(updates_hz: &Value) -> String {
    updates_hz.as_f64().map_or_else(|| "-".to_owned(), |hz| format!("{hz:.2}"))
}

/// Mean and standard deviation.
fn spread(statistics: &Value) -> String {
    if statistics["mean"].is_null() {
        return "-".to_owned();
    }
    format!("{:.3} ± {:.3}", number(&statistics["mean"]), number(&statistics["sd"]))
}

fn published(published: &Value) -> String {
    if published.is_null() {
        return String::new();
    }
    let quantity = plain(&published["quantity"]);
    let value = plain(&published["published"]);
    let error = number(&published["error_percent"]);
    format!("{quantity} {value} ({error:+.1} %), {}", plain(&published["source"]))
}
