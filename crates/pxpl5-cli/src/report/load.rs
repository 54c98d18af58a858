use super::files::Files;
use crate::error::CliError;
use crate::run::INCOMPLETE;
use pxpl5::views::page::{PagePicture, PageRun, latencies_ms};
use serde_json::Value;
use std::path::Path;

/// Returns the experiments in a results folder of `pxpl5 run` or `pxpl5 demo`. Only `report.json` is necessary. Fails
/// if `report.json` is not a report or differs from its entry in the manifest.
pub(super) fn runs(files: &Files<'_>) -> Result<Vec<PageRun>, CliError> {
    let path = files.folder().join(REPORT);
    let bytes = files.first(REPORT).map_err(|error| no_report(&path, &error))?;
    let all: Value = serde_json::from_slice(&bytes).map_err(|error| no_report(&path, &error.to_string()))?;
    match all["schema"].as_str() {
        Some("pxpl5-report/3") => Ok(vec![run(files, "", "", &all, &Value::Null)]),
        Some("pxpl5-demo/1") => {
            Ok(all["runs"].as_array().into_iter().flatten().map(|entry| demo_run(files, entry)).collect())
        }
        found => Err(no_report(&path, &format!("schema {}", found.unwrap_or("missing")))),
    }
}

const REPORT: &str = "report.json";

fn no_report(path: &Path, found: &str) -> CliError {
    let path = path.display();
    CliError::usage(format!("{path}: {found}; expected what `pxpl5 run --out` or `pxpl5 demo` writes"))
}

fn demo_run(files: &Files<'_>, entry: &Value) -> PageRun {
    let name = entry["name"].as_str().unwrap_or_default();
    run(files, name, &format!("{name}-"), &entry["report"], &entry["published"])
}

fn run(files: &Files<'_>, name: &str, prefix: &str, report: &Value, published: &Value) -> PageRun {
    let read = |file: &str| files.read(&format!("{prefix}{file}"));
    let pictures = read("pictures.csv").and_then(|bytes| String::from_utf8(bytes).ok());
    let text = |key: &str| report[key].as_str().unwrap_or("?");
    let own_name = format!("{}, {}", text("pipeline"), text("scene"));
    let name = if name.is_empty() { own_name } else { name.to_owned() };
    PageRun {
        name,
        report: report.clone(),
        published: published.clone(),
        pictures: pictures_of(files, prefix),
        timeline: read("timeline.svg"),
        latencies_ms: pictures.map(|csv| latencies_ms(&csv)).unwrap_or_default(),
    }
}

/// Returns the last picture of every surface. `prefix` is the start of the file names.
fn pictures_of(files: &Files<'_>, prefix: &str) -> Vec<PagePicture> {
    let names = files.names().filter_map(|name| Some((name, name.strip_prefix(prefix)?.strip_suffix(".png")?)));
    let pictures = names.filter_map(|(name, surface)| {
        let incomplete = surface.strip_suffix(INCOMPLETE).map(|surface| (surface, ": not complete in time"));
        let (surface, caption) = incomplete.unwrap_or((surface, ""));
        let eye = if ["left", "right"].contains(&surface) { " eye" } else { "" };
        Some(PagePicture { label: format!("{surface}{eye}{caption}"), png: files.read(name)? })
    });
    pictures.collect()
}
