//! Tests that Rust and Python find the same hashes for the experiments of `python/tests/experiments.json`.
//! python/tests/test_runs.py reads the same file.
//!
//! Hashes change with every simulated time. `PXPL5_UPDATE_EXPERIMENTS=1 cargo test -p pxpl5 --test main front_ends`
//! writes them again.

use pxpl5::{ExperimentFile, Measured};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("python/tests/experiments.json")
}

/// Runs an experiment from its text and returns the hashes.
fn found(text: &str) -> Value {
    let plan = ExperimentFile::parse(text, "experiments.json").and_then(|file| file.resolve()).expect("an experiment");
    let outcome = plan.experiment(plan.load_scene().expect("a scene")).run().expect("it can be run");
    let report = outcome.report();
    json!({ "experiment": text, "trace_hash": report.trace_hash, "config_hash": report.config_hash })
}

#[test]
fn experiments_have_the_same_hashes_in_rust_and_python() {
    let kept: Vec<Value> =
        serde_json::from_str(&std::fs::read_to_string(file()).expect("the file is there")).expect("JSON");
    let texts = kept.iter().map(|entry| entry["experiment"].as_str().expect("a text"));
    let found: Vec<Value> = texts.map(found).collect();
    if std::env::var_os("PXPL5_UPDATE_EXPERIMENTS").is_some() {
        let text = serde_json::to_string_pretty(&found).expect("values");
        std::fs::write(file(), text + "\n").expect("the project can be written");
        return;
    }
    assert_eq!(found, kept);
}
