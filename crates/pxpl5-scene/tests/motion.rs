//! Head motion against the published statistics of recorded heads.

use glam::{DVec3, Vec3};
use pxpl5_scene::config::{MAX_HEAD_SPEED_DEG_PER_S, MEAN_HEAD_SPEED_DEG_PER_S};
use pxpl5_scene::{HeadMotion, HeadPath, Hmd, Pose, Scene, Sway, builtin};

const SECOND: u64 = 1_000_000_000_000;
/// Time between the two poses from which a speed is computed, ps. Ten speeds per second resolve every sine below 2 Hz.
const STEP: u64 = SECOND / 100;

fn forward(pose: &Pose) -> DVec3 {
    pose.orientation * DVec3::NEG_Z
}

/// Returns the angular speed at every tenth of a second, degrees per second.
fn speeds(motion: &HeadMotion, seconds: u64) -> Vec<f64> {
    let speeds = (0..seconds * 10).map(|i| {
        let before = motion.pose(i * SECOND / 10);
        let after = motion.pose(i * SECOND / 10 + STEP);
        before.angle_deg(&after) / 0.01
    });
    speeds.collect()
}

fn swaying(seed: u64) -> HeadMotion {
    HeadMotion::looking_at(Vec3::ZERO, 0.25).with_seed(seed)
}

#[test]
fn the_mean_angular_speed_of_the_motion_agrees_with_recorded_heads_within_10_percent() {
    for seed in [0, 1, 2, 99, u64::MAX] {
        let speeds = speeds(&swaying(seed), 600);
        let mean = speeds.iter().sum::<f64>() / speeds.len() as f64;
        assert!((mean / MEAN_HEAD_SPEED_DEG_PER_S - 1.0).abs() < 0.1, "seed {seed}: {mean}");
    }
}

#[test]
fn no_head_rotates_faster_than_recorded_heads() {
    for seed in 0..8 {
        let fastest = speeds(&swaying(seed), 600).into_iter().fold(0.0, f64::max);
        assert!(fastest < MAX_HEAD_SPEED_DEG_PER_S, "seed {seed}: {fastest}");
    }
}

#[test]
fn the_mean_speed_of_translation_agrees_with_recorded_heads_within_a_quarter() {
    // The published mean is 0.37 m/s. The mean of the motion must agree within a quarter.
    let motion = swaying(1);
    let moved = (0..6_000).map(|i| {
        let a = motion.pose(i * SECOND / 10);
        let b = motion.pose(i * SECOND / 10 + STEP);
        a.position.distance(b.position) / 0.01
    });
    let mean = moved.sum::<f64>() / 6_000.0;
    assert!((mean / 0.37 - 1.0).abs() < 0.25, "{mean}");
}

#[test]
fn practically_all_energy_of_yaw_lies_below_2_hz_and_95_percent_below_0_14_hz() {
    // The discrete Fourier transform of 400 s at 8 Hz, without the mean. A Hann window prevents leaks of lines to
    // higher frequencies.
    let motion = swaying(5);
    let count = 3_200_usize;
    let mut previous = 0.0_f64;
    let yaw = (0..count).map(|i| {
        let f = forward(&motion.pose(i as u64 * SECOND / 8));
        let angle = (-f.x).atan2(-f.z);
        // Unwrap the angle: a turn between two samples is less than half a circle.
        previous +=
            (angle - previous + 3.0 * std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
        previous
    });
    let yaw: Vec<f64> = yaw.collect();
    let mean = yaw.iter().sum::<f64>() / count as f64;
    let energies: Vec<f64> = (1..count / 2).map(|bin| energy(&yaw, mean, bin)).collect();
    let [below_0_145, below_2] = [0.145, 2.0]
        .map(|hz: f64| energies[..(hz * 400.0) as usize].iter().sum::<f64>() / energies.iter().sum::<f64>());
    assert!(below_0_145 > 0.95, "{below_0_145}");
    assert!(below_2 > 0.999, "{below_2}");
}

/// Returns the energy of one frequency of a signal, through a Hann window.
fn energy(signal: &[f64], mean: f64, bin: usize) -> f64 {
    let count = signal.len();
    let turn = std::f64::consts::TAU / count as f64;
    let mut re = 0.0;
    let mut im = 0.0;
    for (i, y) in signal.iter().enumerate() {
        let window = 1.0 - (turn * i as f64).cos();
        let (sin, cos) = (turn * ((bin * i) % count) as f64).sin_cos();
        re += (y - mean) * window * cos;
        im += (y - mean) * window * sin;
    }
    re * re + im * im
}

#[test]
fn equal_seeds_give_equal_poses_and_different_seeds_different_poses() {
    let time = 123_456_789_012_345;
    assert_eq!(swaying(3).pose(time), swaying(3).pose(time));
    assert_ne!(swaying(3).pose(time), swaying(4).pose(time));
}

#[test]
fn a_pan_of_90_degrees_per_second_looks_left_after_a_second() {
    let path = HeadPath::Pan { eye: Vec3::ONE, deg_per_s: 90.0 };
    let motion = HeadMotion::new(path, Sway::none()).expect("in range");
    assert!((forward(&motion.pose(0)) - DVec3::NEG_Z).length() < 1e-6);
    assert!((forward(&motion.pose(SECOND)) - DVec3::NEG_X).length() < 1e-6);
    assert_eq!(motion.pose(SECOND).position, DVec3::ONE);
}

#[test]
fn an_orbit_faces_its_target_from_the_stated_distance() {
    let target = Vec3::new(1.0, 0.0, -2.0);
    let path = HeadPath::Orbit { target, distance: 3.0, height: 0.0, deg_per_s: 90.0 };
    let motion = HeadMotion::new(path, Sway::none()).expect("in range");
    assert!((motion.pose(0).position - DVec3::new(1.0, 0.0, 1.0)).length() < 1e-6);
    let pose = motion.pose(SECOND);
    assert!((pose.position - DVec3::new(4.0, 0.0, -2.0)).length() < 1e-6);
    assert!((forward(&pose) - DVec3::NEG_X).length() < 1e-6);
}

#[test]
fn a_still_head_stays_upright_even_when_it_looks_straight_down() {
    let path = HeadPath::Still { eye: Vec3::Y, target: Vec3::ZERO };
    let pose = HeadMotion::new(path, Sway::none()).expect("in range").pose(SECOND);
    assert!((forward(&pose) - DVec3::NEG_Y).length() < 1e-6);
    assert!((pose.orientation.length() - 1.0).abs() < 1e-6);
}

#[test]
fn the_default_motion_of_every_scene_keeps_the_centre_of_the_model_in_view_for_hours() {
    let hmd = Hmd::unc();
    for name in ["mig", "molecules", "head"] {
        let scene = builtin(name).expect("a built-in scene");
        let (centre, _) = scene.bounding_sphere();
        for i in 0..5_000 {
            let view = hmd.mono(&scene.motion().pose(i * 7_777 * (SECOND / 1_000)));
            let p = (view.projection * view.world_to_eye).project_point3(centre);
            assert!(p.x.abs() < 1.0 && p.y.abs() < 1.0 && (0.0..1.0).contains(&p.z), "{name} {p}");
        }
    }
}

/// Returns the fraction of the picture that the bounding rectangle of the model's vertices covers.
fn boxed_share(scene: &Scene, time_ps: u64) -> f32 {
    let hmd = Hmd::unc();
    let view = hmd.mono(&scene.motion().pose(time_ps));
    let to_clip = view.projection * view.world_to_eye;
    let points = scene.vertices().iter().map(|v| to_clip * v.position.extend(1.0));
    let ahead = points.filter(|p| p.w > 0.05).map(|p| p.truncate().truncate() / p.w);
    let edge = glam::Vec2::ONE;
    let low = ahead.clone().fold(edge, |a, b| a.min(b)).max(-edge);
    let high = ahead.fold(-edge, |a, b| a.max(b)).min(edge);
    let size = (high - low).max(glam::Vec2::ZERO);
    size.x * size.y / 4.0
}

#[test]
fn mig_varies_between_filling_the_view_and_being_small() {
    // The model is large in at least a twentieth of two laps, and small in another twentieth.
    let mig = builtin("mig").expect("a built-in scene");
    let shares: Vec<f32> = (0..80).map(|i| boxed_share(&mig, i * SECOND / 2)).collect();
    assert!(shares.iter().filter(|&&s| s > 0.9).count() >= 4, "{shares:?}");
    assert!(shares.iter().filter(|&&s| s < 0.1).count() >= 4, "{shares:?}");
}

#[test]
fn numbers_out_of_range_are_refused_in_code_and_in_files() {
    let nan = HeadPath::Pan { eye: Vec3::ZERO, deg_per_s: f64::NAN };
    assert_eq!(&*HeadMotion::new(nan, Sway::none()).expect_err("not a number").name, "deg_per_s");
    let far = HeadPath::Look { target: Vec3::splat(f32::INFINITY), distance: 1.0 };
    assert_eq!(&*HeadMotion::new(far, Sway::none()).expect_err("infinite").name, "target");
    let text = serde_json::to_string(&swaying(7)).expect("plain data");
    assert_eq!(serde_json::from_str::<HeadMotion>(&text).expect("its own text"), swaying(7));
    let wild = text.replace("\"scale\":1.0", "\"scale\":-1.0");
    let error = serde_json::from_str::<HeadMotion>(&wild).expect_err("a negative scale").to_string();
    assert!(error.contains("sway scale: expected 0 to 10, found -1"), "{error}");
}
