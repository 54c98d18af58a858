//! Triangles of the size that the papers call typical. The triangles are fixed to the head.

use glam::Vec3;

use super::one_structure;
use crate::config::{DEFAULT_COLOUR, TYPICAL_LEG_PX, TYPICAL_SPREAD_PX};
use crate::scene::{Frame, Scene, Vertex};
use tracking::view::Hmd;

/// Distance of all triangles from the head, metres. Assumed: any value between the display's near and far planes.
const DEPTH_M: f32 = 1.0;

pub(super) fn scene(count: u32) -> Scene {
    let pixel = DEPTH_M / Hmd::unc().focal_px() as f32;
    let vertex = |position: Vec3| Vertex { position, normal: Vec3::Z, colour: DEFAULT_COLOUR };
    let vertices: Vec<Vertex> = (0..count).flat_map(|i| corners(i, pixel)).map(vertex).collect();
    let name = format!("typical:{count}");
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    one_structure::scene(&name, &name, Frame::Head, vertices, triangles)
}

/// Returns the corners of triangle `i`. The triangles' positions follow the additive recurrence of the plastic number,
/// which spreads points evenly over a square. Coordinates of 16 bits keep the recurrence exact.
fn corners(i: u32, pixel: f32) -> [Vec3; 3] {
    let share = |step: u32| (i.wrapping_mul(step) >> 16) as f32 / 65_536.0;
    let [width, height] = TYPICAL_SPREAD_PX.map(|px| px as f32);
    let x = (share(3_242_174_889) - 0.5) * width * pixel;
    let y = (share(2_447_445_413) - 0.5) * height * pixel;
    let leg = TYPICAL_LEG_PX as f32 * pixel;
    let at = |dx: f32, dy: f32| Vec3::new(x + dx, y + dy, -DEPTH_M);
    [at(0.0, 0.0), at(leg, 0.0), at(0.0, leg)]
}
