//! What remains wrong where faces are drawn in no time.

use pxpl5_machine::MachineConfig;
use pxpl5_measure::Registration;
use pxpl5_run::{Aim, Experiment, FacePipeline, FacePolicy, FaceSource, Head, Pipeline, Pixels};
use pxpl5_scene::builtin;
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;
use tracking::motion::Slide;
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// Focal length of 640 pixels over 60 degrees.
const FOCAL_PX: f64 = 554.256_258_422_040_8;

/// A head that slides at a speed, predicted without error for the first pixel of each field: a pixel that lights later shows a wall at
/// z m from where the eye was then, f v t / z pixels off.
#[test]
fn under_a_slide_a_pixel_is_off_by_the_way_since_the_first_of_its_field() {
    let speed = 1.0;
    let pipeline = FacePipeline { source: FaceSource::Ideal, ..FacePipeline::new(FacePolicy::Full) };
    let config = pipeline.adapt(MachineConfig::small_hmd());
    let head = Head::new(Arc::new(Slide::right_at(speed)), TrackerConfig::ideal(), PredictorKind::ConstantVelocity, 1);
    let distance_m = 2.0;
    let head = head.expect("in range").aiming(Aim::FirstPixel).judged_at(distance_m).expect("in range");
    let experiment = Experiment::new(config, pipeline, builtin("sphere:100").expect("even")).fields(44).head(head);
    let outcome = experiment.pixels(Pixels::Off).run().expect("it runs");
    let registration = Registration::of(&outcome).expect("there is a head");
    let field = PeriodNumber(40);
    let lights = |x: u32, y: u32| outcome.record().display().lights(0, x, y, field).expect("scanned").0 as f64 * 1e-12;
    for (x, y) in [(0, 0), (320, 0), (320, 120), (10, 240), (639, 478)] {
        let error = registration.at(x, y, field).expect("shown");
        let seconds = lights(x, y) - lights(0, 0);
        let expected = FOCAL_PX * speed * seconds / distance_m;
        assert!((error.offset_px.x - expected).abs() < 0.01, "{x} {y}: {:?} {expected}", error.offset_px);
        assert!(error.offset_px.y.abs() < 0.01, "{x} {y}: {:?}", error.offset_px);
    }
}
