//! Page section about latency: distribution, parts, and the time from the head's pose until the picture is lit.

use super::values::{cell, decimal, heading, list, number, number_cell, paragraph, plain, row, table, text_or_dash};
use crate::charts::{MeanPart, histogram_element, part_bar_element};
use crate::markup::Element;
use crate::palette::tints_of;
use serde_json::Value;

pub(super) fn latency(report: &Value, latencies_ms: &[f64]) -> Vec<Element> {
    let definition = plain(&report["latency_ms"]["definition"]);
    let mut all = vec![heading("Latency"), paragraph(format_args!("{definition}."))];
    all.extend(of_how_many(&report["latency_ms"]["n"]));
    if !latencies_ms.is_empty() {
        all.push(histogram_element(latencies_ms));
    }
    let parts = list(&report["latency_parts_ms"]);
    // A report without parts gets the histogram only.
    if parts.is_empty() {
        return all;
    }
    let means: Vec<MeanPart> = parts.iter().map(mean_part).collect();
    all.push(heading("Parts of the latency"));
    all.push(paragraph("Mean over all complete pictures. The frame marks the parts that the papers count."));
    all.extend(part_bar_element(&means));
    all.push(table(&["part", "mean, ms", "sd", "n", "definition"], parts.iter().map(part_row)));
    all
}

fn of_how_many(n: &Value) -> Option<Element> {
    match n.as_u64()? {
        0 => Some(paragraph("No complete picture was shown after the warm-up, so there is no latency.")),
        n => Some(paragraph(format_args!("Of {n} complete pictures after the warm-up."))),
    }
}

/// Returns a table with the numbers of due pictures: shown, late, incomplete and so on. If the scene was too heavy for
/// the pipeline, the result also has a prominent warning.
pub(super) fn due(report: &Value) -> Vec<Element> {
    let heavy = report["too_heavy"]["advice"].as_str().map(|advice| {
        let [missed, due] = ["missed_retraces", "pictures_due"].map(|key| text_or_dash(&report["too_heavy"][key]));
        let text = format!("Too heavy: {missed} of {due} pictures due were not shown in time; {advice}.");
        Element::new("p").with("class", "loud").text(text)
    });
    let mut all: Vec<Element> = heavy.into_iter().collect();
    if let Some(definition) = report["due_definition"].as_str() {
        all.push(heading("Pictures due"));
        all.push(paragraph(format_args!("{definition}.")));
    }
    // Pipelines without due pictures have no table.
    if report["due"].is_object() {
        let cells = DUE.map(|key| number_cell(text_or_dash(&report["due"][key])));
        all.push(table(&DUE.map(|key| key.replace('_', " ")).each_ref().map(String::as_str), [row(cells)]));
    }
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
        number_cell(decimal(&part["mean"], 3)),
        number_cell(decimal(&part["sd"], 3)),
        number_cell(text_or_dash(&part["n"])),
        cell(plain(&part["definition"])),
    ])
}

fn swatch(name: &str) -> Element {
    let colour = format!("background:{}", tints_of(name).fill);
    Element::new("span").with("class", "swatch").with("style", colour).text("")
}

const DUE: [&str; 7] = ["first_period", "last_period", "due", "shown", "late", "incomplete", "missed"];

const STAGES: [&str; 8] =
    ["tracking", "waiting", "sending", "drawing", "showing", "scanning", "lighting", "head_to_light"];
const ERRORS: [&str; 2] = ["pixels", "degrees"];
const PERCENTILES: [&str; 5] = ["mean", "p50", "p90", "p99", "max"];

pub(super) fn head_to_light(head: &Value) -> Vec<Element> {
    if head.is_null() {
        return Vec::new();
    }
    let [tracker, predictor, display] = ["tracker", "predictor", "display"].map(|key| plain(&head[key]));
    // Reports of older versions have no aim.
    let aim = head["aim"].as_str().map_or_else(String::new, |aim| format!(", aim {aim}"));
    // One table has the stages from the head's pose until the picture is lit, and one has the errors.
    let stages = STAGES.iter().map(|stage| stage_row(stage, &head["end_to_end"]));
    let errors = ERRORS.iter().map(|unit| error_row(unit, &head["error"][*unit]));
    vec![
        heading("From the head to light"),
        paragraph(format_args!("{tracker}, prediction {predictor}{aim}, display {display}.")),
        paragraph(format_args!("Mean over {} complete pictures.", text_or_dash(&head["end_to_end"]["n"]))),
        table(&["stage", "mean, ms"], stages),
        table(&["error", "mean", "50 %", "90 %", "99 %", "greatest", "n"], errors),
    ]
}

fn stage_row(stage: &str, end_to_end: &Value) -> Element {
    row([cell(stage.replace('_', " ")), number_cell(decimal(&end_to_end[format!("{stage}_ms")], 3))])
}

fn error_row(unit: &str, error: &Value) -> Element {
    let values = PERCENTILES.iter().map(|key| number_cell(decimal(&error[*key], 3)));
    row([cell(unit)].into_iter().chain(values).chain([number_cell(text_or_dash(&error["n"]))]))
}
