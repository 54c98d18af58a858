//! Faces of the cube: when one can come into sight at the earliest, and how many a primitive touches.

use glam::DVec3;

/// The angle, radians, between an axis of view and the nearest direction of the cube's face around an axis (of unit length,
/// along x, y or z); 0 if the axis of view meets that face.
#[must_use]
pub fn angle_to_face(view: DVec3, face: DVec3) -> f64 {
    let view = view.normalize();
    if view.abs().max_element() <= view.dot(face) {
        return 0.0;
    }
    let up = DVec3::new(face.y.abs(), face.z.abs(), face.x.abs());
    let right = face.cross(up);
    let corners = [up + right, up - right, -up - right, right - up].map(|corner| (face + corner).normalize());
    let edges = (0..4).map(|i| angle_to_arc(view, corners[i], corners[(i + 1) % 4]));
    edges.fold(f64::INFINITY, f64::min)
}

/// The angle between a direction (of unit length) and the nearest one of the arc between two others.
fn angle_to_arc(view: DVec3, from: DVec3, to: DVec3) -> f64 {
    let normal = from.cross(to).normalize();
    let across = view.dot(normal);
    let foot = view - normal * across;
    let is_between = from.cross(foot).dot(normal) >= 0.0 && foot.cross(to).dot(normal) >= 0.0;
    if is_between {
        // Of a direction across the whole arc the foot is what rounding leaves: its length says so, its direction nothing.
        return libm::atan2(across.abs(), foot.length());
    }
    angle_between(view, from).min(angle_between(view, to))
}

fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Seconds until a face can come into a picture that reaches `half_diagonal` radians from its middle, for a head that turns
/// at most so fast (rad/s).
#[must_use]
pub fn until_in_sight_s(view: DVec3, face: DVec3, half_diagonal: f64, fastest_turn: f64) -> f64 {
    (angle_to_face(view, face) - half_diagonal).max(0.0) / fastest_turn
}

/// Faces that a cap of this angular radius (radians, at most 35 degrees) touches in the mean over all places: how often a
/// small primitive is drawn in an update of the whole cube.
#[must_use]
pub fn mean_faces_touched(radius: f64) -> f64 {
    let edges = 6.0 / std::f64::consts::PI * libm::acos(1.0 / 3.0);
    3.0 - 2.0 * libm::cos(radius) + edges * libm::sin(radius)
}
