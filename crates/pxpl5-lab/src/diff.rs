//! Comparison of two reports, value by value.

use crate::error::StudyError;
use crate::study::Study;
use pxpl5_sim::Watcher;
use serde::Serialize;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// A value that differs between two reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Changed {
    /// Path of the value, such as `latency_ms.mean`.
    pub key: String,
    /// Value in the first report. `None` if the first report lacks the value.
    pub a: Option<Value>,
    /// Value in the second report. `None` if the second report lacks the value.
    pub b: Option<Value>,
    /// Change from the first to the second value, in percent of the first value. `None` unless both values are numbers
    /// and the first is not 0.
    pub percent: Option<f64>,
}

impl Changed {
    /// Creates the difference of two values.
    pub fn new(key: &str, a: Option<&Value>, b: Option<&Value>) -> Self {
        let numbers = a.and_then(Value::as_f64).zip(b.and_then(Value::as_f64)).filter(|(a, _)| *a != 0.0);
        let percent = numbers.map(|(a, b)| (b / a - 1.0) * 100.0);
        Self { key: key.to_owned(), a: a.cloned(), b: b.cloned(), percent }
    }
}

/// Differences between two reports.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Differences {
    /// True if both runs had the same trace hash and statistics.
    pub same_trace: bool,
    /// Settings that differ.
    pub settings: Vec<Changed>,
    /// Results that differ, without the computing times of this computer.
    pub results: Vec<Changed>,
    /// Number of results that are equal in both reports.
    pub equal: usize,
}

/// First parts of the paths of settings, up to the first dot. All other paths belong to results.
const SETTINGS: [&str; 17] = [
    "schema",
    "version",
    "commit",
    "machine",
    "level",
    "seed",
    "pipeline",
    "variant",
    "display",
    "hmd",
    "overrides",
    "n_gps",
    "n_renderers",
    "scene",
    "triangles",
    "spheres",
    "fields",
];

/// First parts of the paths of values that are not compared, because they do not describe the simulated machine.
const LEFT_OUT: [&str; 4] = ["config_hash", "trace_hash", "host_seconds", "events"];

/// The comparison of two reports in JSON, such as the contents of two files `report.json`.
#[derive(Clone, Debug)]
pub struct DiffQuery {
    /// The two reports.
    pub reports: [Value; 2],
}

impl Study for DiffQuery {
    type Report = Differences;

    fn run(&self, _: &mut dyn Watcher) -> Result<Differences, StudyError> {
        let [a, b] = &self.reports;
        Ok(diff(a, b))
    }
}

fn diff(a: &Value, b: &Value) -> Differences {
    let [of_a, of_b] = [a, b].map(|report| {
        let mut leaves = BTreeMap::new();
        flatten(String::new(), report, &mut leaves);
        leaves
    });
    // A key that only one report has counts as different.
    let keys: BTreeSet<&String> = of_a.keys().chain(of_b.keys()).collect();
    let mut all = Differences {
        same_trace: a["trace_hash"].is_string() && a["trace_hash"] == b["trace_hash"],
        settings: Vec::new(),
        results: Vec::new(),
        equal: 0,
    };
    for key in keys {
        let first = key.split('.').next().unwrap_or(key);
        if LEFT_OUT.contains(&first) {
            continue;
        }
        // Settings are listed separately, because they are the cause of differing results.
        let is_setting = SETTINGS.contains(&first);
        let (a, b) = (of_a.get(key).copied(), of_b.get(key).copied());
        if a == b {
            all.equal += usize::from(!is_setting);
            continue;
        }
        let changed = Changed::new(key, a, b);
        if is_setting { all.settings.push(changed) } else { all.results.push(changed) }
    }
    all
}

/// Collects all values of a JSON tree except objects and lists, with their paths.
fn flatten<'a>(path: String, value: &'a Value, leaves: &mut BTreeMap<String, &'a Value>) {
    let joined = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| flatten(joined(key), value, leaves)),
        Value::Array(list) => list.iter().enumerate().for_each(|(number, value)| {
            flatten(joined(&name_of(value).unwrap_or_else(|| number.to_string())), value, leaves);
        }),
        _ => {
            leaves.insert(path, value);
        }
    }
}

/// Returns the name of an entry in a list, or `None` if the entry has no name.
fn name_of(value: &Value) -> Option<String> {
    let texts = ["name", "resource", "port", "of", "until"].map(|key| value[key].as_str());
    let texts: Vec<&str> = texts.into_iter().flatten().collect();
    (!texts.is_empty()).then(|| texts.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn settings_and_results_are_separated_and_host_times_are_ignored() {
        let a = json!({"pipeline": "slats", "shown": 4, "latency_ms": {"mean": 20.0, "n": 4}, "host_seconds": 1.0, "trace_hash": "x"});
        let b = json!({"pipeline": "frameless", "shown": 4, "latency_ms": {"mean": 25.0, "n": 4}, "host_seconds": 2.0, "trace_hash": "y"});
        let found = diff(&a, &b);
        let keys = |all: &[Changed]| all.iter().map(|changed| changed.key.clone()).collect::<Vec<_>>();
        assert_eq!(
            (keys(&found.settings), keys(&found.results)),
            (vec!["pipeline".to_owned()], vec!["latency_ms.mean".to_owned()])
        );
        assert_eq!((found.equal, found.same_trace), (2, false));
        assert!((found.results[0].percent.expect("numbers") - 25.0).abs() < 1e-9);
    }

    #[test]
    fn entries_of_lists_are_compared_by_name() {
        let part = |name: &str, mean: f64| json!({"name": name, "mean": mean});
        let a = json!({"latency_parts_ms": [part("copy", 1.0), part("scan", 2.0)]});
        let b = json!({"latency_parts_ms": [part("scan", 2.0)]});
        let found = diff(&a, &b);
        let keys: Vec<&str> = found.results.iter().map(|changed| changed.key.as_str()).collect();
        assert_eq!(keys, ["latency_parts_ms.copy.mean", "latency_parts_ms.copy.name"]);
        assert!(found.results.iter().all(|changed| changed.b.is_none() && changed.percent.is_none()));
    }

    #[test]
    fn a_report_does_not_differ_from_itself() {
        let report = json!({"trace_hash": "x", "shown": 1, "arp": null});
        let found = diff(&report, &report);
        assert!(found.same_trace && found.settings.is_empty() && found.results.is_empty());
    }
}
