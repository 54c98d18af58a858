//! Scenes with a single structure that does not move. The head stands still unless the settings choose a motion.

use glam::Vec3;

use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Frame, Lighting, Scene, SceneParts, Structure, Vertex};
use crate::sway::Sway;

/// Makes a scene with all triangles in one structure, which is fixed to the room or to the head. The head is at the
/// origin and looks along -z.
pub(super) fn scene(
    name: &str,
    structure: &str,
    frame: Frame,
    vertices: Vec<Vertex>,
    triangles: Vec<[u32; 3]>,
) -> Scene {
    let structure = Structure {
        name: structure.to_owned(),
        vertices: 0..vertices.len(),
        triangles: 0..triangles.len(),
        spheres: 0..0,
        frame,
        hinge: None,
        culls_back_faces: false,
    };
    let path = HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z };
    let parts = SceneParts {
        name: name.to_owned(),
        vertices,
        triangles,
        spheres: Vec::new(),
        structures: vec![structure],
        lighting: Lighting::over_the_shoulder(),
        motion: HeadMotion::new(path, Sway::none()).expect("pxpl5-scene: constants are in range"),
        path: Vec::new(),
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}
