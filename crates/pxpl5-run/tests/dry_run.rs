//! Test that the result of a dry run without prediction is the same for every predictor.

use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, Head, PipelineSettings, Pixels, Registry};
use pxpl5_scene::builtin;
use std::sync::Arc;
use tracking::motion::Synthetic;
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

fn head(kind: PredictorKind) -> Head {
    Head::new(Arc::new(Synthetic::recorded_use(1)), TrackerConfig::optical_ceiling(), kind, 1).expect("in range")
}

#[test]
fn a_run_that_continues_with_another_predictor_equals_a_run_with_this_predictor_from_the_start() {
    let registry = Registry::of_papers();
    for name in ["rendering-control", "slats", "jitp-field", "arp-full-line"] {
        let pipeline = (registry.pipeline(name).expect("listed").build)(&PipelineSettings::default());
        let config = pipeline.adapt(MachineConfig::small_hmd());
        let scene = Arc::new(builtin("sphere:100").expect("even"));
        let plain = Experiment::with(config, pipeline, scene).fields(70).pixels(Pixels::Off);
        let of_kalman = plain.clone().head(head(PredictorKind::Kalman)).after_dry_run().expect("it runs");
        assert!(of_kalman.dry_run.is_some(), "{name}");
        for kind in [PredictorKind::Kalman, PredictorKind::ConstantVelocity] {
            let alone = plain.clone().head(head(kind));
            let mut continued = alone.clone();
            continued.dry_run = of_kalman.dry_run.clone();
            let [alone, continued] = [alone, continued].map(|experiment| experiment.run().expect("it runs"));
            assert_eq!(alone.record().trace_hash(), continued.record().trace_hash(), "{name}, {kind:?}");
            let sampled = [&alone, &continued].map(|outcome| outcome.head().expect("tracked").sampled());
            assert_eq!(sampled[0], sampled[1], "{name}, {kind:?}");
        }
    }
}

#[test]
fn an_experiment_without_prediction_has_no_dry_run() {
    let registry = Registry::of_papers();
    let pipeline = (registry.pipeline("slats").expect("listed").build)(&PipelineSettings::default());
    let scene = Arc::new(builtin("sphere:100").expect("even"));
    let experiment = Experiment::with(MachineConfig::small_hmd(), pipeline, scene).head(head(PredictorKind::None));
    assert!(experiment.after_dry_run().expect("nothing to run").dry_run.is_none());
}
