//! Tests that the guide shows the Rust examples unchanged, and that the examples run. python/tests/test_examples.py
//! does the same for the Python versions.
//!
//! `PXPL5_UPDATE_GUIDE=1 cargo test -p pxpl5 --test main examples` writes the examples into the guide.

use std::path::{Path, PathBuf};
use std::process::Command;

const EXAMPLES: [&str; 4] = ["my_model", "i860_loop", "my_sweep", "my_recording"];

fn root() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// Returns the page with every example replaced by the content of its file.
fn shown(page: &str) -> String {
    let mut pieces = page.split("<!-- examples/");
    let mut made = pieces.next().unwrap_or_default().to_owned();
    for piece in pieces {
        let (name, rest) = piece.split_once(" -->\n```rust\n").expect("a mark stands before a piece of Rust");
        let (_, after) = rest.split_once("\n```\n").expect("the piece ends");
        made +=
            &format!("<!-- examples/{name} -->\n```rust\n{}```\n{after}", read(&root().join("examples").join(name)));
    }
    made
}

#[test]
fn the_guide_shows_every_example_unchanged() {
    let path = root().join("docs/guide/rust.md");
    let page = read(&path);
    assert!(EXAMPLES.iter().all(|name| page.contains(&format!("examples/{name}.rs"))), "each is shown or linked");
    let expected = shown(&page);
    if std::env::var_os("PXPL5_UPDATE_GUIDE").is_some() {
        std::fs::write(&path, expected).expect("the project can be written");
        return;
    }
    assert!(page == expected, "run PXPL5_UPDATE_GUIDE=1 cargo test -p pxpl5 --test main examples");
}

/// Runs an example in a folder of its own and returns its output. Cargo builds examples beside the tests.
fn printed(name: &str) -> String {
    let tests = std::env::current_exe().expect("a test is a program");
    let programs = tests.ancestors().nth(2).expect("target/PROFILE/deps").join("examples");
    let folder = std::env::temp_dir().join(format!("pxpl5-example-{}-{name}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("the temporary directory can be written");
    let program = programs.join(format!("{name}{}", std::env::consts::EXE_SUFFIX));
    let output = Command::new(program).current_dir(&folder).output().expect("the example was built");
    let _ = std::fs::remove_dir_all(&folder);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Returns the number before a word in a line.
fn number_before(line: &str, word: &str) -> f64 {
    let before = line.split(word).next().unwrap_or_default();
    let number = before.split_whitespace().last().and_then(|number| number.parse().ok());
    number.unwrap_or_else(|| panic!("no number before `{word}`: {line}"))
}

#[test]
fn both_pipelines_show_a_model_file_and_slats_shows_it_in_every_field() {
    let printed = printed("my_model");
    let lines: Vec<&str> = printed.lines().filter(|line| !line.starts_with("warning")).collect();
    let [rendering_control, its_pixels, slats, pixels] = lines[..] else { panic!("{printed}") };
    assert!(rendering_control.starts_with("rendering-control: ") && slats.starts_with("slats: "));
    // An NTSC field takes 16.683 ms, and Slats takes one field.
    assert_eq!(number_before(slats, " ms (sd"), 16.7);
    assert_eq!(number_before(slats, " Hz"), 59.9);
    assert!(number_before(rendering_control, " ms (sd") > 16.7);
    for line in [its_pixels, pixels] {
        assert!(number_before(line, " pixels of the model") > 1_000.0, "{line}");
    }
}

#[test]
fn the_i860_loop_of_the_example_computes_the_sum_of_squares() {
    let printed = printed("i860_loop");
    // The sum 1 + 4 + .. + 100 is 10 x 11 x 21 / 6 = 385.
    assert!(printed.lines().any(|line| line == "result 385"), "{printed}");
    assert!(printed.contains("Stopped after "));
}

#[test]
fn the_sweep_example_prints_a_line_for_each_point_and_more_processors_lower_the_latency() {
    let printed = printed("my_sweep");
    let rows: Vec<&str> = printed.lines().filter(|line| line.ends_with(" Hz")).collect();
    assert_eq!(rows.len(), 3 * 2 * 2);
    let latency = |settings: &str| {
        let row = rows.iter().find(|row| row.starts_with(settings)).unwrap_or_else(|| panic!("{settings}: {printed}"));
        number_before(row, " ms ")
    };
    assert!(latency("8000 13 1 ") < latency("8000 4 1 "));
    // 8,000 triangles of 21.7 us on four processors take 43 ms, more than the two fields of a frame. 1,000 triangles
    // take less.
    assert!(latency("1000 4 1 ") < latency("8000 4 1 "));
}

#[test]
fn the_recording_example_evaluates_every_pipeline_with_and_without_prediction() {
    let printed = printed("my_recording");
    let errors: Vec<f64> = printed.lines().map(|line| number_before(line, " px of error")).collect();
    assert_eq!(errors.len(), 3 * 2);
    // Prediction of a smooth motion reduces the error under each pipeline.
    for pair in errors.chunks(2) {
        assert!(pair[1] < pair[0], "{printed}");
    }
}
