//! A room around the viewer: the simplest scene that is fixed in the world and fills the view in every direction.

use glam::DVec3;

use super::one_structure;
use crate::import::Mesh;
use crate::scene::{Frame, Scene};

/// Distance of every wall from the viewer, metres. Assumed: large enough for a viewer to walk to and fro.
const WALL_M: f64 = 2.0;

/// Returns the corners of the room, a regular tetrahedron. The corners are three times as far from the viewer as the
/// walls. The first corner is behind the viewer, so the wall between the second, third and fourth corner is straight
/// ahead.
fn corners() -> [DVec3; 4] {
    // The three corners of the wall ahead lie on a circle with a radius of sqrt(8) times the wall's distance.
    let ring = WALL_M * 8f64.sqrt();
    let low = ring / 2.0;
    let side = ring * 0.75f64.sqrt();
    [
        DVec3::Z * (3.0 * WALL_M),
        DVec3::new(0.0, ring, -WALL_M),
        DVec3::new(-side, -low, -WALL_M),
        DVec3::new(side, -low, -WALL_M),
    ]
}

/// Indices of the corners of each wall, anticlockwise seen from inside, and the wall's colour.
const WALLS: [([usize; 3], [u8; 3]); 4] =
    [([1, 2, 3], [200, 190, 160]), ([0, 2, 1], [150, 60, 60]), ([0, 1, 3], [60, 90, 150]), ([0, 3, 2], [90, 110, 70])];

pub(super) fn scene() -> Scene {
    let mut mesh = Mesh::default();
    for (wall, colour) in WALLS {
        let places = wall.map(|corner| corners()[corner]);
        let inwards = -places.iter().sum::<DVec3>().normalize();
        let vertices = places.map(|place| mesh.push(place, inwards, colour));
        mesh.fan(&vertices);
    }
    one_structure::scene("room", "walls", Frame::World, mesh.vertices(), mesh.triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_wall_has_the_same_distance_and_faces_the_viewer() {
        let room = scene();
        assert_eq!(room.triangles().len(), 4);
        for triangle in room.triangles() {
            let [a, b, c] = triangle.map(|v| room.vertices()[v as usize].position.as_dvec3());
            let normal = (b - a).cross(c - a).normalize();
            // The corners are anticlockwise seen from within, so the normal points to the viewer at the origin.
            assert!((normal.dot(a) + WALL_M).abs() < 1e-5, "{}", normal.dot(a));
            let stored = room.vertices()[triangle[0] as usize].normal.as_dvec3();
            assert!((stored - normal).length() < 1e-5);
        }
    }
}
