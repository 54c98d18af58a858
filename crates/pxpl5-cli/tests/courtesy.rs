//! Tests of help that the user did not ask for: warnings about doubtful numbers, the command to resume after Ctrl-C,
//! and the pipelines that a machine can run.

use crate::support::{Folder, command, err, json, out};
use std::process::Stdio;
use std::time::{Duration, Instant};

const RUN: [&str; 7] = ["run", "--pipeline", "slats", "--scene", "full-screen:4", "--fields", "12"];

fn with<'a>(first: &[&'a str], more: &[&'a str]) -> Vec<&'a str> {
    [first, more].concat()
}

#[test]
fn a_value_outside_its_range_causes_one_warning_with_range_and_source() {
    let folder = Folder::new();
    for (wrong, expected) in [
        (
            &["--set", "gp.triangle_ns=3"][..],
            "gp.triangle_ns = 3 ns is outside its range, 18000 to 32000 ns (derived: ",
        ),
        (
            &["--head", "still", "--tracker", "fastrak", "--set", "tracking.fastrak.position_noise=50"],
            "tracking.fastrak.position_noise = 50 mm is outside its range, 0 to 0.8 mm (assumed: ",
        ),
    ] {
        let output = folder.run(&with(&with(&RUN, wrong), &["--json"]));
        let message = err(&output);
        assert!(message.matches("warning").count() == 1 && message.contains(expected), "{message}");
        let warnings = json(&output)["warnings"].clone();
        assert_eq!(warnings.as_array().map(Vec::len), Some(1), "{warnings}");
        assert!(message.contains(warnings[0].as_str().expect("text")));
    }
    for fine in
        [&["--set", "gp.triangle_ns=20000"][..], &["--code", "optimised"], &["--quiet", "--set", "gp.triangle_ns=3"]]
    {
        assert_eq!(err(&folder.run(&with(&RUN, fine))), "", "{fine:?}");
    }
    let checked = folder.run(&["check", "--pipeline", "slats", "--scene", "mig", "--set", "gp.triangle_ns=3"]);
    assert_eq!(err(&checked).matches("warning").count(), 1);
}

/// Tests that the output attributes times to executed code only if code ran.
#[test]
fn times_of_the_timing_table_at_the_cycle_level_cause_a_warning() {
    let folder = Folder::new();
    let run = |pipeline: &[&str], level: &str| {
        // Pictures of the high-resolution display need more time.
        let fields = if pipeline.contains(&"hires") { "90" } else { "30" };
        let few = ["--scene", "full-screen:4", "--fields", fields, "--level", level];
        let output = folder.run(&[&["run", "--json", "--pipeline"], pipeline, &few].concat());
        let warnings = json(&output)["warnings"].as_array().cloned().unwrap_or_default();
        // Warnings about nearness to a retrace are not in the report, which has the latencies themselves.
        let text = err(&output);
        let printed = text.lines().filter(|line| line.contains("warning") && !line.contains(" field of ")).count();
        assert_eq!(warnings.len(), printed, "{pipeline:?}: {text}");
        assert!(warnings.iter().all(|text| err(&output).contains(text.as_str().expect("text"))));
        warnings.iter().filter(|text| text.as_str().is_some_and(|text| text.contains("no i860 code"))).count()
    };
    let pipeline = ["arp-cells-warp"];
    assert_eq!([run(&pipeline, "transaction"), run(&pipeline, "cycle")], [0, 1], "{pipeline:?}");
    let by_code: [&[&str]; 6] = [
        &["jitp-field"],
        // With strips of one line, no strip is drawn in time by executed code.
        &["jitp-dual-view", "--set", "strip_rows=32"],
        &["frameless"],
        &["slats"],
        &["rendering-control", "--display", "hires"],
        &["arp-cells"],
    ];
    for pipeline in by_code {
        assert_eq!(run(pipeline, "cycle"), 0, "{pipeline:?}");
    }
}

/// Runs a command and interrupts it after at least two seconds, as soon as `is_begun` returns true. The command has then
/// installed its handler.
#[cfg(unix)]
fn interrupted(folder: &Folder, args: &[&str], is_begun: impl Fn() -> bool) -> std::process::Output {
    let mut child = command(args);
    let child = child.current_dir(&folder.path).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let child = child.expect("the command starts");
    let started = Instant::now();
    while started.elapsed() < Duration::from_secs(2) || !is_begun() {
        assert!(started.elapsed() < Duration::from_secs(120), "it does not begin");
        std::thread::sleep(Duration::from_millis(20));
    }
    let interrupt = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(interrupt.expect("there is a kill").success());
    let output = child.wait_with_output().expect("it ends");
    assert_eq!(output.status.code(), Some(130), "{}", err(&output));
    output
}

#[cfg(unix)]
#[test]
fn ctrl_c_of_a_sweep_prints_a_command_that_resumes_the_sweep() {
    let folder = Folder::new();
    folder.file(
        "s.toml",
        "pipeline = \"slats\"\nscene = \"mig\"\nfields = 60\n[sweep.grid]\ntriangles = { from = 1, to = 100 }\nseed = { from = 1, to = 9 }\n",
    );
    let rows = folder.path.join("o/rows.jsonl");
    let output = interrupted(&folder, &["sweep", "s.toml", "--out", "o", "--threads", "1"], || {
        std::fs::read_to_string(&rows).unwrap_or_default().lines().count() >= 3
    });
    assert!(err(&output).contains("pxpl5 sweep s.toml --out o --threads 1 --resume"), "{}", err(&output));
    let kept = std::fs::read_to_string(&rows).expect("rows").lines().count();
    assert!((3..900).contains(&kept), "{kept}");
}

/// Tests that the report of an interrupted run is that of a run of so many fields, at both levels with events. A search
/// has no such part.
#[cfg(unix)]
#[test]
fn an_interrupted_run_reports_the_fields_so_far_and_a_search_says_how_far_it_came() {
    let folder = Folder::new();
    for level in ["transaction", "cycle"] {
        let run = |fields| {
            ["run", "--pipeline", "slats", "--scene", "full-screen:9", "--level", level, "--json", "--fields", fields]
        };
        let output = interrupted(&folder, &with(&run("900000"), &["--out", "o"]), || true);
        let part: serde_json::Value = serde_json::from_slice(&output.stdout).expect("a report");
        let fields = part["fields"].to_string();
        assert!(err(&output).contains(&format!("interrupted after {fields} of 900000 fields")), "{}", err(&output));
        let whole = json(&folder.run(&run(&fields)));
        for key in ["trace_hash", "config_hash", "window", "due", "latency_ms", "events"] {
            assert_eq!(part[key], whole[key], "{level}, {fields} fields: {key}");
        }
        assert!(folder.names().is_empty(), "{:?}", folder.names());
    }
    let search = ["limit", "--pipeline", "slats", "--fields", "3000", "--level", "cycle"];
    let output = interrupted(&folder, &search, || true);
    assert!(output.stdout.is_empty() && err(&output).contains("nothing was written"), "{}", err(&output));
}

#[test]
fn without_fit_a_model_stays_where_its_file_places_it() {
    let folder = Folder::new();
    folder.file("m.obj", "v -1 -1 -5\nv 1 -1 -5\nv 0 1 -5\nf 1 2 3\n");
    let checked = out(&folder.run(&["check", "--pipeline", "slats", "--scene", "m.obj", "--no-fit"]));
    assert!(checked.contains("fit = false"), "{checked}");
    let hash = |text: &str| text.lines().find(|line| line.contains("config_hash")).map(str::to_owned);
    let fitted = out(&folder.run(&["check", "--pipeline", "slats", "--scene", "m.obj"]));
    assert!(!fitted.contains("fit =") && hash(&fitted) != hash(&checked), "{fitted}");
}

/// Tests that every command that computes adds up its cost before it starts: before it allocates memory, and before the
/// first of many runs. The limit that a command exceeds is its last option but one.
#[test]
fn every_command_that_computes_is_estimated_before_it_starts() {
    let folder = Folder::new();
    let file = "pipeline = \"slats\"\nscene = \"mig\"\nfields = 100000\n[sweep.grid]\nseed = { from = 1, to = 1000 }\n";
    folder.file("s.toml", file);
    folder.file("v.toml", "[sweep.grid]\ndisplay.slices = [4096]\ndisplay.height = [4096]\ndisplay.width = [4096]\n");
    let long = "--pipeline slats --scene full-screen:20 --fields 10000000 --pixels off";
    // 4096^3 voxels have 2^36 / 2 bytes: 34 GB.
    let whole = "--set display.slices=4096 --set display.width=4096 --set display.height=4096";
    let mig = "--pipeline slats --scene mig";
    for line in [
        format!("run {long} --out o --max-memory 1000000 --max-seconds 60"),
        format!("trace {long} --out o/t.json --max-memory 1000000 --max-seconds 60"),
        // Memory is the reason for the refusal on a host of any speed.
        format!("trace {long} --out o/t.json --max-seconds 1000000000 --max-memory 200"),
        format!("film {mig} --length 10000 --out f.png --max-seconds 5"),
        format!("film {mig} --length 10000 --out f.png --max-memory 30"),
        "compare --fields 1200 --seeds 1000 --out o --max-seconds 600".to_owned(),
        "limit --pipeline slats --fields 100000 --max-seconds 600".to_owned(),
        format!("volume run --out o {whole} --max-memory 16000"),
        format!("volume sheet --out o.png {whole} --max-memory 16000"),
        format!("volume slice 3 --out o.png {whole} --max-memory 16000"),
        format!("volume view --out o.png {whole} --max-memory 16000"),
        format!("volume film --out o.png {whole} --max-memory 16000"),
        format!("volume compare --out o {whole} --max-memory 16000"),
        "volume run --max-memory 50".to_owned(),
        "volume compare --scene head --threads 1 --max-seconds 1".to_owned(),
        "arp run --set walk.frames=1000000 --max-seconds 10".to_owned(),
        "arp compare --max-memory 20".to_owned(),
        "sweep s.toml --out o --max-seconds 100".to_owned(),
        format!("debug --do quit {mig} --max-memory 1"),
        "rig --pipeline slats --passes 10000 --max-seconds 1".to_owned(),
    ] {
        let args: Vec<&str> = line.split(' ').collect();
        let output = folder.run(&args);
        let text = err(&output);
        assert_eq!(output.status.code(), Some(1), "{line}: {text}");
        assert!(text.contains("expected to take") && text.contains(args[args.len() - 2]), "{line}: {text}");
        assert_eq!(folder.names(), ["s.toml", "v.toml"], "{line}");
    }
    // A sweep point of volumes that is too large fails alone. Here it is the only point.
    let output = folder.run(&["volume", "sweep", "v.toml", "--out", "o"]);
    assert_eq!(output.status.code(), Some(1), "{}", err(&output));
    assert!(err(&output).contains("expected to take 3"), "{}", err(&output));
}

#[test]
fn a_scene_too_heavy_to_be_shown_is_reported_before_the_run() {
    let folder = Folder::new();
    let heavy = |pipeline: &str, scene: &str, fields: &str| {
        let args = ["run", "--pipeline", pipeline, "--scene", scene, "--fields", fields, "--pixels", "off"];
        let output = folder.run(&[&args[..], &["--max-seconds", "1000", "--set", "gp.bin_bytes=1000000"]].concat());
        let message = err(&output);
        (message.lines().find(|line| line.contains("warning: TOO HEAVY")).map(str::to_owned), output.status.code())
    };
    // A frame of 20,000 triangles that cover the screen takes at least 70 fields.
    let (message, code) = heavy("rendering-control", "full-screen:20000", "60");
    let message = message.expect("a warning");
    assert!(
        message.contains("20000 primitives on 13 graphics processors") && message.contains("60 fields"),
        "{message}"
    );
    assert_eq!(code, Some(1));
    // This pipeline has no closed form. 100,000 triangles of 21.7 us on 13 processors take 10 fields.
    let (message, _) = heavy("jitp-field", "typical:100000", "5");
    assert!(message.is_some_and(|message| message.contains("to transform the whole scene once")));
    for (pipeline, scene, fields) in [("rendering-control", "full-screen:12", "30"), ("slats", "full-screen:12", "30")]
    {
        assert_eq!(heavy(pipeline, scene, fields).0, None, "{pipeline} {scene}");
    }
}

#[test]
fn a_request_for_more_triangles_than_a_scene_has_keeps_all_triangles() {
    let folder = Folder::new();
    let report = |more: &[&str]| json(&folder.run(&[&RUN[..], &["--json"], more].concat()));
    let (whole, more) = (report(&[]), report(&["--triangles", "60"]));
    assert_eq!((&more["triangles"], &more["trace_hash"]), (&4.into(), &whole["trace_hash"]));
    assert_eq!(
        json(&folder.run(&["volume", "run", "--scene", "full-screen:4", "--triangles", "60", "--json"]))["triangles"],
        4
    );
}

/// Tests that XML documents contain no control characters, wherever text of the user appears.
#[cfg(unix)]
#[test]
fn labels_with_control_characters_give_valid_drawings() {
    let folder = Folder::new();
    folder.file("m\u{1}\u{7f}\u{85}.obj", "v -1 -1 -5\nv 1 -1 -5\nv 0 1 -5\nf 1 2 3\n");
    let run =
        ["run", "--pipeline", "slats", "--scene", "m\u{1}\u{7f}\u{85}.obj", "--fields", "12", "--quiet", "--out", "o"];
    assert!(folder.run(&run).status.success());
    folder.file(
        "s.toml",
        "title = \"a\\u0001b\"\npipeline = \"slats\"\nscene = \"full-screen:2\"\nfields = 12\n[sweep.grid]\nseed = [1, 2]\n",
    );
    assert!(folder.run(&["sweep", "s.toml", "--out", "p", "--quiet"]).status.success());
    let plot = ["plot", "p", "--x", "seed", "--y", "latency_ms.mean", "--out", "p/f.svg", "--title", "a\u{1}b\u{b}"];
    let output = folder.run(&[&plot[..], &["--x-label", "\u{1b}[1m", "--y-label", "\u{7f}\u{9f}"]].concat());
    assert!(output.status.success(), "{}", err(&output));
    for name in ["o/timeline.svg", "p/f.svg"] {
        let svg = std::fs::read_to_string(folder.path.join(name)).expect("written");
        let bad = svg.chars().find(|c| c.is_control() && !"\n\t".contains(*c));
        assert_eq!(bad, None, "{name}");
    }
}

#[test]
fn unusual_settings_run_without_a_panic() {
    let folder = Folder::new();
    let run = |pipeline: &str, set: &str| {
        let args =
            ["run", "--pipeline", pipeline, "--scene", "full-screen:4", "--fields", "12", "--quiet", "--set", set];
        let output = folder.run(&args);
        let text = err(&output);
        assert!(matches!(output.status.code(), Some(0..=2)) && !text.contains("panicked"), "{set}: {text}");
    };
    run("slats", "video.pixel_ps=4294967295");
    for lines in [1, 6] {
        run("jitp-dual-screen", &format!("video.visible_lines={lines}"));
        run("jitp-dual-view", &format!("video.visible_lines={lines}"));
    }
}
