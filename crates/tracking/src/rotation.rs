//! Quaternions and rotation vectors. Every transcendental function comes from `libm`, so that all hosts agree bit for
//! bit.
//!
//! Rotation vectors are in radians, in the world frame: `exp(r) * q` rotates `q` by `r`. Axes are right-handed with y
//! up, and a view looks along -z. Positive yaw therefore turns left, and positive pitch turns up.

use glam::{DQuat, DVec3};

/// Squared half angle below which [`exp`] and [`log`] use a series. The first omitted term of the series is below
/// 1e-18, so the result is exact to the last bit.
const SERIES_BELOW: f64 = 1e-6;

/// Returns the rotation by the vector `r` (rad). Any length is allowed.
pub fn exp(r: DVec3) -> DQuat {
    let half_squared = r.length_squared() / 4.0;
    let (sinc, cos) = if half_squared < SERIES_BELOW {
        (1.0 - half_squared / 6.0 * (1.0 - half_squared / 20.0), 1.0 - half_squared / 2.0 * (1.0 - half_squared / 12.0))
    } else {
        let half = half_squared.sqrt();
        let (sin, cos) = libm::sincos(half);
        (sin / half, cos)
    };
    let v = r * (0.5 * sinc);
    DQuat::from_xyzw(v.x, v.y, v.z, cos)
}

/// Returns the shortest rotation vector (rad, length at most pi) that gives the rotation of the unit quaternion `q`.
/// The quaternions `q` and `-q` give the same vector.
pub fn log(q: DQuat) -> DVec3 {
    let q = if q.w < 0.0 { -q } else { q };
    let v = DVec3::new(q.x, q.y, q.z);
    let squared = v.length_squared();
    if squared < SERIES_BELOW {
        let ratio = squared / (q.w * q.w);
        return v * (2.0 / q.w * (1.0 - ratio / 3.0 * (1.0 - 0.6 * ratio)));
    }
    let sin = squared.sqrt();
    v * (2.0 * libm::atan2(sin, q.w) / sin)
}

/// Returns the vector (rad) of the shorter rotation from `from` to `to`, in the world frame.
pub fn difference(from: DQuat, to: DQuat) -> DVec3 {
    log(to * from.conjugate())
}

/// Returns the angle between two orientations in degrees, 0 to 180.
pub fn angle_deg(a: DQuat, b: DQuat) -> f64 {
    difference(a, b).length().to_degrees()
}

/// Interpolates spherically along the shorter rotation between two orientations. The result is `from` for `s` = 0 and
/// `to` for `s` = 1.
pub fn slerp(from: DQuat, to: DQuat, s: f64) -> DQuat {
    (exp(difference(from, to) * s) * from).normalize()
}

/// Returns the rotation by three angles in radians: yaw about the y axis, then pitch about the turned x axis, then roll
/// about the turned z axis.
pub fn from_yaw_pitch_roll(yaw: f64, pitch: f64, roll: f64) -> DQuat {
    about_y(yaw) * about_x(pitch) * about_z(roll)
}

/// Returns yaw, pitch and roll in radians, the inverse of [`from_yaw_pitch_roll`]. Pitch is within +-pi/2. If the view
/// is straight up or down, yaw and roll have the same axis. Yaw is 0 in this case, and roll is the whole angle.
pub fn to_yaw_pitch_roll(q: DQuat) -> (f64, f64, f64) {
    let forward = q * DVec3::NEG_Z;
    let level = (forward.x * forward.x + forward.z * forward.z).sqrt();
    let yaw = if level > 1e-12 { libm::atan2(-forward.x, -forward.z) } else { 0.0 };
    let pitch = libm::atan2(forward.y, level);
    let rest = (about_y(yaw) * about_x(pitch)).conjugate() * q;
    (yaw, pitch, 2.0 * libm::atan2(rest.z, rest.w))
}

/// Returns the rotation about the x axis by `angle` radians.
pub fn about_x(angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle / 2.0);
    DQuat::from_xyzw(sin, 0.0, 0.0, cos)
}

/// Returns the rotation about the y axis by `angle` radians.
pub fn about_y(angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle / 2.0);
    DQuat::from_xyzw(0.0, sin, 0.0, cos)
}

/// Returns the rotation about the z axis by `angle` radians.
pub fn about_z(angle: f64) -> DQuat {
    let (sin, cos) = libm::sincos(angle / 2.0);
    DQuat::from_xyzw(0.0, 0.0, sin, cos)
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use proptest::prelude::*;

    fn vector(limit: f64) -> impl Strategy<Value = DVec3> {
        (-1.0..1.0, -1.0..1.0, -1.0..1.0, 0.0..limit)
            .prop_map(|(x, y, z, length)| DVec3::new(x, y, z).normalize_or(DVec3::X) * length)
    }

    proptest! {
        #[test]
        fn log_undoes_exp_up_to_half_a_turn(r in vector(PI - 1e-6)) {
            prop_assert!((log(exp(r)) - r).length() < 1e-9);
        }

        #[test]
        fn log_undoes_exp_for_tiny_angles_to_machine_precision(r in vector(1e-3)) {
            prop_assert!((log(exp(r)) - r).length() <= 4.0 * f64::EPSILON * r.length());
        }

        #[test]
        fn exp_is_a_unit_quaternion(r in vector(20.0)) {
            prop_assert!((exp(r).length() - 1.0).abs() < 1e-14);
        }

        #[test]
        fn exp_agrees_with_an_independent_library(r in vector(6.0)) {
            prop_assert!((exp(r) - DQuat::from_scaled_axis(r)).length() < 1e-14);
        }

        #[test]
        fn both_signs_of_a_quaternion_have_the_same_log(r in vector(3.0)) {
            prop_assert_eq!(log(exp(r)), log(-exp(r)));
        }

        #[test]
        fn yaw_pitch_and_roll_are_recovered_from_the_quaternion(yaw in -3.1..3.1f64, pitch in -1.5..1.5f64, roll in -3.1..3.1f64) {
            let (y, p, r) = to_yaw_pitch_roll(from_yaw_pitch_roll(yaw, pitch, roll));
            prop_assert!((y - yaw).abs() < 1e-10 && (p - pitch).abs() < 1e-10 && (r - roll).abs() < 1e-10);
        }
    }

    #[test]
    fn log_of_exactly_half_a_turn_has_length_pi() {
        assert!((log(DQuat::from_xyzw(0.0, 1.0, 0.0, 0.0)).length() - PI).abs() < 1e-15);
    }

    #[test]
    fn interpolation_between_quaternions_takes_the_shorter_path_for_either_sign() {
        let a = about_y(0.2);
        let b = -about_y(0.6);
        assert!(angle_deg(slerp(a, b, 0.5), about_y(0.4)) < 1e-12);
    }

    #[test]
    fn yaw_pitch_and_roll_are_recovered_for_a_head_that_looks_straight_up() {
        let q = from_yaw_pitch_roll(0.0, PI / 2.0, 0.3);
        let (yaw, pitch, roll) = to_yaw_pitch_roll(q);
        assert!(angle_deg(from_yaw_pitch_roll(yaw, pitch, roll), q) < 1e-6);
    }

    #[test]
    fn a_positive_yaw_turns_to_the_left_and_a_positive_pitch_turns_up() {
        assert!((about_y(PI / 2.0) * DVec3::NEG_Z - DVec3::NEG_X).length() < 1e-15);
        assert!((about_x(PI / 2.0) * DVec3::NEG_Z - DVec3::Y).length() < 1e-15);
    }
}
