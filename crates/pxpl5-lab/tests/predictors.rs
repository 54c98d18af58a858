//! Tests every predictor on one experiment, tuned for its pipeline. For a still head, the noise error with a predictor
//! must not exceed the error without prediction.

use crate::support;
use pxpl5_lab::compare::{Predictors, predictors};
use pxpl5_machine::MachineConfig;
use pxpl5_measure::Measured;
use pxpl5_run::{Experiment, Head, Pipeline, RenderingControl, Slats};
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::{Motion, Pan, Still};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

const FIELDS: u64 = 180;

fn experiment(pipeline: impl Pipeline + 'static, motion: impl Motion + Send + Sync + 'static) -> Experiment {
    let scene = pxpl5_scene::builtin("room").expect("built in");
    let head = Head::new(Arc::new(motion), TrackerConfig::optical_ceiling(), PredictorKind::Kalman, 1);
    Experiment::new(MachineConfig::small_hmd(), pipeline, scene).head(head.expect("in range")).fields(FIELDS)
}

fn mean(all: &Predictors, kind: PredictorKind) -> f64 {
    all.of(kind).and_then(|one| one.error.as_ref()).expect("evaluated").pixels.mean
}

#[test]
fn on_a_still_head_a_tuned_filter_adds_no_error() {
    let still = || Still(Pose::IDENTITY);
    for (name, experiment) in [
        ("rendering-control", experiment(RenderingControl::stereo(), still())),
        ("slats", experiment(Slats::split(), still())),
    ] {
        let all = predictors(&experiment).expect("there is a head");
        let none = mean(&all, PredictorKind::None);
        let kalman = mean(&all, PredictorKind::Kalman);
        // Each picture shows one report, and 60 independent reports come each second. Without prediction, the standard
        // deviation of the errors' lengths is at most their mean.
        let independent =
            all.of(PredictorKind::None).and_then(|one| one.error.as_ref()).expect("evaluated").by_field.len() / 2;
        let tolerance = 3.0 / (independent as f64).sqrt();
        assert!(kalman <= none * (1.0 + tolerance), "{name}: {kalman} px with the filter, {none} without");
        assert_eq!(all.chosen, PredictorKind::Kalman);
        let least = PredictorKind::ALL.map(|kind| mean(&all, kind)).into_iter().fold(f64::INFINITY, f64::min);
        assert_eq!(mean(&all, all.best.expect("evaluated")), least);
    }
}

#[test]
fn the_report_names_the_tuning_of_a_filter_and_uses_the_interval_of_the_pipeline() {
    let outcome = experiment(RenderingControl::stereo(), Pan::at(60.0)).run().expect("it runs");
    let head = outcome.report().head.expect("there is a head");
    let training = head.training.expect("tuned");
    let interval_ms = training.interval_ps as f64 * 1e-9;
    // A frame is visible for two fields and is predicted for the middle of both. This instant is half a field after the
    // light of the picture's middle.
    let expected_ms = head.end_to_end.total_ms + 1001.0 / 60.0 / 2.0;
    assert!((interval_ms - expected_ms).abs() <= 1.0, "{interval_ms} {expected_ms}");
    assert_ne!(training.seed, 1, "not on the noise that is evaluated");
    assert_eq!(head.prediction.kind, PredictorKind::Kalman);
    // The requested predictor determines the experiment's hash. The tuned predictor has a hash of its own.
    let asked = outcome.experiment().head.as_ref().expect("asked for").fingerprint().to_string();
    assert_ne!(head.fingerprint, asked);
}

#[test]
fn parameters_set_by_the_user_are_not_tuned() {
    let ran = |more: &str| {
        let head = "head.motion = \"pan:50\"\nhead.tracker = \"fastrak\"";
        let plan = support::plan(&format!("pipeline = \"slats\"\nscene = \"room\"\nfields = 40\n{head}\n{more}"));
        support::run(&plan).expect("it runs").report().head.expect("a head")
    };
    let given = ran("tracking.filter.orientation_jerk = 77.0\n");
    assert_eq!((given.prediction.orientation_jerk, given.training), (77.0, None));
    assert_eq!(ran("head.filter = \"given\"\n").training, None);
    assert!(ran("head.filter = \"tuned\"\n").training.is_some());
    assert!(ran("").training.is_some());
    // The output of a run states both the initial parameters and that they were tuned.
    assert!(ran("head.filter = \"tuned\"\ntracking.filter.position_jerk = 1.0\n").training.is_some());
}
