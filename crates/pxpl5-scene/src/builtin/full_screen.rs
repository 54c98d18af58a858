//! Triangles fixed to the head that cover the whole screen.

use glam::{DVec3, Vec3};

use crate::import::Mesh;
use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Frame, Lighting, Scene, SceneParts, Structure};
use crate::sway::Sway;

/// Nearest and farthest triangle, metres before the head. Assumed, within the near and far planes of any display.
const NEAR_M: f64 = 1.0;
const FAR_M: f64 = 2.0;

/// Tangent of the half angle covered up, down, left and right of each eye: fields of view up to 126 degrees.
const COVERED: f64 = 2.0;

/// Room for the eyes beside the centre of the head, metres: the most that a display's separation may be.
const EYES_M: f64 = 0.5;

pub(super) fn scene(count: u32) -> Scene {
    let mut mesh = Mesh::default();
    for i in 0..count {
        // The farthest first: each is seen when drawn, as is the last in the end.
        let fraction = f64::from(i) / f64::from((count - 1).max(1));
        push(&mut mesh, FAR_M + (NEAR_M - FAR_M) * fraction, colour(i));
    }
    let name = format!("full-screen:{count}");
    let structure = Structure {
        name: name.clone(),
        vertices: 0..mesh.positions.len(),
        triangles: 0..mesh.triangles.len(),
        spheres: 0..0,
        frame: Frame::Head,
        hinge: None,
        culls_back_faces: false,
    };
    let path = HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z };
    let parts = SceneParts {
        name,
        vertices: mesh.vertices(),
        triangles: mesh.triangles,
        spheres: Vec::new(),
        structures: vec![structure],
        lighting: Lighting::over_the_shoulder(),
        motion: HeadMotion::new(path, Sway::none()).expect("pxpl5-scene: constants are in range"),
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}

/// A right angle at the lower left whose long side runs through the upper right corner of the covered square.
fn push(mesh: &mut Mesh, depth: f64, colour: [u8; 3]) {
    let half = COVERED * depth + EYES_M;
    let corners = [(-half, -half), (3.0 * half, -half), (-half, 3.0 * half)];
    let corners = corners.map(|(x, y)| mesh.push(DVec3::new(x, y, -depth), DVec3::Z, colour));
    mesh.fan(&corners);
}

/// Six hues by turns, each a shade darker than six triangles before.
fn colour(index: u32) -> [u8; 3] {
    let hues = [[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1], [1, 0, 1]];
    let bright = 255 - (index / 6 % 8) as u8 * 24;
    hues[index as usize % 6].map(|on: u8| 32 + on * (bright - 32))
}
