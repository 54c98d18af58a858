//! Missed retraces: they are counted in the display's own periods, to the end of the run, and a run that shows nothing says
//! so.

use pxpl5_lab::{ExperimentFile, registry};
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Measured, Report};
use pxpl5_run::{Experiment, ExperimentError, Outcome, Pixels, RenderingControl, Slats, WARM_UP_PICTURES};
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
fn on_a_display_of_625_or_1051_lines_rendering_control_misses_no_retrace_either() {
    // A field of 625 lines takes 19.9 ms, one of 1051 lines 33.4 ms; COPY of an eye takes 15.6 ms on each.
    for lines in [525, 625, 1_051] {
        let report = with_frame_lines(lines);
        assert_eq!(report.missed_retraces, 0, "{lines} lines");
        assert!(report.judged_retraces > 50, "{lines} lines: {}", report.judged_retraces);
    }
}

/// A machine on which a triangle of the whole screen takes two fields of each renderer, so that a frame of 12 triangles
/// and two eyes takes about 200: 20 regions over 5 renderers, each 12 times.
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
fn a_run_in_which_nothing_was_shown_keeps_what_it_saw_and_says_how_long_it_must_be() {
    let plan = ExperimentFile::parse(
        "pipeline = \"rendering-control\"\nscene = \"full-screen:12\"\npixels = \"off\"\nfields = 60",
        "test",
    );
    let mut plan = plan.and_then(|file| file.resolve()).expect("valid");
    plan.machine = slow();
    let scene = plan.load_scene().expect("built in");
    let (needed, message, outcome) = partial(plan.experiment(scene.clone()).run().expect_err("too short"));
    let needed = needed.expect("Rendering Control has a closed form");
    assert!(
        message.ends_with(&format!("simulate more fields: the next one is shown after about {needed}")),
        "{message}"
    );
    let report = outcome.report();
    assert_eq!((report.shown, report.updates_hz), (0, None));
    assert_eq!((report.missed_retraces, report.judged_retraces), (60, 60));
    // The closed form follows the events closely: with a fifth more there is something to see.
    plan.fields = needed + needed / 5;
    let longer = plan.experiment(scene).run().expect("long enough");
    assert!(longer.shown() > WARM_UP_PICTURES as u64);
}

#[test]
fn without_a_closed_form_the_message_only_asks_for_more() {
    let error = experiment(slow(), "full-screen:12", 60).run().expect_err("too short");
    let (needed, message, _) = partial(error);
    assert_eq!(needed, None);
    assert!(message.ends_with("simulate more fields"), "{message}");
}

#[test]
fn of_one_picture_after_the_warm_up_there_is_no_rate_and_every_later_retrace_is_missed() {
    let form = registry().pipeline("rendering-control").expect("known").closed_form.map(|form| form.fields_needed);
    let short = experiment(slow(), "full-screen:12", 60).estimated_by(form);
    let needed = partial(short.run().expect_err("too short")).0.expect("it has a closed form");
    // From the first picture after the warm-up the next one is about a fifth of the way off.
    let outcome = experiment(slow(), "full-screen:12", needed + needed / 10).run().expect("long enough");
    let report = outcome.report();
    assert_eq!((report.pictures, report.updates_hz), (1, None));
    let [times] = outcome.steady_pictures() else { panic!("one") };
    let shown = outcome.record().display().period_at(times.shown_at);
    // The next frame was due two retraces later, one for the copy of each eye.
    assert_eq!(report.judged_retraces, report.fields - shown.0);
    assert_eq!(report.missed_retraces, report.judged_retraces - 2);
    assert!(report.missed_retraces_definition.contains("to the end of the run"));
}

#[test]
fn slats_that_is_always_late_has_shown_nothing_and_missed_everything() {
    let scene = builtin("full-screen:1000").expect("built in");
    let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60).pixels(Pixels::Off);
    let report = experiment.run().expect("late pictures are pictures").report();
    assert_eq!((report.shown, report.updates_hz), (0, None));
    assert_eq!((report.missed_retraces, report.judged_retraces), (60, 60));
}
