//! The edges of a scene as lines in space, for a headset that draws the world without the machine's delay.

use glam::Vec3;
use pxpl5_run::Stepper;
use pxpl5_scene::{Frame, Scene};
use pxpl5_sim::Time;
use std::collections::HashMap;

/// Smallest cosine between the normals of two triangles that count as one flat surface: 2.6 degrees.
const FLAT: f32 = 0.999;

/// Returns the edges of the scene's triangles as pairs of points: x, y and z in metres, six numbers for each edge.
///
/// The axes are those of the head at time zero: x to the right, y up, and the view along -z. Edges within a flat surface
/// are left out, and so are structures that move with the head. The result is empty without a tracked head.
pub(crate) fn edges(stepper: &Stepper) -> Vec<f32> {
    let Some(head) = stepper.head() else { return Vec::new() };
    let start = head.truth(Time::ZERO);
    let points = of(head.scene()).into_iter().flatten();
    points.flat_map(|point| start.view_of(point.as_dvec3()).as_vec3().to_array()).collect()
}

fn of(scene: &Scene) -> Vec<[Vec3; 2]> {
    let key = |point: Vec3| point.to_array().map(|number| (number + 0.0).to_bits());
    let mut found = HashMap::<_, ([Vec3; 2], Vec<Vec3>)>::new();
    let of_world = scene.structures().iter().filter(|structure| structure.frame == Frame::World);
    for corners in of_world.flat_map(|structure| &scene.triangles()[structure.triangles.clone()]) {
        let [a, b, c] = corners.map(|corner| scene.vertices()[corner as usize].position);
        let normal = (b - a).cross(c - a).normalize_or_zero();
        for ends in [[a, b], [b, c], [c, a]] {
            let mut name = ends.map(key);
            name.sort_unstable();
            found.entry(name).or_insert_with(|| (ends, Vec::new())).1.push(normal);
        }
    }
    // An edge is visible at the rim of a surface, and where the surface bends.
    let is_visible = |normals: &[Vec3]| match normals {
        [one, two] => one.dot(*two).abs() < FLAT,
        _ => true,
    };
    found.into_values().filter(|(_, normals)| is_visible(normals)).map(|(ends, _)| ends).collect()
}

#[cfg(test)]
mod tests {
    use crate::files::Files;
    use crate::session::Session;

    #[test]
    fn a_square_ahead_of_the_head_has_four_edges_of_equal_length_and_no_diagonal() {
        let square = b"v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n";
        let settings = "pipeline=slats\nscene=square.obj\nfields=9\nhead.motion=still\n";
        let files = Files([("square.obj".to_owned(), square.to_vec().into())].into_iter().collect());
        let session = Session::new(settings, &files).expect("known settings");
        let lines = super::edges(&session.stepper);
        assert_eq!(lines.len(), 4 * 6);
        // The longest side of a model has a fixed length, and all four sides of a square have the same length.
        let length = |line: &[f32]| (0..3).map(|k| (line[k] - line[k + 3]).powi(2)).sum::<f32>().sqrt();
        let lengths: Vec<f32> = lines.chunks(6).map(length).collect();
        assert!(lengths.iter().all(|one| (one / lengths[0] - 1.0).abs() < 1e-5), "{lengths:?}");
        // The square is ahead of the head.
        assert!(lines.chunks(3).all(|point| point[2] < 0.0), "{lines:?}");
    }
}
