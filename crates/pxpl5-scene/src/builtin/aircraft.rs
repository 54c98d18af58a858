//! A swept-wing jet with a closed surface of 100 triangles. Slats, a rendering method of Pixel-Planes 5 with a new
//! picture in every field, can draw this number of triangles in time.
//!
//! The length is along z with the nose at +z. +y is up, and +x is the left of the aircraft. Lengths are roughly metres.
//! The finished aircraft is scaled to the radius of the scene `mig` and uses the same flight path. Every part is a
//! closed solid that overlaps the next part.

use glam::DVec3;

use super::mig::{RADIUS_M, fly_through};
use super::solid::Colour;
use crate::import::Mesh;
use crate::scene::{Lighting, Scene, SceneParts, bounding_sphere};
use crate::trig;

const SILVER: Colour = [214, 220, 228];
const RED: Colour = [224, 36, 30];
const GLASS: Colour = [90, 170, 226];

pub(super) fn scene() -> Scene {
    let mut mesh = fuselage(); // 48 triangles
    for side in [1.0, -1.0] {
        add_flat(&mut mesh, wing(side), SILVER); // 12 triangles
        add_flat(&mut mesh, tailplane(side), RED); // 6 triangles
    }
    add_flat(&mut mesh, fin(), RED); // 8 triangles
    add_flat(&mut mesh, canopy(), GLASS); // 8 triangles
    // Scale the aircraft to the radius of `mig` about the origin.
    let (centre, radius) = bounding_sphere(mesh.positions.iter().map(|&place| (place, 0.0)));
    for place in &mut mesh.positions {
        *place = (*place - centre) * (RADIUS_M / radius);
    }
    let parts = SceneParts {
        name: "aircraft".to_owned(),
        vertices: mesh.vertices(),
        triangles: mesh.triangles,
        spheres: Vec::new(),
        structures: Vec::new(),
        lighting: Lighting { background: [92, 140, 200], ..Lighting::over_the_shoulder() },
        motion: fly_through(),
        path: Vec::new(),
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}

const SIDES: u32 = 6;

fn fuselage() -> Mesh {
    // (z, y, half width, half height) of each ring, from the tail to the nose.
    let stations = [(-4.6, 0.12, 0.45, 0.5), (-1.6, 0.05, 0.8, 0.88), (2.2, 0.0, 0.8, 0.86), (4.6, -0.05, 0.5, 0.52)];
    let mut mesh = Mesh::default();
    for (z, y, width, height) in stations {
        for side in 0..SIDES {
            let turns = (f64::from(side) + 0.5) / f64::from(SIDES);
            let place = DVec3::new(trig::cos_turns(turns) * width, y + trig::sin_turns(turns) * height, z);
            mesh.push(place, DVec3::ZERO, SILVER);
        }
    }
    // Close both ends, and join each ring with the next.
    let tail = mesh.push(DVec3::new(0.0, 0.16, -5.5), DVec3::ZERO, SILVER);
    let nose = mesh.push(DVec3::new(0.0, -0.08, 6.4), DVec3::ZERO, RED);
    let last = (stations.len() as u32 - 1) * SIDES;
    for side in 0..SIDES {
        let next = (side + 1) % SIDES;
        mesh.fan(&[tail, next, side]);
        for low in (0..last).step_by(SIDES as usize) {
            let high = low + SIDES;
            mesh.fan(&[low + side, low + next, high + next, high + side]);
        }
        mesh.fan(&[last + side, last + next, nose]);
    }
    mesh.complete_normals();
    mesh
}

/// Returns a wing's cross-section along the direction of flight: leading edge, upper side, trailing edge, lower side.
fn diamond(leading: DVec3, chord: f64, thickness: DVec3) -> Vec<DVec3> {
    let middle = leading - DVec3::Z * (0.4 * chord);
    vec![leading, middle + thickness, leading - DVec3::Z * chord, middle - thickness]
}

fn wing(side: f64) -> Vec<Vec<DVec3>> {
    let root = diamond(DVec3::new(side * 0.4, -0.1, 2.4), 3.2, DVec3::Y * 0.17);
    let tip = diamond(DVec3::new(side * 4.9, -0.35, -2.3), 1.4, DVec3::Y * 0.06);
    prism(&root, &tip)
}

fn tailplane(side: f64) -> Vec<Vec<DVec3>> {
    let root = diamond(DVec3::new(side * 0.1, 0.45, -3.6), 1.7, DVec3::Y * 0.1);
    pyramid(&root, DVec3::new(side * 2.2, 0.5, -5.6))
}

fn wedge(leading: DVec3, chord: f64, half_thickness: f64) -> [DVec3; 3] {
    let trailing = [half_thickness, -half_thickness].map(|x| leading + DVec3::new(x, 0.0, -chord));
    [leading, trailing[0], trailing[1]]
}

fn fin() -> Vec<Vec<DVec3>> {
    let root = wedge(DVec3::new(0.0, 0.4, -2.4), 2.5, 0.14);
    let tip = wedge(DVec3::new(0.0, 2.7, -4.8), 1.0, 0.06);
    prism(&root, &tip)
}

fn canopy() -> Vec<Vec<DVec3>> {
    let base = [(0.0, 3.6), (0.4, 1.9), (0.0, -0.4), (-0.4, 1.9)].map(|(x, z)| DVec3::new(x, 0.62, z));
    let [above, below] = [1.35, 0.4].map(|y| DVec3::new(0.0, y, 1.9));
    let sides = |tip: DVec3| (0..4).map(move |side| vec![base[side], base[(side + 1) % 4], tip]);
    let lower = sides(below).map(reversed);
    sides(above).chain(lower).collect()
}

fn prism(root: &[DVec3], tip: &[DVec3]) -> Vec<Vec<DVec3>> {
    let count = root.len();
    let side = |side: usize| vec![root[side], root[(side + 1) % count], tip[(side + 1) % count], tip[side]];
    let ends = [reversed(root.to_vec()), tip.to_vec()];
    (0..count).map(side).chain(ends).collect()
}

fn pyramid(root: &[DVec3], tip: DVec3) -> Vec<Vec<DVec3>> {
    let count = root.len();
    let side = |side: usize| vec![root[side], root[(side + 1) % count], tip];
    (0..count).map(side).chain([reversed(root.to_vec())]).collect()
}

fn reversed(mut face: Vec<DVec3>) -> Vec<DVec3> {
    face.reverse();
    face
}

/// Adds a solid of flat faces with outward normals. If the volume of the solid is negative, the solid is a mirror image
/// with inward normals, so all faces are reversed.
fn add_flat(mesh: &mut Mesh, faces: Vec<Vec<DVec3>>, colour: Colour) {
    let six_volumes =
        |face: &Vec<DVec3>| -> f64 { face[1..].windows(2).map(|pair| face[0].dot(pair[0].cross(pair[1]))).sum() };
    let is_inside_out = faces.iter().map(six_volumes).sum::<f64>() < 0.0;
    for face in faces {
        let face = if is_inside_out { reversed(face) } else { face };
        let normal = (face[1] - face[0]).cross(face[2] - face[0]);
        let corners: Vec<u32> =
            face.iter().map(|&place| mesh.push(place, normal.normalize_or(DVec3::Y), colour)).collect();
        mesh.fan(&corners);
    }
}
