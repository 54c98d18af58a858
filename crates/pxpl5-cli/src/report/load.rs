//! What a results folder holds.

use crate::error::CliError;
use serde_json::Value;
use std::fs;
use std::path::Path;

/// One experiment of a results folder.
#[derive(Debug, Default)]
pub(super) struct Run {
    /// What stands over it.
    pub(super) name: String,
    /// Its `report.json`.
    pub(super) report: Value,
    /// The published value beside the simulated one, if there is one.
    pub(super) published: Value,
    /// Left and right picture, as PNG.
    pub(super) pictures: [Option<Vec<u8>>; 2],
    /// Its timeline, as SVG.
    pub(super) timeline: Option<Vec<u8>>,
    /// The latency of each picture after the warm-up.
    pub(super) latencies_ms: Vec<f64>,
}

/// The experiments of a folder; files other than `report.json` may be missing.
///
/// # Errors
///
/// When `report.json` is missing or is no report.
pub(super) fn runs(folder: &Path) -> Result<Vec<Run>, CliError> {
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

fn demo_run(folder: &Path, entry: &Value) -> Run {
    let name = entry["name"].as_str().unwrap_or_default();
    // A name is part of file names, so it must not lead out of the folder.
    let plain: String = name.chars().filter(|c| c.is_alphanumeric() || "-_".contains(*c)).collect();
    run(folder, name, &format!("{plain}-"), &entry["report"], &entry["published"])
}

fn run(folder: &Path, name: &str, prefix: &str, report: &Value, published: &Value) -> Run {
    let read = |file: &str| fs::read(folder.join(format!("{prefix}{file}"))).ok();
    let pictures = read("pictures.csv").and_then(|bytes| String::from_utf8(bytes).ok());
    let text = |key: &str| report[key].as_str().unwrap_or("?").to_owned();
    let name = if name.is_empty() { format!("{}, {}", text("pipeline"), text("scene")) } else { name.to_owned() };
    Run {
        name,
        report: report.clone(),
        published: published.clone(),
        pictures: ["left.png", "right.png"].map(read),
        timeline: read("timeline.svg"),
        latencies_ms: pictures.map(|csv| latencies_ms(&csv)).unwrap_or_default(),
    }
}

/// The column `latency_ps` of the rows that are `steady`; nothing of a file that has no such columns.
fn latencies_ms(csv: &str) -> Vec<f64> {
    let mut lines = csv.lines().skip_while(|line| line.starts_with('#'));
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let place = |name: &str| names.iter().position(|found| *found == name);
    let (Some(latency), Some(steady)) = (place("latency_ps"), place("steady")) else { return Vec::new() };
    let row = |line: &str| {
        let values: Vec<&str> = line.split(',').collect();
        let latency: u64 = values.get(latency)?.parse().ok()?;
        (values.get(steady) == Some(&"1")).then_some(latency as f64 * 1e-9)
    };
    lines.filter_map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_pictures_after_the_warm_up_are_read() {
        let csv = "# a comment\npicture,steady,latency_ps\n0,0,1\n1,1,2000000000\n2,1,\n3,1,3000000000\n";
        assert_eq!(latencies_ms(csv), [2.0, 3.0]);
        assert!(latencies_ms("nothing").is_empty());
    }
}
