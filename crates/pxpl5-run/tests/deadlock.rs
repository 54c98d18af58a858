//! A run in which nobody can go on is a deadlock, however few fields were asked for, and names who waits for what.

use pxpl5_gp::Priority;
use pxpl5_machine::{ConfigError, Machine, MachineConfig, Record, RunError};
use pxpl5_renderer::Layout;
use pxpl5_run::{Experiment, ExperimentError, PictureTimes, Pipeline, Pixels, Setup, Slats};
use pxpl5_scene::builtin;
use pxpl5_sim::Time;

/// A pipeline that waits for what nobody does.
#[derive(Debug)]
struct Waiting;

impl Pipeline for Waiting {
    fn name(&self) -> &'static str {
        "waiting"
    }

    fn eyes(&self) -> usize {
        1
    }

    fn layout(&self) -> Layout {
        Layout::slats()
    }

    fn load(&self, machine: &mut Machine, _: &Setup) -> Result<(), ConfigError> {
        let node = machine.ports().gps[0];
        let gp = machine.processor(node, Priority::Foreground);
        let program = async move {
            gp.until("a message that nobody sends", || None::<()>).await;
            Ok(())
        };
        machine.load(node, Priority::Foreground, Box::pin(program));
        Ok(())
    }

    fn pictures(&self, _: &Record, _: Time) -> Vec<PictureTimes> {
        Vec::new()
    }

    fn latency_definition(&self) -> &'static str {
        "none"
    }

    fn due_definition(&self) -> &'static str {
        "none"
    }
}

fn run(pipeline: impl Pipeline + 'static, fields: u64) -> ExperimentError {
    let scene = builtin("full-screen:1").expect("built in");
    let experiment = Experiment::new(MachineConfig::slats(), pipeline, scene).fields(fields).pixels(Pixels::Off);
    experiment.run().expect_err("nothing is shown")
}

#[test]
fn a_run_of_any_length_in_which_nobody_can_go_on_is_a_deadlock() {
    for fields in [1, 2, 12, 119, 200] {
        match run(Waiting, fields) {
            ExperimentError::Run { error: RunError::Deadlock { blocked, .. }, partial } => {
                assert!(blocked.iter().any(|b| b.waits_for == "a message that nobody sends"), "{blocked:?}");
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
