//! A sphere of any even number of triangles of about the same size.

use glam::DVec3;

use crate::config::{DEFAULT_COLOUR, IMPORT_RADIUS_M};
use crate::import::{Mesh, fitted_scene};
use crate::scene::Scene;
use crate::trig;

/// Generates a sphere of `count` triangles. `count` must be even and at least
/// [`crate::config::MIN_SPHERE_TRIANGLES`].
pub(super) fn scene(count: u32) -> Scene {
    // Add the parallels from pole to pole, and join each with the parallel above.
    let rings = rings(count);
    let mut mesh = Mesh::default();
    let top = push(&mut mesh, DVec3::Y);
    let mut above = Ring { first: top, points: 1 };
    for (index, &points) in rings.iter().enumerate() {
        let ring = Ring { first: mesh.positions.len() as u32, points };
        push_ring(&mut mesh, (index as f64 + 1.0) / (rings.len() as f64 + 1.0), points);
        join(&mut mesh, &above, &ring);
        above = ring;
    }
    let bottom = push(&mut mesh, DVec3::NEG_Y);
    join(&mut mesh, &above, &Ring { first: bottom, points: 1 });
    fitted_scene(&format!("sphere:{count}"), mesh, Vec::new())
}

struct Ring {
    first: u32,
    points: u32,
}

/// Returns the number of points on each parallel of a sphere with `count` triangles. A parallel with n points is
/// divided into n edges. Each edge belongs to one triangle above the parallel and one triangle below. The parallels
/// between the poles therefore have `count` / 2 points in total. Each parallel gets points in proportion to its length.
fn rings(count: u32) -> Vec<u32> {
    // An equilateral triangle with side s has the area s^2 sqrt(3)/4, and rows of such triangles are s sqrt(3)/2 apart.
    let side = (16.0 * std::f64::consts::PI / (3f64.sqrt() * f64::from(count))).sqrt();
    let rows = (std::f64::consts::PI / (side * 3f64.sqrt() / 2.0) + 0.5) as u32;
    let rings = rows.max(2) - 1;
    let lengths: Vec<f64> =
        (1..=rings).map(|ring| trig::sin_turns(f64::from(ring) / f64::from(2 * (rings + 1)))).collect();
    let all: f64 = lengths.iter().sum();
    // The running sum is rounded, not each share, so that the total is exact.
    let mut points = Vec::with_capacity(lengths.len());
    let mut sum = 0.0;
    let mut given = 0;
    for length in lengths {
        sum += length;
        let until = (sum / all * f64::from(count / 2) + 0.5) as u32;
        points.push(until - given);
        given = until;
    }
    points
}

fn push(mesh: &mut Mesh, direction: DVec3) -> u32 {
    mesh.push(direction * IMPORT_RADIUS_M, direction, DEFAULT_COLOUR)
}

/// Adds the vertices of a parallel with `points` points. `down` is the fraction of the way from the upper to the lower
/// pole.
fn push_ring(mesh: &mut Mesh, down: f64, points: u32) {
    let radius = trig::sin_turns(down / 2.0);
    let height = trig::cos_turns(down / 2.0);
    for point in 0..points {
        let turns = f64::from(point) / f64::from(points);
        let direction = DVec3::new(radius * trig::sin_turns(turns), height, radius * trig::cos_turns(turns));
        push(mesh, direction.normalize_or(DVec3::Y));
    }
}

/// Adds the triangles between a parallel and the parallel below it. A pole counts as a parallel of one point.
fn join(mesh: &mut Mesh, above: &Ring, below: &Ring) {
    let steps = |ring: &Ring| if ring.points == 1 { 0 } else { ring.points };
    let [upper, lower] = [above, below].map(steps);
    let [mut a, mut b] = [0, 0];
    while a < upper || b < lower {
        let corner = |ring: &Ring, index: u32| ring.first + index % ring.points;
        // Advance on the parallel whose next point comes first around the axis.
        let is_upper =
            b == lower || (a < upper && u64::from(a + 1) * u64::from(lower) <= u64::from(b + 1) * u64::from(upper));
        if is_upper {
            mesh.fan(&[corner(above, a), corner(below, b), corner(above, a + 1)]);
            a += 1;
        } else {
            mesh.fan(&[corner(above, a), corner(below, b), corner(below, b + 1)]);
            b += 1;
        }
    }
}
