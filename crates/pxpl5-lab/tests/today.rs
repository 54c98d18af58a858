//! Tests of the settings for today's displays: displays with given parameters, and devices that move pictures to the
//! newest pose.

use pxpl5_lab::{ExperimentFile, Plan};
use pxpl5_run::{Every, Raster, Reprojection, Warp};

const RC: &str = "pipeline = \"rendering-control\"\nscene = \"mig\"\n";

fn plan(text: &str) -> Plan {
    let file = ExperimentFile::parse(&format!("{RC}{text}"), "test").unwrap_or_else(|error| panic!("{error}: {text}"));
    file.resolve().unwrap_or_else(|error| panic!("{error}: {text}"))
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
fn a_display_by_numbers_is_a_panel_of_these_numbers() {
    let plan = plan(
        "display = { width = 800, height = 600, hz = 75, interlace = false, scan = \"global\", direction = \"up\", active = 0.9, \
         persistence_ms = 1.5, response_ms = 0.2, ports = 2, bits = 18 }\n",
    );
    assert_eq!(plan.display(), "panel");
    let expected = [
        ("width", 800),
        ("height", 600),
        ("refresh_hz", 75),
        ("interlace", 0),
        ("scan", 1),
        ("direction", 1),
        ("active_permille", 900),
        ("persistence_us", 1_500),
        ("response_us", 200),
        ("ports", 2),
        ("bits", 18),
    ];
    for (name, value) in expected {
        assert_eq!(number(&plan, &format!("panel.{name}")), value, "{name}");
    }
    // The written settings give the same experiment again.
    let again = ExperimentFile::parse(&plan.settings().to_string(), "written").and_then(|file| file.resolve());
    assert_eq!(again.expect("an experiment"), plan);
}

#[test]
fn numbers_stand_on_a_preset_that_is_named() {
    let plan = plan("display = { preset = \"oled-90\", persistence_ms = 1 }\n");
    assert_eq!((plan.display(), number(&plan, "oled-90.persistence_us")), ("oled-90", 1_000));
    assert_eq!((number(&plan, "oled-90.width"), number(&plan, "oled-90.refresh_hz")), (1_080, 90));
}

#[test]
fn numbers_of_a_display_that_cannot_be_are_refused_with_the_key_and_the_range() {
    for (text, expected) in [
        ("display = { width = 0 }", "display.width: expected a number from 1 to 16384, found 0"),
        ("display = { hz = 5000 }", "display.hz: expected a number from 1 to 1000, found 5000"),
        (
            "display = { persistence_ms = -1 }",
            "display.persistence_ms: expected a number from 0 on in steps of 0.001, found -1",
        ),
        (
            "display = { hz = 90, persistence_ms = 12 }",
            "display.persistence_ms: panel.persistence_us: expected 0 to 11111, a period of 90 Hz, found 12000",
        ),
        ("display = { scan = \"sideways\" }", "display.scan: expected one of rolling, global (the nearest is"),
        (
            "display = { width = 4000, height = 4000 }",
            "display.width: panel.width: expected at most 128 regions of 128 x 128",
        ),
        (
            "display = { preset = \"ntsc\", hz = 50 }",
            "display.hz: expected nothing: the display ntsc has no such number",
        ),
    ] {
        let found = refusal(&format!("{RC}{text}\n"));
        assert!(found.contains(expected), "{text}: {found}");
    }
}

#[test]
fn a_pipeline_that_needs_interlace_says_so_by_name() {
    for pipeline in ["slats", "frameless", "jitp-field"] {
        let text =
            format!("pipeline = \"{pipeline}\"\nscene = \"full-screen:2\"\ndisplay = \"oled-90\"\nfields = 20\n");
        let plan = ExperimentFile::parse(&text, "test").and_then(|file| file.resolve()).expect("a plan");
        let error =
            plan.experiment(plan.load_scene().expect("built in")).run().expect_err("it needs fields").to_string();
        assert!(error.contains("needs interlace") && error.ends_with("found oled-90"), "{pipeline}: {error}");
    }
}

/// Returns the raster of a plan whose head settings are given as text.
fn raster(text: &str) -> Raster {
    let text = format!("head.motion = \"pan:10\"\n{text}");
    let plan = plan(&text);
    let raster = plan.head.as_ref().expect("a head").head().raster();
    let again = ExperimentFile::parse(&plan.settings().to_string(), "written").and_then(|file| file.resolve());
    assert_eq!(again.expect("an experiment").head.expect("a head").head().raster(), raster);
    raster
}

#[test]
fn a_device_has_a_way_of_moving_how_often_and_a_latency() {
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
fn numbers_of_a_device_without_one_and_depth_of_faces_are_refused() {
    let head = format!("{RC}head.motion = \"pan:10\"\n");
    let found = refusal(&format!("{head}head.reprojection.every = \"line\"\n"));
    assert!(
        found.contains("head.reprojection.every: expected nothing: head.raster is no shift, rotation or depth"),
        "{found}"
    );
    let found = refusal(&format!("{head}head.raster = \"rotation\"\nhead.reprojection.latency_us = 200000\n"));
    assert!(found.contains("expected a whole number from 0 to 100000, found 200000"), "{found}");
    let faces = "pipeline = \"arp-full\"\nscene = \"gallery\"\nhead.motion = \"pan:10\"\nhead.raster = \"depth\"\n";
    let found = refusal(faces);
    assert!(found.contains("head.raster = depth does not apply to the pipeline arp-full"), "{found}");
    let vdrt = "pipeline = \"jitp-scanline\"\nscene = \"gallery\"\nhead.motion = \"pan:10\"\nhead.raster = \"vdrt\"\n";
    assert!(refusal(vdrt).contains("head.raster = vdrt does not apply to the pipeline jitp-scanline"));
}
