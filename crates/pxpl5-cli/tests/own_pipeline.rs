//! Tests of the guide's own pipeline. The page equals the example, and the example runs in every command.

use crate::support::Folder;
use std::path::PathBuf;
use std::process::{Command, Output};

const PAGE: &str = include_str!("../../../docs/guide/own-pipeline.md");
const EXAMPLE: &str = include_str!("../examples/own_pipeline.rs");

/// Returns the path of the example's program, which cargo builds with the tests.
fn program() -> PathBuf {
    let tests = std::env::current_exe().expect("a test is a program");
    let folder = tests.ancestors().nth(2).expect("target/PROFILE/deps").join("examples");
    folder.join(format!("own_pipeline{}", std::env::consts::EXE_SUFFIX))
}

fn run(folder: &Folder, args: &[&str]) -> Output {
    Command::new(program()).args(args).current_dir(&folder.path).output().expect("the example was built")
}

fn succeeded(output: &Output) -> String {
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Returns the lines of the example between two marks.
fn piece(name: &str) -> String {
    let begin = format!("// ANCHOR: {name}\n");
    let end = format!("// ANCHOR_END: {name}\n");
    let rest = EXAMPLE.split_once(&begin).expect("the piece begins").1;
    rest.split_once(&end).expect("the piece ends").0.to_owned()
}

#[test]
fn every_code_block_of_the_guide_equals_its_part_of_the_example() {
    for name in ["firmware", "entry", "main"] {
        let shown = format!("<!-- {name} -->\n```rust,ignore\n{}```\n", piece(name));
        assert!(PAGE.contains(&shown), "{name}: run scripts/guide-code");
    }
}

/// The guide's Cargo.toml has one dependency, so every path in the example starts with that crate or the standard
/// library.
#[test]
fn the_example_needs_one_dependency() {
    let section = PAGE.split_once("[dependencies]\n").expect("a Cargo.toml").1;
    let dependencies: Vec<&str> = section.lines().take_while(|line| *line != "```").collect();
    assert_eq!(dependencies.len(), 1);
    assert!(dependencies[0].starts_with("pxpl5-cli = "), "{dependencies:?}");
    let code: Vec<&str> = EXAMPLE.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    for line in code.iter().filter(|line| line.starts_with("use ")) {
        assert!(line.starts_with("use pxpl5_cli::") || line.starts_with("use std::"), "{line}");
    }
    let code = code.join("\n").replace("pxpl5_cli::pxpl5::", "");
    for foreign in ["pxpl5::", "glam::", "pphigs::", "pxpl5_sim::parameters::", "tracking::", "slats::"] {
        assert!(!code.contains(foreign), "{foreign}");
    }
}

#[test]
fn a_binary_with_a_pipeline_of_its_own_has_at_most_ten_lines() {
    assert!(piece("main").lines().count() <= 10);
}

#[test]
fn the_latency_of_the_pipeline_is_the_sum_of_its_stages() {
    let folder = Folder::new();
    let args = ["run", "--pipeline", "one-at-a-time", "--scene", "mig", "--fields", "60", "--json", "--out", "out"];
    let report: serde_json::Value = serde_json::from_str(&succeeded(&run(&folder, &args))).expect("JSON");
    // TRANSFORM takes at least 417 x 21.7 us = 9.05 ms, and COPY at least 300 x 52 us = 15.6 ms, one after the other.
    // The sum is between one and two fields, so a frame that starts just after a retrace is shown at the second
    // retrace.
    assert!(report["latency_ms"]["min"].as_f64() >= Some(9.05 + 15.6));
    assert!((report["latency_fields"]["mean"].as_f64().expect("a number") - 2.0).abs() < 1e-4);
    assert_eq!(report["variant"], "shading=phong");
    let picture = image::open(folder.path.join("out/left.png")).expect("a picture").into_rgb8();
    assert!(picture.pixels().any(|pixel| pixel != picture.get_pixel(0, 0)), "the aircraft is there");
    assert!(folder.path.join("out/timeline.svg").exists());
}

#[test]
fn the_key_of_the_pipeline_is_an_option_and_other_keys_are_refused() {
    let folder = Folder::new();
    let own = ["run", "--pipeline", "one-at-a-time", "--scene", "full-screen:4", "--fields", "40", "--json"];
    let gouraud = succeeded(&run(&folder, &[&own[..], &["--shading", "gouraud"]].concat()));
    assert!(gouraud.contains("\"variant\": \"shading=gouraud\""));
    let refused = run(&folder, &[&own[..], &["--copy", "split"]].concat());
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("copy does not apply to the pipeline one-at-a-time"));
    assert!(succeeded(&run(&folder, &["run", "--help"])).contains("one-at-a-time"));
}

#[test]
fn sweep_compare_and_limit_accept_the_pipeline() {
    let folder = Folder::new();
    let sweep = PAGE.split("```toml\n").nth(2).and_then(|rest| rest.split("```").next()).expect("the guide's sweep");
    folder.file("sweep.toml", sweep);
    succeeded(&run(&folder, &["sweep", "sweep.toml", "--out", "rows", "--quiet"]));
    let rows = std::fs::read_to_string(folder.path.join("rows/rows.jsonl")).expect("written");
    assert_eq!(rows.matches("\"status\":\"done\"").count(), 2);
    let compared = ["compare", "--scene", "full-screen:4", "--fields", "30", "--only", "one-at-a-time", "--json"];
    assert!(succeeded(&run(&folder, &compared)).contains("\"pipeline\": \"one-at-a-time\""));
    let limit = succeeded(&run(&folder, &["limit", "--pipeline", "one-at-a-time", "--json"]));
    let limit: serde_json::Value = serde_json::from_str(&limit).expect("JSON");
    // A mean latency of 2.5 fields leaves 2 fields of 16.7 ms for most frames. TRANSFORM of 21.7 us a triangle and
    // COPY of 15.6 ms fit for at most (33.4 - 15.6) / 0.0217 = 820 triangles.
    let triangles = limit["triangles"].as_u64().expect("a number");
    assert!((1..=820).contains(&triangles), "{triangles}");
}
