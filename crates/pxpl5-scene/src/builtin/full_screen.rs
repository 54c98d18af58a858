//! Triangles fixed to the head that cover the whole screen.

use glam::DVec3;

use super::one_structure;
use crate::import::Mesh;
use crate::scene::{Frame, Scene};

/// Nearest and farthest triangle, metres before the head. Assumed, within the near and far planes of any display.
const NEAR_M: f64 = 1.0;
const FAR_M: f64 = 2.0;

/// Tangent of the half angle covered up, down, left and right of each eye: a field of view of 90 degrees. Displays for the head
/// have 60 degrees here, the faces of a cube 90.
const COVERED: f64 = 1.0;

/// Room for the eyes beside the centre of the head, metres: half of the greatest separation of eyes, 74 mm.
const EYES_M: f64 = 0.037;

/// Distance of the farthest side of the least triangle around a square, for half of a side of 1: 1 + sqrt(2).
const REACH: f64 = 1.0 + std::f64::consts::SQRT_2;

pub(super) fn scene(count: u32) -> Scene {
    let mut mesh = Mesh::default();
    for i in 0..count {
        // The farthest first: each is seen when drawn, as is the last in the end.
        let fraction = f64::from(i) / f64::from((count - 1).max(1));
        push(&mut mesh, FAR_M + (NEAR_M - FAR_M) * fraction, colour(i));
    }
    let name = format!("full-screen:{count}");
    one_structure::scene(&name, &name, Frame::Head, mesh.vertices(), mesh.triangles)
}

/// The triangle around the covered square whose corners are least far out: 1 + sqrt(2) times half of the square's side, to the left and
/// right and up and down.
///
/// The corners lie at (-r, -r), (r, -s) and (-s, r), where r = (1 + sqrt(2)) h, s = (sqrt(2) - 1) h and h is half of the side. Two
/// sides run through the lower right and the upper left corner of the square, the third one through the upper right corner.
///
/// Nothing of it is clipped: at 60 degrees the corners are at most 4.4 times half of the picture's width from the picture's centre, and the
/// guard band ends 4,095 pixels less half of the width from there. So pictures of up to 1,500 pixels across have room.
fn push(mesh: &mut Mesh, depth: f64, colour: [u8; 3]) {
    let half = COVERED * depth + EYES_M;
    let far = REACH * half;
    let near = far - 2.0 * half;
    let corners = [(-far, -far), (far, -near), (-near, far)];
    let corners = corners.map(|(x, y)| mesh.push(DVec3::new(x, y, -depth), DVec3::Z, colour));
    mesh.fan(&corners);
}

/// Six hues by turns, each a shade darker than six triangles before.
fn colour(index: u32) -> [u8; 3] {
    let hues = [[1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1], [1, 0, 1]];
    let bright = 255 - (index / 6 % 8) as u8 * 24;
    hues[index as usize % 6].map(|on: u8| 32 + on * (bright - 32))
}
