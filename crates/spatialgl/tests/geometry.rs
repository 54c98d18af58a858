//! Tests of the numbered cases 1 to 11 and 26, computed by hand: slices, tie rules, clip variants and projections as
//! numbers.

use crate::support::*;
use glam::DVec3;
use spatialgl::*;
use std::f64::consts::FRAC_1_SQRT_2;

const EXACT: SliceClip = SliceClip::ShaderPlanes;

fn close(found: f64, expected: f64, half_unit: f64) {
    assert!((found - expected).abs() <= half_unit, "{found} is not {expected}");
}

/// Returns the indices of the slices in the first half turn that accept a point at height 0.
fn planes_of(display: &SweptDisplay, x: f64, z: f64) -> Vec<usize> {
    (0..198).filter(|k| display.accepts(*k, DVec3::new(x, 0.0, z))).collect()
}

#[test]
fn case_1_the_wedge_of_396_slices_has_the_computed_sine_cosine_and_tangent() {
    let wedge = HalfWedge::new(396, 384.0);
    close(wedge.sin, 0.007_933_231_6, 5e-11);
    close(wedge.cos, 0.999_968_531_4, 5e-11);
    close(wedge.tan, 0.007_933_481_2, 5e-11);
    close(2.0 * SliceClip::Prism.reach(wedge), 6.092_913_6, 5e-8);
    close(1.0 / (2.0 * wedge.tan), 63.02, 5e-3);
    close(360.0 / 396.0, 0.909_091, 5e-7);
}

#[test]
fn case_2_each_point_lies_in_its_plane() {
    let display = swept(EXACT, Projection::Orthographic);
    let cases = [
        (100.0, 0.0, 0),
        (0.0, 100.0, 99),
        (100.0, 100.0, 50),
        (-100.0, 0.0, 0),
        (100.0, -1.0, 197),
        (100.0, 0.7932, 0),
        (100.0, 0.7934, 1),
        (3.0, 200.0, 98),
        (-250.0, 90.0, 176),
    ];
    for (x, z, plane) in cases {
        assert_eq!(planes_of(&display, x, z), [plane], "({x}, {z})");
    }
}

#[test]
fn case_3_points_have_the_computed_distances_from_the_boundary_planes() {
    let display = swept(EXACT, Projection::Orthographic);
    let distances = |k: usize, p: [f64; 3]| {
        let SliceVolume::Wedge(planes, _) = display.views()[k].volume else { panic!("a wedge") };
        [planes.a, planes.b].map(|plane| plane[0] * p[0] + plane[1] * p[2])
    };
    let cases = [
        (0, [100.0, 20.0, 0.5], [1.293_307, 0.293_339]),
        (1, [100.0, 20.0, 0.5], [-0.293_339, 1.879_911]),
        (50, [90.0, -40.0, 91.0], [FRAC_1_SQRT_2, 1.323_609]),
        (248, [90.0, -40.0, 91.0], [-FRAC_1_SQRT_2, -1.323_609]),
    ];
    for (k, p, expected) in cases {
        let found = distances(k, p);
        close(found[0], expected[0], 5e-7);
        close(found[1], expected[1], 5e-7);
    }
    assert_eq!(distances(0, [100.0, 20.0, 0.5])[1], -distances(1, [100.0, 20.0, 0.5])[0], "the same computation");
}

#[test]
fn case_4_the_slab_of_each_clip_has_the_computed_half_thickness() {
    let wedge = HalfWedge::new(396, 384.0);
    let cases = [
        (EXACT, [0.0, 0.253_87, 0.793_35, 3.046_46]),
        (SliceClip::Parallel(0.5), [0.500_02, 0.753_89, 1.293_36, 3.546_47]),
        (SliceClip::Hyperbolic(0.25), [0.500_02, 0.560_77, 0.937_77, 3.087_22]),
        (SliceClip::Tapered(0.5), [0.5, 0.712_20, 1.163_14, 3.046_46]),
    ];
    for (clip, expected) in cases {
        for (u, expected) in [0.0, 32.0, 100.0, 384.0].into_iter().zip(expected) {
            close(clip.half_thickness(wedge, u), expected, 5.001e-6);
        }
    }
}

/// Checks that a slice's volume test agrees with the formula of the thickness, just inside and just outside.
#[test]
fn the_volume_of_a_slice_ends_at_the_computed_half_thickness() {
    for clip in SliceClip::ALL {
        let display = swept(clip, Projection::Orthographic);
        let wedge = display.config().half_wedge();
        for u in [-380.0, -100.0, -32.0, 1.0, 32.0, 100.0, 380.0] {
            let thickness = clip.half_thickness(wedge, u);
            for side in [-1.0, 1.0] {
                let at = |s: f64| DVec3::new(u, 5.0, side * s);
                assert!(display.accepts(0, at(thickness - 1e-9)), "{clip:?} {u}");
                assert!(!display.accepts(0, at(thickness + 1e-9)), "{clip:?} {u}");
            }
        }
    }
}

#[test]
fn case_5_the_number_of_slices_that_show_a_point_falls_with_its_radius() {
    let cases = [
        (SliceClip::Prism, [198, 83, 39, 19, 11, 5, 3, 1]),
        (SliceClip::Hyperbolic(0.25), [31, 13, 7, 3, 1, 1, 1, 1]),
        (SliceClip::Parallel(0.5), [33, 13, 7, 5, 3, 1, 1, 1]),
    ];
    for (clip, expected) in cases {
        let display = swept(clip, Projection::Orthographic);
        let found = [2.0, 5.0, 10.0, 20.0, 38.4, 96.0, 192.0, 384.0].map(|r| planes_of(&display, r, 0.0).len());
        assert_eq!(found, expected, "{clip:?}");
    }
}

/// Returns the number of integer points within a radius, the total number of slices that contain them, and the number
/// of points in each plane.
fn integer_points(ties: TieRule, radius: i32) -> (usize, usize, Vec<usize>) {
    let config = SweptConfig { ties, ..SweptConfig::perspecta(EXACT, Projection::Orthographic) };
    let display = SweptDisplay::new(config).expect("valid");
    let mut each = vec![0; 198];
    let mut points = 0;
    for x in -radius..=radius {
        for z in -radius..=radius {
            if x * x + z * z == 0 || x * x + z * z > radius * radius {
                continue;
            }
            points += 1;
            let world = [f64::from(x), 0.0, f64::from(z)];
            for (count, view) in each.iter_mut().zip(display.views()) {
                *count += usize::from(view.volume.contains(world, 0.0, 0.0));
            }
        }
    }
    (points, each.iter().sum(), each)
}

#[test]
fn case_6_the_integer_points_within_a_radius_of_100_lie_in_exactly_one_slice() {
    let (points, memberships, each) = integer_points(TieRule::HalfOpen, 100);
    assert_eq!((points, memberships), (31_416, 31_416));
    assert_eq!([0, 1, 49, 50, 99, 149].map(|k| each[k]), [200, 144, 92, 232, 200, 232]);
    assert_eq!(integer_points(TieRule::Closed, 100).1, 31_696);
}

#[test]
fn case_7_the_integer_points_within_a_radius_of_384_lie_in_exactly_one_slice() {
    let (points, memberships, each) = integer_points(TieRule::HalfOpen, 384);
    assert_eq!((points, memberships), (463_188, 463_188));
    assert_eq!([each[0], each[50]], [2_340, 2_614]);
    assert_eq!(integer_points(TieRule::Closed, 384).1, 464_272);
}

/// Checks figure P4 as printed, at the points where the printed rule is ambiguous.
#[test]
fn the_printed_tie_rules_give_different_numbers_of_slices_for_points_of_a_boundary_plane() {
    let accepting = |ties: TieRule, x: f64, z: f64| {
        let config = SweptConfig { ties, ..SweptConfig::perspecta(EXACT, Projection::Orthographic) };
        planes_of(&SweptDisplay::new(config).expect("valid"), x, z).len()
    };
    let rules = [TieRule::HalfOpen, TieRule::ProductPositive, TieRule::SameSign, TieRule::Closed];
    assert_eq!(rules.map(|ties| accepting(ties, 100.0, 100.0)), [1, 0, 2, 2], "the + lobe");
    assert_eq!(rules.map(|ties| accepting(ties, -100.0, -100.0)), [1, 0, 0, 2], "the - lobe");
    assert_eq!(rules.map(|ties| accepting(ties, 0.0, 0.0)), [0, 0, 198, 198], "the axis");
}

#[test]
fn case_9_points_seen_by_an_eye_moved_aside_have_the_computed_positions() {
    let display = swept(SliceClip::Prism, ASIDE);
    let seen = |u: f64, v: f64, s: f64| {
        let clip = display.views()[0].projection * DVec3::new(u, v, s).extend(1.0);
        [clip.x / clip.w * 384.0, clip.y / clip.w * 384.0, clip.z / clip.w, clip.w]
    };
    let [u, v, z, _] = seen(300.0, -200.0, 0.0);
    close(u, 300.0, 1e-9);
    close(v, -200.0, 1e-9);
    close(z, 0.500_99, 5.1e-6);
    let [u, v, z, w] = seen(300.0, -200.0, 2.5);
    close(u, 300.451_255, 5.1e-7);
    close(v, -199.831_105, 5.1e-7);
    close(w, 1533.5, 1e-9);
    close(z, 0.090_012, 5.1e-7);
    let [u, v, z, _] = seen(-120.0, 64.0, -3.0);
    close(u, -119.720_858, 5.1e-7);
    // The value computed by hand is 63.283430; to six digits it is 63.283431 (63.28343080).
    close(v, 63.283_430_8, 5.1e-8);
    close(z, 0.992_405, 5.1e-7);
}

/// Returns the area of a projected triangle in the image, in square pixels. The corners are given as (u, v, s).
fn area(projection: Projection, corners: Triangle) -> f64 {
    let display = swept(SliceClip::Prism, projection);
    let [a, b, c] = corners.map(|corner| {
        let clip = display.views()[0].projection * DVec3::from_array(corner).extend(1.0);
        384.0 * clip.truncate().truncate() / clip.w
    });
    ((b - a).perp_dot(c - a) / 2.0).abs()
}

#[test]
fn cases_10_and_11_triangles_seen_edge_on_have_the_computed_areas() {
    let ahead = Projection::Perspective { eye: [0.0; 2], distance: 1536.0, shear: [0.0; 2] };
    let upright = [[100.0, 50.0, -2.0], [200.0, 50.0, -1.0], [150.0, 50.0, 2.0]];
    close(area(Projection::Orthographic, upright), 0.0, 1e-9);
    close(area(ahead, upright), 5.692_918, 5.1e-7);
    close(area(ASIDE, upright), 40.260_315, 5.1e-7);
    let eyes_own = [[0.0, 0.0, 0.0], [100.0, 0.0, 0.0], [50.0, 0.0, 3.0]];
    close(area(ahead, eyes_own), 0.0, 1e-9);
    let unsheared = Projection::Perspective { eye: [100.0, -150.0], distance: 1536.0, shear: [0.0; 2] };
    close(area(unsheared, eyes_own), 14.677_104, 5.1e-7);
}

/// Checks the wall z = 40.1. A slice accepts it from u = c / (sin + T cos) to u = c / (sin - T cos), and nowhere else.
#[test]
fn case_26_a_wall_crosses_a_slice_at_the_computed_positions() {
    let display = swept(EXACT, Projection::Orthographic);
    for (k, from, width) in [(20, 125.480_794, 6.212_201), (50, 55.829_419, 0.878_760), (90, 40.466_199, 0.092_422)] {
        let (sin, cos) = sin_cos_of_turn(k, 396);
        let wall = |u: f64| {
            let s = (40.1 - u * sin) / cos;
            DVec3::new(u * cos - s * sin, 3.0, u * sin + s * cos)
        };
        for (u, is_inside) in
            [(from - 2e-6, false), (from + 2e-6, true), (from + width - 2e-6, true), (from + width + 2e-6, false)]
        {
            assert_eq!(display.accepts(k as usize, wall(u)), is_inside, "slice {k}, u = {u}");
        }
    }
}

#[test]
fn the_plane_of_a_slice_does_not_depend_on_the_eye() {
    for projection in [Projection::Orthographic, ASIDE, Projection::Jittered(Jitter::new(7))] {
        let display = swept(SliceClip::Hyperbolic(0.25), projection);
        for view in display.views().iter().step_by(29) {
            let clip = view.projection * DVec3::new(-77.0, 123.0, 0.0).extend(1.0);
            close(clip.x / clip.w * 384.0, -77.0, 1e-9);
            close(clip.y / clip.w * 384.0, 123.0, 1e-9);
        }
    }
}

#[test]
fn jitter_is_a_pure_function_of_seed_and_slice_within_its_ranges() {
    let law = Projection::Jittered(Jitter::new(1));
    let reach = 3.0;
    let eyes: Vec<SliceEye> = (0..396).map(|k| law.eye(k, 384.0, reach)).collect();
    assert_eq!(eyes, (0..396).map(|k| law.eye(k, 384.0, reach)).collect::<Vec<_>>());
    assert!(eyes[0] != eyes[198] && eyes[0] != Projection::Jittered(Jitter::new(2)).eye(0, 384.0, reach));
    for SliceEye { eye, shear } in &eyes {
        let [u, v, distance] = eye.expect("near");
        assert!(u.hypot(v) <= 192.0 && distance == 1536.0 && shear[0].hypot(shear[1]) * reach <= 0.5);
    }
    let mean = eyes.iter().map(|eye| eye.eye.expect("near")[0]).sum::<f64>() / 396.0;
    // The standard deviation of one coordinate in a disc of radius 192 is 96.
    assert!(mean.abs() < 4.0 * 96.0 / 396f64.sqrt(), "{mean}");
}
