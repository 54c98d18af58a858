//! A room around the viewer: the simplest scene that stands in the world and fills the view wherever the head turns.

use glam::{DVec3, Vec3};

use crate::import::Mesh;
use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Frame, Lighting, Scene, SceneParts, Structure};
use crate::sway::Sway;

/// Distance of every wall from the viewer, metres: so far that a head may walk to and fro. Assumed.
const WALL_M: f64 = 2.0;

/// Corners of a regular tetrahedron, three times as far as its walls; the first behind the viewer, so that the wall of the other
/// three is straight ahead.
fn corners() -> [DVec3; 4] {
    // On the wall ahead the three lie on a circle of sqrt(8) times the wall's distance.
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

/// The corners of each wall, anticlockwise seen from within, and its colour.
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
    let structure = Structure {
        name: "walls".to_owned(),
        vertices: 0..mesh.positions.len(),
        triangles: 0..mesh.triangles.len(),
        spheres: 0..0,
        frame: Frame::World,
        hinge: None,
        culls_back_faces: false,
    };
    let path = HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z };
    let parts = SceneParts {
        name: "room".to_owned(),
        vertices: mesh.vertices(),
        triangles: mesh.triangles,
        spheres: Vec::new(),
        structures: vec![structure],
        lighting: Lighting::over_the_shoulder(),
        motion: HeadMotion::new(path, Sway::none()).expect("pxpl5-scene: constants are in range"),
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_wall_is_as_far_and_faces_the_viewer() {
        let room = scene();
        assert_eq!(room.triangles().len(), 4);
        for triangle in room.triangles() {
            let [a, b, c] = triangle.map(|v| room.vertices()[v as usize].position.as_dvec3());
            let normal = (b - a).cross(c - a).normalize();
            // Anticlockwise seen from within: the normal points to the viewer at the origin.
            assert!((normal.dot(a) + WALL_M).abs() < 1e-5, "{}", normal.dot(a));
            let stored = room.vertices()[triangle[0] as usize].normal.as_dvec3();
            assert!((stored - normal).length() < 1e-5);
        }
    }
}
