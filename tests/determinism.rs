//! Tests that the same input gives the same trace, with any order of ties. (random_machines.rs tests pixels and threads.)

use crate::support;
use pxpl5::{Experiment, Frameless, MachineConfig, Measured, Pixels, RenderingControl, Slats, scene};
use rayon::prelude::*;

fn pipelines() -> [Experiment; 3] {
    let mig = scene::builtin("mig").expect("built in");
    let full = scene::builtin("full-screen:60").expect("built in");
    [
        Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), mig.clone()).fields(16),
        Experiment::new(MachineConfig::small_hmd(), RenderingControl::mono(), mig).fields(16),
        Experiment::new(MachineConfig::slats(), Slats::split(), full).fields(12),
    ]
}

fn hash(experiment: &Experiment) -> String {
    experiment.run().expect("it runs").report().trace_hash
}

#[test]
fn equal_seeds_give_equal_traces_and_different_seeds_different_traces() {
    for experiment in pipelines() {
        assert_eq!(hash(&experiment), hash(&experiment));
    }
    let [with_mig, ..] = pipelines();
    assert_ne!(hash(&with_mig), hash(&with_mig.clone().seed(2)));
}

/// Returns the whole report without values that depend on the host or on the order of ties. These are the seconds of
/// the run, and the number of events without effect.
fn report(experiment: &Experiment) -> serde_json::Value {
    let mut report = serde_json::to_value(experiment.run().expect("it runs").report()).expect("it is data");
    let fields = report.as_object_mut().expect("an object");
    fields.remove("host_seconds");
    fields.remove("events");
    report
}

/// Returns machines in which more events happen at one instant than in any machine that was built.
fn machines_of_many_ties() -> [Experiment; 2] {
    let scene = scene::builtin("full-screen:4").expect("built in");
    let crowded = MachineConfig { n_renderers: 1_000, ..MachineConfig::small_hmd() };
    let mut instant = MachineConfig::small_hmd();
    instant.set("renderer.backing_block_clocks", 0u64).expect("within its limits");
    let mig = scene::builtin("mig").expect("built in");
    [
        Experiment::new(crowded, Frameless::new(), scene).fields(8).pixels(Pixels::Off),
        Experiment::new(instant, RenderingControl::mono(), mig).fields(16).pixels(Pixels::Off),
    ]
}

#[test]
fn no_number_of_a_report_depends_on_the_order_of_simultaneous_events() {
    for experiment in machines_of_many_ties().into_iter().chain(pipelines().map(|e| e.pixels(Pixels::Off))) {
        let unshuffled = report(&experiment);
        (0..support::sample_or_all(3, 6)).into_par_iter().for_each(|seed| {
            assert_eq!(report(&experiment.clone().shuffle_ties(seed)), unshuffled, "{seed}");
        });
    }
}
