//! An art gallery with a path through it. Floor, ceiling, walls and partitions of the hall are large quadrangles.
//! Priority rendering (the method that redraws each part of a scene only when its image is outdated) cuts these
//! quadrangles into segments.
//!
//! All numbers are assumed, because the papers print neither size nor plan. The path runs 1 m beside the partitions.
//! Such a path is the worst case for priority rendering, because images of near surfaces become outdated soonest.

use glam::{DVec3, Vec3};

use super::solid::Solid;
use crate::import::Mesh;
use crate::motion::{HeadMotion, HeadPath};
use crate::scene::{Lighting, Scene, SceneParts};
use crate::sway::Sway;

/// Half the length and half the width of the hall, metres.
const HALF_M: f64 = 20.0;

const HEIGHT_M: f64 = 4.0;
const PARTITION_M: f64 = 3.0;
/// Height of the viewer's eyes, metres.
const EYE_M: f64 = 1.7;

/// Distance of the path from the near side of a partition, metres.
const BESIDE_M: f64 = 1.0;
const THICKNESS_M: f64 = 0.1;

/// Ends of each partition, as fractions of the straight part of the path beside the partition.
const BESIDE_LEG: [f64; 2] = [0.2, 0.8];

/// Corners of the path, x and z in metres. The straight parts are slanted, so the head's distances to the borders of
/// the cells (squares of the floor) change all the time.
const CORNERS: [[f64; 2]; 10] = [
    [-16.0, -15.0],
    [-3.0, -17.0],
    [2.0, -6.0],
    [15.0, -16.0],
    [17.0, 3.0],
    [6.0, 6.0],
    [13.0, 16.0],
    [-4.0, 12.0],
    [-15.0, 17.0],
    [-17.0, 2.0],
];

const FLOOR: [u8; 3] = [120, 100, 80];
const CEILING: [u8; 3] = [225, 225, 215];
/// Colours of the walls at +x, -x, +z and -z.
const WALLS: [[u8; 3]; 4] = [[170, 140, 120], [120, 150, 170], [165, 165, 120], [130, 160, 130]];

const PARTITIONS: [[u8; 3]; 5] = [[200, 90, 80], [90, 130, 200], [210, 180, 90], [110, 180, 110], [170, 110, 180]];

/// Generates the hall with its partitions. If `is_full` is true, the hall also has picture frames and benches.
pub(super) fn scene(is_full: bool) -> Scene {
    let mut solid = Solid::default();
    hall(&mut solid);
    for leg in 0..CORNERS.len() {
        partition(&mut solid, leg);
    }
    if is_full {
        for leg in 0..CORNERS.len() {
            (0..FRAMES).for_each(|number| frame(&mut solid, leg, number));
            bench(&mut solid, leg);
        }
    }
    // The head stands at the first corner and looks along the path. A run can let it walk along the path instead.
    let path: Vec<Vec3> = CORNERS.map(|[x, z]| DVec3::new(x, EYE_M, z).as_vec3()).to_vec();
    let standing = HeadPath::Still { eye: path[0], target: path[1] };
    let parts = SceneParts {
        name: if is_full { "gallery:full" } else { "gallery" }.to_owned(),
        vertices: solid.mesh.vertices(),
        triangles: solid.mesh.triangles,
        spheres: Vec::new(),
        structures: solid.structures,
        // Lamps cover the ceiling, so most of the light is ambient. With less ambient light the ceiling itself would be
        // black.
        lighting: Lighting { ambient: 0.6, diffuse: 0.4, ..Lighting::over_the_shoulder() },
        motion: HeadMotion::new(standing, Sway::none()).expect("pxpl5-scene: constants are in range"),
        path,
    };
    Scene::new(parts).expect("pxpl5-scene: generators check what they make")
}

/// Adds a quadrangle. The corners run anticlockwise, seen from the visible side.
fn quadrangle(solid: &mut Solid, corners: [DVec3; 4], colour: [u8; 3]) {
    let normal = (corners[1] - corners[0]).cross(corners[3] - corners[0]).normalize();
    let mut part = Mesh::default();
    let vertices = corners.map(|corner| part.push(corner, normal, colour));
    part.fan(&vertices);
    solid.append(part);
}

fn hall(solid: &mut Solid) {
    // Corners run anticlockwise seen from inside the hall.
    let corner = |x: f64, y: f64, z: f64| DVec3::new(x * HALF_M, y * HEIGHT_M, z * HALF_M);
    let sides = [
        (
            "floor",
            FLOOR,
            [corner(-1.0, 0.0, 1.0), corner(1.0, 0.0, 1.0), corner(1.0, 0.0, -1.0), corner(-1.0, 0.0, -1.0)],
        ),
        (
            "ceiling",
            CEILING,
            [corner(-1.0, 1.0, -1.0), corner(1.0, 1.0, -1.0), corner(1.0, 1.0, 1.0), corner(-1.0, 1.0, 1.0)],
        ),
        (
            "wall +x",
            WALLS[0],
            [corner(1.0, 0.0, -1.0), corner(1.0, 0.0, 1.0), corner(1.0, 1.0, 1.0), corner(1.0, 1.0, -1.0)],
        ),
        (
            "wall -x",
            WALLS[1],
            [corner(-1.0, 0.0, 1.0), corner(-1.0, 0.0, -1.0), corner(-1.0, 1.0, -1.0), corner(-1.0, 1.0, 1.0)],
        ),
        (
            "wall +z",
            WALLS[2],
            [corner(1.0, 0.0, 1.0), corner(-1.0, 0.0, 1.0), corner(-1.0, 1.0, 1.0), corner(1.0, 1.0, 1.0)],
        ),
        (
            "wall -z",
            WALLS[3],
            [corner(-1.0, 0.0, -1.0), corner(1.0, 0.0, -1.0), corner(1.0, 1.0, -1.0), corner(-1.0, 1.0, -1.0)],
        ),
    ];
    for (name, colour, corners) in sides {
        quadrangle(solid, corners, colour);
        solid.end_structure(name, None);
    }
}

struct Leg {
    from: DVec3,
    along: DVec3,
    length: f64,
    left: DVec3,
}

fn leg(number: usize) -> Leg {
    let [from, to] = [number, number + 1].map(|i| {
        let [x, z] = CORNERS[i % CORNERS.len()];
        DVec3::new(x, 0.0, z)
    });
    let length = (to - from).length();
    let along = (to - from) / length;
    Leg { from, along, length, left: DVec3::Y.cross(along) }
}

/// Adds an upright box. A box that stands on the floor gets no lower side, because the lower side is invisible.
fn upright(solid: &mut Solid, middle: DVec3, along: DVec3, half: DVec3, colour: [u8; 3]) {
    let across = DVec3::Y.cross(along);
    let corner =
        |x: f64, y: f64, z: f64| middle + along * (x * half.x) + DVec3::Y * (y * half.y) + across * (z * half.z);
    let [a, b, c, d] = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)].map(|(x, z)| corner(x, -1.0, z));
    let [e, f, g, h] = [a, b, c, d].map(|low| low + DVec3::Y * (2.0 * half.y));
    // `across` points to the left of `along`, so a, b, c, d run clockwise seen from above.
    for side in [[b, a, e, f], [c, b, f, g], [d, c, g, h], [a, d, h, e], [h, g, f, e]] {
        quadrangle(solid, side, colour);
    }
    if middle.y > half.y {
        quadrangle(solid, [a, b, c, d], colour);
    }
}

fn partition_middle(leg: &Leg) -> DVec3 {
    leg.from + leg.along * (leg.length / 2.0) + leg.left * (BESIDE_M + THICKNESS_M / 2.0)
}

fn partition(solid: &mut Solid, number: usize) {
    let leg = leg(number);
    let half_length = leg.length * (BESIDE_LEG[1] - BESIDE_LEG[0]) / 2.0;
    let middle = partition_middle(&leg) + DVec3::Y * (PARTITION_M / 2.0);
    let half = DVec3::new(half_length, PARTITION_M / 2.0, THICKNESS_M / 2.0);
    upright(solid, middle, leg.along, half, PARTITIONS[number % PARTITIONS.len()]);
    solid.end_structure(&format!("partition {number}"), None);
}

const FRAMES: usize = 3;

fn frame(solid: &mut Solid, number: usize, place: usize) {
    let leg = leg(number);
    let half_length = leg.length * (BESIDE_LEG[1] - BESIDE_LEG[0]) / 2.0;
    let along = (place as f64 - 1.0) * half_length * 0.6;
    let near_side = partition_middle(&leg) + leg.along * along - leg.left * (THICKNESS_M / 2.0 + 0.03);
    let colour = PARTITIONS[(number + 2 + place) % PARTITIONS.len()].map(|part| 255 - part / 2);
    upright(solid, near_side + DVec3::Y * 1.6, leg.along, DVec3::new(0.6, 0.45, 0.03), colour);
    solid.end_structure(&format!("frame {number}.{place}"), None);
}

/// Adds a bench beside the middle of straight part `number` of the path, on the side without the partition.
fn bench(solid: &mut Solid, number: usize) {
    let leg = leg(number);
    let middle = leg.from + leg.along * (leg.length / 2.0) - leg.left * (2.0 * BESIDE_M);
    upright(solid, middle + DVec3::Y * 0.225, leg.along, DVec3::new(0.9, 0.225, 0.25), [110, 75, 50]);
    solid.end_structure(&format!("bench {number}"), None);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the distance of a point from a line segment on the floor, in metres.
    fn distance(point: DVec3, from: DVec3, to: DVec3) -> f64 {
        let along = to - from;
        let share = ((point - from).dot(along) / along.length_squared()).clamp(0.0, 1.0);
        point.distance(from + along * share)
    }

    #[test]
    fn the_path_keeps_one_metre_from_every_upright_surface() {
        let legs: Vec<Leg> = (0..CORNERS.len()).map(leg).collect();
        for wall in 0..CORNERS.len() {
            let beside = &legs[wall];
            let ends = BESIDE_LEG.map(|share| {
                beside.from + beside.along * (beside.length * share) + beside.left * (BESIDE_M + THICKNESS_M / 2.0)
            });
            let mut nearest = f64::INFINITY;
            for leg in &legs {
                for step in 0..=1000 {
                    let place = leg.from + leg.along * (leg.length * f64::from(step) / 1000.0);
                    nearest = nearest.min(distance(place, ends[0], ends[1]));
                    assert!(place.abs().max_element() < HALF_M - BESIDE_M);
                }
            }
            assert!((nearest - BESIDE_M - THICKNESS_M / 2.0).abs() < 1e-9, "partition {wall}: {nearest}");
        }
    }

    #[test]
    fn all_objects_are_inside_the_hall_whose_six_sides_face_inwards() {
        let gallery = scene(true);
        for vertex in gallery.vertices() {
            let place = vertex.position.as_dvec3();
            assert!(place.x.abs() <= HALF_M && place.z.abs() <= HALF_M && (0.0..=HEIGHT_M).contains(&place.y));
        }
        let middle = DVec3::Y * (HEIGHT_M / 2.0);
        for triangle in &gallery.triangles()[..12] {
            let [a, b, c] = triangle.map(|corner| gallery.vertices()[corner as usize].position.as_dvec3());
            assert!((b - a).cross(c - a).dot(middle - a) > 0.0);
        }
    }

    #[test]
    fn the_sides_of_all_boxes_face_outwards() {
        let gallery = scene(true);
        for structure in &gallery.structures()[6..] {
            let places = structure.vertices.clone().map(|i| gallery.vertices()[i].position.as_dvec3());
            let middle = places.sum::<DVec3>() / structure.vertices.len() as f64;
            for i in structure.triangles.clone() {
                let [a, b, c] =
                    gallery.triangles()[i].map(|corner| gallery.vertices()[corner as usize].position.as_dvec3());
                assert!((b - a).cross(c - a).dot(a - middle) > 0.0, "{}", structure.name);
            }
        }
    }
}
