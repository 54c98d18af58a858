//! `pxpl5 compare` as a user starts it.

use std::path::PathBuf;
use std::process::{Command, Output};

fn compare(arguments: &[&str]) -> Output {
    let output = Command::new(env!("CARGO_BIN_EXE_pxpl5")).arg("compare").args(arguments).output();
    output.expect("the command is built")
}

fn folder(name: &str) -> PathBuf {
    let path = std::env::temp_dir().join(format!("pxpl5-compare-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&path);
    path
}

#[test]
fn json_lists_a_row_for_each_pipeline_with_latency_error_updates_and_triangles() {
    let output = compare(&["--motion", "pan:200", "--scene", "full-screen:2", "--fields", "24", "--json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON and nothing else");
    let rows = json["pipelines"].as_array().expect("a list");
    let names: Vec<_> = rows.iter().filter_map(|row| row["pipeline"].as_str()).collect();
    for name in ["rendering-control", "slats", "vdrt", "frameless", "ideal", "jitp-field", "jitp-scanline-racing"] {
        assert!(names.contains(&name), "{name} is not among {names:?}");
    }
    for row in rows.iter().filter(|row| row["pipeline"] != "ideal") {
        assert!(row["end_to_end"]["total_ms"].as_f64() > Some(0.0), "{row}");
        assert!(row["error"]["pixels"]["mean"].as_f64() > Some(0.0), "{row}");
        assert!(row["updates_hz"].as_f64() > Some(0.0) && row["triangles_possible"].as_u64() > Some(0), "{row}");
    }
}

#[test]
fn a_folder_gets_the_chart_and_the_four_pictures() {
    let out = folder("files");
    let path = out.to_str().expect("a plain path");
    let output = compare(&["--fields", "20", "--no-triangles", "--out", path]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let svg = std::fs::read_to_string(out.join("error.svg")).expect("the chart");
    assert!(svg.contains("90 ms: mean") && svg.contains("50 ms: mean"));
    for name in ["conventional-computed", "conventional-seen", "just-in-time-computed", "just-in-time-seen"] {
        let picture = image::open(out.join(format!("edge-{name}.png"))).expect("a picture");
        assert_eq!((picture.width(), picture.height()), (640, 240));
    }
    let _ = std::fs::remove_dir_all(&out);
}

#[test]
fn what_is_wrong_with_an_option_is_said_and_the_exit_code_is_2() {
    for (arguments, expected) in [
        (["--motion", "pan:fast"], "such as pan:200"),
        (["--motion", "dance"], "expected still, pan:DEG_PER_S"),
        (["--tracker", "sonar"], "expected optical, fastrak"),
        (["--predict", "oracle"], "expected none, velocity"),
        (["--fields", "3"], "found 3"),
        (["--machine", "smal-hmd"], "small-hmd"),
    ] {
        let output = compare(&arguments);
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {message}");
        assert!(message.contains(expected), "{message}");
    }
}
