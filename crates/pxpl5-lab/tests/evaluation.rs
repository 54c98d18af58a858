//! Tests that pixel errors are evaluated at the depth of the content, and at the instant when the pixel is lit. This
//! also holds for moving objects.

use glam::{DVec2, Vec3};
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{Measured, PixelErrors, Registration};
use pxpl5_run::{Experiment, ExperimentError, Head, Outcome, Pixels, SampledPose, Slats};
use pxpl5_scene::{Frame, Hinge, Scene, SceneParts, Structure, Vertex};
use pxpl5_sim::Time;
use pxpl5_wire::PeriodNumber;
use std::sync::Arc;
use tracking::Pose;
use tracking::motion::{End, Motion, Recording, Slide, Still};
use tracking::predict::PredictorKind;
use tracking::tracker::TrackerConfig;

/// Focal length in pixels of a picture with 640 pixels over 60 degrees.
const FOCAL_PX: f64 = 554.256_258_422_040_8;
/// Number of an evaluated field, long after the start.
const FIELD: PeriodNumber = PeriodNumber(40);

fn head(motion: impl Motion + Send + Sync + 'static) -> Head {
    Head::new(Arc::new(motion), TrackerConfig::ideal(), PredictorKind::None, 1).expect("in range")
}

fn run(scene: Scene, head: Head) -> Result<Outcome, ExperimentError> {
    let experiment = Experiment::new(MachineConfig::small_hmd(), Slats::split(), scene);
    experiment.head(head).fields(FIELD.0 + 2).pixels(Pixels::Off).run()
}

/// Returns the head pose whose picture a field shows, and the time at which the given pixel is lit.
fn view_of_field(outcome: &Outcome, (x, y): (u32, u32)) -> (SampledPose, Time) {
    let display = outcome.record().display();
    let in_field = outcome.pictures().iter().find(|times| display.period_at(times.shown_at) == FIELD);
    let view = in_field.expect("Slats shows a picture a field").view;
    let sampled = outcome.head().expect("there is a head").sampled();
    let sampled = sampled.into_iter().find(|sampled| sampled.number == view).expect("it was asked for");
    (sampled, display.lights(0, x, y, FIELD).expect("lit"))
}

fn offset_px(outcome: &Outcome, (x, y): (u32, u32)) -> DVec2 {
    let registration = Registration::of(outcome).expect("there is a head");
    registration.at(x, y, FIELD).expect("shown").offset_px
}

#[test]
fn the_error_of_a_translation_is_focal_length_times_movement_over_distance() {
    const SPEED: f64 = 0.5;
    let room = || pxpl5_scene::builtin("room").expect("built in");
    // The wall ahead is 2 m away. `head.evaluate_at` overrides this distance.
    for (evaluated_at, distance_m) in [(None, 2.0), (Some(5.0), 5.0), (Some(0.5), 0.5)] {
        let head = head(Slide::right_at(SPEED));
        let head =
            evaluated_at.map_or_else(|| head.clone(), |metres| head.clone().evaluated_at(metres).expect("in range"));
        let outcome = run(room(), head).expect("it runs");
        for pixel in [(320, 240), (100, 120), (600, 400)] {
            let (view, lights_at) = view_of_field(&outcome, pixel);
            let late_s = lights_at.since(view.measured_at.expect("measured")).as_ms() * 1e-3;
            let expected = FOCAL_PX * SPEED * late_s / distance_m;
            let found = offset_px(&outcome, pixel);
            assert!((found.x / expected - 1.0).abs() < 1e-3 && found.y.abs() < 1e-3 * expected, "{found} {expected}");
        }
    }
}

/// Returns a scene with a wheel 2 m in front of the viewer. The wheel swings about the axis of view.
fn wheel(hinge: Hinge) -> Scene {
    let corner = |x: f32, y: f32| Vertex { position: Vec3::new(x, y, -2.0), normal: Vec3::Z, colour: [255; 3] };
    Scene::new(SceneParts {
        structures: vec![Structure {
            name: "wheel".to_owned(),
            vertices: 0..3,
            triangles: 0..1,
            spheres: 0..0,
            frame: Frame::World,
            hinge: Some(hinge),
            culls_back_faces: false,
        }],
        ..SceneParts::of("wheel", vec![corner(-9.0, -9.0), corner(9.0, -9.0), corner(0.0, 9.0)], vec![[0, 1, 2]])
    })
    .expect("a scene")
}

#[test]
fn the_error_of_a_rotating_object_is_the_chord_of_its_rotation() {
    // At the evaluated field the swing is near its middle, where its rate is highest: 30 degrees x 2 pi x 0.5 Hz.
    let hinge = Hinge {
        point: Vec3::ZERO,
        axis: Vec3::Z,
        amplitude_deg: 30.0,
        period_ps: 2_000_000_000_000,
        phase_turns: 0.17,
    };
    let outcome = run(wheel(hinge), head(Still(Pose::IDENTITY))).expect("it runs");
    for pixel in [(320, 240), (420, 240), (320, 340), (200, 120)] {
        let (view, lights_at) = view_of_field(&outcome, pixel);
        let turned_deg = hinge.angle_deg(lights_at.0) - hinge.angle_deg(view.objects_at.0);
        let radius_px = f64::hypot(f64::from(pixel.0) + 0.5 - 320.0, f64::from(pixel.1) + 0.5 - 240.0);
        let expected = 2.0 * radius_px * (turned_deg.to_radians().abs() / 2.0).sin();
        let found = offset_px(&outcome, pixel).length();
        assert!(turned_deg.abs() > 0.5 && (found / expected - 1.0).abs() < 1e-3, "{found} {expected}");
    }
    let at_a_distance = head(Still(Pose::IDENTITY)).evaluated_at(2.0).expect("in range");
    let outcome = run(wheel(hinge), at_a_distance).expect("it runs");
    assert!(PixelErrors::of(&outcome).pixels.max < 1e-9, "points at a distance do not move with objects");
}

#[test]
fn a_recording_that_is_shorter_than_the_run_is_refused_and_held_on_request() {
    let text = "time_s,x,y,z,qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n0.5,0.1,0,0,1,0,0,0\n";
    let recording = || Recording::read(text.as_bytes()).expect("valid");
    let room = || pxpl5_scene::builtin("room").expect("built in");
    let error = run(room(), head(recording())).expect_err("42 fields are 0.7 s");
    let message = error.to_string();
    assert!(message.starts_with("the recording of the head ends after 0.500 s and the run takes 0.701 s"), "{message}");
    let held = run(room(), head(recording().ending(End::Hold))).expect("it runs");
    let looped = run(room(), head(recording().ending(End::Loop))).expect("it runs");
    assert_ne!(
        held.experiment().config_hash(),
        looped.experiment().config_hash(),
        "what comes after the end belongs to the experiment"
    );
    // With `hold`, the head stands still at the end of the run. With `loop`, the head moves on.
    assert!(held.report().head.expect("a head").error.by_field.last().expect("evaluated").mean_px < 1e-9);
    assert!(looped.report().head.expect("a head").error.by_field.last().expect("evaluated").mean_px > 0.1);
}
