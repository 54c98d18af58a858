//! Tests of due pictures. They are counted in the display's own periods, over a stated part of the run. A run that
//! shows no picture reports this fact.

use crate::support;
use pxpl5_lab::registry;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Measured, Report};
use pxpl5_run::{Experiment, ExperimentError, Outcome, Pixels, RenderingControl, WARM_UP_PICTURES};
use pxpl5_scene::builtin;

fn experiment(config: MachineConfig, scene: &str, fields: u64) -> Experiment {
    let scene = builtin(scene).expect("built in");
    Experiment::new(config, RenderingControl::stereo(), scene).fields(fields).pixels(Pixels::Off)
}

fn with_frame_lines(lines: u64) -> Report {
    let mut config = MachineConfig::small_hmd();
    config.set("video.frame_lines", lines).expect("known");
    experiment(config, "full-screen:12", 120).run().expect("it runs").report()
}

#[test]
fn rendering_control_misses_no_retrace_of_a_display_with_525_625_or_1051_lines() {
    // A field of 625 lines takes 19.9 ms, and a field of 1051 lines takes 33.4 ms. COPY of both eyes takes 31.2 ms on
    // each display.
    for (lines, fields_of_two_copies) in [(525, 2), (625, 2), (1_051, 1)] {
        let due = with_frame_lines(lines).due.expect("frames are due");
        assert_eq!(due.periods_a_picture, fields_of_two_copies, "{lines} lines");
        assert_eq!(due.not_shown(), 0, "{lines} lines: {due:?}");
        assert!(due.due > 50, "{lines} lines: {due:?}");
    }
}

/// Returns a machine on which a screen-filling triangle takes two fields of each renderer. A frame of 12 triangles for
/// two eyes takes about 200 fields: 20 regions over 5 renderers, for each triangle and eye.
fn slow() -> MachineConfig {
    let mut config = MachineConfig::small_hmd();
    let clocks = config.renderer.clock_hz / 30;
    config.set("renderer.phong_triangle_clocks", clocks).expect("known");
    config
}

fn partial(error: ExperimentError) -> (Option<u64>, String, Box<Outcome>) {
    let message = error.to_string();
    match error {
        ExperimentError::TooShort { needed, partial, .. } => (needed, message, partial),
        other => panic!("expected too few fields, found {other}"),
    }
}

#[test]
fn a_run_that_showed_nothing_keeps_its_results_and_names_the_length_needed() {
    let text = "pipeline = \"rendering-control\"\nscene = \"full-screen:12\"\npixels = \"off\"\nfields = 60";
    let mut plan = support::plan(text);
    plan.machine = slow();
    let (needed, message, outcome) = partial(support::run(&plan).expect_err("too short"));
    let needed = needed.expect("Rendering Control has a closed form");
    assert!(
        message.ends_with(&format!("simulate more fields: the next one is shown after about {needed}")),
        "{message}"
    );
    let report = outcome.report();
    assert_eq!((report.shown, report.updates_hz), (0, None));
    // The first 8 of 60 fields are the warm-up. A frame takes two fields.
    let due = report.due.expect("frames are due");
    assert_eq!((due.due, due.missed, report.missed_retraces), (26, 26, Some(26)));
    // The closed form follows the simulation closely. A run that is a fifth longer shows pictures.
    plan.fields = needed + needed / 5;
    let longer = support::run(&plan).expect("long enough");
    assert!(longer.shown() > WARM_UP_PICTURES as u64);
}

#[test]
fn without_a_closed_form_the_message_asks_for_a_longer_run() {
    let error = experiment(slow(), "full-screen:12", 60).run().expect_err("too short");
    let (needed, message, _) = partial(error);
    assert_eq!(needed, None);
    assert!(message.ends_with("simulate more fields"), "{message}");
}

#[test]
fn a_frame_of_two_hundred_fields_counts_as_one_shown_picture() {
    let form = registry().pipeline("rendering-control").expect("known").closed_form.map(|form| form.estimates);
    let mut short = experiment(slow(), "full-screen:12", 60);
    short.estimates = form;
    let needed = partial(short.run().expect_err("too short")).0.expect("it has a closed form");
    let outcome = experiment(slow(), "full-screen:12", needed + needed / 10).run().expect("long enough");
    let report = outcome.report();
    assert_eq!((report.pictures, report.latency_ms.statistics.n), (1, 1));
    assert!(report.latency_ms.statistics.sd.is_nan(), "one picture has no deviation");
    let due = report.due.expect("frames are due");
    // The window ends at the last field and begins with the first frame or after it. Each frame is one picture.
    let shown = outcome.pictures().iter().map(|times| outcome.record().display().period_at(times.shown_at));
    let in_window = shown.filter(|field| (due.first_period..=due.last_period).contains(field)).count() as u64;
    assert_eq!((due.shown, due.missed), (in_window, due.due - in_window));
    assert!(due.last_period.after(2).0 >= report.fields && due.shown > 0, "{due:?}");
    assert_eq!(report.updates_hz, None, "a single picture after the warm-up has no rate");
}

#[test]
fn if_slats_is_always_late_no_picture_is_shown_and_the_report_names_a_size_that_fits() {
    let run = |triangles: u64| {
        let scene = format!("scene = \"full-screen:{triangles}\"");
        let plan = support::plan(&format!("pipeline = \"slats\"\n{scene}\nfields = 60\npixels = \"off\""));
        support::run(&plan).expect("late pictures are pictures").report()
    };
    let report = run(1_000);
    assert_eq!((report.shown, report.updates_hz, report.latency_ms.statistics.n), (0, None, 0));
    let due = report.due.expect("fields are due");
    assert_eq!((due.due, due.shown, report.missed_retraces), (52, 0, Some(52)));
    assert!(due.missed > 0 && due.incomplete + due.late > 0, "{due:?}");
    let heavy = report.too_heavy.expect("nothing was shown");
    // The closed form is within 5 % of the limit by simulation (docs, and `BOUND_PERCENT` of tests/limits.rs).
    let would_do = heavy.primitives_in_time.expect("Slats has a closed form");
    let missed = |percent: u64| run(would_do * percent / 100).missed_retraces;
    assert_eq!(missed(95), Some(0), "{heavy}");
    assert!(missed(106) > Some(0), "{heavy}");
    assert!(heavy.to_string().contains(&format!("triangles = {would_do}")), "{heavy}");
}
