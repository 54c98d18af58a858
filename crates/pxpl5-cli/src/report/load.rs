//! What a results folder holds that `pxpl5 run` or `pxpl5 demo` wrote.

use crate::error::CliError;
use pxpl5::views::page::{PagePicture, PageRun, latencies_ms};
use serde_json::Value;
use std::fs;
use std::path::Path;

/// The experiments of a folder; files other than `report.json` may be missing.
///
/// # Errors
///
/// When `report.json` is missing or is no report.
pub(super) fn runs(folder: &Path) -> Result<Vec<PageRun>, CliError> {
    let path = folder.join("report.json");
    let problem = |what: String| CliError::failure(format!("{}: {what}", path.display()));
    let advice = "; expected what `pxpl5 run --out` or `pxpl5 demo` writes";
    let text = fs::read_to_string(&path).map_err(|error| problem(format!("{error}{advice}")))?;
    let all: Value = serde_json::from_str(&text).map_err(|error| problem(format!("{error}{advice}")))?;
    match all["schema"].as_str() {
        Some("pxpl5-report/1") => Ok(vec![run(folder, "", "", &all, &Value::Null)]),
        Some("pxpl5-demo/1") => {
            let runs = all["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
            Ok(runs.iter().map(|entry| demo_run(folder, entry)).collect())
        }
        found => Err(problem(format!("schema {}{advice}", found.unwrap_or("missing")))),
    }
}

fn demo_run(folder: &Path, entry: &Value) -> PageRun {
    let name = entry["name"].as_str().unwrap_or_default();
    // A name is part of file names, so it must not lead out of the folder.
    let plain: String = name.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect();
    run(folder, name, &format!("{plain}-"), &entry["report"], &entry["published"])
}

fn run(folder: &Path, name: &str, prefix: &str, report: &Value, published: &Value) -> PageRun {
    let read = |file: &str| fs::read(folder.join(format!("{prefix}{file}"))).ok();
    let pictures = read("pictures.csv").and_then(|bytes| String::from_utf8(bytes).ok());
    let text = |key: &str| report[key].as_str().unwrap_or("?").to_owned();
    let name = if name.is_empty() { format!("{}, {}", text("pipeline"), text("scene")) } else { name.to_owned() };
    PageRun {
        name,
        report: report.clone(),
        published: published.clone(),
        pictures: pictures_of(folder, prefix),
        timeline: read("timeline.svg"),
        latencies_ms: pictures.map(|csv| latencies_ms(&csv)).unwrap_or_default(),
    }
}

/// The last pictures of the surfaces that there can be.
fn pictures_of(folder: &Path, prefix: &str) -> Vec<PagePicture> {
    let labels = ["left", "right"].into_iter();
    let read = |label: &str| fs::read(folder.join(format!("{prefix}{label}.png"))).ok();
    labels.filter_map(|label| Some(PagePicture { label: format!("{label} eye"), png: read(label)? })).collect()
}
