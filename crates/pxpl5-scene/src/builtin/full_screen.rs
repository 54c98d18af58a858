//! Triangles that are fixed to the head and cover the whole screen.

use glam::DVec3;

use super::one_structure;
use crate::import::Mesh;
use crate::scene::{Frame, Scene};

/// Distance from the head to the nearest triangle, metres. Assumed, beyond the near plane of any display.
const NEAR_M: f64 = 1.0;
/// Distance from the head to the farthest triangle, metres. Assumed, before the far plane of any display.
const FAR_M: f64 = 2.0;

/// Tangent of the half angle that the triangles cover in each direction from each eye. The value 1 gives 90 degrees. A
/// head-mounted display needs only 60 degrees, and a face of a cube around the head needs all 90 degrees.
const COVERED: f64 = 1.0;

/// Distance of each eye from the centre of the head, metres: half of the greatest distance between two eyes, 74 mm.
const EYES_M: f64 = 0.037;

/// Side of the bounding box of the triangle that [`push`] draws around a square, divided by the square's side: 1 +
/// sqrt(2).
const REACH: f64 = 1.0 + std::f64::consts::SQRT_2;

pub(super) fn scene(count: u32) -> Scene {
    let mut mesh = Mesh::default();
    for i in 0..count {
        // The farthest triangle comes first, so each triangle is visible when it is drawn.
        let fraction = f64::from(i) / f64::from((count - 1).max(1));
        push(&mut mesh, FAR_M + (NEAR_M - FAR_M) * fraction, colour(i));
    }
    let name = format!("full-screen:{count}");
    one_structure::scene(&name, &name, Frame::Head, mesh.vertices(), mesh.triangles)
}

/// Adds a triangle that covers a square and extends as little as possible beyond the square.
///
/// Let h be half the side of the square, r = (1 + sqrt(2)) h and s = (sqrt(2) - 1) h. The square's centre is the
/// origin. The corners of the triangle lie at (-r, -r), (r, -s) and (-s, r), so no coordinate exceeds r. The lower
/// right, the upper left and the upper right corner of the square each lie on one side of the triangle.
///
/// No triangle is clipped in pictures of up to 1,500 pixels across with a field of view of 60 degrees. In a picture w
/// pixels across, a corner is at most 2.2 w from the centre. The guard band, beyond which triangles are clipped, ends
/// 4,095 - w / 2 from the centre.
fn push(mesh: &mut Mesh, depth: f64, colour: [u8; 3]) {
    let half = COVERED * depth + EYES_M;
    let far = REACH * half;
    let near = far - 2.0 * half;
    let corners = [(-far, -far), (far, -near), (-near, far)];
    let corners = corners.map(|(x, y)| mesh.push(DVec3::new(x, y, -depth), DVec3::Z, colour));
    mesh.fan(&corners);
}

fn colour(index: u32) -> [u8; 3] {
    let hues = [[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1], [1, 0, 1]];
    let bright = 255 - (index / 6 % 8) as u8 * 24;
    hues[index as usize % 6].map(|on: u8| 32 + on * (bright - 32))
}
