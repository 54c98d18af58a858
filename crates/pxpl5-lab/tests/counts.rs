//! Tests of counts for every pipeline. Each due picture ends in exactly one way, and rates depend on the load and not
//! on the length of the run. A pipeline that fails at a load fails at every higher load.

use pxpl5_lab::{ExperimentFile, registry};
use pxpl5_measure::{ErrorCauses, Measured, Report, Showing};
use pxpl5_run::{DuePictures, ExperimentError, Outcome, WARM_UP_PERIODS};

/// Runs a pipeline with a number of triangles that cover the screen. Strips (groups of scan lines) have eight lines, so
/// that the run has an eighth of the events.
fn run(pipeline: &str, triangles: u32, fields: u64) -> Result<Outcome, ExperimentError> {
    let strips = if pipeline.starts_with("jitp") { "strip_rows = 8\n" } else { "" };
    let text = format!(
        "pipeline = \"{pipeline}\"\nscene = \"full-screen:{triangles}\"\nfields = {fields}\npixels = \"off\"\n{strips}"
    );
    let plan = ExperimentFile::parse(&text, "test").and_then(|file| file.resolve()).expect("valid");
    plan.experiment(plan.load_scene().expect("built in")).run()
}

/// Returns the numbers of due, shown and missed pictures of a run, even if the run is too short.
fn due(pipeline: &str, triangles: u32, fields: u64) -> Option<DuePictures> {
    match run(pipeline, triangles, fields) {
        Ok(outcome) => outcome.due(),
        Err(ExperimentError::TooShort { partial, .. }) => partial.due(),
        Err(error) => panic!("{pipeline}, {triangles} triangles: {error}"),
    }
}

fn pipelines() -> Vec<&'static str> {
    registry().pipelines().iter().map(|entry| entry.name).collect()
}

/// Numbers of triangles, from a small load to far more than any pipeline of the papers draws in time.
const LOADS: [u32; 9] = [1, 4, 16, 64, 110, 150, 400, 1_000, 3_000];

/// Returns every second load, with the smallest and the largest. With `PXPL5_ALL_CASES=1`, as in scripts/nightly,
/// returns all loads.
fn loads() -> Vec<u32> {
    let step = if std::env::var_os("PXPL5_ALL_CASES").is_some() { 1 } else { 2 };
    LOADS.into_iter().step_by(step).collect()
}

/// Returns the allowed difference between the shares of late pictures at two loads.
///
/// Slats sends clumps (groups) of 30 triangles, and a nearly empty clump costs as many messages as a full one. A few
/// triangles more can therefore be late in one field less. None of the loads is close to such a limit. The tolerance is
/// one picture for each run, because the evaluated parts of two runs may begin in different periods.
fn tolerance(a: &DuePictures, b: &DuePictures) -> f64 {
    1.0 / a.due as f64 + 1.0 / b.due as f64
}

#[test]
fn every_picture_due_has_one_result_and_heavier_loads_never_miss_fewer() {
    let loads = loads();
    for pipeline in pipelines() {
        if pipeline == "frameless" || pipeline.starts_with("arp-") {
            let ends = [LOADS[0], LOADS[LOADS.len() - 1]];
            let counts = ends.map(|triangles| due(pipeline, triangles, 60));
            assert!(counts.iter().all(Option::is_none), "no picture of {pipeline} is ever due");
            continue;
        }
        let counts: Vec<_> = loads.iter().map(|triangles| due(pipeline, *triangles, 60)).collect();
        let counts: Vec<DuePictures> = counts.into_iter().map(|due| due.expect("60 fields are enough")).collect();
        for (due, triangles) in counts.iter().zip(&loads) {
            assert_eq!(due.shown + due.late + due.incomplete + due.missed, due.due, "{pipeline}, {triangles}");
            let periods = due.last_period.next().since(due.first_period);
            // Without a picture after the warm-up, the warm-up's shown pictures, at most four, are left out.
            let most = if due.shown == 0 { 4 } else { 0 };
            let is_counted = (0..=most).any(|left_out| periods == (due.due + left_out) * due.periods_a_picture);
            assert!(is_counted, "{pipeline}, {triangles}: {due:?}");
        }
        for (pair, triangles) in counts.windows(2).zip(&loads) {
            let falls = pair[0].not_shown_share() - pair[1].not_shown_share();
            assert!(falls <= tolerance(&pair[0], &pair[1]), "{pipeline} above {triangles}: {pair:?}");
        }
        assert_eq!(counts[0].not_shown(), 0, "{pipeline} draws one triangle in time: {:?}", counts[0]);
        assert!(counts[loads.len() - 1].not_shown_share() > 0.5, "{pipeline}: {:?}", counts[loads.len() - 1]);
    }
}

#[test]
fn rates_do_not_depend_on_the_length_of_the_run() {
    let cases: [(&str, &[u32]); 4] = [
        ("rendering-control", &[12, 200, 800]),
        ("slats", &[100, 150, 400]),
        ("jitp-field", &[4, 100, 800]),
        ("jitp-dual-screen-racing", &[4, 60]),
    ];
    for (pipeline, loads) in cases {
        for triangles in loads {
            let [short, long] = [400, 800].map(|fields| due(pipeline, *triangles, fields).expect("long enough"));
            let expected = long.shown as f64 / long.due as f64 * short.due as f64;
            let difference = (short.shown as f64 - expected).abs();
            assert!(difference <= 1.0, "{pipeline}, {triangles} triangles: {short:?} {long:?}");
        }
    }
}

fn with_a_head(pipeline: &str, scene: &str) -> Report {
    let text = format!(
        "pipeline = \"{pipeline}\"\nscene = \"{scene}\"\nfields = 60\npixels = \"off\"\nhead.motion = \"pan:200\""
    );
    let plan = ExperimentFile::parse(&text, "test").and_then(|file| file.resolve()).expect("valid");
    match plan.experiment(plan.load_scene().expect("built in")).run() {
        Ok(outcome) => outcome.report(),
        Err(ExperimentError::TooShort { partial, .. }) => partial.report(),
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn without_a_complete_picture_there_is_no_latency_update_or_error() {
    for (pipeline, scene) in [("jitp-scanline-racing", "mig"), ("slats", "full-screen:1000")] {
        let report = serde_json::to_value(with_a_head(pipeline, scene)).expect("JSON");
        for path in [
            "/latency_ms/mean",
            "/latency_fields/mean",
            "/updates_hz",
            "/head/end_to_end/head_to_light_ms",
            "/head/end_to_end/drawing_ms",
            "/head/error/pixels/mean",
            "/head/error/pixels/p99",
            "/head/error/degrees/mean",
            "/head/error/centre_px/max",
        ] {
            assert_eq!(report.pointer(path), Some(&serde_json::Value::Null), "{pipeline}: {path}");
        }
        for path in ["/latency_ms/n", "/head/end_to_end/n", "/head/error/pixels/n", "/head/error/evaluated"] {
            assert_eq!(report.pointer(path), Some(&0.into()), "{pipeline}: {path}");
        }
        assert!(report["too_heavy"]["advice"].is_string() && report["ends_complete"] == false, "{pipeline}");
        // With the aircraft, no line of just-in-time pixels arrives in time, and regions of Slats arrive late.
        let not_evaluated = ["incomplete", "empty"].map(|key| report["head"]["error"][key].as_u64().expect("a number"));
        assert!(not_evaluated.iter().sum::<u64>() > 0, "{pipeline}");
    }
}

#[test]
fn a_pipeline_without_a_closed_form_explains_how_its_limit_is_found() {
    let heavy = run("jitp-field", 3_000, 60).expect("fields are begun").report().too_heavy.expect("far too many");
    assert_eq!(heavy.primitives_in_time, None);
    assert!(heavy.advice.contains("`limit` finds the number of test triangles that jitp-field draws"), "{heavy}");
}

/// Tests a load that is never drawn in time: three processors cannot draw 500 triangles in a field. For any length of
/// the run, the first picture stays on the screen and is not evaluated.
#[test]
fn a_picture_of_start_up_that_stays_on_the_screen_has_no_error() {
    for fields in [30, 120] {
        let text = format!(
            "pipeline = \"jitp-dual-screen\"\nscene = \"typical:500\"\nfields = {fields}\npixels = \"off\"\n\
             head.motion = \"pan:200\"\nmachine.n_gps = 3"
        );
        let plan = ExperimentFile::parse(&text, "test").and_then(|file| file.resolve()).expect("valid");
        let outcome = plan.experiment(plan.load_scene().expect("built in")).run().expect("fields are begun");
        let report = outcome.report();
        let due = report.due.expect("fields are due");
        assert_eq!((due.shown, due.due), (0, fields - WARM_UP_PERIODS), "{due:?}");
        let error = report.head.expect("a head").error;
        assert_eq!((error.evaluated, error.behind), (0, 0), "{error:?}");
        assert!(error.pixels.mean.is_nan() && error.before > 0, "{error:?}");
        assert!(ErrorCauses::of(&outcome, Showing::Plain, &error).is_none());
    }
}
