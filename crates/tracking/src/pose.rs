use glam::{DQuat, DVec3};
use serde::{Deserialize, Serialize};

use crate::rotation;

/// A position in metres and an orientation (head axes to world axes).
///
/// Axes are right-handed with y up, and the head looks along its own -z axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Position of the head in the world, metres. This is the point between the eyes, or the eye itself if there is
    /// only one picture.
    pub position: DVec3,
    /// Unit quaternion that rotates head axes into world axes.
    pub orientation: DQuat,
}

impl Pose {
    /// The pose of a head at the origin that looks along -z.
    pub const IDENTITY: Self = Self { position: DVec3::ZERO, orientation: DQuat::IDENTITY };

    /// Creates a pose at `position` with the identity orientation, so that the head looks along -z.
    pub fn at(position: DVec3) -> Self {
        Self { position, ..Self::IDENTITY }
    }

    /// Creates a pose at the origin with the orientation `orientation`.
    pub fn facing(orientation: DQuat) -> Self {
        Self { orientation, ..Self::IDENTITY }
    }

    /// Returns the pose with every number rounded to single precision, the precision of scene coordinates.
    pub fn in_single_precision(&self) -> Self {
        Self { position: self.position.as_vec3().as_dvec3(), orientation: self.orientation.as_quat().as_dquat() }
    }

    /// Converts a position in the world into the head's axes (metres, the view along -z).
    pub fn view_of(&self, world: DVec3) -> DVec3 {
        self.orientation.conjugate() * (world - self.position)
    }

    /// Interpolates between two poses: positions linearly, orientations by slerp. `s` = 0 gives `self`, and 1 gives
    /// `to`.
    pub fn interpolate(&self, to: &Self, s: f64) -> Self {
        Self {
            position: self.position.lerp(to.position, s),
            orientation: rotation::slerp(self.orientation, to.orientation, s),
        }
    }

    /// Returns the distance from this pose to `other` in metres.
    pub fn distance_m(&self, other: &Self) -> f64 {
        self.position.distance(other.position)
    }

    /// Returns the angle between the orientations of this pose and `other` in degrees, 0 to 180.
    pub fn angle_deg(&self, other: &Self) -> f64 {
        rotation::angle_deg(self.orientation, other.orientation)
    }

    /// Returns true if none of the seven numbers is NaN or infinite.
    pub fn is_finite(&self) -> bool {
        self.position.is_finite() && self.orientation.is_finite()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_ahead_moves_right_in_the_view_when_the_head_turns_left() {
        let turned = Pose::facing(rotation::about_y(0.1));
        assert!(turned.view_of(DVec3::NEG_Z).x > 0.0);
    }

    #[test]
    fn interpolation_is_exact_at_both_ends() {
        let a = Pose::IDENTITY;
        let b = Pose { position: DVec3::X, orientation: rotation::about_x(1.0) };
        assert!(a.interpolate(&b, 0.0).angle_deg(&a) < 1e-12 && a.interpolate(&b, 1.0).angle_deg(&b) < 1e-12);
        assert_eq!(a.interpolate(&b, 0.5).position, DVec3::X * 0.5);
    }
}
