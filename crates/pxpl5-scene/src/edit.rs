//! Edits: what a host changes in a scene from one frame to the next.

use glam::{DMat3, DMat4, DVec3, Mat4, Vec3};

use crate::trig;

/// Sets the model matrix of one structure. A host sends few of these per frame (published TR94).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edit {
    /// Which structure: an index into [`crate::Scene::structures`].
    pub structure: usize,
    /// From the structure's coordinates to its frame's; replaces the previous one. Identity before the first edit.
    pub model: Mat4,
}

/// A scripted motion of a structure: it swings about an axis like a control surface.
///
/// Angle at time t: `amplitude_deg * sin(2 pi (t / period_ps + phase_turns))`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hinge {
    /// A point of the axis, metres, coordinates of the scene.
    pub point: Vec3,
    /// Direction of the axis; need not be of unit length, but not zero.
    pub axis: Vec3,
    /// Largest deflection to either side, degrees.
    pub amplitude_deg: f64,
    /// Time of one swing, picoseconds of simulated time; not zero.
    pub period_ps: u64,
    /// Beginning of the swing, in turns.
    pub phase_turns: f64,
}

impl Hinge {
    /// Deflection at simulated time `time_ps` (picoseconds), degrees.
    #[must_use]
    pub fn angle_deg(&self, time_ps: u64) -> f64 {
        let turns = (time_ps % self.period_ps) as f64 / self.period_ps as f64;
        self.amplitude_deg * trig::sin_turns(turns + self.phase_turns)
    }

    /// Model matrix at simulated time `time_ps` (picoseconds): a rotation about the axis.
    #[must_use]
    pub fn model(&self, time_ps: u64) -> Mat4 {
        let rotation = rotation_about(self.axis.as_dvec3(), self.angle_deg(time_ps));
        let point = self.point.as_dvec3();
        DMat4::from_cols(
            rotation.x_axis.extend(0.0),
            rotation.y_axis.extend(0.0),
            rotation.z_axis.extend(0.0),
            (point - rotation * point).extend(1.0),
        )
        .as_mat4()
    }
}

/// Rotation by `angle_deg` about `axis`, right-handed (Rodrigues' formula).
fn rotation_about(axis: DVec3, angle_deg: f64) -> DMat3 {
    let axis = axis.normalize_or(DVec3::Y);
    let (sin, cos) = trig::sin_cos_deg(angle_deg);
    let [x, y, z] = DVec3::AXES.map(|v| v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos)));
    DMat3::from_cols(x, y, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quarter_swing() -> Hinge {
        Hinge {
            point: Vec3::new(1.0, 0.0, 0.0),
            axis: Vec3::new(0.0, 0.0, 2.0),
            amplitude_deg: 90.0,
            period_ps: 4_000,
            phase_turns: 0.0,
        }
    }

    #[test]
    fn a_hinge_is_fully_deflected_after_a_quarter_of_its_period() {
        // 90 deg about +z through (1, 0, 0): (2, 0, 0) is one unit right of the axis and goes one unit above it.
        let point = quarter_swing().model(1_000).transform_point3(Vec3::new(2.0, 0.0, 0.0));
        assert!((point - Vec3::new(1.0, 1.0, 0.0)).length() < 1e-6, "{point}");
    }

    #[test]
    fn a_hinge_leaves_its_axis_in_place() {
        let point = Vec3::new(1.0, 0.0, 5.0);
        assert!((quarter_swing().model(777).transform_point3(point) - point).length() < 1e-6);
    }

    #[test]
    fn a_swing_repeats_after_its_period_even_late_in_a_long_run() {
        let hinge = quarter_swing();
        let late = 4_000 * 1_000_000_000_000_000;
        assert_eq!(hinge.model(123), hinge.model(late + 123));
    }
}
