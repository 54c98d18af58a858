//! The table at the top of the page, with a row for each experiment.

use super::run::PageRun;
use super::values::{cell, decimal, number, number_cell, plain, row, table, text_or_dash};
use crate::markup::Element;
use serde_json::Value;

const NAMES: [&str; 8] = [
    "experiment",
    "primitives",
    "latency, fields",
    "latency, ms",
    "pictures",
    "updates, Hz",
    "not shown in time",
    "published",
];

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
        number_cell(text_or_dash(&report["latency_ms"]["n"])),
        number_cell(decimal(&report["updates_hz"], 2)),
        number_cell(not_shown(report)),
        cell(published(&run.published)),
    ])
}

fn not_shown(report: &Value) -> String {
    match report["missed_retraces"].as_u64() {
        Some(missed) => format!("{missed} of {}", text_or_dash(&report["due"]["due"])),
        None => "-".to_owned(),
    }
}

/// Returns mean and standard deviation as text. For a single picture, the result has only the mean.
fn spread(statistics: &Value) -> String {
    match statistics["sd"].as_f64() {
        Some(sd) => format!("{} ± {sd:.3}", decimal(&statistics["mean"], 3)),
        None => decimal(&statistics["mean"], 3),
    }
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
