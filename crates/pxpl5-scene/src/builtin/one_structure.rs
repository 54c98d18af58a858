//! Scenes with a single structure that does not move. The head stands still unless the settings choose a motion.

use crate::scene::{Frame, Scene, SceneParts, Structure, Vertex};

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
    let parts = SceneParts { structures: vec![structure], ..SceneParts::of(name, vertices, triangles) };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}
