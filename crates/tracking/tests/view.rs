//! The matrices of the eyes agree with values computed by hand.

use glam::{DQuat, DVec3, Vec3, Vec4};
use tracking::Pose;
use tracking::view::{EyePoint, Hmd, HmdConfig, View};

fn hmd() -> Hmd {
    Hmd::unc()
}

/// Returns a head at (1, 2, 3), turned left by 90 degrees. The head looks along -x, and its right is -z.
fn turned_left() -> Pose {
    let half = std::f64::consts::FRAC_1_SQRT_2;
    Pose { position: DVec3::new(1.0, 2.0, 3.0), orientation: DQuat::from_xyzw(0.0, half, 0.0, half) }
}

fn close(a: Vec3, b: Vec3) -> bool {
    (a - b).length() < 1e-5
}

fn pixel_x(view: &View, world: Vec3) -> f64 {
    let clip = view.projection * view.world_to_eye * world.extend(1.0);
    (f64::from(clip.x) / f64::from(clip.w) + 1.0) * 320.0
}

#[test]
fn a_point_ahead_of_a_turned_head_lies_on_the_minus_z_axis_of_the_eye() {
    let view = hmd().mono(&turned_left());
    assert_eq!(view.eye, EyePoint::Centre);
    assert!(close(view.world_to_eye.transform_point3(Vec3::new(-4.0, 2.0, 3.0)), Vec3::new(0.0, 0.0, -5.0)));
    // One metre towards -z in the world is one metre to the right of that head.
    assert!(close(view.world_to_eye.transform_point3(Vec3::new(1.0, 2.5, 2.0)), Vec3::new(1.0, 0.5, 0.0)));
}

#[test]
fn the_left_eye_is_32_mm_left_of_the_head() {
    let [left, right] = hmd().stereo(&turned_left());
    assert_eq!((left.eye, right.eye), (EyePoint::Left, EyePoint::Right));
    // Left of a head that looks along -x is +z.
    assert!(close(left.world_to_eye.transform_point3(Vec3::new(1.0, 2.0, 3.032)), Vec3::ZERO));
    assert!(close(right.world_to_eye.transform_point3(Vec3::new(1.0, 2.0, 2.968)), Vec3::ZERO));
    assert!(close(left.head_to_eye.transform_point3(Vec3::ZERO), Vec3::new(0.032, 0.0, 0.0)));
}

#[test]
fn the_edges_of_the_picture_are_30_degrees_off_the_axis() {
    // tan 30 deg = 0.57735; the height is 3/4 of that.
    let p = hmd().mono(&turned_left()).projection;
    let edge = p.project_point3(Vec3::new(0.577_350_3, 0.433_012_7, -1.0));
    assert!((edge.truncate() - glam::Vec2::ONE).length() < 1e-5, "{edge}");
}

#[test]
fn depth_is_0_at_the_near_plane_1_at_the_far_plane_and_grows_between() {
    let p = hmd().mono(&turned_left()).projection;
    let [near, between, far] = [0.05, 1.0, 50.0].map(|z: f32| p.project_point3(Vec3::new(0.0, 0.0, -z)).z);
    assert!(near.abs() < 1e-6 && (far - 1.0).abs() < 1e-6);
    // far / (far - near) x (1 - near / z) = 50 / 49.95 x 0.95 at 1 m.
    assert!((between - 0.950_951).abs() < 1e-5);
    let clip = p * Vec4::new(0.0, 0.0, -7.0, 1.0);
    assert_eq!(clip.w, 7.0);
}

#[test]
fn disparity_is_eye_separation_times_focal_length_over_depth() {
    // Focal length 320 / tan 30 deg = 554.256 px; 0.064 x 554.256 / 2 = 17.736 px at 2 m.
    assert!((hmd().focal_px() - 554.256).abs() < 1e-3);
    assert!((hmd().disparity_px(2.0) - 17.736_2).abs() < 1e-3);
    let head = turned_left();
    for depth in [0.3_f32, 1.0, 2.0, 40.0] {
        let point = Vec3::new(1.0 - depth, 2.1, 2.9);
        let [left, right] = hmd().stereo(&head).map(|view| pixel_x(&view, point));
        let expected = 0.064 * 554.256_258 / f64::from(depth);
        assert!((left - right - expected).abs() < 0.01, "{depth}: {}", left - right);
    }
}

#[test]
fn an_orientation_quaternion_may_have_any_length() {
    let mut head = turned_left();
    head.orientation *= 7.0;
    let view = hmd().mono(&head);
    assert!(close(view.world_to_eye.transform_point3(Vec3::new(-4.0, 2.0, 3.0)), Vec3::new(0.0, 0.0, -5.0)));
    head.orientation = DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0);
    assert!(close(hmd().mono(&head).world_to_eye.transform_point3(Vec3::ZERO), -head.position.as_vec3()));
}

#[test]
fn numbers_out_of_range_are_refused_by_name() {
    type Damage = fn(&mut HmdConfig);
    let damage: [(&str, Damage); 10] = [
        ("eye_separation_m", |c| c.eye_separation_m = -0.1),
        ("horizontal_fov_deg", |c| c.horizontal_fov_deg = 180.0),
        ("horizontal_fov_deg", |c| c.horizontal_fov_deg = f64::NAN),
        ("convergence_m", |c| c.convergence_m = Some(0.05)),
        ("convergence_m", |c| c.convergence_m = Some(2e6)),
        ("convergence_m", |c| c.convergence_m = Some(f64::NAN)),
        ("width_px", |c| c.width_px = 0),
        ("near_m", |c| c.near_m = f64::NAN),
        ("far_m", |c| c.far_m = 0.05),
        ("far_m", |c| c.far_m = f64::INFINITY),
    ];
    for (what, damage) in damage {
        let mut config = HmdConfig::unc();
        damage(&mut config);
        assert_eq!(&*Hmd::new(config).expect_err(what).name, what);
    }
}

#[test]
fn unknown_keys_of_a_configuration_are_errors() {
    let text = serde_json::to_string(&HmdConfig::unc()).expect("numbers");
    assert_eq!(serde_json::from_str::<HmdConfig>(&text).expect("its own text"), HmdConfig::unc());
    let wrong = text.replace("near_m", "nearest");
    assert!(serde_json::from_str::<HmdConfig>(&wrong).is_err());
}

/// The middle of the picture is pixel 320. Half the eye distance is 32 mm, and cot 30 degrees is 1.732: at 2 m the
/// point is 8.87 pixels off the middle with parallel axes.
#[test]
fn with_converging_eyes_the_point_where_the_eye_axes_meet_is_in_the_middle_of_both_pictures() {
    let head = turned_left();
    let meeting = Vec3::new(-1.0, 2.0, 3.0);
    let places = |convergence_m| {
        let hmd = Hmd::new(HmdConfig { convergence_m, ..HmdConfig::unc() }).expect("in range");
        hmd.stereo(&head).map(|view| pixel_x(&view, meeting))
    };
    let [left, right] = places(Some(2.0));
    assert!((left - 320.0).abs() < 1e-3 && (right - 320.0).abs() < 1e-3, "{left} {right}");
    let [left, right] = places(None);
    let off = 0.032 / 2.0 * 320.0 * 3f64.sqrt();
    assert!((left - 320.0 - off).abs() < 1e-3 && (right - 320.0 + off).abs() < 1e-3, "{left} {right}");
}
