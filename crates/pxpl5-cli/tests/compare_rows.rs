//! Tests of the finished rows, the length and the precision of `pxpl5 compare`, as a user runs it.

use crate::support::{Folder, err};
use serde_json::Value;

fn with<'a>(more: &[&'a str]) -> Vec<&'a str> {
    let short = "compare --scene full-screen:2 --fields 24 --seeds 2 --only slats,jitp-field,ideal --json";
    short.split(' ').chain(more.iter().copied()).collect()
}

fn read(folder: &Folder, name: &str) -> String {
    std::fs::read_to_string(folder.path.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Returns the comparison of a folder without the times on the host.
fn comparison(folder: &Folder, out: &str) -> Value {
    let mut all: Value = serde_json::from_str(&read(folder, &format!("{out}/comparison.json"))).expect("JSON");
    for row in all["pipelines"].as_array_mut().expect("a list") {
        row["host_seconds"] = Value::Null;
    }
    all
}

/// Leaves the folder in the state after a kill: one complete row, half of a second row, and no results.
fn interrupt(folder: &Folder, out: &str) -> String {
    let rows = read(folder, &format!("{out}/rows/rows.jsonl"));
    let lines: Vec<&str> = rows.split_inclusive('\n').collect();
    assert_eq!(lines.len(), 4, "a header and three rows");
    let kept = [lines[0], lines[1], &lines[2][..lines[2].len() / 2]].concat();
    folder.file(&format!("{out}/rows/rows.jsonl"), kept);
    std::fs::remove_file(folder.path.join(out).join("comparison.json")).expect("written before");
    lines[1].to_owned()
}

#[test]
fn an_interrupted_comparison_resumes_and_writes_the_same_files() {
    let folder = Folder::new();
    let whole = folder.run(&with(&["--out", "whole"]));
    assert!(whole.status.success(), "{}", err(&whole));
    assert!(err(&whole).contains("row 3 of 3, ") && err(&whole).contains(" s to go"), "{}", err(&whole));
    assert!(folder.run(&with(&["--out", "o"])).status.success());
    let kept = interrupt(&folder, "o");
    // Without --resume, the command is refused and the finished rows stay.
    let refused = folder.run(&with(&["--out", "o"]));
    assert_eq!(refused.status.code(), Some(2));
    assert!(
        err(&refused).contains("1 of 3 rows of an interrupted comparison are here; resume the comparison, or choose another folder (--resume)"),
        "{}",
        err(&refused)
    );
    let resumed = folder.run(&with(&["--out", "o", "--resume"]));
    assert!(resumed.status.success(), "{}", err(&resumed));
    assert!(err(&resumed).contains("1 of 3 rows were finished before"), "{}", err(&resumed));
    assert!(read(&folder, "o/rows/rows.jsonl").lines().nth(1) == Some(kept.trim_end()), "the row was not repeated");
    assert_eq!(comparison(&folder, "o"), comparison(&folder, "whole"));
    for name in ["rows.csv", "errors.csv", "error-over-time.svg", "gallery.html"] {
        assert!(read(&folder, &format!("o/{name}")) == read(&folder, &format!("whole/{name}")), "{name}");
    }
    // A complete comparison is replaced as before, and resumed without any run.
    let done = folder.run(&with(&["--out", "o", "--resume"]));
    assert!(done.status.success() && !err(&done).contains("row 3 of 3"), "{}", err(&done));
    assert!(folder.run(&with(&["--out", "o"])).status.success());
}

#[test]
fn resuming_a_comparison_with_other_settings_is_refused_with_the_changed_key() {
    let folder = Folder::new();
    assert!(folder.run(&with(&["--out", "o"])).status.success());
    interrupt(&folder, "o");
    for (more, key) in [
        (&["--set", "machine.gp.triangle_ns=20000"][..], "machine.gp.triangle_ns was not set, expected 20000"),
        (&["--set", "hmd.near=0.1"], "hmd.near was not set, expected 0.1"),
        (&["--confidence", "0.9"], "confidence was 0.95, expected 0.9"),
        (&["--until-precision", "10%"], "max_seeds was none, expected 50"),
        (&["--seed", "3"], "seeds was [1, 2], expected [3, 4]"),
    ] {
        let refused = folder.run(&with(&[&["--out", "o", "--resume"], more].concat()));
        assert_eq!(refused.status.code(), Some(2), "{more:?}");
        assert!(
            err(&refused).contains("rows are of another comparison") && err(&refused).contains(key),
            "{}",
            err(&refused)
        );
    }
    let mut rows = read(&folder, "o/rows/rows.jsonl").replacen("\"pipeline\"", "\"pipelin\"", 1);
    rows.push('\n');
    folder.file("o/rows/rows.jsonl", rows);
    let damaged = folder.run(&with(&["--out", "o", "--resume"]));
    assert!(err(&damaged).contains("rows.jsonl, line 2: expected a row of a comparison"), "{}", err(&damaged));
}

/// Writes a recording of a head that turns back and forth, one pose for each hundredth of a second, from 0 to
/// `hundredths`.
fn recording(folder: &Folder, name: &str, hundredths: u32) {
    let mut text = "time_s,x,y,z,qw,qx,qy,qz\n".to_owned();
    for n in 0..=hundredths {
        let time = f64::from(n) / 100.0;
        let half = (0.2 * (3.0 * time).sin() + 0.05 * (11.0 * time).cos()) / 2.0;
        text += &format!("{time},0,0,0,{},0,{},0\n", half.cos(), half.sin());
    }
    folder.file(name, text);
}

/// A field lasts 1001/60000 s: 2 s hold 119.88 fields, and 120 fields take 2.002 s. 30 s hold 1,798.2 fields.
///
/// Two seconds are too short for an interval, and thirty seconds are more than ten blocks of the swinging head.
#[test]
fn a_recording_determines_the_number_of_fields_and_a_long_recording_gives_an_interval() {
    let folder = Folder::new();
    recording(&folder, "head.csv", 200);
    recording(&folder, "long.csv", 3_000);
    let usual =
        ["compare", "--scene", "full-screen:2", "--only", "slats,jitp-field", "--tracker", "ideal", "--json", "--head"];
    let run = |more: &[&str]| folder.run(&[&usual, more].concat());
    for (more, fields) in [
        (&["head.csv", "--seeds", "1"][..], 119),
        (&["head.csv", "--seeds", "2", "--fields", "120"], 119),
        (&["head.csv", "--seeds", "1", "--fields", "60"], 60),
        (&["head.csv", "--seeds", "1", "--fields", "150", "--set", "head.end=hold"], 150),
        (&["long.csv", "--seeds", "1"], 1_798),
        (&["long.csv", "--seeds", "2", "--fields", "1700"], 1_700),
    ] {
        let output = run(more);
        assert!(output.status.success(), "{}", err(&output));
        let warning = "the recording of the head ends before 120 fields: each run has 119 fields";
        assert_eq!(err(&output).contains(warning), more.contains(&"120"), "{}", err(&output));
        let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        assert_eq!(json["fields"], fields, "{more:?}");
        for row in json["pipelines"].as_array().expect("a list") {
            let mean = &row["error"]["mean_px"];
            // Three quarters of the fields are evaluated, and an interval needs 100 fields.
            if fields * 3 / 4 < 100 {
                assert!(mean["method"] == "none" && mean["low"].is_null() && mean["high"].is_null(), "{row}");
                continue;
            }
            assert_eq!(mean["method"], "student_t_of_parts", "{row}");
            let [low, mean, high] = ["low", "mean", "high"].map(|name| mean[name].as_f64().expect(name));
            assert!(0.0 < low && low < mean && mean < high, "{row}");
        }
    }
    let refused = run(&["head.csv", "--until-precision", "10%"]);
    assert_eq!(refused.status.code(), Some(2));
    assert!(err(&refused).contains("this motion is the same for all seeds"), "{}", err(&refused));
}

#[test]
fn seeds_are_added_until_the_interval_is_narrow_or_the_maximum_is_reached() {
    let folder = Folder::new();
    let usual = ["compare", "--scene", "full-screen:2", "--fields", "24", "--seeds", "2", "--only", "slats", "--json"];
    let run = |more: &[&str]| {
        let output = folder.run(&[&usual, more].concat());
        assert!(output.status.success(), "{}", err(&output));
        let json: Value = serde_json::from_slice(&output.stdout).expect("JSON");
        let row = json["pipelines"][0].clone();
        (row["seeds"].as_u64(), row["is_precise"].as_bool(), row["error"]["mean_px"]["n"].as_u64())
    };
    assert_eq!(run(&[]), (Some(2), None, Some(2)));
    assert_eq!(run(&["--until-precision", "0.001%", "--max-seeds", "5"]), (Some(5), Some(false), Some(5)));
    assert_eq!(run(&["--until-precision", "1e9px"]), (Some(2), Some(true), Some(2)));
    let refused = folder.run(&[&usual, &["--until-precision", "10"][..]].concat());
    assert_eq!(refused.status.code(), Some(2));
    assert!(err(&refused).contains("share of the mean (10%) or in pixels (0.2px)"), "{}", err(&refused));
}

/// Tests rows behind a device that moves pictures by their depths. Errors are smaller, and a row whose pictures it cannot
/// move says so.
#[test]
fn rows_show_their_pictures_through_the_device_of_the_settings() {
    let folder = Folder::new();
    let run = |more: &[&str]| {
        let shared = ["compare", "--only", "slats,arp-full,ideal", "--seeds", "1", "--fields", "60", "--json"];
        let ran = folder.run(&[&shared[..], &["--head", "recorded:vive-dev", "--predict", "none"], more].concat());
        assert!(ran.status.success(), "{}", err(&ran));
        let json: Value = serde_json::from_slice(&ran.stdout).expect("JSON");
        let px = |row: &str| {
            json["pipelines"].as_array().unwrap().iter().find(|one| one["pipeline"] == row).cloned().unwrap()
        };
        ["slats", "ideal", "arp-full"].map(px)
    };
    let mean = |row: &Value| row["error"]["mean_px"]["mean"].as_f64().expect("an error in pixels");
    let [plain, ideal, faces] = run(&[]);
    let [moved, same, refused] = run(&["--raster", "depth"]);
    assert!(mean(&moved) < mean(&plain) && mean(&same) == mean(&ideal), "{moved} {plain}");
    assert!(mean(&faces) > 0.0 && faces["failure"].is_null() && refused["error"]["n"] == 0, "{refused}");
    assert!(refused["failure"].as_str().unwrap().contains("head.raster = depth"), "{refused}");
    // A recording on which the predictor is tuned changes nothing without a predictor.
    assert_eq!(mean(&run(&["--set", "head.train=recorded:vive-tracked"])[0]), mean(&plain));
}

/// Tests the experiment file in the folder of a comparison. It has the overrides and a way to the model, it makes the
/// same comparison again, and after a change of the model it says so.
#[test]
fn the_folder_of_a_comparison_makes_it_again_and_says_when_the_model_has_changed() {
    let folder = Folder::new();
    let model = |z: f32| format!("v -1 0 {z}\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::fs::create_dir(folder.path.join("models")).expect("a folder");
    folder.file("models/tri.obj", model(0.0));
    let run = |more: &[&str]| {
        let shared = ["compare", "--only", "slats", "--seeds", "1", "--json"];
        let ran = folder.run(&[&shared, more].concat());
        assert!(ran.status.success(), "{}", err(&ran));
        let json: Value = serde_json::from_slice(&ran.stdout).expect("JSON");
        (json, err(&ran))
    };
    let set = ["--scene", "models/tri.obj", "--head", "recorded:vive-dev", "--fields", "40", "--out", "o"];
    let (first, _) = run(&[&set[..], &["--set", "machine.gp.triangle_ns=25000"]].concat());
    assert_eq!(first["settings"]["machine.gp.triangle_ns"], "25000");
    let file = read(&folder, "o/experiment.toml");
    assert!(file.contains("gp.triangle_ns = 25000") && file.contains("scene = \"../models/tri.obj\""), "{file}");
    assert!(file.starts_with("# pxpl5 compare experiment.toml --seed 1 --only slats --seeds 1"), "{file}");
    let (again, words) = run(&["o/experiment.toml", "--out", "again"]);
    assert_eq!(again["config_hash"], first["config_hash"]);
    assert_eq!(again["pipelines"][0]["error"], first["pipelines"][0]["error"]);
    assert!(!words.contains("has changed"), "{words}");
    folder.file("models/tri.obj", model(0.5));
    let (_, words) = run(&["o/experiment.toml"]);
    assert!(words.contains("the model of the scene has changed"), "{words}");
}
