//! Tests of `pxpl5 volume`: files, JSON and exit codes.

use crate::support::{Folder, err, json, names, out};
use image::RgbImage;
use serde_json::Value;

/// Options of a small display: 36 slices with 128 x 96 pixels.
const SMALL: [&str; 6] = ["--set", "display.slices=36", "--set", "display.width=128", "--set", "display.height=96"];

fn volume<'a>(command: &'a str, arguments: &[&'a str]) -> Vec<&'a str> {
    [&["volume", command], arguments, &SMALL].concat()
}

fn picture(folder: &Folder, name: &str) -> RgbImage {
    image::open(folder.path.join(name)).unwrap_or_else(|error| panic!("{name}: {error}")).to_rgb8()
}

#[test]
fn run_prints_one_json_object_and_writes_the_same_object() {
    let folder = Folder::new();
    let arguments = ["--scene", "mig", "--clip", "hyperbolic:1", "--seed", "7", "--json", "--out", "a/b"];
    let report = json(&folder.run(&volume("run", &arguments)));
    assert_eq!(report["schema"], "pxpl5-volume/1");
    assert_eq!((&report["clip"], &report["seed"]), (&Value::from("hyperbolic:1"), &Value::from(7)));
    assert_eq!(report["bytes_unpacked"], 36 * 128 * 96 * 4);
    let paths: Vec<_> = report["overrides"].as_array().expect("a list").iter().map(|o| o["path"].clone()).collect();
    assert_eq!(paths, ["display.slices", "display.width", "display.height", "clip.bias_px2"]);
    let written = folder.path.join("a/b");
    assert_eq!(
        names(&written),
        ["manifest.json", "report.json", "sheet.png", "slice-0.png", "slices.csv", "tiles.png", "view.png"]
    );
    let kept: Value =
        serde_json::from_slice(&std::fs::read(written.join("report.json")).expect("written")).expect("JSON");
    assert_eq!(kept["volume_hash"], report["volume_hash"]);
    let slices = std::fs::read_to_string(written.join("slices.csv")).expect("written");
    assert_eq!(slices.lines().count(), 1 + 36);
    let accepted: u64 = slices.lines().skip(1).filter_map(|line| line.split(',').nth(3)?.parse::<u64>().ok()).sum();
    assert_eq!(report["fragments_accepted"], accepted);
    assert_eq!(picture(&folder, "a/b/sheet.png").dimensions(), (22 * 64, 2 * 64));
}

#[test]
fn run_prints_a_table_and_marks_results_beyond_the_paper() {
    let folder = Folder::new();
    let text = out(&folder.run(&volume("run", &["--strobes", "mirror"])));
    for part in ["mig (417 primitives)", "18 in 1 passes", "Beyond the paper: mirrored strobes.", "volumes per second"]
    {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(out(&folder.run(&volume("run", &["--quiet"]))), "");
}

#[test]
fn slices_sheets_views_and_films_state_their_origin() {
    let folder = Folder::new();
    for (arguments, size) in [
        (volume("slice", &["7", "--out", "o.png"]), (256, 96)),
        (volume("slice", &["7", "--show", "after", "--out", "o.png"]), (128, 96)),
        (volume("slice", &["7", "--show", "tiles", "--out", "o.png"]), (128, 96)),
        (volume("sheet", &["--out", "o.png"]), (22 * 64, 2 * 64)),
        (volume("view", &["--size", "64", "--cut", "0:90", "--out", "o.png"]), (64, 64)),
        (
            volume("view", &["--size", "64", "--undithered", "--lambert", "--azimuth", "-30", "--out", "o.png"]),
            (64, 64),
        ),
        (volume("film", &["--size", "32", "--frames", "5", "--out", "o.png"]), (32, 32)),
    ] {
        let output = folder.run(&arguments);
        assert!(output.status.success(), "{arguments:?}: {}", err(&output));
        assert_eq!(picture(&folder, "o.png").dimensions(), size, "{arguments:?}");
        let file = std::fs::File::open(folder.path.join("o.png")).expect("written");
        let reader = png::Decoder::new(std::io::BufReader::new(file)).read_info().expect("PNG");
        let keys: Vec<_> = reader.info().utf8_text.iter().map(|text| text.keyword.clone()).collect();
        assert!(keys.contains(&"pxpl5 volume_hash".to_owned()), "{keys:?}");
        assert_eq!(folder.names(), ["o.png"], "nothing else is left");
        std::fs::remove_file(folder.path.join("o.png")).expect("ours");
    }
}

#[test]
fn compare_lists_every_variant_and_writes_its_files() {
    let folder = Folder::new();
    let comparison = json(&folder.run(&volume("compare", &["--size", "32", "--json", "--out", "o"])));
    assert_eq!(comparison["schema"], "pxpl5-volume-comparison/1");
    assert_eq!(comparison["variants"].as_array().map(Vec::len), Some(21));
    assert_eq!(
        names(&folder.path.join("o")),
        ["brightness.svg", "comparison.json", "manifest.json", "rows.csv", "samples.png", "variants.png"]
    );
    assert_eq!(picture(&folder, "o/variants.png").dimensions(), (3 * 32, 6 * 32));
    let text = out(&folder.run(&volume("compare", &[])));
    assert!(text.contains("tapered:0.5") && text.contains("connected is beyond the paper"), "{text}");
}

#[test]
fn model_files_are_drawn() {
    let folder = Folder::new();
    folder.file("m.obj", "v -1 -1 -5\nv 1 -1 -5\nv 0 1 -5\nf 1 2 3\n");
    let report = json(&folder.run(&volume("run", &["--scene", "m.obj", "--json"])));
    assert_eq!(report["triangles"], 1);
}

/// Tests a sweep of three clips (ways to cut a scene) and two tile sizes. After an interruption at two points, the
/// final file must be the same as without an interruption.
#[test]
fn an_interrupted_sweep_of_volumes_ends_with_the_same_file_as_an_uninterrupted_sweep() {
    let folder = Folder::new();
    folder.file(
        "s.toml",
        "title = \"t\"\nmeasure = [\"lit_voxels\", \"model_ms.gpu.ms\"]\n[display]\nslices = 12\nwidth = 64\nheight = 64\n\
         [sweep.grid]\nclip.variant = [\"exact\", \"hyperbolic\", \"cone\"]\ntile.size = { from = 16, to = 32, step = 16 }\n",
    );
    let whole = folder.run(&["volume", "sweep", "s.toml", "--out", "whole"]);
    assert!(whole.status.success(), "{}", err(&whole));
    assert!(err(&whole).contains("2 of 6 points could not be drawn; point 4"), "{}", err(&whole));
    let rows = std::fs::read(folder.path.join("whole/rows.jsonl")).expect("written");
    let text = String::from_utf8(rows.clone()).expect("text");
    let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).expect("JSON")).collect();
    assert_eq!((lines.len(), &lines[0]["points"]), (7, &Value::from(6)));
    assert!(lines[1]["measured"]["lit_voxels"].as_f64() < lines[3]["measured"]["lit_voxels"].as_f64());
    std::fs::create_dir(folder.path.join("again")).expect("ours");
    let begun: String = text.split_inclusive('\n').take(3).collect::<String>() + "{\"point\":2,";
    std::fs::write(folder.path.join("again/rows.jsonl"), begun).expect("ours");
    let refused = folder.run(&["volume", "sweep", "s.toml", "--out", "again"]);
    assert_eq!(refused.status.code(), Some(2), "{}", err(&refused));
    let resumed = folder.run(&["volume", "sweep", "s.toml", "--out", "again", "--resume"]);
    assert!(resumed.status.success(), "{}", err(&resumed));
    assert_eq!(std::fs::read(folder.path.join("again/rows.jsonl")).expect("written"), rows);
    let csv = std::fs::read_to_string(folder.path.join("again/results.csv")).expect("written");
    assert!(csv.contains("point,status,clip.variant,tile.size,lit_voxels,model_ms.gpu.ms"), "{csv}");
}

#[test]
fn a_run_of_a_head_in_front_of_a_volume_writes_a_report_a_figure_and_a_film() {
    let folder = Folder::new();
    let arguments =
        ["--head", "slide:0.2", "--latency", "50", "--seconds", "0.5", "--frames", "3", "--size", "32", "--out", "h"];
    let output = folder.run(&volume("view", &arguments));
    assert!(output.status.success(), "{}", err(&output));
    assert_eq!(names(&folder.path.join("h")), ["errors.csv", "errors.svg", "eyes.png", "manifest.json", "report.json"]);
    let report: Value =
        serde_json::from_slice(&std::fs::read(folder.path.join("h/report.json")).expect("written")).expect("JSON");
    assert_eq!(report["schema"], "pxpl5-volume-head/1");
    assert_eq!((&report["latency_ms"], report["samples"].as_array().map(Vec::len)), (&Value::from(50.0), Some(24)));
    let csv = std::fs::read_to_string(folder.path.join("h/errors.csv")).expect("written");
    assert_eq!(csv.lines().count(), 1 + 24);
    assert_eq!(picture(&folder, "h/eyes.png").dimensions(), (64, 64));
}

#[test]
fn values_outside_the_range_of_their_source_cause_warnings() {
    let folder = Folder::new();
    let output = folder.run(&volume("run", &["--set", "display.spin_rpm=3000"]));
    assert!(
        err(&output).contains("display.spin_rpm = 3000 1/min is outside its range, 600 to 900"),
        "{}",
        err(&output)
    );
}
