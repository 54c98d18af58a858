//! Tests of `pxpl5 compare` as a user runs it.

use crate::support::{Folder, command, json};
use serde_json::Value;
use std::collections::BTreeMap;
use std::process::Output;

fn pxpl5(name: &str, arguments: &[&str]) -> Output {
    command(&[&[name], arguments].concat()).output().expect("the command is built")
}

fn compare(arguments: &[&str]) -> Output {
    pxpl5("compare", arguments)
}

fn rows(comparison: &Value) -> &Vec<Value> {
    comparison["pipelines"].as_array().expect("a list")
}

fn row<'a>(comparison: &'a Value, name: &str) -> &'a Value {
    let named = rows(comparison).iter().find(|row| row["pipeline"] == name);
    named.unwrap_or_else(|| panic!("no row {name}"))
}

#[test]
fn json_lists_a_row_for_each_pipeline_with_times_and_an_error_whose_parts_add_up() {
    let arguments = ["--head", "pan:200", "--scene", "full-screen:2", "--fields", "24", "--seeds", "2"];
    let json = json(&compare(&[arguments.as_slice(), &["--causes", "--predictors", "--json"]].concat()));
    assert_eq!(json["seeds"].as_array().map(Vec::len), Some(2));
    let names: Vec<_> = rows(&json).iter().filter_map(|row| row["pipeline"].as_str()).collect();
    for name in ["rendering-control", "slats", "vdrt", "frameless", "ideal", "jitp-field", "jitp-scanline-racing"] {
        assert!(names.contains(&name), "{name} is not among {names:?}");
    }
    for row in rows(&json) {
        let px = |of: &str, name: &str| row["error"][of][name].as_f64().expect("every pipeline can draw two triangles");
        let mean_px = px("mean_px", "mean");
        assert!(px("mean_px", "low") <= mean_px && px("pixels", "p50") <= px("pixels", "p99"), "{row}");
        let parts: f64 =
            row["causes"].as_array().expect("a list").iter().filter_map(|c| c["px"]["mean"].as_f64()).sum();
        assert!((parts - mean_px).abs() < 1e-9, "{parts} of {mean_px}: {row}");
    }
    for row in rows(&json).iter().filter(|row| row["pipeline"] != "ideal") {
        assert!(row["head_to_light_ms"]["mean"].as_f64() > Some(0.0), "{row}");
        assert!(row["prediction_interval_ms"]["mean"].as_f64() > Some(0.0), "{row}");
        assert!(row["updates_hz"]["mean"].as_f64() > Some(0.0), "{row}");
        assert_eq!(row["predictors"].as_array().map(Vec::len), Some(4), "{row}");
    }
}

/// Causes and predictors take time, so a comparison computes them only on request. They change no other number.
#[test]
fn computing_causes_and_predictors_changes_no_other_number_of_a_comparison() {
    let shared =
        ["--scene", "full-screen:2", "--fields", "24", "--seeds", "1", "--only", "slats,vdrt,jitp-field,ideal"];
    let given = |more: &[&str]| {
        let mut all = json(&compare(&[shared.as_slice(), more, &["--json"]].concat()));
        all["settings"] = Value::Null;
        let rows = all["pipelines"].as_array_mut().expect("a list");
        let lists = rows.iter_mut().map(|row| {
            row["host_seconds"] = Value::Null;
            // Causes come with intervals that are wrong by -20, -10, 10 and 20 ms.
            let errors = row["prediction_interval_errors"].take().as_array().map_or(0, Vec::len);
            assert_eq!(errors, if more.is_empty() || row["pipeline"] == "ideal" { 0 } else { 4 });
            let lists = ["causes", "predictors"].map(|key| row[key].take().as_array().map_or(0, Vec::len));
            (row["pipeline"].as_str().expect("a name").to_owned(), lists)
        });
        let lists: BTreeMap<String, [usize; 2]> = lists.collect();
        (lists, all)
    };
    let of_all = |pipelines: [usize; 2], ideal: [usize; 2]| -> BTreeMap<String, [usize; 2]> {
        let each = [("slats", pipelines), ("vdrt", pipelines), ("jitp-field", pipelines), ("ideal", ideal)];
        each.map(|(name, lists)| (name.to_owned(), lists)).into()
    };
    let (none, plain) = given(&[]);
    assert_eq!(none, of_all([0, 0], [0, 0]));
    // Five causes and their interaction; four predictors, except for the reference.
    for (more, expected) in
        [(&["--causes"][..], of_all([6, 0], [6, 0])), (&["--causes", "--predictors"], of_all([6, 4], [6, 0]))]
    {
        let (lists, other) = given(more);
        assert_eq!(lists, expected, "{more:?}");
        assert_eq!(other, plain, "{more:?}");
    }
    let table = |more: &[&str]| String::from_utf8(compare(&[shared.as_slice(), more].concat()).stdout).expect("text");
    let [plain, whole] = [table(&[]), table(&["--causes", "--predictors"])];
    assert!(!plain.contains("error by cause") && whole.contains("error by cause"), "{plain}");
    assert!(!plain.contains("best with  ") && whole.contains("best with  "), "{plain}");
}

#[test]
fn a_comparison_uses_the_boards_triangles_seeds_and_settings_of_the_command_line() {
    let machine = "--gps 17 --renderers 9 --set gp.triangle_ns=20000 --scene mig --triangles 60";
    let runs = "--fields 24 --seeds 1 --seed 7 --only slats,ideal --json";
    let json = json(&compare(&machine.split(' ').chain(runs.split(' ')).collect::<Vec<_>>()));
    let names: Vec<_> = rows(&json).iter().filter_map(|row| row["pipeline"].as_str()).collect();
    assert_eq!(names, ["slats", "ideal"]);
    assert_eq!(json["boards"], serde_json::json!([17, 9]));
    assert_eq!(json["seeds"], serde_json::json!([7]));
    assert!(json["triangles"].as_u64().is_some_and(|n| (40..=60).contains(&n)), "{}", json["triangles"]);
}

/// With an ideal tracker, the row `delayed-video` has no error at all. The error of a pipeline is larger.
#[test]
fn the_line_with_the_least_error_names_the_references_that_it_leaves_out() {
    let shared = ["--scene", "full-screen:2", "--tracker", "ideal", "--head", "pan:200", "--fields", "30"];
    let footer = |only: &str| {
        let output = compare(&[shared.as_slice(), &["--seeds", "1", "--only", only]].concat());
        let text = String::from_utf8(output.stdout).expect("text");
        text.lines().find(|line| line.starts_with("Least error")).expect("a row has the least error").to_owned()
    };
    let with_references = footer("slats-touched,delayed-video,ideal");
    assert!(with_references.contains("(not ranked: delayed-video, ideal): slats-touched "), "{with_references}");
    let without = footer("slats-touched,vdrt");
    assert!(without.contains("showed every picture: vdrt ") && !without.contains("not ranked"), "{without}");
}

#[test]
fn a_scene_too_heavy_for_a_pipeline_is_reported_with_the_limit_of_the_pipeline() {
    let settings = ["--machine", "small-hmd", "--set", "fields=24"];
    let only = ["--only", "slats,jitp-scanline-racing"];
    let json = json(&compare(
        &[settings.as_slice(), &["--scene", "mig", "--seeds", "1", "--head", "still", "--limits", "--json"], &only]
            .concat(),
    ));
    let racing = row(&json, "jitp-scanline-racing");
    let could = racing["triangles_possible"].as_u64().expect("limits are searched for");
    let failure = racing["failure"].as_str().expect("a line of the Mig takes far longer than a line lasts");
    assert!(failure.contains("too heavy") && failure.contains(&format!("could draw {could} ")), "{failure}");
    assert!(racing["error"]["mean_px"]["mean"].is_null() && racing["head_to_light_ms"]["mean"].is_null(), "{racing}");
    for name in ["slats", "jitp-scanline-racing"] {
        let limit = pxpl5("limit", &["--pipeline", name, "--machine", "small-hmd", "--json"]);
        let limit: Value = serde_json::from_slice(&limit.stdout).expect("an object");
        assert_eq!(limit["triangles"], row(&json, name)["triangles_possible"], "{name}");
    }
}

#[test]
fn a_comparison_writes_its_tables_drawings_and_four_pictures_into_the_folder() {
    let folder = Folder::new();
    let out = folder.path.join("out");
    let path = out.to_str().expect("a plain path");
    let shown = ["rendering-control", "slats", "vdrt", "frameless", "jitp-field", "jitp-scanline-racing"];
    let only = shown.join(",");
    let settings = ["--fields", "24", "--seeds", "2", "--scene", "full-screen:2", "--only", &only];
    let output = compare(&[settings.as_slice(), &["--out", path]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = |name: &str| std::fs::read_to_string(out.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"));
    let json: Value = serde_json::from_str(&text("comparison.json")).expect("JSON");
    let table = text("rows.csv");
    let header = table.lines().next().expect("a header");
    assert!(header.starts_with("pipeline,settings,eyes,") && header.contains(",error.mean_px.mean,"), "{header}");
    assert_eq!(table.lines().count(), 1 + rows(&json).len());
    assert!(text("errors.csv").lines().count() > rows(&json).len());
    let drawings =
        ["error-over-time.svg", "error-distribution.svg", "error-over-latency.svg", "error-over-prediction.svg"];
    for name in drawings {
        let drawing = text(name);
        assert!(drawing.contains("rendering-control") && drawing.contains("jitp-field"), "{name}");
    }
    let gallery = text("gallery.html");
    for name in shown {
        assert!(gallery.contains(&format!("{name}: ")), "{name} is not in the gallery");
        let picture = image::open(out.join(format!("picture-{name}.png"))).expect("two triangles are complete");
        assert_eq!((picture.width(), picture.height()), (640, 480));
    }
    for name in ["conventional-computed", "conventional-seen", "just-in-time-computed", "just-in-time-seen"] {
        let picture = image::open(out.join(format!("edge-{name}.png"))).expect("a picture");
        assert_eq!((picture.width(), picture.height()), (640, 240));
    }
}

#[test]
fn values_that_were_not_measured_are_null_in_json() {
    let only = ["--only", "slats,ideal,frameless,jitp-dual-screen"];
    let settings = ["--head", "pan:200", "--scene", "typical:500", "--gps", "3", "--fields", "30", "--seeds", "2"];
    let json = json(&compare(&[settings.as_slice(), &only, &["--json"]].concat()));
    // None of the 22 due fields of either seed was shown. The screen still shows the picture of the start.
    let heavy = row(&json, "jitp-dual-screen");
    assert_eq!((&heavy["pictures_due"], &heavy["missed_retraces"]), (&Value::from(44), &Value::from(44)), "{heavy}");
    assert!(heavy["error"]["mean_px"]["mean"].is_null() && heavy["error"]["n"] == 0, "{heavy}");
    assert_eq!(heavy["causes"], serde_json::json!([]), "{heavy}");
    let failure = heavy["failure"].as_str().expect("the row says why");
    assert!(failure.starts_with("cannot draw the scene: of 44 pictures due none was complete in time"), "{failure}");
    for name in ["ideal", "frameless"] {
        let never = row(&json, name);
        for count in ["pictures_due", "missed_retraces", "late_regions"] {
            assert!(never[count].is_null(), "{name} {count}: {never}");
        }
    }
    assert!(row(&json, "ideal")["end_to_end"]["n"] == 0 && row(&json, "ideal")["updates_hz"]["mean"].is_null());
    // The stages and their sum cover both seeds.
    let frameless = row(&json, "frameless");
    assert_eq!(frameless["end_to_end"]["n"], frameless["head_to_light_ms"]["n"]);
    let [total, mean] = [&frameless["end_to_end"]["head_to_light_ms"], &frameless["head_to_light_ms"]["mean"]];
    assert!((total.as_f64().expect("shown") - mean.as_f64().expect("shown")).abs() < 1e-9, "{total} {mean}");
}
