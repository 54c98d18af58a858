//! Tests of `pxpl5 arp`: files, JSON and exit codes.

use crate::support::{Folder, err, json, names, out};
use image::RgbImage;
use serde_json::Value;

/// Options of a small walk: faces of 128 texels, a picture of 160 x 120 pixels, and two seconds.
const SMALL: [&str; 10] = [
    "--set",
    "arp.face_texels=128",
    "--set",
    "arp_scan.visible_pixels=160",
    "--set",
    "arp_scan.visible_lines=60",
    "--set",
    "walk.frames=120",
    "--set",
    "walk.m_per_s=1",
];

fn arp<'a>(command: &'a str, arguments: &[&'a str]) -> Vec<&'a str> {
    [&["arp", command], arguments, &SMALL].concat()
}

fn picture(folder: &Folder, name: &str) -> RgbImage {
    image::open(folder.path.join(name)).unwrap_or_else(|error| panic!("{name}: {error}")).to_rgb8()
}

#[test]
fn run_prints_one_json_object_and_writes_the_same_with_all_pictures() {
    let folder = Folder::new();
    let report = json(&folder.run(&arp("run", &["--warp", "none", "--json", "--out", "a/b"])));
    assert_eq!(report["schema"], "pxpl5-arp/1");
    assert_eq!((&report["scene"], &report["frames"]), (&Value::from("gallery"), &Value::from(120)));
    assert_eq!(
        (&report["priority"]["policy"], &report["settings"]["warp"]),
        (&Value::from("cells"), &Value::from("none"))
    );
    assert_eq!(report["memories"].as_array().map(Vec::len), Some(4));
    assert_eq!(report["memories"][0]["updates_hz"], 60.0);
    assert!(report["tears_texels"]["after"]["max"].as_f64() > Some(0.0), "{report}");
    let written = folder.path.join("a/b");
    assert_eq!(
        names(&written),
        [
            "cells-seen.png",
            "cells.svg",
            "cuts.svg",
            "difference.png",
            "error.png",
            "experiment.toml",
            "eye-flat.png",
            "eye.png",
            "faces-0.png",
            "faces-1.png",
            "faces-2.png",
            "faces-3.png",
            "faces-whole.png",
            "frames.csv",
            "manifest.json",
            "memories.png",
            "objects.png",
            "report.json",
            "tears.png",
            "unsegmented.png",
            "updates.svg",
            "warped.png",
        ]
    );
    let kept: Value =
        serde_json::from_slice(&std::fs::read(written.join("report.json")).expect("written")).expect("JSON");
    assert_eq!(kept, report);
    let frames = std::fs::read_to_string(written.join("frames.csv")).expect("written");
    assert_eq!(frames.lines().count(), 1 + 120);
    let shown: u32 = frames.lines().skip(1).filter_map(|line| line.split(',').nth(6)?.parse::<u32>().ok()).sum();
    assert_eq!(shown, 120, "memory 0 is drawn in every frame");
    assert_eq!(picture(&folder, "a/b/faces-0.png").dimensions(), (4 * 128, 3 * 128));
    assert_eq!(picture(&folder, "a/b/eye.png").dimensions(), (160, 120));
}

#[test]
fn run_prints_a_table_and_with_quiet_prints_nothing() {
    let folder = Folder::new();
    let text = out(&folder.run(&arp("run", &["--policy", "objects"])));
    for part in ["policy objects", "updates/s", "objects that changed memory", "new assignments of cells      -"] {
        assert!(text.contains(part), "{part}: {text}");
    }
    assert_eq!(out(&folder.run(&arp("run", &["--quiet"]))), "");
}

#[test]
fn a_warped_walk_has_no_tear_and_a_slow_renderer_misses_retraces() {
    let folder = Folder::new();
    let warped = json(&folder.run(&arp("run", &["--json"])));
    assert!(warped["tears_texels"]["after"]["max"].as_f64() < Some(1e-6), "{warped}");
    assert!(warped["tears_texels"]["before"]["max"].as_f64() > Some(0.1), "{warped}");
    let slow = json(&folder.run(&arp("run", &["--source", "3000", "--json"])));
    assert!(slow["memories"][3]["missed"].as_u64() > Some(10), "{slow}");
}

#[test]
fn options_override_the_file_and_set_overrides_options() {
    let folder = Folder::new();
    folder.file(
        "walk.toml",
        "scene = \"gallery\"\npolicy = \"objects\"\n[priority]\ncell_m = 6.0\nmemories = 3\n[walk]\nm_per_s = 0.5\n",
    );
    let report = json(&folder.run(&arp("run", &["walk.toml", "--policy", "cells", "--json"])));
    assert_eq!(report["priority"]["policy"], "cells");
    assert_eq!(report["priority"]["cell_m"], 6.0);
    assert_eq!(report["memories"].as_array().map(Vec::len), Some(3));
    assert_eq!(report["m_per_s"], 1.0, "--set goes before the file");
}

#[test]
fn compare_lists_every_policy_and_warp_and_writes_its_files() {
    let folder = Folder::new();
    let comparison = json(&folder.run(&arp("compare", &["--json", "--out", "o"])));
    assert_eq!(comparison["schema"], "pxpl5-arp-comparison/1");
    let rows = comparison["rows"].as_array().expect("a list");
    assert_eq!(rows.len(), 9);
    let row = |name: &str| rows.iter().find(|row| row["variant"] == name).expect("listed");
    assert_eq!(row("full")["saved_percent"], 0.0);
    assert!(row("cells, torn")["draws_per_s"].as_f64() < row("cells, uncut")["draws_per_s"].as_f64());
    assert!(row("cells, warped")["tears"]["max"].as_f64() < row("cells, torn")["tears"]["max"].as_f64());
    assert!(row("objects")["tears"].is_null());
    assert_eq!(names(&folder.path.join("o")), ["comparison.json", "manifest.json", "rows.csv"]);
    let text = out(&folder.run(&arp("compare", &[])));
    assert!(text.contains("cells, smoothstep") && text.contains("stretch, texels"), "{text}");
}

#[test]
fn errors_name_the_setting_and_the_expected_and_found_values() {
    let folder = Folder::new();
    folder.file("bad.toml", "polcy = \"cells\"\n");
    for (arguments, parts) in [
        (vec!["arp", "run", "--set", "priority.cel_m=5"], vec!["--set", "`priority.cel_m`", "`priority.cell_m`"]),
        (vec!["arp", "run", "--set", "priority.cell_m=-1"], vec!["priority.cell_m", "expected", "found -1"]),
        (vec!["arp", "run", "--set", "arp.face_texels=500"], vec!["arp.face_texels", "a multiple of 128", "found 500"]),
        (
            vec!["arp", "run", "--policy", "objekts"],
            vec!["--policy", "--policy: expected objects, full or cells", "found `objekts`"],
        ),
        (vec!["arp", "run", "--warp", "curved"], vec!["--warp", "linear, smoothstep or step", "found `curved`"]),
        (vec!["arp", "run", "--lens", "radial:-0.3"], vec!["arp.lens", "expected"]),
        (vec!["arp", "run", "--set", "priority.threshold=2"], vec!["priority.threshold", "2px", "found \"2\""]),
        (vec!["arp", "run", "--set", "walk.route=zigzag"], vec!["walk.route", "straight", "found `zigzag`"]),
        (vec!["arp", "run", "--lens", "table:none.txt"], vec!["none.txt"]),
        (vec!["arp", "run", "bad.toml"], vec!["bad.toml", "`polcy`", "`policy`"]),
        (vec!["arp", "run", "--scene", "mig"], vec!["mig", "a path to walk along", "found none"]),
    ] {
        let output = folder.run(&[&arguments[..], &["--out", "o"]].concat());
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}", err(&output));
        for part in parts {
            assert!(err(&output).contains(part), "{arguments:?} lacks {part}: {}", err(&output));
        }
        assert_eq!(folder.names(), ["bad.toml"], "{arguments:?}: nothing is left");
    }
}

#[test]
fn a_lens_too_wide_for_a_plane_still_has_pictures() {
    let folder = Folder::new();
    let wide = ["--lens", "equidistant", "--set", "arp.horizontal_deg=200", "--json"];
    let alone = json(&folder.run(&arp("run", &wide)));
    let written = json(&folder.run(&arp("run", &[&wide[..], &["--out", "o"]].concat())));
    assert_eq!(alone, written);
    let names = names(&folder.path.join("o"));
    assert!(names.contains(&"eye.png".to_owned()) && !names.contains(&"eye-flat.png".to_owned()), "{names:?}");
}

/// Tests the default lens, which is flat. The views through the lens and without a lens must be equal.
#[test]
fn the_default_lens_shows_the_same_picture_as_no_lens() {
    let folder = Folder::new();
    json(&folder.run(&arp("run", &["--json", "--out", "o"])));
    assert!(picture(&folder, "o/eye.png") == picture(&folder, "o/eye-flat.png"));
}

/// Tests the example pixel of the guide: upper left, head 30 degrees to the left, faces of 512 texels.
#[test]
fn texel_prints_the_face_and_the_texels_of_a_pixel() {
    let folder = Folder::new();
    let found = json(&folder.run(&["arp", "texel", "0", "0", "--yaw", "30", "--json"]));
    assert_eq!(found["texels"][0]["face"], "NegX");
    let texels = found["texels"].as_array().expect("four").iter();
    let places: Vec<_> = texels.clone().map(|texel| [&texel["column"], &texel["row"]].map(|n| n.as_u64())).collect();
    let expected = [[402, 145], [403, 145], [402, 146], [403, 146]];
    assert_eq!(places, expected.map(|place| place.map(Some)));
    let weights: Vec<f64> = texels.filter_map(|texel| texel["weight"].as_f64()).collect();
    assert_eq!(weights, [12.0, 180.0, 4.0, 60.0].map(|weight| weight / 256.0));
    let text = out(&folder.run(&["arp", "texel", "0", "0", "--yaw", "30"]));
    assert!(text.contains("NegX") && text.contains("402"), "{text}");
    let beyond = folder.run(&["arp", "texel", "640", "0"]);
    assert!(err(&beyond).contains("a pixel of 640 x 480"), "{}", err(&beyond));
}
