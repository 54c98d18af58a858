//! The scenes of limits, at every size.

use glam::Vec3;
use pxpl5_run::TestScene;
use pxpl5_scene::{
    Frame, HeadMotion, HeadPath, Hmd, HmdConfig, Lighting, Scene, SceneParts, Structure, Sway, Vertex, builtin,
};

/// Legs of a typical triangle in pixels: its box touches (1 + 18/128)^2 = 1.30 regions of 128 x 128 on average.
pub(crate) const TYPICAL_LEG_PX: f64 = 18.0;

/// Width and height of the place that their corners are spread over: with the disparity of the eyes and the triangle itself
/// they stay inside the 640 x 480 pixels.
pub(crate) const TYPICAL_SPREAD_PX: [f64; 2] = [540.0, 420.0];

/// Distance of typical triangles from the head, metres (assumed; any within the display's near and far planes).
const TYPICAL_DEPTH_M: f32 = 1.0;

/// A scene of so many triangles, at least one.
///
/// # Panics
///
/// Above the scene generator's largest number of triangles.
#[must_use]
pub fn test_scene(kind: TestScene, triangles: u32) -> Scene {
    match kind {
        TestScene::FullScreen => builtin(&format!("full-screen:{}", triangles.max(1))).expect("in range"),
        TestScene::Typical => typical(triangles.max(1)),
    }
}

/// Right-angled triangles fixed to the head, spread evenly by an additive recurrence.
fn typical(count: u32) -> Scene {
    let hmd = Hmd::new(HmdConfig::unc()).expect("the preset is valid");
    let pixel = TYPICAL_DEPTH_M / hmd.focal_length_px() as f32;
    let vertices = (0..count).flat_map(|i| corners(i, pixel)).map(|position| Vertex {
        position,
        normal: Vec3::Z,
        colour: [200, 196, 188],
    });
    let name = format!("typical:{count}");
    let parts = SceneParts {
        name: name.clone(),
        vertices: vertices.collect(),
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        spheres: Vec::new(),
        structures: vec![Structure {
            name,
            vertices: 0..3 * count as usize,
            triangles: 0..count as usize,
            spheres: 0..0,
            frame: Frame::Head,
            hinge: None,
        }],
        lighting: Lighting::over_the_shoulder(),
        motion: HeadMotion::new(HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z }, Sway::none())
            .expect("in range"),
    };
    Scene::new(parts).expect("indices and normals are right by construction")
}

/// The plastic number's recurrence spreads points evenly over the unit square; 16 bits keep it exact.
fn corners(i: u32, pixel: f32) -> [Vec3; 3] {
    let share = |step: u32| (i.wrapping_mul(step) >> 16) as f32 / 65_536.0;
    let [width, height] = TYPICAL_SPREAD_PX.map(|px| px as f32);
    let x = (share(3_242_174_889) - 0.5) * width * pixel;
    let y = (share(2_447_445_413) - 0.5) * height * pixel;
    let leg = TYPICAL_LEG_PX as f32 * pixel;
    let at = |dx: f32, dy: f32| Vec3::new(x + dx, y + dy, -TYPICAL_DEPTH_M);
    [at(0.0, 0.0), at(leg, 0.0), at(0.0, leg)]
}
