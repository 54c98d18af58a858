//! Changes of a scene that the host sends from one frame to the next.

use glam::{DMat3, DMat4, DVec3, Mat4, Vec3};

use crate::trig;

/// A change of the scene by the host: a new model matrix for one structure. A host sends few of these changes per frame
/// (published TR94).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edit {
    /// Index of the structure in [`crate::Scene::structures`].
    pub structure: usize,
    /// New matrix from the structure's coordinates to the coordinate system to which the structure is fixed: the room
    /// or the head. Before the first edit the matrix is the identity.
    pub model: Mat4,
}

/// A motion of a structure as a function of time: the structure swings about an axis like an aircraft's control
/// surface.
///
/// The angle at time t is `amplitude_deg * sin(2 pi (t / period_ps + phase_turns))`.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Hinge {
    /// A point on the axis of the swing, metres, in coordinates of the scene.
    pub point: Vec3,
    /// Direction of the axis of the swing. The vector can have any length except zero.
    pub axis: Vec3,
    /// Greatest angle of the swing to each side, degrees.
    pub amplitude_deg: f64,
    /// Duration of a full swing, picoseconds of simulated time, above zero.
    pub period_ps: u64,
    /// Phase of the swing at time 0, as a fraction of the period.
    pub phase_turns: f64,
}

impl Hinge {
    /// Returns the angle of the swing at simulated time `time_ps` (picoseconds), degrees.
    pub fn angle_deg(&self, time_ps: u64) -> f64 {
        let turns = (time_ps % self.period_ps) as f64 / self.period_ps as f64;
        self.amplitude_deg * trig::sin_turns(turns + self.phase_turns)
    }

    /// Returns the model matrix at simulated time `time_ps` (picoseconds). The matrix is a rotation about the axis of
    /// the swing.
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

/// Returns the matrix of the right-handed rotation by `angle_deg` about `axis` (Rodrigues' formula).
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
        // 90 degrees about +z through (1, 0, 0): the point (2, 0, 0) is one unit to the right of the axis and moves to
        // one unit above it.
        let point = quarter_swing().model(1_000).transform_point3(Vec3::new(2.0, 0.0, 0.0));
        assert!((point - Vec3::new(1.0, 1.0, 0.0)).length() < 1e-6, "{point}");
    }

    #[test]
    fn the_swing_of_a_hinge_does_not_move_points_on_its_axis() {
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
