//! Tests of report pages, traces and films as a user creates them.

use crate::support::{self, Folder, err, out};

fn results(folder: &Folder) {
    let run =
        ["run", "--pipeline", "slats", "--scene", "mig", "--triangles", "60", "--fields", "20", "--out", "results"];
    let output = folder.run(&run);
    assert!(output.status.success(), "{}", err(&output));
}

#[test]
fn a_report_page_contains_all_files_of_its_folder_and_loads_nothing_else() {
    let folder = Folder::new();
    results(&folder);
    let output = folder.run(&["report", "results"]);
    assert!(output.status.success(), "{}", err(&output));
    assert!(out(&output).contains("results/report.html"));
    let page = std::fs::read_to_string(folder.path.join("results/report.html")).expect("written");
    // The page has a timeline and two pictures, a histogram and the stages of latency.
    assert_eq!(page.matches("data:image/svg+xml;base64,").count(), 1);
    assert_eq!(page.matches("data:image/png;base64,").count(), 2);
    assert_eq!(page.matches("<svg ").count(), 2);
    for word in ["wait for retrace", "config_hash", "fields and", "name=\"viewport\"", "@media print"] {
        assert!(page.contains(word), "{word} is missing");
    }
    assert!(!page.contains("http://") && !page.contains("https://"), "something from outside");
}

#[test]
fn a_folder_without_a_report_is_refused_with_what_was_expected() {
    let folder = Folder::new();
    for (contents, expected) in [(None, "report.json"), (Some("{\"schema\""), "EOF"), (Some("{}"), "schema missing")] {
        if let Some(text) = contents {
            folder.file("report.json", text);
        }
        let output = folder.run(&["report", "."]);
        assert_eq!(output.status.code(), Some(2));
        assert!(err(&output).contains(expected) && err(&output).contains("run --out"), "{}", err(&output));
        assert!(!folder.names().contains(&"report.html".to_owned()));
    }
}

#[test]
fn the_waveform_and_the_explanation_of_one_picture_agree() {
    let folder = Folder::new();
    let run = ["--pipeline", "rendering-control", "--scene", "mig", "--triangles", "30", "--fields", "40"];
    let output = folder.run(&[&["trace"][..], &run, &["--picture", "5", "--out", "a.vcd"]].concat());
    assert!(output.status.success(), "{}", err(&output));
    let text = std::fs::read_to_string(folder.path.join("a.vcd")).expect("written");
    let output = folder.run(&[&["run"][..], &run, &["--picture", "5"]].concat());
    assert!(output.status.success(), "{}", err(&output));
    // The waveform begins with the sampled pose.
    let begin =
        text.lines().find_map(|line| line.strip_prefix('#')).and_then(|ps| ps.parse::<u64>().ok()).expect("a time");
    let said = out(&output);
    let sampled = said.lines().find_map(|line| line.trim().strip_prefix("pose sampled")).expect("a line").trim();
    let ms: f64 = sampled.trim_end_matches("ms").trim().parse().expect("a number");
    assert!((ms - begin as f64 / 1e9).abs() < 1e-3, "{sampled} and {begin} ps");
    let output = folder.run(&[&["run"][..], &run, &["--picture", "99"]].concat());
    assert!(err(&output).contains("expected one of the pictures"), "{}", err(&output));
}

#[test]
fn a_film_has_the_requested_fields() {
    let folder = Folder::new();
    let run = ["film", "--pipeline", "slats", "--scene", "mig", "--triangles", "30", "--length", "3", "--out", "f.png"];
    let output = folder.run(&run);
    assert!(output.status.success(), "{}", err(&output));
    let file = std::fs::File::open(folder.path.join("f.png")).expect("written");
    let reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("PNG");
    assert_eq!(reader.info().animation_control().map(|control| control.num_frames), Some(3));
}

#[test]
fn a_report_of_a_sweep_shows_its_complete_rows() {
    let folder = Folder::new();
    folder.file(
        "s.toml",
        "title = \"Two sizes\"\npipeline = \"slats\"\nscene = \"full-screen:8\"\nfields = 12\n[sweep.grid]\ntriangles = [1, 8]\n",
    );
    assert!(folder.run(&["sweep", "s.toml", "--out", "o", "--quiet"]).status.success());
    for results in ["o", "o/rows.jsonl"] {
        assert!(folder.run(&["report", results]).status.success());
        let page = std::fs::read_to_string(folder.path.join("o/report.html")).expect("written");
        assert!(page.contains("<h2>Two sizes</h2>") && page.contains("2 of 2 points"), "{page}");
        assert_eq!(page.matches("<tr>").count(), 3);
        for column in ["triangles", "latency_ms.mean", "missed_retraces"] {
            assert!(page.contains(&format!("<th>{column}</th>")), "{column}: {page}");
        }
    }
    // After an interruption in the middle of a line, the page shows the complete lines.
    let rows = std::fs::read_to_string(folder.path.join("o/rows.jsonl")).expect("written");
    folder.file("o/rows.jsonl", &rows[..rows.len() - 9]);
    assert!(folder.run(&["report", "o", "--quiet"]).status.success());
    assert!(std::fs::read_to_string(folder.path.join("o/report.html")).expect("written").contains("1 of 2 points"));
}

#[test]
fn a_report_of_a_comparison_has_a_row_for_each_pipeline_and_its_pictures() {
    let folder = Folder::new();
    let output = folder.run(&["compare", "--fields", "60", "-q", "--out", "c", "--only", "rendering-control,slats"]);
    assert!(output.status.success(), "{}", err(&output));
    assert!(folder.run(&["report", "c", "--quiet"]).status.success());
    let page = std::fs::read_to_string(folder.path.join("c/report.html")).expect("written");
    for part in ["<td>rendering-control</td>", "pipeline</th>", "data:image/svg+xml;", "data:image/png;"] {
        assert!(page.contains(part), "{part}");
    }
    // The page begins with its answer. Two rows with equal seeds differ in the mean by the difference of their means.
    let json = std::fs::read_to_string(folder.path.join("c/comparison.json")).expect("written");
    let all: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    let px = |row: usize| all["pipelines"][row]["error"]["mean_px"]["mean"].as_f64().expect("a mean");
    let [slats, above] = [px(1), px(0) - px(1)].map(|px| format!("{px:.2}"));
    let answer = format!("slats has the least error, {slats} px in the mean. rendering-control has {above} px more");
    assert!(page.contains(&format!("<h2>Comparison</h2>\n<p>{answer}, from ")), "{answer}: {page}");
}

#[test]
fn a_report_reads_what_its_manifest_lists_and_nothing_else() {
    let folder = Folder::new();
    results(&folder);
    let pictures = |warned: bool| {
        let output = folder.run(&["report", "results"]);
        assert!(output.status.success() && err(&output).contains("left out") == warned, "{}", err(&output));
        let page = std::fs::read_to_string(folder.path.join("results/report.html")).expect("written");
        page.matches("data:image/png;base64,").count()
    };
    assert_eq!(pictures(false), 2);
    let right = std::fs::read(folder.path.join("results/right.png")).expect("written");
    folder.file("results/left-incomplete.png", &right);
    assert_eq!(pictures(false), 2, "a picture that no run of this folder wrote");
    folder.file("results/right.png", b"another one");
    assert_eq!(pictures(true), 1);
    let manifest = std::fs::read(folder.path.join("results/manifest.json")).expect("written");
    std::fs::remove_file(folder.path.join("results/manifest.json")).expect("there");
    assert_eq!(pictures(true), 0, "their run is not known");
    folder.file("results/manifest.json", &manifest);
    folder.file("results/report.json", "{}");
    let output = folder.run(&["report", "results"]);
    assert_eq!(output.status.code(), Some(2));
    assert!(err(&output).contains("report.json") && err(&output).contains("other contents"), "{}", err(&output));
}

/// Tests a run of three pictures. It has a trace, a film and files, although no latency is known after the warm-up.
#[test]
fn runs_with_few_pictures_write_all_results() {
    let folder = Folder::new();
    let few = ["--pipeline", "rendering-control", "--scene", "full-screen:4", "--fields"];
    let output = folder.run(&[&["run"], &few[..], &["10", "--out", "o"]].concat());
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    let message = err(&output);
    assert!(message.contains("only ") && message.contains("the next one is shown after about "), "{message}");
    let needed: u64 =
        message.split("about ").nth(1).and_then(|rest| rest.trim().parse().ok()).unwrap_or_else(|| panic!("{message}"));
    let read = |name: &str| std::fs::read_to_string(folder.path.join("o").join(name)).expect("written");
    let report: serde_json::Value = serde_json::from_str(&read("report.json")).expect("JSON");
    let shown = report["shown"].as_u64().expect("a number");
    assert!((1..=4).contains(&shown), "{shown}");
    assert!(report["latency_ms"]["mean"].is_null() && report["latency_ms"]["n"] == 0, "{report}");
    assert!(read("results.csv").contains("latency_ms.mean,,"), "{}", read("results.csv"));
    assert_eq!(read("pictures.csv").lines().count() as u64, 1 + shown);
    for name in ["left.png", "right.png", "timeline.svg", "experiment.toml", "manifest.json"] {
        assert!(folder.path.join("o").join(name).exists(), "{name}");
    }
    // The number of fields in the message is sufficient, and not much too large.
    for (fields, is_enough) in [(needed + 1, true), (needed - 4, false)] {
        let output = folder.run(&[&["run"], &few[..], &[&fields.to_string(), "--quiet"]].concat());
        assert_eq!(output.status.success(), is_enough, "{fields} fields, {needed} were predicted: {}", err(&output));
    }
    for (args, file) in [
        (&["trace", "--out", "t.json"][..], "t.json"),
        (&["film", "--from", "2", "--length", "3", "--head", "still", "--raster", "vdrt", "--out", "f.png"], "f.png"),
    ] {
        let output = folder.run(&[args, &few[..], &["10"]].concat());
        assert_eq!(output.status.code(), Some(0), "{args:?}: {}", err(&output));
        assert!(std::fs::metadata(folder.path.join(file)).is_ok_and(|found| found.len() > 1000), "{file}");
    }
    let output = folder.run(&[&["debug", "--do", "run"], &few[..], &["10"]].concat());
    assert!(output.status.success() && out(&output).contains("the run is over"), "{}", err(&output));
}

/// Tests that every pipeline refuses a run within the warm-up, and estimates the necessary length of a run. Without a
/// closed form, the estimate comes from the run's own pictures.
#[test]
fn every_pipeline_reports_how_many_fields_a_run_needs() {
    let folder = Folder::new();
    for pipeline in ["jitp-field", "frameless", "arp-full", "slats"] {
        let run = |fields: &str| {
            let args = ["run", "--pipeline", pipeline, "--scene", "full-screen:2", "--head", "pan:60", "--quiet"];
            folder.run(&[&args[..], &["--fields", fields]].concat())
        };
        let output = run("5");
        let message = err(&output);
        assert_eq!(output.status.code(), Some(1), "{pipeline}: {message}");
        let needed: Option<u64> =
            message.split("about ").nth(1).and_then(|rest| rest.split_whitespace().next()?.parse().ok());
        let needed = needed.unwrap_or_else(|| panic!("{pipeline}: {message}"));
        let output = run(&(needed + 1).to_string());
        assert!(output.status.success(), "{pipeline}, {needed}: {}", err(&output));
    }
}

/// Tests that `diff` compares only pictures that the manifests of both folders list, and keeps the numbers of both
/// runs.
#[test]
fn diff_compares_two_runs_and_ignores_files_beside_them() {
    let folder = Folder::new();
    results(&folder);
    let other = ["run", "--pipeline", "slats", "--scene", "mig", "--triangles", "60", "--fields", "20", "--set"];
    let other = folder.run(&[&other[..], &["gp.triangle_ns=20000", "--out", "other"]].concat());
    assert!(other.status.success(), "{}", err(&other));
    let right = std::fs::read(folder.path.join("results/right.png")).expect("written");
    ["results/stale.png", "other/stale.png"].iter().for_each(|name| {
        folder.file(name, &right);
    });
    let output = folder.run(&["diff", "results", "other", "--json"]);
    assert!(output.status.success(), "{}", err(&output));
    let found = support::json(&output);
    let names: Vec<_> = found["pictures"].as_array().expect("a list").iter().map(|picture| &picture["name"]).collect();
    assert_eq!(names, ["left.png", "right.png"]);
    assert!(found["settings"].to_string().contains("gp.triangle_ns") && found["same_trace"] == false, "{found}");
    // A changed picture is left out with a warning.
    folder.file("other/right.png", b"another one");
    let output = folder.run(&["diff", "results", "other"]);
    assert!(err(&output).contains("left out") && !out(&output).contains("right.png"), "{}", err(&output));
}
