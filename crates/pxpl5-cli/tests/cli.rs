//! Tests of the command as a user runs it: results on standard output, complete files, and helpful messages.

use crate::support::{Folder, command, err, json, names, out};
use std::path::Path;
use std::process::Stdio;

const SLATS: [&str; 7] = ["run", "--pipeline", "slats", "--scene", "full-screen:10", "--fields", "12"];
fn with<'a>(first: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [first, more].concat()
}

#[test]
fn a_run_prints_one_object_with_units_in_its_names() {
    let folder = Folder::new();
    let report = json(&folder.run(&with(&SLATS, &["--json", "--seed", "7"])));
    assert_eq!(report["schema"], "pxpl5-report/3");
    assert_eq!((&report["pipeline"], &report["machine"]), (&"slats".into(), &"slats".into()));
    assert_eq!((&report["scene"], &report["triangles"]), (&"full-screen:10".into(), &10.into()));
    assert_eq!((&report["spheres"], &report["fields"], &report["seed"]), (&0.into(), &12.into(), &7.into()));
    // TR94, I3D95: Slats has a latency of one field, 1001/60 ms.
    for (key, one_field) in [("latency_fields", 1.0), ("latency_ms", 1001.0 / 60.0)] {
        for part in ["mean", "min", "max"] {
            let value = report[key][part].as_f64().expect("a number");
            assert!((value / one_field - 1.0).abs() < 1e-6, "{key}.{part} = {value}");
        }
        assert_eq!(report[key]["n"], report["pictures"]);
        assert!(report[key]["sd"].is_number() && report[key]["definition"].is_string());
    }
    assert!(report["updates_hz"].is_number() && report["host_seconds"].is_number());
    assert_eq!((&report["missed_retraces"], &report["too_heavy"]), (&0.into(), &serde_json::Value::Null));
    assert_eq!(report["trace_hash"].as_str().map(str::len), Some(16));
}

#[test]
fn a_run_that_shows_nothing_fails_with_a_message() {
    // Slats shows every field, and none of these fields is complete in time.
    let folder = Folder::new();
    let late = ["run", "--pipeline", "slats", "--scene", "full-screen:1000", "--fields", "60", "--pixels", "off"];
    let output = folder.run(&with(&late, &["--json"]));
    assert_eq!(output.status.code(), Some(1));
    assert!(err(&output).contains("no complete picture was shown in 60 fields"), "{}", err(&output));
    let report = json_of(&output);
    assert_eq!((&report["shown"], &report["updates_hz"]), (&0.into(), &serde_json::Value::Null));
    assert!(report["too_heavy"]["primitives_in_time"].as_u64() > Some(100));
    assert_eq!(report["ends_complete"], false);
}

#[test]
fn a_run_that_is_too_short_prints_its_partial_results() {
    let folder = Folder::new();
    let short = "run --pipeline rendering-control --scene full-screen:20000 --pixels off --fields 60";
    // The slaves have room for the bins of both eyes.
    let text = folder.run(&short.split(' ').chain(["--set", "gp.bin_bytes=400000"]).collect::<Vec<_>>());
    assert_eq!(text.status.code(), Some(1));
    let words = out(&text).split_whitespace().collect::<Vec<_>>().join(" ");
    for part in ["fields simulated 60", "latency, fields: mean - ", "not shown in time", "TOO HEAVY"] {
        assert!(words.contains(part), "{part}: {words}");
    }
}

/// Returns the JSON object that a command printed to standard output, for any exit code.
fn json_of(output: &std::process::Output) -> serde_json::Value {
    serde_json::from_str(&out(output)).expect("one object")
}

fn read(folder: &Path, name: &str) -> Vec<u8> {
    std::fs::read(folder.join(name)).expect("written")
}

#[test]
fn result_files_state_their_origin_and_tables_begin_with_column_names() {
    let folder = Folder::new();
    let report = json(&folder.run(&with(&SLATS, &["--json", "--out", "a/b", "--set", "gp.triangle_ns=31000"])));
    // With the feature `parquet` there is also a Parquet file.
    let names: Vec<String> = names(&folder.path.join("a/b")).into_iter().filter(|n| !n.ends_with(".parquet")).collect();
    let tables = "experiment.toml left.png manifest.json pictures.csv report.json results.csv right.png timeline.svg";
    assert_eq!(names.join(" "), tables);
    let written = folder.path.join("a/b");
    let hash = report["config_hash"].as_str().expect("a hash");
    let text = |name: &str| String::from_utf8(read(&written, name)).expect("text");
    let config_hash = format!("# config_hash: {hash}");
    let expected = ["# machine: slats", &config_hash, "# version: 0.1.0", "# level: transaction", "# seed: 1"];
    assert_eq!(text("experiment.toml").lines().take(5).collect::<Vec<_>>(), expected);
    // Tables open in other programs without options: names, then rows. The other files state the origin of the
    // tables.
    assert!(text("results.csv").starts_with("quantity,value,definition\n"));
    assert!(text("pictures.csv").starts_with("picture,steady,complete,"));
    let saved: serde_json::Value = serde_json::from_slice(&read(&written, "report.json")).expect("JSON");
    let keys: Vec<&str> = saved.as_object().expect("an object").keys().map(String::as_str).take(7).collect();
    assert_eq!(keys, ["schema", "version", "commit", "machine", "config_hash", "level", "seed"]);
    assert_eq!(saved["overrides"]["gp.triangle_ns"], 31_000);
    let svg = String::from_utf8(read(&written, "timeline.svg")).expect("text");
    assert!(svg.find(hash).is_some_and(|at| at < svg.find("<svg").expect("a drawing")), "the origin comes first");
    let png = read(&written, "left.png");
    assert!(png.windows(hash.len()).any(|part| part == hash.as_bytes()), "the picture names its configuration");
    assert!(image::load_from_memory(&png).is_ok(), "the picture can be read");
}

#[test]
fn run_prints_a_table_to_standard_output_and_with_quiet_prints_nothing() {
    let folder = Folder::new();
    let output = folder.run(&SLATS);
    assert!(output.status.success() && err(&output).is_empty());
    let text = out(&output);
    for part in ["pipeline", "slats", "full-screen:10", "10 triangles", "1.00, sd 0.00, n", "not shown in time"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert!(!text.contains('\u{1b}'), "no colour where there is no terminal");
    let output = folder.run(&with(&SLATS, &["--quiet"]));
    assert!(output.status.success() && out(&output).is_empty() && err(&output).is_empty());
}

#[test]
fn lists_name_all_built_in_items() {
    let folder = Folder::new();
    let scenes = json(&folder.run(&["scenes", "--json"]));
    let names: Vec<_> = scenes["scenes"].as_array().expect("a list").iter().map(|scene| &scene["name"]).collect();
    let of_one_size = ["aircraft", "mig", "molecules", "head", "room", "gallery", "gallery:full"];
    let expected = [&of_one_size[..], &["full-screen:N", "typical:N", "sphere:N"]].concat();
    assert_eq!(names, expected);
    let machines = json(&folder.run(&["machines", "--json"]));
    // TR94: 13 GPs and 5 renderers.
    let small =
        machines["machines"].as_array().expect("a list").iter().find(|m| m["name"] == "small-hmd").expect("listed");
    assert_eq!((&small["n_gps"], &small["n_renderers"]), (&13.into(), &5.into()));
    let slats = json(&folder.run(&["machines", "slats", "--json"]));
    assert!(
        slats["parameters"].as_array().expect("a list").iter().any(|p| p["path"] == "ring.word_ns" && p["value"] == 50)
    );
}

#[test]
fn an_experiment_file_reaches_every_setting() {
    let folder = Folder::new();
    folder.file(
        "e.toml",
        "pipeline = \"slats\"\nscene = \"mig\"\ntriangles = 50\nfields = 12\n[machine]\ngp.triangle_ns = 20_000\n",
    );
    let report = json(&folder.run(&["run", "e.toml", "--set", "copy=whole", "--fields", "14", "--json"]));
    assert_eq!((&report["triangles"], &report["fields"]), (&50.into(), &14.into()));
    assert!(report["variant"].as_str().expect("text").contains("copy=whole"));
    assert_eq!(report["overrides"]["gp.triangle_ns"], 20_000);
}

#[test]
fn check_prints_an_equivalent_file() {
    let folder = Folder::new();
    let args = ["--pipeline", "rendering-control", "--scene", "mig", "--mono", "--set", "ring.hop_ns=100"];
    let once = out(&folder.run(&with(&["check"], &args)));
    assert!(once.contains("ring.hop_ns = 100  # ns, assumed; the preset has 50"), "{once}");
    folder.file("once.toml", &once);
    let twice = out(&folder.run(&["check", "once.toml"]));
    assert_eq!(once, twice);
}

#[cfg(unix)]
#[test]
fn a_closed_pipe_is_no_error() {
    for args in [&["machines"][..], &["scenes"], &["--help"], &["completions", "bash"]] {
        let mut child =
            command(args).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts");
        drop(child.stdout.take());
        let output = child.wait_with_output().expect("it ends");
        assert!(output.status.success(), "{args:?}: {}", err(&output));
        assert_eq!(err(&output), "");
    }
}

#[test]
fn help_shows_examples_and_completions_have_the_options() {
    let folder = Folder::new();
    for args in
        [&["--help"][..], &["run", "--help"], &["check", "--help"], &["demo", "--help"], &["machines", "--help"]]
    {
        let text = out(&folder.run(args));
        assert!(text.contains("Example"), "{args:?}: {text}");
    }
    for shell in ["bash", "zsh", "fish", "powershell", "elvish"] {
        assert!(out(&folder.run(&["completions", shell])).contains("triangles"), "{shell}");
    }
}

#[test]
fn without_arguments_the_command_runs_both_pipelines_and_writes_pictures() {
    let folder = Folder::new();
    let output = folder.run(&[]);
    assert!(output.status.success(), "{}", err(&output));
    let text = out(&output);
    for part in "rendering-control|slats|full-screen:12|mig|417 triangles|aircraft|100 triangles|56.5|76.91".split('|')
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    let report: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.path.join("out/report.json")).expect("written")).expect("JSON");
    assert_eq!(report["runs"][0]["name"], "rendering-control-mig", "the scene first, the plain rectangle last");
    for run in report["runs"].as_array().expect("a list") {
        assert!(run["report"]["fields"].as_u64().expect("a number") >= 120);
        assert_agrees_with_accuracy(&run["published"]);
        let timeline = format!("out/{}-timeline.svg", run["name"].as_str().expect("text"));
        assert!(std::fs::read_to_string(folder.path.join(timeline)).expect("written").contains("</svg>"));
        for eye in ["left", "right"] {
            let name = format!("out/{}-{eye}.png", run["name"].as_str().expect("text"));
            let picture = image::open(folder.path.join(&name)).expect("a picture").to_rgb8();
            assert_eq!((picture.width(), picture.height()), (640, 480), "{name}");
            // Background colours of the two scenes. Twelve triangles cover the screen, and an aircraft covers part of
            // the sky.
            let is_flight = name.contains("mig") || name.contains("aircraft");
            let (empty, least) = if is_flight { ([92, 140, 200], 5_000) } else { ([16, 24, 48], 640 * 480) };
            let drawn = picture.pixels().filter(|pixel| pixel.0 != empty).count();
            assert!(drawn >= least, "{name}: {drawn} pixels");
        }
    }
    assert!(folder.run(&["report", "out", "--quiet", "--write", "page.html"]).status.success());
    let page = String::from_utf8(read(&folder.path, "page.html")).expect("text");
    assert_eq!((page.matches("<h2>").count(), page.matches("data:image/png;base64,").count()), (3, 6));
    assert!(page.contains("figure 9, TR94, I3D95"));
}

/// Returns the names and texts of the repository's experiment files.
fn experiments() -> Vec<(String, String)> {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../experiments");
    let files = names(&folder).into_iter().filter(|name| name.ends_with(".toml"));
    files.map(|name| (name.clone(), std::fs::read_to_string(folder.join(&name)).expect("text"))).collect()
}

#[test]
fn every_experiment_file_is_valid_and_every_reproducible_figure_has_an_experiment_file() {
    let mut figures = std::collections::BTreeSet::new();
    for (name, text) in experiments() {
        let file = pxpl5::ExperimentFile::parse(&text, &name).expect("valid");
        let plan = match file.is_sweep() {
            false => file.resolve().expect("an experiment"),
            true => {
                let sweep = pxpl5::sweep::Sweep::new(file).expect("a sweep");
                sweep.plan(sweep.space().points() - 1).expect("an experiment")
            }
        };
        plan.load_scene().expect("a scene");
        figures.extend(name.strip_prefix("figure-").map(|rest| rest[..2].to_owned()));
    }
    // Figure 8 is a property of scenes, so no run reproduces it.
    let expected = (1..=99).filter(|n| pxpl5::figures::has_file(&n.to_string())).map(|n| format!("{n:02}"));
    assert_eq!(figures, expected.collect());
}

/// Returns the published and the simulated value of a figure, as ACCURACY.md prints them.
fn accuracy(id: &str) -> (f64, f64) {
    let document = include_str!("../../../ACCURACY.md");
    let row = document.lines().find(|line| line.starts_with(&format!("| {id} |"))).expect("a row");
    let cells: Vec<&str> = row.split('|').map(str::trim).collect();
    let number = |cell: &str| cell.split_whitespace().next().and_then(|n| n.parse().ok()).expect("a number");
    (number(cells[3]), number(cells[4]))
}

/// Asserts that an experiment file reproduces its figure as in ACCURACY.md, on the same machine and by the same
/// quantity.
fn assert_agrees_with_accuracy(published: &serde_json::Value) {
    let id = published["source"].as_str().and_then(|source| source.strip_prefix("figure ")?.split(',').next());
    let (printed, found) = accuracy(id.expect("a figure"));
    let [value, simulated] = ["published", "simulated"].map(|name| published[name].as_f64().expect("a number"));
    // Shares are compared, because the units may differ: ACCURACY.md has figure 7 in fields.
    assert!((simulated / value / (found / printed) - 1.0).abs() < 0.002, "{published}: in ACCURACY.md {found}");
}

/// Beginning of the comment in an experiment file that explains a difference from ACCURACY.md.
const DIFFERS: &str = "# Not the number of ACCURACY.md: ";

#[test]
fn the_files_of_figures_agree_with_accuracy_md_or_state_the_reason() {
    for (name, text) in experiments() {
        let file = pxpl5::ExperimentFile::parse(&text, &name).expect("valid");
        if file.is_sweep() || text.contains(DIFFERS) {
            continue;
        }
        let plan = file.resolve().expect("an experiment");
        let published = plan.published.clone().expect("a figure");
        let id = published.figure.expect("its number").to_string();
        let results = plan.run(plan.load_scene().expect("a scene")).expect("it runs");
        let simulated = published.quantity.of(&results).expect("measured");
        // Errors are compared instead of values, because the units may differ: ACCURACY.md has figure 10 in region
        // times. Four digits are printed there.
        let (printed, found) = accuracy(&id);
        let here = simulated / published.value;
        let there = found / printed;
        assert!((here / there - 1.0).abs() < 0.001, "{name}: {here} of the published value, in ACCURACY.md {there}");
    }
}

/// Tests a scene that needs only one update: a still ball in front of a still head, on a display that turns cube faces.
#[test]
fn a_scene_that_is_drawn_once_counts_as_shown_and_has_no_update_rate() {
    let folder = Folder::new();
    let still = ["--scene", "sphere:1000", "--set", "head.path=still", "--set", "head.sway=0"];
    for pipeline in ["arp-priority", "arp-cells"] {
        for fields in ["60", "200"] {
            let run = ["run", "--pipeline", pipeline, "--fields", fields, "--pixels", "off", "--json"];
            let output = folder.run(&with(&run, &still));
            assert_eq!(output.status.code(), Some(1), "{pipeline} has no latency");
            assert!(err(&output).contains("a head that moves"), "{}", err(&output));
            let report = json_of(&output);
            assert!(report["shown"].as_u64() > Some(0) && report["updates_hz"].is_null(), "{pipeline}: {report}");
            let memories = report["arp"]["memories"].as_array().expect("a list");
            assert!(memories.iter().all(|memory| memory["updates_hz"].is_null()), "{pipeline}: {memories:?}");
        }
        let output = folder.run(&with(&["limit", "--pipeline", pipeline], &still));
        assert_eq!(output.status.code(), Some(2), "{}", out(&output));
        assert!(err(&output).contains("expected a scene with a rate of updates"), "{}", err(&output));
    }
}
