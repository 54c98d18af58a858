use glam::{DVec2, DVec3};

use super::Hmd;
use super::hmd::angle_between;
use crate::pose::Pose;
use crate::rotation;
use crate::time::span_s;

/// The raster offset, a method of Breglia's display VDRT (1981). Just before scan-out, a picture drawn for a predicted
/// pose is shifted by the yaw and pitch error of the prediction. During the field the shift changes at the rates of yaw
/// and pitch.
///
/// Yaw and pitch are about the axes of the head. A projector can rotate its whole raster. The offset is then exact for
/// yaw and pitch errors of distant points. A flat raster can only be shifted, so the offset is exact only in the
/// middle. Errors by roll and translation always remain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RasterOffset {
    /// Yaw angle of the offset, radians. A positive value moves the picture to the left.
    pub yaw: f64,
    /// Pitch angle of the offset, radians. A positive value moves the picture up.
    pub pitch: f64,
    /// Rate of change of the offset's yaw, rad/s.
    pub yaw_rate: f64,
    /// Rate of change of the offset's pitch, rad/s.
    pub pitch_rate: f64,
    /// Instant at which the offset is exactly `yaw` and `pitch`, ps.
    pub at_ps: u64,
}

impl RasterOffset {
    /// Returns the raster offset at `at_ps` for a picture that was drawn for the pose `predicted` and is seen from the
    /// pose `actual`. The rates of this offset are 0, so the offset does not change during the field.
    pub fn between(predicted: &Pose, actual: &Pose, at_ps: u64) -> Self {
        let error = actual.orientation.conjugate() * predicted.orientation;
        let (yaw, pitch, _roll) = rotation::to_yaw_pitch_roll(error);
        Self { yaw, pitch, yaw_rate: 0.0, pitch_rate: 0.0, at_ps }
    }

    /// Returns this raster offset with new rates of yaw and pitch. The rates follow from `angular_velocity` (rad/s,
    /// world frame), with which the head turns after the picture was drawn. The rates are exact if the head turns only
    /// about its yaw axis or only about its pitch axis.
    pub fn with_rates(self, actual: &Pose, angular_velocity: DVec3) -> Self {
        let of_head = actual.orientation.conjugate() * angular_velocity;
        Self { yaw_rate: -of_head.y, pitch_rate: -of_head.x, ..self }
    }

    fn angles(&self, t_ps: u64) -> (f64, f64) {
        let dt_s = span_s(self.at_ps, t_ps);
        (self.yaw + self.yaw_rate * dt_s, self.pitch + self.pitch_rate * dt_s)
    }

    /// Returns the direction in which a viewer sees a point at the time `t_ps`. The point was drawn in the direction
    /// `drawn`. The raster rotates as a whole.
    pub fn turned(&self, drawn: DVec3, t_ps: u64) -> DVec3 {
        let (yaw, pitch) = self.angles(t_ps);
        rotation::about_y(yaw) * (rotation::about_x(pitch) * drawn)
    }

    /// Returns the shift of a flat raster at `t_ps`, px, x to the right and y down.
    pub fn shift_px(&self, view: &Hmd, t_ps: u64) -> DVec2 {
        let middle = self.turned(DVec3::NEG_Z, t_ps);
        view.project(middle).map_or(DVec2::ZERO, |place| place - view.centre_px())
    }

    /// Returns the angular error (degrees) of a world point after the offset at `t_ps`, on a raster that rotates as a
    /// whole. The point was drawn for the pose `predicted` and is seen from the pose `actual`.
    pub fn residual_deg(&self, world: DVec3, predicted: &Pose, actual: &Pose, t_ps: u64) -> f64 {
        let shown = self.turned(predicted.view_of(world), t_ps);
        angle_between(shown, actual.view_of(world)).to_degrees()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::{Motion, Pan};
    use crate::time::{NTSC_FIELD_PS, ntsc_lines_ps};

    const FAR: f64 = 1e9;

    fn points(distance: f64) -> impl Iterator<Item = DVec3> {
        (-3..=3).flat_map(move |i| {
            (-2..=2).map(move |j| {
                let yaw = f64::from(i) * 0.16;
                let pitch = f64::from(j) * 0.18;
                rotation::from_yaw_pitch_roll(yaw, pitch, 0.0) * DVec3::NEG_Z * distance
            })
        })
    }

    fn worst(offset: &RasterOffset, distance: f64, predicted: &Pose, actual: &Pose, t_ps: u64) -> f64 {
        points(distance)
            .map(|p| predicted.orientation * p)
            .map(|p| offset.residual_deg(p, predicted, actual, t_ps))
            .fold(0.0, f64::max)
    }

    fn wrong_by(yaw: f64, pitch: f64, roll: f64, predicted: &Pose) -> Pose {
        let error = rotation::from_yaw_pitch_roll(yaw, pitch, roll);
        Pose { orientation: predicted.orientation * error.conjugate(), ..*predicted }
    }

    #[test]
    fn the_raster_offset_removes_yaw_and_pitch_errors_of_distant_points() {
        let predicted = Pose::facing(rotation::from_yaw_pitch_roll(0.7, -0.3, 0.2));
        for (yaw, pitch) in [(0.05, 0.0), (0.0, -0.04), (0.06, 0.03)] {
            let actual = wrong_by(yaw, pitch, 0.0, &predicted);
            let offset = RasterOffset::between(&predicted, &actual, 0);
            assert!(worst(&offset, FAR, &predicted, &actual, 0) < 1e-12);
        }
    }

    #[test]
    fn the_raster_offset_does_not_remove_roll_errors() {
        let predicted = Pose::IDENTITY;
        let actual = wrong_by(0.05, 0.02, 0.03, &predicted);
        let offset = RasterOffset::between(&predicted, &actual, 0);
        let edge = rotation::about_y(0.5) * DVec3::NEG_Z * FAR;
        let expected = 2.0 * (0.5f64.sin() * 0.015f64.sin()).asin();
        assert!((offset.residual_deg(edge, &predicted, &actual, 0) - expected.to_degrees()).abs() < 1e-9);
    }

    #[test]
    fn the_raster_offset_leaves_the_error_of_a_translation_at_near_points() {
        let predicted = Pose::IDENTITY;
        let actual = Pose::at(DVec3::X * 0.01);
        let offset = RasterOffset::between(&predicted, &actual, 0);
        let [near, far] = [1.0, FAR].map(|m| offset.residual_deg(DVec3::NEG_Z * m, &predicted, &actual, 0));
        assert!((near - 0.01f64.atan().to_degrees()).abs() < 1e-9);
        assert!(far < 1e-8);
    }

    #[test]
    fn the_rate_signal_keeps_a_pan_exact_to_the_last_line() {
        let pan = Pan::at(200.0);
        let predicted = pan.pose(1_000_000_000);
        let start = pan.pose(0);
        let held = RasterOffset::between(&predicted, &start, 0);
        let steered = held.with_rates(&start, pan.angular_velocity(0));
        for line in [0, 1, 120, 239] {
            let t_ps = ntsc_lines_ps(line);
            let drift = 200.0 * t_ps as f64 / 1e12;
            assert!(worst(&steered, FAR, &predicted, &pan.pose(t_ps), t_ps) < 1e-9, "line {line}");
            let ahead = predicted.orientation * DVec3::NEG_Z * FAR;
            let left = held.residual_deg(ahead, &predicted, &pan.pose(t_ps), t_ps);
            assert!((left - drift).abs() < 1e-9, "without it the error grows: line {line}");
        }
    }

    #[test]
    fn a_flat_raster_is_correct_in_the_middle_and_wrong_at_the_edge() {
        let view = Hmd::unc();
        let pan = Pan::at(200.0);
        let predicted = pan.pose(0);
        let actual = pan.pose(NTSC_FIELD_PS);
        let shift = RasterOffset::between(&predicted, &actual, 0).shift_px(&view, 0);
        let edge = 30f64.to_radians();
        let [error_middle, error_edge] = [0.0, edge].map(|yaw| {
            let point = predicted.orientation * rotation::about_y(yaw) * DVec3::NEG_Z * FAR;
            let drawn = view.project(predicted.view_of(point)).unwrap();
            (drawn + shift - view.project(actual.view_of(point)).unwrap()).length()
        });
        assert!(error_middle < 1e-9);
        // f (tan(30 deg) - tan(30 deg - turn)) minus f tan(turn): 9.1 px.
        let f = view.focal_px();
        let turn = 200f64.to_radians() * NTSC_FIELD_PS as f64 / 1e12;
        let expected = f * (edge.tan() - (edge - turn).tan() - turn.tan());
        assert!((error_edge - expected).abs() < 1e-6, "{error_edge} {expected}");
    }
}
