//! Tests that the command and its outputs state version and commit, and that `pxpl5 cite` prints citations.

use crate::support::{Folder, out};
use std::fs;
use std::path::Path;
use std::process::Command;

/// Returns the commit of this clone from Git, or `None` without Git or outside of a clone.
fn commit_of_clone() -> Option<String> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    if !root.join(".git").exists() {
        return None;
    }
    let output = Command::new("git").args(["rev-parse", "HEAD"]).current_dir(root).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[test]
fn the_version_names_the_commit_of_the_clone() {
    let folder = Folder::new();
    let expected = commit_of_clone();
    for args in [&["-V"][..], &["--version"], &["run", "--version"]] {
        let text = out(&folder.run(args));
        let commit = text.trim().strip_suffix(')').and_then(|text| text.split_once("0.1.0 (commit "));
        let commit = commit.unwrap_or_else(|| panic!("{text}")).1.trim_end_matches("-modified");
        match &expected {
            Some(expected) => assert!(commit.len() == 12 && expected.starts_with(commit), "{text}"),
            None => assert_eq!(commit, "unknown"),
        }
    }
}

#[test]
fn every_file_of_a_run_states_the_same_commit() {
    let folder = Folder::new();
    let run = ["run", "--pipeline", "slats", "--scene", "full-screen:4", "--fields", "12", "--quiet", "--out", "r"];
    assert!(folder.run(&run).status.success());
    let read =
        |name: &str| fs::read(folder.path.join("r").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let value = |name: &str| -> serde_json::Value { serde_json::from_slice(&read(name)).expect("JSON") };
    let manifest = value("manifest.json");
    assert_eq!(manifest["version"], "0.1.0");
    assert_eq!(manifest["commit"], value("report.json")["commit"]);
    let Some(expected) = commit_of_clone() else {
        return assert!(manifest["commit"].is_null(), "{manifest}");
    };
    assert!(manifest["commit"].as_str().is_some_and(|commit| commit.starts_with(&expected)), "{manifest}");
    // Tables do not state their origin, because the manifest of their folder states it.
    for name in ["experiment.toml", "timeline.svg", "left.png"] {
        let has_commit = read(name).windows(expected.len()).any(|part| part == expected.as_bytes());
        assert!(has_commit, "{name}");
    }
}

#[test]
fn citations_can_be_printed_in_three_forms() {
    let folder = Folder::new();
    let print = |args: &[&str]| out(&folder.run(args));
    assert!(print(&["cite"]).contains("Low Latency Rendering on Pixel-Planes 5"));
    assert!(print(&["cite", "--format", "bibtex"]).contains("@techreport{TR94,"));
    assert!(print(&["cite", "--format", "cff"]).contains("cff-version: 1.2.0"));
}
