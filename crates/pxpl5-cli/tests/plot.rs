//! Tests of `pxpl5 plot` as a user runs it, on rows whose means were computed by hand.

use crate::support::{Folder, err, out};
use serde_json::{Value, json};

/// Writes a sweep of three seeds at three points of two curves. `measured` returns the values of each point.
fn sweep(folder: &Folder, measured: impl Fn(&str, u64, u64) -> Value) {
    let axes =
        [("copy", json!([["whole"], ["split"]])), ("n", json!([[1], [2], [4]])), ("seed", json!([[1], [2], [3]]))];
    let axes: Vec<Value> = axes.iter().map(|(path, steps)| json!({"paths": [path], "steps": steps})).collect();
    let mut text = json!({"schema": "pxpl5-sweep/1", "points": 18, "title": "t", "axes": axes}).to_string() + "\n";
    for copy in ["whole", "split"] {
        for n in [1, 2, 4] {
            for seed in [1, 2, 3] {
                let row = json!({
                    "point": 0, "status": "done", "parameters": {"copy": copy, "n": n, "seed": seed},
                    "measured": {"latency": measured(copy, n, seed)}, "error": null
                });
                text += &(row.to_string() + "\n");
            }
        }
    }
    folder.file("rows.jsonl", text);
}

/// Tests mean and interval. The values are 1, 2, 3 plus ten times the x value: mean 2, standard deviation 1. For two
/// degrees of freedom the 97.5th percentile of Student's t is 4.302653 (any table). Half of the interval is therefore
/// 4.302653 / sqrt(3) = 2.484138.
#[test]
fn a_plot_computes_means_deviations_and_intervals_over_the_seeds() {
    let folder = Folder::new();
    sweep(&folder, |copy, n, seed| json!(10 * n + seed + if copy == "split" { 100 } else { 0 }));
    let run = folder.run(&["plot", ".", "--x", "n", "--y", "latency", "--by", "copy", "--out", "fig.svg"]);
    assert!(run.status.success(), "{}", err(&run));
    assert!(out(&run).contains("6 places"), "{}", out(&run));
    assert_eq!(folder.names(), ["fig.csv", "fig.json", "fig.svg", "rows.jsonl"]);
    let table = std::fs::read_to_string(folder.path.join("fig.csv")).expect("written");
    let mut lines = table.lines();
    assert_eq!(lines.next(), Some("copy,n,mean,sd,n,low,high,missing,pictures_due,missed_retraces,samples"));
    for (line, (copy, n, mean)) in lines.by_ref().zip([
        ("whole", "1", 12.0),
        ("whole", "2", 22.0),
        ("whole", "4", 42.0),
        ("split", "1", 112.0),
        ("split", "2", 122.0),
        ("split", "4", 142.0),
    ]) {
        let cells: Vec<&str> = line.split(',').collect();
        assert_eq!((cells[0], cells[1], cells[4], cells[7]), (copy, n, "3", "0"), "{line}");
        let number = |i: usize| cells[i].parse::<f64>().expect("a number");
        // Positive values have the interval of their logarithm: from mean / exp(half / mean) to mean x exp(half /
        // mean).
        let factor = (2.484_138f64 / mean).exp();
        let expected = [mean, 1.0, mean / factor, mean * factor];
        for (found, expected) in [2, 3, 5, 6].map(number).into_iter().zip(expected) {
            assert!((found - expected).abs() < 1e-5, "{line}: {expected}");
        }
    }
    let origin: Value =
        serde_json::from_slice(&std::fs::read(folder.path.join("fig.json")).expect("written")).expect("JSON");
    assert_eq!((&origin["about"]["title"], &origin["by"]), (&json!("t"), &json!(["copy"])));
    let svg = std::fs::read_to_string(folder.path.join("fig.svg")).expect("written");
    assert!(svg.contains("width=\"84mm\"") && svg.contains("whole") && svg.contains("split"));
    // The chart has two bands, two curves and their samples in the legend.
    assert_eq!(svg.matches("<polygon").count(), 2 + 4, "and the triangles of the second curve with its sample");
}

#[test]
fn a_plot_leaves_out_results_that_are_null() {
    let folder = Folder::new();
    sweep(&folder, |copy, n, seed| if (copy, n) == ("split", 4) || seed == 3 { Value::Null } else { json!(seed) });
    let run = folder.run(&["plot", "rows.jsonl", "--x", "n", "--y", "latency", "--by", "copy", "--out", "fig.svg"]);
    assert!(run.status.success(), "{}", err(&run));
    assert!(err(&run).contains("8 rows have no number"), "{}", err(&run));
    let table = std::fs::read_to_string(folder.path.join("fig.csv")).expect("written");
    assert!(table.ends_with("split,4,,,0,,,3,,,\n"), "{table}");
    assert!(table.contains("whole,1,1.5,"), "{table}");
    // A curve without a point has no name in the legend.
    sweep(&folder, |copy, _, seed| if copy == "split" { Value::Null } else { json!(seed) });
    let run = folder.run(&["plot", ".", "--x", "n", "--y", "latency", "--by", "copy", "--out", "one.svg"]);
    assert!(run.status.success(), "{}", err(&run));
    let svg = std::fs::read_to_string(folder.path.join("one.svg")).expect("written");
    assert!(svg.contains("whole") && !svg.contains("split"), "{svg}");
    sweep(&folder, |_, _, _| Value::Null);
    let run = folder.run(&["plot", ".", "--x", "n", "--y", "latency", "--by", "copy", "--out", "none.svg"]);
    assert_eq!(run.status.code(), Some(1));
    assert!(err(&run).contains("none of 18 rows has a number") && !folder.names().contains(&"none.svg".to_owned()));
}

/// Tests the size of figures. 84 mm are 992 dots of 1/300 inch, and 238.11 points of 1/72 inch.
#[cfg(feature = "print")]
#[test]
fn a_figure_has_the_stated_width_in_every_format() {
    let folder = Folder::new();
    sweep(&folder, |_, n, seed| json!(n * seed));
    for name in ["fig.png", "fig.pdf"] {
        let run = folder.run(&["plot", ".", "--x", "n", "--y", "latency", "--by", "copy", "--out", name]);
        assert!(run.status.success(), "{}", err(&run));
    }
    let picture = image::open(folder.path.join("fig.png")).expect("a picture").into_rgb8();
    assert_eq!(picture.width(), 992);
    let dark = picture.pixels().filter(|pixel| pixel.0.iter().all(|value| *value < 64)).count();
    assert!(dark > 2_000, "axes, names and a black curve, not {dark} dots: is there a typeface?");
    let pdf = std::fs::read(folder.path.join("fig.pdf")).expect("written");
    assert!(pdf.starts_with(b"%PDF"));
    let text = String::from_utf8_lossy(&pdf);
    let rest = text.split_once("/MediaBox [0 0 ").expect("a page").1;
    let width: f64 = rest.split(' ').next().and_then(|width| width.parse().ok()).expect("a number");
    assert!((width - 84.0 / 25.4 * 72.0).abs() < 0.1, "{width}");
}

#[cfg(not(feature = "print"))]
#[test]
fn pdf_without_its_feature_is_refused_with_the_command_that_builds_it() {
    let folder = Folder::new();
    sweep(&folder, |_, n, seed| json!(n * seed));
    let run = folder.run(&["plot", ".", "--x", "n", "--y", "latency", "--by", "copy", "--out", "fig.pdf"]);
    assert_eq!(run.status.code(), Some(2));
    assert!(err(&run).contains("cargo build --release -p pxpl5-cli --features print"), "{}", err(&run));
    assert_eq!(folder.names(), ["rows.jsonl"]);
}

#[test]
fn an_invalid_request_is_reported_and_nothing_is_written() {
    let folder = Folder::new();
    sweep(&folder, |_, n, _| json!(n));
    for (arguments, says) in [
        (["--x", "n", "--y", "latncy", "--out", "a.svg"], "did you mean `latency`?"),
        (
            ["--x", "n", "--y", "latency", "--out", "a.svg"],
            "copy varies too (split, whole): draw a curve for each with --by copy",
        ),
        (["--x", "n", "--y", "latency", "--out", "a.gif"], "ends in .svg, .png or .pdf, found a.gif"),
        (["--x", "n", "--y", "latency", "--width", "7"], "expected 40 to 400 millimetres, found 7"),
        (["--x", "n", "--y", "latency", "--where", "copy"], "expected COLUMN=VALUE, found copy"),
    ] {
        let run = folder.run(&[&["plot", "."], &arguments[..]].concat());
        assert_eq!(run.status.code(), Some(2), "{arguments:?}: {}", err(&run));
        assert!(err(&run).contains(says), "{}", err(&run));
    }
    assert_eq!(folder.names(), ["rows.jsonl"]);
    let run = folder.run(&["plot", "/", "--x", "n", "--y", "latency", "--out", "a.svg"]);
    assert!(err(&run).contains("neither rows.jsonl nor comparison.json"), "{}", err(&run));
    let chosen = ["plot", ".", "--x", "n", "--y", "latency", "--where", "copy=split", "--out", "a.svg"];
    assert!(folder.run(&chosen).status.success());
    let over = ["plot", ".", "--x", "n", "--y", "latency", "--band", "seed,copy", "--out", "b.svg"];
    assert!(folder.run(&over).status.success());
    assert!(std::fs::read_to_string(folder.path.join("b.csv")).expect("written").contains("\n1,1,0,6,"));
}

/// Tests a plot of a comparison. Each of its rows is a mean over seeds with an interval.
#[test]
fn a_plot_of_a_comparison_has_one_point_for_each_pipeline() {
    let folder = Folder::new();
    let row = |name: &str, ms: f64, px: f64| json!({"pipeline": name, "head_to_light_ms": {"mean": ms}, "error": {"mean_px": {"mean": px, "low": px - 1.0, "high": px + 1.0, "n": 5}}});
    let comparison = json!({"schema": "pxpl5-comparison/2", "scene": "mig", "pipelines": [row("slats", 50.0, 8.0), row("jitp-field", 40.0, 7.0)]});
    folder.file("comparison.json", comparison.to_string());
    let run =
        folder.run(&["plot", ".", "--x", "head_to_light_ms.mean", "--y", "error.mean_px.mean", "--out", "fig.svg"]);
    assert!(run.status.success(), "{}", err(&run));
    let table = std::fs::read_to_string(folder.path.join("fig.csv")).expect("written");
    assert_eq!(
        table,
        "pipeline,head_to_light_ms.mean,mean,sd,n,low,high,missing,pictures_due,missed_retraces,samples\n\
         slats,50.0,8,,5,7,9,0,,,\njitp-field,40.0,7,,5,6,8,0,,,\n"
    );
}

/// Returns the number of hollow circles (if `is_hollow` is true) or of filled circles in a figure.
fn circles(svg: &str, is_hollow: bool) -> usize {
    svg.lines().filter(|line| line.contains("<circle") && line.contains("fill=\"none\"") == is_hollow).count()
}

#[test]
fn a_plotted_point_with_missed_pictures_is_hollow_and_has_its_counts_in_the_table() {
    let folder = Folder::new();
    let axes = json!([{"paths": ["n"], "steps": [[1], [2]]}, {"paths": ["seed"], "steps": [[1], [2]]}]);
    let mut text = json!({"schema": "pxpl5-sweep/1", "points": 4, "title": "t", "axes": axes}).to_string() + "\n";
    for (n, seed, missed) in [(1, 1, 0), (1, 2, 0), (2, 1, 0), (2, 2, 7)] {
        let measured = json!({"error_px.mean": 3.0 + f64::from(seed), "pictures_due": 20, "missed_retraces": missed, "error_px.n": 500});
        let parameters = json!({"n": n, "seed": seed});
        let row = json!({"point": 0, "status": "done", "parameters": parameters, "measured": measured, "error": null});
        text += &(row.to_string() + "\n");
    }
    folder.file("rows.jsonl", text);
    let run = folder.run(&["plot", ".", "--x", "n", "--y", "error_px.mean", "--band", "seed", "--out", "fig.svg"]);
    assert!(run.status.success(), "{}", err(&run));
    let table = std::fs::read_to_string(folder.path.join("fig.csv")).expect("written");
    let ends: Vec<&str> = table.lines().map(|line| line.splitn(7, ',').last().unwrap_or_default()).collect();
    assert_eq!(ends, ["missing,pictures_due,missed_retraces,samples", "0,40,0,1000", "0,40,7,1000"], "{table}");
    let svg = std::fs::read_to_string(folder.path.join("fig.svg")).expect("written");
    assert_eq!(circles(&svg, true), 1, "{svg}");
}

#[test]
fn finished_rows_of_an_unfinished_comparison_can_be_drawn() {
    let folder = Folder::new();
    let row = |name: &str, px: f64, missed: u64| {
        let error = json!({"mean_px": {"mean": px, "low": px - 1.0, "high": px + 1.0, "n": 5}, "n": 100});
        json!({"row": {"pipeline": name, "pictures_due": 9, "missed_retraces": missed, "error": error}, "by_field": [], "picture": null})
    };
    let header = json!({"schema": "pxpl5-comparison-rows/2", "rows": ["slats", "vdrt", "ideal"]});
    std::fs::create_dir(folder.path.join("rows")).expect("made");
    folder.file("rows/rows.jsonl", format!("{header}\n{}\n{}\n{{\"row\": ", row("slats", 8.0, 0), row("vdrt", 7.0, 2)));
    let run = folder.run(&["plot", ".", "--x", "pipeline", "--y", "error.mean_px.mean", "--out", "fig.svg"]);
    assert!(run.status.success(), "{}", err(&run));
    let table = std::fs::read_to_string(folder.path.join("fig.csv")).expect("written");
    assert!(table.contains("slats,slats,8,,5,7,9,0,9,0,100\nvdrt,vdrt,7,,5,6,8,0,9,2,100\n"), "{table}");
}
