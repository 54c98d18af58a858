//! Tests of the paper about the project. Every number in its text must come from a generated file or a constant list.

use serde_json::Value;

/// Most words of the paper, by the rules of the Journal of Open Source Software with a margin.
const MAX_WORDS: usize = 1_200;

/// Phrases with digits that are names, or sizes that a paper prints. No command produces them.
const NAMES: [&str; 11] = [
    "Pixel-Planes 5",
    "i860",
    "`pxpl5",
    "128 x 128",
    "gem5",
    "208 bits",
    "Figure 1",
    "Figure 2",
    "Ramulator2",
    "Slats of 1994",
    "Slats of 1995",
];

fn read(name: &str) -> String {
    let path = format!("{}/{name}", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// Returns the text between the header and the list of references. Line breaks become spaces.
fn body() -> String {
    let paper = read("paper/paper.md");
    let after_header = paper.splitn(3, "---\n").nth(2).expect("a header").to_owned();
    let (text, _) = after_header.split_once("# References").expect("a list of references");
    // A space that joins a number and its unit is written as a backslash and a space.
    text.replace("\\ ", " ").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Returns a cell of a row of the main table of ACCURACY.md: column 2 is the published value, 3 the simulated one.
fn figure(id: &str, column: usize) -> String {
    let accuracy = read("ACCURACY.md");
    let row = accuracy.lines().find(|line| line.starts_with(&format!("| {id} |"))).expect("a row of the main table");
    row.split(" | ").nth(column).expect("a cell").to_owned()
}

/// Returns a percentage of the recorded levels of modelling, as the paper prints it.
fn median_percent(level: &str, times_of_code: bool) -> String {
    let found = level_record(level, times_of_code);
    format!("{:.2} %", found["from_cycle_percent"]["median"].as_f64().expect("a number"))
}

fn level_record(level: &str, times_of_code: bool) -> Value {
    let record = levels();
    let all = record["levels"].as_array().expect("levels");
    let found = all.iter().find(|entry| entry["level"] == level && entry["times_of_code"] == times_of_code);
    found.expect("the level is recorded").clone()
}

fn levels() -> Value {
    serde_json::from_str(&read("crates/pxpl5-cli/src/levels.json")).expect("JSON")
}

/// Returns the simulated seconds per second of the host, without pixels, with one decimal or as whole thousands.
fn speed(level: &str, times_of_code: bool) -> String {
    let found = level_record(level, times_of_code);
    let speed = found["speeds"][0]["simulated_seconds_per_second"].as_f64().expect("a number");
    assert_eq!(found["speeds"][0]["pixels"], "off");
    if speed < 1_000.0 { format!("{speed:.1}") } else { with_thousands(&format!("{speed:.0}")) }
}

/// Returns a number of four to six digits with a comma after the thousands.
fn with_thousands(digits: &str) -> String {
    let (thousands, rest) = digits.split_at(digits.len() - 3);
    format!("{thousands},{rest}")
}

fn compared(pipeline: &str, column: &str) -> f64 {
    let table = read("paper/comparison.csv");
    let mut lines = table.lines();
    let columns: Vec<&str> = lines.next().expect("names of columns").split(',').collect();
    let place = columns.iter().position(|name| *name == column).unwrap_or_else(|| panic!("no {column}: {columns:?}"));
    let row = lines.find(|line| line.split(',').next() == Some(pipeline)).expect("a row of the pipeline");
    let without_texts: String = row.split('"').step_by(2).collect();
    without_texts.split(',').nth(place).expect("a cell").parse().expect("a number")
}

/// Returns the phrases of the paper that contain a result, made from the files that have the result.
fn results() -> Vec<String> {
    let vectors = read("crates/i860/tests/conformance.rs");
    let vectors =
        vectors.split("summary.failed()), (").nth(1).and_then(|rest| rest.split(',').next()).expect("a count");
    let experiments = levels()["experiments"].as_u64().expect("a count");
    let triangles = pxpl5::scene::builtin("mig").expect("built in").triangles().len();
    let light = |pipeline| format!("{:.1} ms", compared(pipeline, "head_to_light_ms.mean"));
    let pixels = |pipeline, column: &str| format!("{:.1}", compared(pipeline, &format!("error.mean_px.{column}")));
    let interval = |pipeline| format!("{} to {}", pixels(pipeline, "low"), pixels(pipeline, "high"));
    let error = |pipeline| format!("{} pixels ({}", pixels(pipeline, "mean"), interval(pipeline));
    vec![
        crate::readme::headline().replace("**", ""),
        format!("TRANSFORM to swap | {} | {} |", figure("4", 2), figure("4", 3)),
        format!("without the COPY optimization | {} | {} |", figure("12", 2), figure("12", 3)),
        format!("with the COPY optimization | {} | {} |", figure("13", 2), figure("13", 3)),
        format!("passes {} vectors", with_thousands(vectors)),
        format!("differs from this level by {} in", median_percent("transaction", true)),
        format!("the median of {experiments} random experiments"),
        format!("The level of formulas differs by {}", median_percent("analytic", true)),
        format!(
            "simulate {}, {} and {} seconds in a second",
            speed("cycle", true),
            speed("transaction", true),
            speed("analytic", true)
        ),
        format!("trace hashes of {} runs", read("tests/golden/hashes.txt").lines().count()),
        format!("a fighter aircraft of {triangles} triangles"),
        format!("is {} for Rendering Control.", light("rendering-control")),
        format!("the latency is {}.", light("slats-touched")),
        format!("are {} over five motions)", error("rendering-control")),
        format!("and {}).", error("slats-touched")),
        format!("the tracker has {} pixels", pixels("ideal", "mean")),
        format!("to all regions, has {} pixels", pixels("slats", "mean")),
    ]
}

#[test]
fn every_number_in_the_paper_comes_from_a_result_file() {
    let mut text = body();
    for phrase in results() {
        assert!(text.contains(&phrase), "paper/paper.md must say: {phrase}");
        text = text.replace(&phrase, "");
    }
    // Citations contain keys such as F89.
    let cited = text.split("[@").map(|part| part.split_once(']').map_or(part, |(_, rest)| rest)).collect::<String>();
    let plain = NAMES.iter().fold(cited, |text, name| text.replace(name, ""));
    let words: Vec<&str> = plain.split(' ').filter(|word| word.contains(|c: char| c.is_ascii_digit())).collect();
    assert!(words.is_empty(), "numbers without a source: {words:?}");
}

#[test]
fn the_paper_is_short_enough_and_cites_only_what_its_bibliography_has() {
    let text = body();
    let words = text.split_whitespace().count();
    assert!(words <= MAX_WORDS, "{words} words");
    let bibliography = read("paper/paper.bib");
    let mut keys = 0;
    for part in text.split('@').skip(1) {
        let key = part.split(|c: char| !c.is_ascii_alphanumeric()).next().unwrap_or_default();
        assert!(bibliography.contains(&format!("{{{key},\n")), "paper/paper.bib lacks {key}");
        keys += 1;
    }
    assert!(keys > 8, "{keys} citations");
}

#[test]
fn the_paper_has_each_section_required_by_the_journal() {
    let paper = read("paper/paper.md");
    for title in ["Summary", "Statement of need", "State of the field", "Validation", "Limits", "References"] {
        assert!(paper.contains(&format!("\n# {title}\n")), "{title}");
    }
}
