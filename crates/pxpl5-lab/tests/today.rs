//! Tests of the settings for today's displays: displays with given parameters, and devices that move pictures to the
//! newest pose.

use crate::support;
use pxpl5_lab::{ExperimentFile, Plan};
use pxpl5_run::{Every, Raster, Reprojection, Warp};

const RC: &str = "pipeline = \"rendering-control\"\nscene = \"mig\"\n";

fn plan(text: &str) -> Plan {
    support::plan(&format!("{RC}{text}"))
}

fn refusal(text: &str) -> String {
    let resolved = ExperimentFile::parse(text, "test").and_then(|file| file.resolve());
    resolved.expect_err("no experiment").to_string()
}

/// Returns the value of a parameter of a plan's first display.
fn number(plan: &Plan, path: &str) -> u64 {
    match plan.machine.parameters().into_iter().find(|parameter| parameter.path == path).expect("known").value {
        pxpl5_sim::parameters::Value::Whole(value) => value,
        pxpl5_sim::parameters::Value::Real(value) => panic!("{path} = {value}"),
    }
}

#[test]
fn a_display_described_by_numbers_is_a_panel_with_these_numbers() {
    let plan = plan(
        "display = { width = 800, height = 600, hz = 75, interlace = false, scan = \"global\", direction = \"up\", active = 0.9, \
         persistence_ms = 1.5, response_ms = 0.2, ports = 2, bits = 18 }\n",
    );
    assert_eq!(plan.display(), "panel");
    let expected = "width=800 height=600 refresh_hz=75 interlace=0 scan=1 direction=1 active_permille=900 \
                    persistence_us=1500 response_us=200 ports=2 bits=18";
    for (name, value) in expected.split(' ').filter_map(|number| number.split_once('=')) {
        assert_eq!(number(&plan, &format!("panel.{name}")).to_string(), value, "{name}");
    }
    // The written settings give the same experiment again.
    assert_eq!(support::plan(&plan.settings().to_string()), plan);
}

#[test]
fn numbers_override_a_named_preset() {
    let plan = plan("display = { preset = \"oled-90\", persistence_ms = 1 }\n");
    assert_eq!((plan.display(), number(&plan, "oled-90.persistence_us")), ("oled-90", 1_000));
    assert_eq!((number(&plan, "oled-90.width"), number(&plan, "oled-90.refresh_hz")), (1_080, 90));
}

/// Each number of a display is valid at both ends of its range, and refused one step beyond each end.
#[test]
fn numbers_of_a_display_are_valid_up_to_their_limits_and_refused_beyond_them() {
    let whole = |least: &str, greatest: &str| format!("a number from {least} to {greatest}");
    // A row has the key, other numbers, both ends of the range, a step beyond both ends, and the range in the error.
    for (key, others, [least, greatest], [below, above], expected) in [
        ("width", "height = 100, ", ["1", "16384"], ["0", "16385"], whole("1", "16384")),
        ("height", "width = 100, ", ["1", "16384"], ["0", "16385"], whole("1", "16384")),
        ("hz", "", ["1", "1000"], ["0", "1001"], whole("1", "1000")),
        ("active", "", ["0.001", "1"], ["0", "1.001"], whole("0.001", "1")),
        ("response_ms", "", ["0", "1000"], ["-1", "1000.001"], whole("0", "1000")),
        ("ports", "", ["1", "8"], ["0", "9"], whole("1", "8")),
        ("bits", "", ["3", "24"], ["2", "25"], whole("3", "24")),
        // A period of 100 Hz is 10 ms.
        ("persistence_ms", "hz = 100, ", ["0", "10"], ["-1", "10.001"], "0 to 10000, a period of 100 Hz".to_owned()),
    ] {
        for value in [least, greatest] {
            plan(&format!("display = {{ {others}{key} = {value} }}\n"));
        }
        for value in [below, above] {
            let found = refusal(&format!("{RC}display = {{ {others}{key} = {value} }}\n"));
            // A negative number is refused before the period is looked up.
            let range = if value.starts_with('-') { "a number from 0 to 1000" } else { &expected };
            assert!(found.contains(&format!("display.{key}: ")), "{key} = {value}: {found}");
            assert!(found.contains(&format!("expected {range}")), "{key} = {value}: {found}");
        }
    }
    for (text, expected) in [
        ("bits = 4", "panel.bits: expected a multiple of 3"),
        ("scan = \"sideways\"", "display.scan: there is no scan `sideways`; did you mean `global`?"),
        ("preset = \"ntsc\", hz = 50", "display.hz: expected nothing: the display ntsc has no such number"),
        ("hz = nan", "display.hz: expected a number from 1 to 1000 Hz, found nan"),
        ("hz = 59.94", "display.hz: expected a number from 1 to 1000 Hz in steps of 1, found 59.94"),
        ("persistence_ms = inf", "display.persistence_ms: expected a number from 0 to 1000 ms, found inf"),
        ("interlace = true, height = 481", "panel.height: expected an even number of interlaced lines, found 481"),
        ("interlace = true, scan = \"global\"", "panel.interlace: expected 0: an interlaced scan is rolling"),
        // 128 columns of regions are allowed only with one row of regions.
        ("width = 16384, height = 129", "panel.width: expected at most 128 regions of 128 x 128"),
    ] {
        let found = refusal(&format!("{RC}display = {{ {text} }}\n"));
        assert!(found.contains(expected), "{text}: {found}");
    }
    let head = "head.motion = \"pan:10\"\nhead.raster = \"rotation\"\nhead.reprojection.latency_us = ";
    for latency in [0, 100_000] {
        plan(&format!("{head}{latency}\n"));
    }
    for latency in [-1, 100_001] {
        let found = refusal(&format!("{RC}{head}{latency}\n"));
        let expected =
            format!("head.reprojection.latency_us: expected a whole number from 0 to 100000 us, found {latency}");
        assert!(found.contains(&expected), "{found}");
    }
}

#[test]
fn every_pipeline_draws_for_a_panel_or_names_the_missing_requirement() {
    let mut refused = Vec::new();
    for entry in pxpl5_run::Registry::of_papers().pipelines() {
        let text =
            format!("pipeline = {:?}\nscene = \"full-screen:2\"\ndisplay = \"panel\"\nfields = 20\n", entry.name);
        let error = match ExperimentFile::parse(&text, "test").and_then(|file| file.resolve()) {
            Err(error) => error.to_string(),
            Ok(plan) => match support::run(&plan) {
                Ok(_) => continue,
                Err(error) => error.to_string(),
            },
        };
        assert!(error.contains(entry.name), "{}: {error}", entry.name);
        assert!(error.contains("panel"), "{}: {error}", entry.name);
        let needs_fields = ["slats", "frameless", "jitp-field"].contains(&entry.name);
        assert!(!needs_fields || error.contains("needs interlace"), "{}: {error}", entry.name);
        refused.push(entry.name);
    }
    assert!(refused.contains(&"slats") && !refused.contains(&"rendering-control"), "{refused:?}");
}

/// Returns the raster of a plan whose head settings are given as text.
fn raster(text: &str) -> Raster {
    let text = format!("head.motion = \"pan:10\"\n{text}");
    let plan = plan(&text);
    let raster = plan.head.as_ref().expect("a head").head().raster;
    assert_eq!(support::plan(&plan.settings().to_string()).head.expect("a head").head().raster, raster);
    raster
}

#[test]
fn a_device_has_a_kind_of_reprojection_a_rate_and_a_latency() {
    assert_eq!(raster(""), Raster::Plain);
    assert_eq!(raster("head.raster = \"vdrt\""), Raster::Vdrt);
    let usual = Raster::Reprojected(Reprojection { by: Warp::Rotation, every: Every::Field, latency_us: 2_000 });
    assert_eq!(raster("head.raster = \"rotation\""), usual);
    let given = "head.raster = \"depth\"\nhead.reprojection.every = \"line\"\nhead.reprojection.latency_us = 64";
    let expected = Reprojection { by: Warp::Depth, every: Every::Line, latency_us: 64 };
    assert_eq!(raster(given), Raster::Reprojected(expected));
    assert_eq!(
        raster("head.raster = \"shift\"\nhead.reprojection.every = \"strip\""),
        Raster::Reprojected(Reprojection::new(Warp::Shift, Every::Strip))
    );
}

#[test]
fn reprojection_settings_without_a_device_and_depth_reprojection_of_faces_are_refused() {
    let head = format!("{RC}head.motion = \"pan:10\"\n");
    let found = refusal(&format!("{head}head.reprojection.every = \"line\"\n"));
    assert!(
        found.contains("head.reprojection.every: expected nothing: head.raster is no shift, rotation or depth"),
        "{found}"
    );
    let faces = "pipeline = \"arp-full\"\nscene = \"gallery\"\nhead.motion = \"pan:10\"\nhead.raster = \"depth\"\n";
    let found = refusal(faces);
    assert!(found.contains("head.raster = depth does not apply to the pipeline arp-full"), "{found}");
    let vdrt = "pipeline = \"jitp-scanline\"\nscene = \"gallery\"\nhead.motion = \"pan:10\"\nhead.raster = \"vdrt\"\n";
    assert!(refusal(vdrt).contains("head.raster = vdrt does not apply to the pipeline jitp-scanline"));
}

/// Tests the form in which Python pickles a scene.
#[test]
fn the_parts_of_a_scene_are_the_same_after_json() {
    for name in ["mig", "molecules", "gallery", "typical:50"] {
        let parts = pxpl5_scene::builtin(name).expect("built in").into_parts();
        let text = serde_json::to_vec(&parts).expect("data");
        let again: pxpl5_scene::SceneParts = serde_json::from_slice(&text).expect("as written");
        assert!(again == parts, "{name}");
    }
}
