//! Tests of deadlocks: a run in which no program can continue fails for any number of fields, and the error names the
//! waiting programs.

use pxpl5_gp::Priority;
use pxpl5_machine::{Board, Machine, MachineConfig, Record, RunError};
use pxpl5_renderer::Layout;
use pxpl5_run::{
    Experiment, ExperimentError, Pause, PictureRules, PictureTimes, Pipeline, PipelineProperties, Pixels, Setup, Slats,
};
use pxpl5_scene::builtin;
use pxpl5_sim::Time;
use pxpl5_sim::parameters::SettingError;

/// A pipeline whose program waits for a message that is never sent.
#[derive(Debug)]
struct Waiting;

impl Pipeline for Waiting {
    fn name(&self) -> &'static str {
        "waiting"
    }

    fn properties(&self) -> PipelineProperties {
        PipelineProperties::new(Layout::slats(), "none", "none")
    }

    fn load(&self, machine: &mut Machine, _: &Setup) -> Result<(), SettingError> {
        let node = machine.ports().gps[0];
        let gp = machine.processor(node, Priority::Foreground);
        let program = async move {
            gp.until("a message that is never sent", || None::<()>).await;
            Ok(())
        };
        machine.load(node, Priority::Foreground, Box::pin(program));
        Ok(())
    }
}

impl PictureRules for Waiting {
    fn pictures(&self, _: &Record, _: Time) -> Vec<PictureTimes> {
        Vec::new()
    }
}

fn run(pipeline: impl Pipeline + 'static, fields: u64) -> ExperimentError {
    let scene = builtin("full-screen:1").expect("built in");
    let experiment = Experiment::new(MachineConfig::slats(), pipeline, scene).fields(fields).pixels(Pixels::Off);
    experiment.run().expect_err("nothing is shown")
}

#[test]
fn a_run_of_any_length_in_which_all_programs_wait_is_a_deadlock() {
    for fields in [1, 2, 12, 119, 200] {
        match run(Waiting, fields) {
            ExperimentError::Run { error: RunError::Deadlock { blocked, .. }, partial } => {
                assert!(blocked.iter().any(|b| b.waits_for == "a message that is never sent"), "{blocked:?}");
                assert_eq!(partial.fields(), fields);
            }
            other => panic!("{fields} fields: {other}"),
        }
    }
}

#[test]
fn a_run_that_is_too_short_is_no_deadlock() {
    for fields in [1, 2, 5] {
        let error = run(Slats::split(), fields);
        assert!(matches!(error, ExperimentError::TooShort { .. }), "{fields} fields: {error}");
    }
}

/// After a failure, the state of the machine can be read, and running on changes nothing.
#[test]
fn a_stepper_stops_at_a_deadlock_and_returns_the_same_error() {
    let scene = builtin("full-screen:1").expect("built in");
    let experiment = Experiment::new(MachineConfig::slats(), Waiting, scene).fields(300).pixels(Pixels::Off);
    let mut stepper = experiment.stepper().expect("it can be built");
    let Pause::Failed(error) = stepper.run_to(stepper.end()) else { panic!("it waits for ever") };
    assert_eq!((stepper.now(), stepper.failure()), (error.time(), Some(&error)));
    let snapshot = stepper.processor(Board::Gp(0)).expect("a graphics processor");
    assert_eq!(snapshot.programs[0].waits_for, "a message that is never sent");
    assert_eq!(stepper.step_event(), Pause::Failed(error.clone()));
    let Err(ExperimentError::Run { error: whole, .. }) = experiment.run() else { panic!("it fails") };
    assert_eq!(whole, error);
    assert!(matches!(stepper.finish(), Err(ExperimentError::Run { error: last, .. }) if last == error));
}
