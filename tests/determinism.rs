//! Same input, same trace: whatever the ties, the threads and the pixels.

use pxpl5::{Experiment, MachineConfig, Measured, Pixels, RenderingControl, Slats, Workstation, scene};

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
fn the_same_seed_gives_the_same_trace_twice_and_another_seed_another() {
    for experiment in pipelines() {
        assert_eq!(hash(&experiment), hash(&experiment));
    }
    let [with_mig, ..] = pipelines();
    assert_ne!(hash(&with_mig), hash(&with_mig.clone().seed(2)));
}

#[test]
fn a_hundred_shuffles_of_simultaneous_events_change_nothing() {
    for experiment in pipelines() {
        let experiment = experiment.pixels(Pixels::Off);
        let unshuffled = hash(&experiment);
        for seed in 0..100 {
            assert_eq!(hash(&experiment.clone().shuffle_ties(seed)), unshuffled, "{seed}");
        }
    }
}

#[test]
fn pixels_and_threads_change_no_time_and_threads_no_pixel() {
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
