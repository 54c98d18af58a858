//! Tests that the same input gives the same trace, with any order of ties, any number of threads, and with or without
//! pixels.

use crate::support;
use pxpl5::{Experiment, Frameless, MachineConfig, Measured, Pixels, RenderingControl, Slats, Workstation, scene};
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

/// Runs random orders, each with one of the three pipelines. `PXPL5_ALL_CASES=1` runs a hundred orders, each with all
/// pipelines.
#[test]
fn no_order_of_simultaneous_events_changes_the_trace() {
    let experiments = pipelines().map(|experiment| experiment.pixels(Pixels::Off));
    let unshuffled = experiments.each_ref().map(hash);
    let all = support::runs_all_cases();
    (0..support::sample_or_all(36, 100)).into_par_iter().for_each(|seed| {
        for (number, (experiment, expected)) in experiments.iter().zip(&unshuffled).enumerate() {
            if all || seed as usize % experiments.len() == number {
                assert_eq!(hash(&experiment.clone().shuffle_ties(seed)), *expected, "{seed}");
            }
        }
    });
}

#[test]
fn pixels_change_no_time_and_threads_change_no_time_or_pixel() {
    for experiment in pipelines() {
        let off = hash(&experiment.clone().pixels(Pixels::Off));
        let lazy = experiment.clone().pixels(Pixels::Lazy).run().expect("it runs");
        assert_eq!(lazy.report().trace_hash, off);
        for threads in [0, 1, 2] {
            let all =
                experiment.clone().pixels(Pixels::All).host(Workstation::with_threads(threads)).run().expect("it runs");
            assert_eq!(all.report().trace_hash, off);
            for eye in pxpl5::Eye::BOTH {
                assert!(all.picture(eye) == lazy.picture(eye), "{eye:?} with {threads} threads");
            }
        }
    }
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

/// The report hash covers the statistics, so a different order of summation changes the hash.
#[test]
fn the_report_hash_differs_from_the_trace_hash() {
    let [experiment, ..] = pipelines();
    let outcome = experiment.pixels(Pixels::Off).run().expect("it runs");
    assert_ne!(outcome.report().trace_hash, outcome.record().trace_hash().to_string());
}
