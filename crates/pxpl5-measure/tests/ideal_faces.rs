//! Errors that remain in pictures drawn without error for one instant of their field.

use address_recalculation::Latch;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::Registration;
use pxpl5_run::{Aim, Experiment, FacePipeline, FacePolicy, FaceSource, Head, Jitp, Pipeline, Pixels, Viewpoint};
use pxpl5_scene::builtin;
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;
use tracking::motion::{Slide, Synthetic};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// Focal length of a picture with 640 pixels over 60 degrees, in pixels.
const FOCAL_PX: f64 = 554.256_258_422_040_8;

/// A head slides at speed v, and its pose is predicted exactly for the first pixel of each field.
///
/// A pixel that lights t later shows content at distance z with an error of f v t / z pixels. The same holds for faces
/// that are drawn in no time, and for a picture without content.
#[test]
fn the_error_of_a_translation_grows_from_the_first_pixel_of_the_field() {
    let speed = 1.0;
    let distance_m = 2.0;
    let faces = FacePipeline { source: FaceSource::Ideal, ..FacePipeline::new(FacePolicy::Full) };
    let pipelines: [(Arc<dyn Pipeline>, &str); 2] =
        [(Arc::new(faces), "sphere:100"), (Arc::new(Jitp::new(Viewpoint::Field, false)), "full-screen:2")];
    for (pipeline, scene) in pipelines {
        let motion = Arc::new(Slide::right_at(speed));
        let head = Head::new(motion, TrackerConfig::ideal(), PredictorKind::ConstantVelocity, 1).expect("in range");
        let head = head.with_aim(Aim::FirstPixel).evaluated_at(distance_m).expect("in range");
        let (name, config) = (pipeline.name(), pipeline.adapt(MachineConfig::small_hmd()));
        let experiment = Experiment::with(config, pipeline, Arc::new(builtin(scene).expect("built in"))).head(head);
        let outcome = experiment.fields(44).pixels(Pixels::Off).run().expect("it runs");
        let registration = Registration::of(&outcome).expect("there is a head");
        let field = PeriodNumber(40);
        let display = outcome.record().display();
        let lights = |x: u32, y: u32| display.lights(0, x, y, field).expect("scanned").0 as f64 * 1e-12;
        for (x, y) in [(0, 0), (320, 0), (320, 120), (10, 240), (639, 478)] {
            let error = registration.at(x, y, field).expect("shown");
            let seconds = lights(x, y) - lights(0, 0);
            let expected = FOCAL_PX * speed * seconds / distance_m;
            assert!((error.offset_px.x - expected).abs() < 0.01, "{name}, {x} {y}: {:?} {expected}", error.offset_px);
            assert!(error.offset_px.y.abs() < 0.01, "{name}, {x} {y}: {:?}", error.offset_px);
        }
    }
}

/// The estimator accepts reports only in ascending order. A request for an earlier pixel must still give the same
/// result.
#[test]
fn errors_do_not_depend_on_the_order_of_requests() {
    let pipeline =
        FacePipeline { source: FaceSource::Ideal, latch: Latch::Line, ..FacePipeline::new(FacePolicy::Full) };
    let config = pipeline.adapt(MachineConfig::small_hmd());
    let motion = Arc::new(Synthetic::recorded_use(1));
    let head = Head::new(motion, TrackerConfig::fastrak(), PredictorKind::ConstantVelocity, 1).expect("in range");
    let experiment = Experiment::new(config, pipeline, builtin("sphere:100").expect("even")).fields(44).head(head);
    let outcome = experiment.pixels(Pixels::Off).run().expect("it runs");
    let registration = Registration::of(&outcome).expect("there is a head");
    for (x, y, field) in [(0, 0, 40), (320, 240, 40), (320, 241, 31), (10, 2, 42), (10, 2, 20), (10, 2, 42)] {
        let field = PeriodNumber(field);
        let alone = Registration::of(&outcome).expect("there is a head").at(x, y, field);
        assert!(alone.is_some_and(|error| error.pixels > 0.0), "{x} {y} {field:?}");
        assert_eq!(registration.at(x, y, field), alone, "{x} {y} {field:?}");
    }
}
