//! Triangles of the size that the papers call typical, fixed to the head.

use glam::Vec3;

use crate::config::{DEFAULT_COLOUR, TYPICAL_LEG_PX, TYPICAL_SPREAD_PX};
use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Frame, Lighting, Scene, SceneParts, Structure, Vertex};
use crate::sway::Sway;
use crate::view::{Hmd, HmdConfig};

/// Distance from the head, metres. Assumed, any within the display's near and far planes.
const DEPTH_M: f32 = 1.0;

/// Right-angled triangles spread evenly by an additive recurrence.
pub(super) fn scene(count: u32) -> Scene {
    let hmd = Hmd::new(HmdConfig::unc()).expect("pxpl5-scene: the preset is in range");
    let pixel = DEPTH_M / hmd.focal_length_px() as f32;
    let vertex = |position: Vec3| Vertex { position, normal: Vec3::Z, colour: DEFAULT_COLOUR };
    let vertices: Vec<Vertex> = (0..count).flat_map(|i| corners(i, pixel)).map(vertex).collect();
    let name = format!("typical:{count}");
    let structure = Structure {
        name: name.clone(),
        vertices: 0..vertices.len(),
        triangles: 0..count as usize,
        spheres: 0..0,
        frame: Frame::Head,
        hinge: None,
        culls_back_faces: false,
    };
    let path = HeadPath::Still { eye: Vec3::ZERO, target: Vec3::NEG_Z };
    let parts = SceneParts {
        name,
        vertices,
        triangles: (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(),
        spheres: Vec::new(),
        structures: vec![structure],
        lighting: Lighting::over_the_shoulder(),
        motion: HeadMotion::new(path, Sway::none()).expect("pxpl5-scene: constants are in range"),
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}

/// The plastic number's recurrence spreads points evenly over the unit square; 16 bits keep it exact.
fn corners(i: u32, pixel: f32) -> [Vec3; 3] {
    let share = |step: u32| (i.wrapping_mul(step) >> 16) as f32 / 65_536.0;
    let [width, height] = TYPICAL_SPREAD_PX.map(|px| px as f32);
    let x = (share(3_242_174_889) - 0.5) * width * pixel;
    let y = (share(2_447_445_413) - 0.5) * height * pixel;
    let leg = TYPICAL_LEG_PX as f32 * pixel;
    let at = |dx: f32, dy: f32| Vec3::new(x + dx, y + dy, -DEPTH_M);
    [at(0.0, 0.0), at(leg, 0.0), at(0.0, leg)]
}
