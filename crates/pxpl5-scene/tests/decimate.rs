//! Decimated scenes keep their shape (area, box, closedness) and have at most the requested number of primitives.

use std::collections::BTreeMap;

use glam::{DVec3, Vec3};
use proptest::prelude::*;
use pxpl5_scene::{Decimation, Scene, builtin};

fn scene(name: &str) -> Scene {
    builtin(name).unwrap_or_else(|error| panic!("{error}"))
}

/// Returns the positions of the corners as bits, so that vertices at the same position compare as equal.
fn places(scene: &Scene, triangle: &[u32; 3]) -> [[u32; 3]; 3] {
    triangle.map(|corner| scene.vertices()[corner as usize].position.to_array().map(|x| (x + 0.0).to_bits()))
}

/// Returns true if every edge is used equally often in both directions: the surface is closed and consistently
/// oriented.
fn is_closed(scene: &Scene) -> bool {
    let mut edges: BTreeMap<[[u32; 3]; 2], i32> = BTreeMap::new();
    for triangle in scene.triangles() {
        let [a, b, c] = places(scene, triangle);
        for [from, onto] in [[a, b], [b, c], [c, a]] {
            let (key, way) = if from < onto { ([from, onto], 1) } else { ([onto, from], -1) };
            *edges.entry(key).or_default() += way;
        }
    }
    edges.values().all(|balance| *balance == 0)
}

fn corners(scene: &Scene, triangle: &[u32; 3]) -> [DVec3; 3] {
    triangle.map(|corner| scene.vertices()[corner as usize].position.as_dvec3())
}

fn area(scene: &Scene) -> f64 {
    let of = |[a, b, c]: [DVec3; 3]| (b - a).cross(c - a).length() / 2.0;
    scene.triangles().iter().map(|triangle| of(corners(scene, triangle))).sum()
}

fn volume(scene: &Scene) -> f64 {
    let of = |[a, b, c]: [DVec3; 3]| a.dot(b.cross(c)) / 6.0;
    scene.triangles().iter().map(|triangle| of(corners(scene, triangle))).sum()
}

/// Returns the lengths of the sides of the box around a scene.
fn size(scene: &Scene) -> Vec3 {
    let used = scene.triangles().iter().flatten().map(|corner| scene.vertices()[*corner as usize].position);
    let (low, high) = used.fold((Vec3::MAX, Vec3::MIN), |(low, high), p| (low.min(p), high.max(p)));
    high - low
}

#[test]
fn the_decimated_head_is_closed_and_has_the_same_size() {
    let whole = scene("head");
    // The unavoidable error of a polyhedron against a smooth shape is inversely proportional to the number of
    // triangles.
    for (wanted, within) in [(6_000, 0.01), (1_000, 0.04), (140, 0.2)] {
        let few = whole.decimated(wanted).expect("it has more");
        assert_eq!(few.triangles().len(), wanted);
        assert!(is_closed(&few), "{wanted}");
        for (name, of) in [("area", area as fn(&Scene) -> f64), ("volume", volume)] {
            let ratio = of(&few) / of(&whole);
            assert!((ratio - 1.0).abs() < within, "{name} of {wanted}: {ratio}");
        }
        let ratio = size(&few) / size(&whole);
        assert!((ratio - Vec3::ONE).abs().max_element() < within as f32, "{wanted}: {ratio}");
    }
}

/// Every octant of the bounding box must keep triangles. Keeping only the first N triangles of the head would leave
/// only its crown.
#[test]
fn a_decimated_head_keeps_triangles_in_every_octant() {
    let few = scene("head").decimated(200).expect("it has more");
    let (centre, radius) = few.bounding_sphere();
    for octant in 0..8 {
        let side = |bit: u32| if octant >> bit & 1 == 0 { -1.0 } else { 1.0 };
        let towards = Vec3::new(side(0), side(1), side(2));
        let reached = few.vertices().iter().any(|v| ((v.position - centre) * towards).min_element() > 0.05 * radius);
        assert!(reached, "{towards}");
    }
}

#[test]
fn a_decimated_aircraft_keeps_wings_tail_and_nose() {
    let whole = scene("mig");
    for wanted in [300, 140, 100] {
        let few = whole.decimated(wanted).expect("it has more");
        assert!((wanted - 1..=wanted).contains(&few.triangles().len()), "{wanted}: {}", few.triangles().len());
        let ratio = size(&few) / size(&whole);
        assert!((ratio - Vec3::ONE).abs().max_element() < 0.06, "{wanted}: {ratio}");
        assert!((area(&few) / area(&whole) - 1.0).abs() < 0.25, "{wanted}: {}", area(&few) / area(&whole));
        assert_eq!(few.structures().len(), whole.structures().len(), "ailerons, tailplanes and rudder still move");
    }
}

#[test]
fn decimation_reduces_a_flat_sheet_of_many_triangles_to_two_triangles() {
    // Corners keep their positions, and everything within a plane can be removed.
    let mut parts = scene("full-screen:1").into_parts();
    const SIDE: u32 = 9;
    let vertex = parts.vertices[0];
    let place = |i: u32| Vec3::new((i % SIDE) as f32, (i / SIDE) as f32, 0.0);
    parts.vertices = (0..SIDE * SIDE).map(|i| pxpl5_scene::Vertex { position: place(i), ..vertex }).collect();
    let cells = (0..SIDE * (SIDE - 1)).filter(|i| i % SIDE < SIDE - 1);
    let halves = |i: u32| [[i, i + 1, i + SIDE + 1], [i, i + SIDE + 1, i + SIDE]];
    parts.triangles = cells.flat_map(halves).collect();
    parts.structures.clear();
    let sheet = Scene::new(parts).expect("a sheet");
    let few = sheet.decimated(2).expect("it has 128");
    assert_eq!((few.triangles().len(), area(&few)), (2, 64.0));
}

#[test]
fn decimating_separate_pieces_keeps_the_requested_number_of_triangles_from_all_parts() {
    let few = scene("typical:1000").decimated(100).expect("it has more");
    assert_eq!(few.triangles().len(), 100);
    let ratio = size(&few) / size(&scene("typical:1000"));
    assert!(ratio.x > 0.9 && ratio.y > 0.9, "{ratio}");
    assert_eq!(scene("full-screen:12").decimated(5).expect("it has 12").triangles().len(), 5);
}

#[test]
fn decimation_keeps_the_proportion_of_spheres_and_triangles() {
    let whole = scene("molecules");
    let few = whole.decimated(384).expect("it has more");
    // 384 of 3,839 primitives: about 262 of 2,620 triangles, as far as a closed ribbon allows, and 122 of 1,219
    // spheres.
    assert_eq!(few.spheres().len(), 122);
    assert!((255..=262).contains(&few.triangles().len()), "{}", few.triangles().len());
    assert!((few.bounding_sphere().1 / whole.bounding_sphere().1 - 1.0).abs() < 0.1);
    assert_eq!(whole.decimated(2_620 + 1_219).expect("all"), whole);
    for n in [0, 2_620 + 1_219 + 1] {
        let error = whole.decimated(n).expect_err("impossible").to_string();
        assert!(error.contains("1 to 3839") && error.contains(&format!("found {n}")), "{error}");
    }
}

#[test]
fn decimation_uses_only_existing_positions_normals_and_colours() {
    let whole = scene("mig");
    for vertex in whole.decimated(120).expect("it has more").vertices() {
        assert!(whole.vertices().contains(vertex));
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn decimation_respects_its_limit_and_is_deterministic(half in 4u32..200, share in 0.01f64..1.0) {
        let whole = scene(&format!("sphere:{}", 2 * half));
        let wanted = ((f64::from(2 * half) * share) as usize).max(1);
        let few = whole.decimated(wanted).expect("it has more");
        prop_assert!((1..=wanted).contains(&few.triangles().len()));
        // A closed surface has at least four triangles and an even number.
        if wanted >= 4 {
            prop_assert!(is_closed(&few));
            prop_assert!(few.triangles().len() + 1 >= wanted);
        }
        prop_assert_eq!(&whole.decimated(wanted).expect("again"), &few);
    }
}

/// Decimates a scene to several sizes, one after the other. Some calls can continue from the state of an earlier call,
/// and others cannot.
#[test]
fn decimating_in_two_steps_gives_the_same_scene() {
    for (name, numbers) in [
        ("mig", &[200, 201, 199, 190, 120, 60, 300, 416, 150, 7, 1, 417][..]),
        ("molecules", &[900, 880, 901, 500, 3_000, 20]),
        ("head", &[14_587, 14_588, 14_500, 7_000, 20_000]),
        ("sphere:100", &[50, 49, 48, 20, 4, 2]),
        ("full-screen:8", &[6, 5, 3, 1]),
    ] {
        let whole = scene(name);
        let decimation = Decimation::new(std::sync::Arc::new(whole.clone()));
        for number in numbers {
            let [alone, after_others] =
                [whole.decimated(*number), decimation.decimated(*number)].map(|scene| scene.expect("in range"));
            assert!(alone == after_others, "{name}, {number}");
        }
        assert!(decimation.decimated(0).is_err(), "{name}");
    }
}
