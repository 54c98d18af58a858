//! The matrices with which the pictures of the eyes are drawn.

use super::Hmd;
use crate::pose::Pose;
use glam::{DMat4, DQuat, DVec3, DVec4, Mat4};
use serde::{Deserialize, Serialize};

/// The eye for which a picture is drawn. In pairs of pictures, the left eye comes first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum EyePoint {
    /// The left eye, half the eye separation to the left of the head's position.
    Left,
    /// The right eye, half the eye separation to the right of the head's position.
    Right,
    /// The point between the two eyes, for a display with a single picture.
    Centre,
}

/// The matrices with which one eye's picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Eye for which the picture is drawn.
    pub eye: EyePoint,
    /// Matrix from world to eye coordinates, which only rotates and moves. Eye coordinates are right-handed with +y up,
    /// and the eye looks along -z.
    pub world_to_eye: Mat4,
    /// Matrix from head to eye coordinates, which only rotates and moves. Structures that are fixed to the head are
    /// drawn with this matrix.
    pub head_to_eye: Mat4,
    /// Matrix from eye to clip coordinates: -w <= x <= w (right), -w <= y <= w (up), 0 <= z <= w. The depth z/w grows
    /// from 0 at the near plane to 1 at the far plane.
    pub projection: Mat4,
}

impl Hmd {
    /// Returns the matrices of the left and the right eye for this pose of the head.
    pub fn stereo(&self, head: &Pose) -> [View; 2] {
        [EyePoint::Left, EyePoint::Right].map(|eye| self.view(eye, head))
    }

    /// Returns the matrices of a single picture, seen from the point between the eyes, for this pose of the head.
    pub fn mono(&self, head: &Pose) -> View {
        self.view(EyePoint::Centre, head)
    }

    fn view(&self, eye: EyePoint, head: &Pose) -> View {
        let half = self.config().eye_separation_m / 2.0;
        let right_of_head = match eye {
            EyePoint::Left => -half,
            EyePoint::Right => half,
            EyePoint::Centre => 0.0,
        };
        let shift = DMat4::from_translation(DVec3::new(-right_of_head, 0.0, 0.0));
        // The middle of the picture shows the point where the axes meet.
        let head_to_eye = match self.config().convergence_m {
            Some(metres) => turn_towards(-right_of_head, metres) * shift,
            None => shift,
        };
        View {
            eye,
            world_to_eye: (head_to_eye * world_to_head(head)).as_mat4(),
            head_to_eye: head_to_eye.as_mat4(),
            projection: self.projection(),
        }
    }
}

/// Returns the rotation that moves a point onto the axis of view. The point lies `right` metres to the right and
/// `ahead` metres ahead. The function uses square roots instead of angles, so its result has the same bits on every
/// computer.
fn turn_towards(right: f64, ahead: f64) -> DMat4 {
    let distance = (right * right + ahead * ahead).sqrt();
    let (sin, cos) = (right / distance, ahead / distance);
    DMat4::from_cols(
        DVec4::new(cos, 0.0, -sin, 0.0),
        DVec4::new(0.0, 1.0, 0.0, 0.0),
        DVec4::new(sin, 0.0, cos, 0.0),
        DVec4::new(0.0, 0.0, 0.0, 1.0),
    )
}

/// Returns the matrix from world to head coordinates, the inverse of the head's pose, in double precision. An
/// orientation of length zero counts as the identity.
fn world_to_head(head: &Pose) -> DMat4 {
    let q = head.orientation;
    let length = q.length();
    let q = if length > 0.0 { q / length } else { DQuat::IDENTITY };
    let back = q.conjugate();
    DMat4::from_rotation_translation(back, -(back * head.position))
}
