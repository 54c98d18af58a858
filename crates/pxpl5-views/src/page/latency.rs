//! Latency: how it is spread, where it goes, and from the head on.

use super::values::{cell, heading, list, number, number_cell, paragraph, plain, row, table};
use crate::charts::{MeanPart, colour_of_part, histogram_element, part_bar_element};
use crate::markup::Element;
use serde_json::Value;

pub(super) fn latency(report: &Value, latencies_ms: &[f64]) -> Vec<Element> {
    let definition = plain(&report["latency_ms"]["definition"]);
    let mut all = vec![heading("Latency"), paragraph(format_args!("{definition}."))];
    if !latencies_ms.is_empty() {
        all.push(histogram_element(latencies_ms));
    }
    let parts = list(&report["latency_parts_ms"]);
    if parts.is_empty() {
        return all;
    }
    let means: Vec<MeanPart> = parts.iter().map(mean_part).collect();
    all.push(heading("Where it goes"));
    all.push(paragraph("Mean over all pictures; the frame holds what the papers count."));
    all.extend(part_bar_element(&means));
    all.push(table(&["part", "mean, ms", "sd", "definition"], parts.iter().map(part_row)));
    all
}

fn mean_part(part: &Value) -> MeanPart {
    MeanPart {
        name: plain(&part["name"]),
        mean_ms: number(&part["mean"]),
        published: part["in_published_latency"] == true,
    }
}

fn part_row(part: &Value) -> Element {
    let name = plain(&part["name"]);
    row([
        Element::new("td").child(&swatch(&name)).text(name.replace('_', " ")),
        number_cell(format_args!("{:.3}", number(&part["mean"]))),
        number_cell(format_args!("{:.3}", number(&part["sd"]))),
        cell(plain(&part["definition"])),
    ])
}

/// A square in the colour of a part.
fn swatch(name: &str) -> Element {
    let colour = format!("background:{}", colour_of_part(name));
    Element::new("span").with("class", "swatch").with("style", colour).text("")
}

const STAGES: [&str; 7] = ["tracking", "waiting", "sending", "drawing", "showing", "scanning", "total"];
const ERRORS: [&str; 2] = ["pixels", "degrees"];
const PERCENTILES: [&str; 5] = ["mean", "p50", "p90", "p99", "max"];

/// From the head to light, of a run with a tracker.
pub(super) fn head_to_light(head: &Value) -> Vec<Element> {
    if head.is_null() {
        return Vec::new();
    }
    let [tracker, predictor, display] = ["tracker", "predictor", "display"].map(|key| plain(&head[key]));
    // Reports of older versions do not say it.
    let aim = head["aim"].as_str().map_or_else(String::new, |aim| format!(", aim {aim}"));
    let stages = STAGES.iter().map(|stage| stage_row(stage, &head["end_to_end"]));
    let errors = ERRORS.iter().map(|unit| error_row(unit, &head["error"][*unit]));
    vec![
        heading("From the head to light"),
        paragraph(format_args!("{tracker}, prediction {predictor}{aim}, display {display}.")),
        table(&["stage", "mean, ms"], stages),
        table(&["error", "mean", "50 %", "90 %", "99 %", "greatest"], errors),
    ]
}

fn stage_row(stage: &str, end_to_end: &Value) -> Element {
    let ms = number(&end_to_end[format!("{stage}_ms")]);
    row([cell(stage), number_cell(format_args!("{ms:.3}"))])
}

fn error_row(unit: &str, error: &Value) -> Element {
    let values = PERCENTILES.iter().map(|key| number_cell(format_args!("{:.3}", number(&error[*key]))));
    row([cell(unit)].into_iter().chain(values))
}
