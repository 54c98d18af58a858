//! What a results folder holds.

use crate::error::CliError;
use crate::run::INCOMPLETE;
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
    let text = fs::read_to_string(&path).map_err(|error| no_report(&path, &error.to_string()))?;
    let all: Value = serde_json::from_str(&text).map_err(|error| no_report(&path, &error.to_string()))?;
    match all["schema"].as_str() {
        Some("pxpl5-report/2") => Ok(vec![run(folder, "", "", &all, &Value::Null)]),
        Some("pxpl5-demo/1") => {
            let runs = all["runs"].as_array().map(Vec::as_slice).unwrap_or_default();
            Ok(runs.iter().map(|entry| demo_run(folder, entry)).collect())
        }
        found => Err(no_report(&path, &format!("schema {}", found.unwrap_or("missing")))),
    }
}

fn no_report(path: &Path, found: &str) -> CliError {
    let path = path.display();
    CliError::failure(format!("{path}: {found}; expected what `pxpl5 run --out` or `pxpl5 demo` writes"))
}

fn demo_run(folder: &Path, entry: &Value) -> PageRun {
    let name = entry["name"].as_str().unwrap_or_default();
    // A name is part of file names, so it must not lead out of the folder.
    let plain: String = name.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect();
    run(folder, name, &format!("{plain}-"), &entry["report"], &entry["published"])
}

fn run(folder: &Path, name: &str, prefix: &str, report: &Value, published: &Value) -> PageRun {
    let pictures = read(folder, prefix, "pictures.csv").and_then(|bytes| String::from_utf8(bytes).ok());
    let own_name = format!("{}, {}", text(report, "pipeline"), text(report, "scene"));
    let name = if name.is_empty() { own_name } else { name.to_owned() };
    PageRun {
        name,
        report: report.clone(),
        published: published.clone(),
        pictures: pictures_of(folder, prefix),
        timeline: read(folder, prefix, "timeline.svg"),
        latencies_ms: pictures.map(|csv| latencies_ms(&csv)).unwrap_or_default(),
    }
}

/// The last pictures of the surfaces that there can be.
fn pictures_of(folder: &Path, prefix: &str) -> Vec<PagePicture> {
    let mut pictures = Vec::new();
    for label in ["left", "right"] {
        for (mark, caption) in [("", ""), (INCOMPLETE, ": not complete, it was not there in time")] {
            if let Some(png) = read(folder, prefix, &format!("{label}{mark}.png")) {
                pictures.push(PagePicture { label: format!("{label} eye{caption}"), png });
            }
        }
    }
    pictures
}

/// A file of a run; `None` where there is none.
fn read(folder: &Path, prefix: &str, file: &str) -> Option<Vec<u8>> {
    fs::read(folder.join(format!("{prefix}{file}"))).ok()
}

fn text<'a>(report: &'a Value, key: &str) -> &'a str {
    report[key].as_str().unwrap_or("?")
}
