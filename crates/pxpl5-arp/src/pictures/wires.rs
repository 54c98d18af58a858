//! Wireframe drawing of the cuts that the segmentation makes, as the eye sees them.

use crate::world::World;
use address_recalculation::LensPicture;
use glam::{DQuat, DVec3};
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Distance of the near plane from the eye in metres. Edges nearer to the eye are clipped.
const NEAR_M: f64 = 0.05;

/// Draws the edges of all triangles. Edges behind a surface are also drawn.
///
/// Edges of the scene are grey. Edges that result from cuts at the borders of cells with side `side_m` are red.
pub fn cuts_svg(world: &World, side_m: f64, eye: DVec3, orientation: DQuat, screen: &LensPicture) -> String {
    let [width, height] = [screen.width, screen.height].map(f64::from);
    let focal = width / 2.0 / libm::tan(screen.horizontal_deg.to_radians() / 2.0);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" fill=\"none\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
    );
    // Rotate world coordinates to the axes of the head.
    let back = orientation.conjugate();
    let seen = |index: u32| back * (world.vertices[index as usize] - eye);
    // Draw the grey edges first, so that red edges cover the grey edges.
    for (is_cut, style) in
        [(false, "stroke=\"#999\" stroke-width=\"0.7\""), (true, "stroke=\"#d00\" stroke-width=\"1.2\"")]
    {
        let mut wires = String::new();
        for ([a, b], _) in edges(world, side_m).iter().filter(|(_, cut)| **cut == is_cut) {
            let Some([from, to]) = before(seen(*a), seen(*b)) else { continue };
            // Project, and skip edges outside the picture.
            let [x1, x2] = [from, to].map(|p| width / 2.0 + focal * p.x / -p.z);
            let [y1, y2] = [from, to].map(|p| height / 2.0 - focal * p.y / -p.z);
            let is_beside = x1.max(x2) < 0.0 || x1.min(x2) > width || y1.max(y2) < 0.0 || y1.min(y2) > height;
            if !is_beside {
                let _ = write!(wires, "M{x1:.1} {y1:.1}L{x2:.1} {y2:.1}");
            }
        }
        let _ = writeln!(svg, "<path d=\"{wires}\" {style}/>");
    }
    svg.push_str("</svg>\n");
    svg
}

/// Returns all edges as pairs of vertices. The value of an edge is true if the edge lies on a border of cells.
fn edges(world: &World, side_m: f64) -> BTreeMap<[u32; 2], bool> {
    let mut edges = BTreeMap::new();
    for three in world.segments.iter().flat_map(|segment| &segment.triangles) {
        for (a, b) in [(three[0], three[1]), (three[1], three[2]), (three[2], three[0])] {
            edges.entry([a.min(b), a.max(b)]).or_insert_with(|| {
                let [p, q] = [a, b].map(|index| world.vertices[index as usize]);
                is_on_border(p.x, q.x, side_m) || is_on_border(p.z, q.z, side_m)
            });
        }
    }
    edges
}

/// Returns true if both coordinates lie exactly on the same border of cells. The test needs no tolerance, because cuts
/// set coordinates exactly to a border.
fn is_on_border(p: f64, q: f64, side_m: f64) -> bool {
    let border = (p / side_m).round() * side_m;
    p == border && q == border
}

/// Returns the part of an edge that lies in front of the eye, beyond the near plane.
fn before(a: DVec3, b: DVec3) -> Option<[DVec3; 2]> {
    let at_near = |from: DVec3, to: DVec3| from.lerp(to, (-NEAR_M - from.z) / (to.z - from.z));
    match (a.z < -NEAR_M, b.z < -NEAR_M) {
        (true, true) => Some([a, b]),
        (true, false) => Some([a, at_near(a, b)]),
        (false, true) => Some([at_near(b, a), b]),
        (false, false) => None,
    }
}
