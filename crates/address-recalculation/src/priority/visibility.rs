//! Visibility of the cube's faces: the earliest time at which a face can become visible, and the number of faces that a
//! primitive touches.

use glam::DVec3;

/// Returns the smallest angle, in radians, between a viewing axis and the directions to a face of the cube.
///
/// `face` is the axis of the face, a unit vector along x, y or z. The angle is 0 if the viewing axis intersects the
/// face.
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

/// Returns the smallest angle, in radians, between the unit vector `view` and the arc from `from` to `to`.
fn angle_to_arc(view: DVec3, from: DVec3, to: DVec3) -> f64 {
    let normal = from.cross(to).normalize();
    let across = view.dot(normal);
    let foot = view - normal * across;
    let is_between = from.cross(foot).dot(normal) >= 0.0 && foot.cross(to).dot(normal) >= 0.0;
    if is_between {
        // If the direction is perpendicular to the arc's plane, `foot` contains only rounding errors. Its length is
        // still usable.
        return libm::atan2(across.abs(), foot.length());
    }
    angle_between(view, from).min(angle_between(view, to))
}

fn angle_between(a: DVec3, b: DVec3) -> f64 {
    libm::atan2(a.cross(b).length(), a.dot(b))
}

/// Returns the shortest time, in seconds, until a face can become visible in a picture.
///
/// `half_diagonal` is the angle from the picture's middle to its corner, in radians. The head rotates by at most
/// `fastest_turn` rad/s.
pub fn time_until_visible_s(view: DVec3, face: DVec3, half_diagonal: f64, fastest_turn: f64) -> f64 {
    (angle_to_face(view, face) - half_diagonal).max(0.0) / fastest_turn
}

/// Returns the mean number of faces that a small round object touches. The mean is taken over all directions.
///
/// `radius` is the object's angular radius in radians, at most 35 degrees. An update of the whole cube draws a small
/// primitive this number of times on average.
pub fn mean_faces_touched(radius: f64) -> f64 {
    let edges = 6.0 / std::f64::consts::PI * libm::acos(1.0 / 3.0);
    3.0 - 2.0 * libm::cos(radius) + edges * libm::sin(radius)
}
