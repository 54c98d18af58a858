//! Tests of counts for every pipeline. Each due picture ends in exactly one way. A pipeline that fails at a load fails at
//! every higher load.

use crate::support;
use pxpl5_lab::registry;
use pxpl5_measure::{ErrorCauses, Measured, Showing};
use pxpl5_run::{DuePictures, ExperimentError, Outcome, WARM_UP_PERIODS};

/// Runs a pipeline with a number of triangles that cover the screen. Strips (groups of scan lines) have eight lines, so
/// that the run has an eighth of the events.
fn run(pipeline: &str, triangles: u32, fields: u64) -> Result<Outcome, ExperimentError> {
    let strips = if pipeline.starts_with("jitp") { "strip_rows = 8\n" } else { "" };
    let text = format!(
        "pipeline = \"{pipeline}\"\nscene = \"full-screen:{triangles}\"\nfields = {fields}\npixels = \"off\"\n{strips}"
    );
    support::run(&support::plan(&text))
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
        let outcome = support::run(&support::plan(&text)).expect("fields are begun");
        let report = outcome.report();
        let due = report.due.expect("fields are due");
        assert_eq!((due.shown, due.due), (0, fields - WARM_UP_PERIODS), "{due:?}");
        let error = report.head.expect("a head").error;
        assert_eq!((error.evaluated, error.behind), (0, 0), "{error:?}");
        assert!(error.pixels.mean.is_nan() && error.before > 0, "{error:?}");
        assert!(ErrorCauses::of(&outcome, Showing::Plain, &error).is_none());
    }
}
