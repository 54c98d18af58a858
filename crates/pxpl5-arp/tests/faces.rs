//! Compares faces with an independent model that casts a ray for each texel.

use address_recalculation::{CubeFace, FaceGeometry, FaceSet, TexelAddress, TexelFormat};
use glam::DVec3;
use proptest::prelude::*;
use pxpl5_arp::cube_faces::{Corner, CubeView, DepthRange, DrawCounts};

const FORMAT: TexelFormat = TexelFormat { colour_bits: 24, depth_bits: 24 };
const NEAR: f64 = 0.1;
const FAR: f64 = 100.0;

fn view(texels: u32, guard: u32) -> CubeView {
    CubeView { geometry: FaceGeometry { texels, guard }, depth: DepthRange::new(NEAR, FAR).expect("a range") }
}

fn drawn(view: &CubeView, eye: DVec3, triangles: &[[Corner; 3]]) -> (FaceSet, DrawCounts) {
    let mut faces = FaceSet::new(view.geometry.texels, FORMAT);
    let drawing = view.draw(eye, triangles.iter().copied(), &mut faces);
    (faces, drawing)
}

fn all_texels(texels: u32) -> impl Iterator<Item = TexelAddress> {
    let places =
        move |face| (0..texels * texels).map(move |k| TexelAddress { face, column: k % texels, row: k / texels });
    CubeFace::ALL.into_iter().flat_map(places)
}

fn triangle(places: [[f64; 3]; 3], colour: u32) -> [Corner; 3] {
    places.map(|place| Corner { place: DVec3::from_array(place), colour })
}

/// Returns the intersection of a ray with a triangle: the smallest barycentric coordinate, the distance along the axis,
/// and all barycentric coordinates.
fn met(ray: DVec3, corners: [DVec3; 3]) -> Option<(f64, f64, DVec3)> {
    let [a, b, c] = corners;
    let normal = (b - a).cross(c - a);
    let distance = a.dot(normal) / ray.dot(normal);
    let place = ray * distance;
    let share = |from: DVec3, to: DVec3| (to - from).cross(place - from).dot(normal) / normal.length_squared();
    let shares = DVec3::new(share(b, c), share(c, a), share(a, b));
    distance.is_finite().then_some((shares.min_element(), distance, shares))
}

/// Compares every texel except those very close to an edge or to the near and far plane.
fn agrees(view: &CubeView, eye: DVec3, triangles: &[[Corner; 3]]) {
    let (faces, _) = drawn(view, eye, triangles);
    for texel in all_texels(view.geometry.texels) {
        let ray = DVec3::from_array(view.geometry.direction(texel));
        let mut best: Option<(f64, u32)> = None;
        let mut is_sure = true;
        for corners in triangles {
            let Some((inside, distance, shares)) = met(ray, corners.map(|corner| corner.place - eye)) else { continue };
            let is_near = |a: f64, b: f64| (a - b).abs() < 1e-9 * b.max(1.0);
            is_sure &= inside.abs() > 1e-9 && !is_near(distance, NEAR) && !is_near(distance, FAR);
            if inside <= 0.0 || !(NEAR..FAR).contains(&distance) {
                continue;
            }
            is_sure &= best.is_none_or(|(before, _)| (before - distance).abs() > 1e-5 * distance * distance / NEAR);
            if best.is_none_or(|(before, _)| distance < before) {
                let part = |shift: u32| {
                    let parts = DVec3::from_array(corners.map(|corner| f64::from(corner.colour >> shift & 0xFF)));
                    let exact = parts.dot(shares);
                    is_sure &= (exact - exact.floor() - 0.5).abs() > 1e-6;
                    exact.round() as u32
                };
                best = Some((distance, [16, 8, 0].map(part).into_iter().fold(0, |colour, part| colour << 8 | part)));
            }
        }
        if is_sure {
            let expected = best.map(|(distance, colour)| (colour, distance));
            let found = faces.texel(texel);
            assert_eq!(found.map(|(colour, _)| colour), expected.map(|(colour, _)| colour), "{texel:?}");
            if let (Some((_, word)), Some((_, distance))) = (found, expected) {
                // The depth z/w is 0 at the near plane and 1 at the far plane, in 24 bits, rounded down.
                let depth = FAR / (FAR - NEAR) * (1.0 - NEAR / distance) * 16_777_215.0;
                assert!((depth - 0.5 - f64::from(word)).abs() < 0.51, "{texel:?}: {depth} {word}");
            }
        }
    }
}

fn place(limit: f64) -> impl Strategy<Value = [f64; 3]> {
    [-limit..limit, -limit..limit, -limit..limit]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn every_texel_shows_the_first_triangle_on_its_ray(
        places in prop::collection::vec([place(6.0), place(6.0), place(6.0)], 1..6),
        colours in prop::collection::vec([0_u32..0x100_0000, 0_u32..0x100_0000, 0_u32..0x100_0000], 6),
        eye in place(3.0), guard in 0_u32..3,
    ) {
        let corner = |place: [f64; 3], colour: u32| Corner { place: DVec3::from_array(place), colour };
        let triangles: Vec<[Corner; 3]> = places.iter().zip(&colours)
            .map(|(places, colours)| [0, 1, 2].map(|i| corner(places[i], colours[i]))).collect();
        agrees(&view(32, guard), DVec3::from_array(eye), &triangles);
    }

    #[test]
    fn a_closed_surface_around_the_eye_takes_every_texel_exactly_once(
        tip in place(0.9), corners in [0.5..2.0_f64, 0.5..2.0, 0.5..2.0, 0.5..2.0, 0.5..2.0, 0.5..2.0], on_axis in any::<bool>(),
    ) {
        // The edges of this octahedron pass through texel middles if the eye is on its axes.
        let axes = [DVec3::X, DVec3::NEG_X, DVec3::Y, DVec3::NEG_Y, DVec3::Z, DVec3::NEG_Z];
        let points: Vec<DVec3> = axes.iter().zip(corners).map(|(axis, size)| *axis * size * 4.0).collect();
        let eye = if on_axis { DVec3::ZERO } else { DVec3::from_array(tip) * 0.1 };
        let mut triangles = Vec::new();
        for i in 0..8_usize {
            let three = [i & 1, 2 + (i >> 1 & 1), 4 + (i >> 2)];
            triangles.push(three.map(|k| Corner { place: points[k], colour: i as u32 + 1 }));
        }
        let view = view(64, 1);
        let (faces, drawing) = drawn(&view, eye, &triangles);
        prop_assert_eq!(drawing.texels, 6 * 64 * 64);
        prop_assert!(all_texels(64).all(|texel| faces.texel(texel).is_some()));
    }
}

#[test]
fn corners_behind_the_eye_are_drawn_correctly() {
    let floor = triangle([[-50.0, -1.7, 60.0], [70.0, -1.7, 40.0], [0.0, -1.7, -90.0]], 0x00AB_CDEF);
    let through = triangle([[-1.0, 0.05, 0.1], [1.0, 0.05, 0.2], [0.0, -0.3, -2.0]], 0x0012_3456);
    agrees(&view(64, 1), DVec3::ZERO, &[floor, through]);
}

#[test]
fn triangles_outside_the_near_and_far_limits_are_not_drawn() {
    let at = |z: f64| triangle([[-300.0, -300.0, z], [300.0, -300.0, z], [0.0, 600.0, z]], 1);
    let middle = TexelAddress { face: CubeFace::NegZ, column: 32, row: 32 };
    for (z, is_there) in [(-0.0999, false), (-0.1001, true), (-99.9, true), (-100.1, false)] {
        let (faces, _) = drawn(&view(64, 1), DVec3::ZERO, &[at(z)]);
        assert_eq!(faces.texel(middle).is_some(), is_there, "{z}");
    }
}

#[test]
fn at_equal_depth_the_first_triangle_stays() {
    let red = triangle([[-9.0, -9.0, -5.0], [9.0, -9.0, -5.0], [0.0, 9.0, -5.0]], 0x00FF_0000);
    let blue = red.map(|corner| Corner { colour: 0xFF, ..corner });
    let middle = TexelAddress { face: CubeFace::NegZ, column: 32, row: 32 };
    let first =
        |triangles: &[[Corner; 3]]| drawn(&view(64, 1), DVec3::ZERO, triangles).0.texel(middle).map(|texel| texel.0);
    assert_eq!([first(&[red, blue]), first(&[blue, red])], [Some(0x00FF_0000), Some(0xFF)]);
}

#[test]
fn a_guard_texel_shows_the_surface_of_the_neighbouring_face() {
    // Each side of the hall has one colour. The guard column to the right of NegZ shows the side of PosX.
    let wall = |x: f64, colour: u32| vec![triangle([[x, -90.0, -90.0], [x, 90.0, -90.0], [x, 0.0, 90.0]], colour)];
    let (faces, _) = drawn(&view(64, 1), DVec3::ZERO, &wall(5.0, 0x77));
    let guard = TexelAddress { face: CubeFace::NegZ, column: 63, row: 32 };
    let inner = TexelAddress { face: CubeFace::NegZ, column: 62, row: 32 };
    // The ray at u = 63/62 meets the plane x = 5 at z = -4.92, and the ray at u = 61/62 meets it at -5.08. Both points
    // lie on the same plane.
    assert_eq!([guard, inner].map(|texel| faces.texel(texel).map(|texel| texel.0)), [Some(0x77); 2]);
    let distances = [guard, inner].map(|texel| faces.texel(texel).map(|texel| view(64, 1).depth.distance_m(texel.1)));
    assert!((distances[0].expect("drawn") - 5.0 * 62.0 / 63.0).abs() < 1e-4, "{distances:?}");
    assert!((distances[1].expect("drawn") - 5.0 * 62.0 / 61.0).abs() < 1e-4, "{distances:?}");
}

#[test]
fn invalid_coordinates_draw_nothing() {
    for wrong in [f64::NAN, f64::INFINITY, 1e308] {
        let (faces, drawing) = drawn(
            &view(32, 1),
            DVec3::ZERO,
            &[triangle([[wrong, 0.0, -5.0], [1.0, wrong, -5.0], [0.0, 1.0, -5.0]], 1)],
        );
        assert_eq!(drawing.triangles, 1);
        let taken = all_texels(32).filter(|texel| faces.texel(*texel).is_some()).count() as u64;
        assert!(taken <= drawing.texels, "{wrong}");
    }
}

#[test]
fn invalid_ranges_are_refused() {
    for (near, far) in [(0.0, 1.0), (-1.0, 1.0), (1.0, 1.0), (2.0, 1.0), (f64::NAN, 1.0), (0.1, f64::INFINITY)] {
        let error = DepthRange::new(near, far).expect_err("no range").to_string();
        assert!(error.contains("expected 0 < near < far"), "{error}");
    }
}
