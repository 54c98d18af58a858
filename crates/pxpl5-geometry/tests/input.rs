//! Tests of user input: meshes, invalid numbers, culling, and invisible spheres.

use crate::support::random::Random;
use crate::support::spheres::{self, ExactSphere, native};
use crate::support::{self, at_pixel, cases, pixel_view};
use glam::{Mat4, Vec3};
use pxpl5_geometry::{
    Culling, GouraudSphere, LANES, Light, ScreenTriangle, SetupStats, SurfaceVertex, Touch, Transform, Triangle,
    TriangleLanes, VertexColours, ViewTransform, Viewport, WorldSphere,
};
use pxpl5_wire::{FieldParity, Linear};

fn transform(culling: Culling) -> Transform {
    Transform::new(&pixel_view(1.0, 16_384.0), Viewport::FRAME, culling).expect("a finite view")
}

fn triangle(positions: [Vec3; 3]) -> Triangle {
    Triangle { positions, normals: [Vec3::Z; 3], colours: [[10, 20, 30], [40, 50, 60], [70, 80, 90]] }
}

fn drawn(transform: &Transform, positions: [Vec3; 3]) -> (Vec<ScreenTriangle<VertexColours>>, SetupStats) {
    let mut out = Vec::new();
    let mut stats = SetupStats::default();
    transform.gouraud(&triangle(positions), &Light::NONE, &mut stats, |t| out.push(t));
    (out, stats)
}

fn clockwise() -> [Vec3; 3] {
    [at_pixel(100.0, 100.0, 1.0), at_pixel(200.0, 100.0, 1.0), at_pixel(100.0, 200.0, 1.0)]
}

#[test]
fn nan_infinite_and_huge_coordinates_are_counted_and_never_drawn() {
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX] {
        for axis in 0..3 {
            let mut positions = clockwise();
            positions[1][axis] = bad;
            let (out, stats) = drawn(&transform(Culling::None), positions);
            assert_eq!((out.len(), stats.not_finite, stats.triangles), (0, 1, 1), "{bad} on axis {axis}");
        }
    }
}

#[test]
fn nan_normals_give_a_colour_and_no_panic() {
    let mut bad = triangle(clockwise());
    bad.normals = [Vec3::NAN, Vec3::ZERO, Vec3::splat(f32::INFINITY)];
    let mut out = Vec::new();
    let mut stats = SetupStats::default();
    transform(Culling::None).gouraud(&bad, &Light::HEADLIGHT, &mut stats, |t| out.push(t));
    assert_eq!(out[0].surface.0, bad.colours.map(|c| c.map(|v| u16::from(v) * 256)));
}

#[test]
fn a_view_with_nan_is_refused_by_name() {
    let mut view = pixel_view(1.0, 10.0);
    view.model_view.w_axis.x = f32::NAN;
    let error = Transform::new(&view, Viewport::FRAME, Culling::None).unwrap_err();
    assert_eq!(error.to_string(), "model-view matrix: expected finite numbers, found NaN or infinity");
    view = pixel_view(1.0, 1.0);
    let error = Transform::new(&view, Viewport::FRAME, Culling::None).unwrap_err();
    assert_eq!(error.to_string(), "projection matrix: expected finite numbers, found NaN or infinity");
}

#[test]
fn back_faces_are_dropped_only_on_request() {
    let [a, b, c] = clockwise();
    assert_eq!(drawn(&transform(Culling::None), [a, b, c]).0.len(), 1);
    let (out, stats) = drawn(&transform(Culling::Back), [a, b, c]);
    assert_eq!((out.len(), stats.back_facing), (0, 1));
    assert_eq!(drawn(&transform(Culling::Back), [a, c, b]).0.len(), 1);
}

#[test]
fn mirroring_matrices_do_not_reverse_faces() {
    let view = pixel_view(1.0, 16_384.0);
    let culled = |view: &ViewTransform, positions: [Vec3; 3]| {
        let transform = Transform::new(view, Viewport::FRAME, Culling::Back).expect("a finite view");
        let vertices = positions.map(|p| transform.screen_vertex(p));
        let stats = drawn(&transform, positions).1;
        let shared = transform.touched(&vertices, 0, &[[0, 1, 2]]).get(0) == Touch::BackFacing;
        assert_eq!(stats.back_facing == 1, shared, "alone and with shared vertices");
        shared
    };
    for (scale, mirrors) in [
        (Vec3::new(-1.0, 1.0, 1.0), true),
        (Vec3::new(1.0, -1.0, 1.0), true),
        (Vec3::new(1.0, 1.0, -1.0), true),
        (Vec3::new(-1.0, -1.0, 1.0), false),
        (Vec3::splat(-2.0), true),
        (Vec3::splat(3.0), false),
    ] {
        let scaled = ViewTransform { model_view: Mat4::from_scale(scale), ..view };
        // The triangle has the same place on the screen. A mirroring matrix reverses the winding of the model's
        // triangle.
        let there = clockwise().map(|p| p / scale);
        assert_eq!(culled(&scaled, there), !mirrors, "{scale}");
        assert_eq!(culled(&scaled, [there[0], there[2], there[1]]), mirrors, "{scale}");
    }
    // A projection with y downwards mirrors the picture but not the model.
    let down = ViewTransform { projection: Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * view.projection, ..view };
    assert!(culled(&down, clockwise()));
    // Without perspective, the depth determines the direction of the view.
    let projection = Mat4::orthographic_rh(-960.0, 960.0, -960.0, 960.0, 1.0, 16_384.0);
    for (scale, mirrors) in [(Vec3::ONE, false), (Vec3::new(-1.0, 1.0, 1.0), true)] {
        let flat = ViewTransform { model_view: Mat4::from_scale(scale), projection };
        assert_eq!(culled(&flat, clockwise().map(|p| p / scale)), !mirrors, "{scale}");
    }
}

#[test]
fn colours_follow_their_corners_when_a_triangle_is_turned_clockwise() {
    let [a, b, c] = clockwise();
    let (out, _) = drawn(&transform(Culling::None), [a, c, b]);
    assert_eq!(out[0].outline.x, [1600, 3200, 1600]);
    let expected = [[10, 20, 30], [70, 80, 90], [40, 50, 60]].map(|c| c.map(|v: u16| v * 256));
    assert_eq!(out[0].surface.0, expected);
}

#[test]
fn a_vertex_that_faces_the_light_has_full_light_and_a_vertex_at_90_degrees_has_ambient_light() {
    let mut lit = triangle(clockwise());
    lit.normals = [Vec3::Z, Vec3::NEG_Z * 7.0, Vec3::X];
    lit.colours = [[200; 3]; 3];
    let light = Light { direction: [0.0, 0.0, 1.0], ambient: 0.25, diffuse: 0.5 };
    let mut out = Vec::new();
    let mut stats = SetupStats::default();
    transform(Culling::None).gouraud(&lit, &light, &mut stats, |t| out.push(t));
    // Lighting is two-sided: a normal that points away is treated like the opposite normal.
    assert_eq!(out[0].surface.0.map(|c| c[0]), [200 * 192, 200 * 192, 200 * 64]);
}

#[test]
fn phong_normals_are_unit_length_and_face_the_eye() {
    let mut away = triangle(clockwise());
    away.normals = [Vec3::NEG_Z * 3.0, Vec3::new(0.0, -3.0, -4.0), Vec3::NEG_Z];
    let mut out = Vec::new();
    let mut stats = SetupStats::default();
    transform(Culling::None).phong(&away, &mut stats, |t| out.push(t));
    // The expected values are 0.6 and 0.8 in units of 1/2^14, rounded.
    assert_eq!(out[0].surface.normals, [[0, 0, 16_384], [0, 9830, 13_107], [0, 0, 16_384]]);
    assert_eq!(out[0].surface.colour, [10, 20, 30]);
}

#[test]
fn shared_vertices_give_the_same_result_as_separate_triangles() {
    let pictures = [Viewport::FRAME, Viewport::field(FieldParity::Even), Viewport::field(FieldParity::Odd)];
    for (picture, culling) in pictures.iter().flat_map(|p| [(p, Culling::None), (p, Culling::Back)]) {
        let mut whole = 0;
        for case in cases::all().iter().filter(|c| !c.tiling) {
            let transform = Transform::new(&case.view, *picture, culling).expect("a finite view");
            for (n, triangle) in case.triangles.iter().enumerate() {
                let tilted = Vec3::new(0.3, 0.4, if n % 2 == 0 { 0.8 } else { -0.8 });
                let triangle = Triangle { normals: [tilted, Vec3::X, Vec3::NEG_Z], ..*triangle };
                whole += u32::from(agrees_with_its_shared_vertices(&transform, &triangle, n % LANES, case.name));
            }
        }
        assert!(whole > 500, "{whole}");
    }
}

/// Compares a triangle with the same triangle from shared vertices, which is in a lane after other triangles. Returns
/// false if the triangle is invisible or clipped.
fn agrees_with_its_shared_vertices(transform: &Transform, t: &Triangle, lane: usize, name: &str) -> bool {
    let light = Light { direction: [0.6, 0.0, 0.8], ambient: 0.2, diffuse: 0.7 };
    let [a, b, c] = t.positions.map(|p| transform.screen_vertex(p));
    let mut stats = [SetupStats::default(); 2];
    let mut lit = Vec::new();
    let mut normals = Vec::new();
    transform.gouraud(t, &light, &mut stats[0], |t| lit.push(t));
    transform.phong(t, &mut SetupStats::default(), |t| normals.push(t));
    stats[1].triangles += 1;
    // Vertex numbers begin with 5.
    let vertices = [a, b, c, transform.screen_vertex(Vec3::NAN)];
    let triangles: Vec<_> = (0..=lane).map(|i| if i == lane { [5, 6, 7] } else { [5, 8, 6] }).collect();
    let touch = transform.touched(&vertices, 5, &triangles);
    if touch.get(lane) == Touch::NeedsClipping {
        return false;
    }
    assert!((0..lane).all(|i| touch.get(i) == Touch::NeedsClipping));
    let mask = touch.get(lane).count(&mut stats[1]);
    assert_eq!(mask, lit.first().map(|t| t.outline.regions), "{name}");
    assert_eq!(stats[0], stats[1], "{name}");
    let Some(lit) = lit.first() else { return false };
    let Some(normals) = normals.first() else { return false };
    let colours = transform.vertex_colours(&light, &vertices[..3], &t.positions, &t.normals, &t.colours);
    let facing = transform.vertex_normals(&vertices[..3], &t.positions, &t.normals);
    let found = transform.gouraud_lanes(&in_lane(lane, &colours), &mut stats[1]);
    assert_eq!(found.get(lane), lit.gouraud(transform.viewport(), &mut stats[0]), "{name}");
    assert!((0..lane).all(|empty| found.get(empty).edges == [Linear::constant(-1); 3]));
    let found = transform.phong_lanes(&in_lane(lane, &facing), &mut stats[1]).get(lane, t.colours[0]);
    assert_eq!(found, normals.phong(transform.viewport(), &mut stats[0]), "{name}");
    assert_eq!(stats[0], stats[1], "{name}");
    true
}

fn in_lane(lane: usize, corners: &[SurfaceVertex]) -> TriangleLanes<'_> {
    let mut lanes = TriangleLanes::default();
    (0..lane).for_each(|_| lanes.push_nothing());
    assert!(lanes.push([&corners[0], &corners[1], &corners[2]]), "it needs no clipping");
    lanes
}

#[test]
fn spheres_outside_the_view_and_spheres_cut_by_a_clip_plane_have_separate_counts() {
    assert_eq!(one(50.0, 10.0).spheres_outside, 1);
    assert_eq!(one(0.0, 10.0).spheres_across_near, 1);
    assert_eq!(one(-5.0, 4.5).spheres_across_near, 1);
    assert_eq!(one(-16_390.0, 100.0).spheres_across_far, 1);
    assert_eq!(one(-20_000.0, 100.0).spheres_outside, 1);
    assert_eq!(one(f32::NAN, 1.0).spheres_not_finite, 1);
    assert_eq!(one(-5.0, -1.0).spheres_not_finite, 1);
    assert_eq!(one(-5.0, f32::INFINITY).spheres_not_finite, 1);
    assert_eq!(one(-5.0, 3.9).screen_spheres, 1);
    assert_eq!(one(-5.0, 0.0).spheres_outside, 1);
}

/// Returns the counts for one sphere with its centre on the eye's axis.
fn one(z: f32, radius: f32) -> SetupStats {
    let mut stats = SetupStats::default();
    let sphere = WorldSphere { centre: Vec3::new(0.0, 0.0, z), radius, colour: [1; 3] };
    let found = spheres::transform().sphere(&sphere, &mut stats);
    assert_eq!(found.is_some(), stats.screen_spheres == 1);
    stats
}

#[test]
fn a_projection_that_is_neither_perspective_nor_parallel_draws_no_spheres() {
    let mut view = pixel_view(1.0, 10.0);
    view.projection.x_axis.y = 0.5;
    let transform = Transform::new(&view, Viewport::FRAME, Culling::None).expect("a finite view");
    let mut stats = SetupStats::default();
    let sphere = WorldSphere { centre: Vec3::new(0.0, 0.0, -5.0), radius: 1.0, colour: [1; 3] };
    assert!(transform.sphere(&sphere, &mut stats).is_none());
    assert_eq!(stats.spheres_unprojectable, 1);
}

#[test]
fn silhouettes_are_exact_to_the_pixel_and_covered_by_their_regions() {
    let mut random = Random::new(77);
    let mut pixels = 0;
    for _ in 0..25 {
        let radius = random.between(0.02, 1.0);
        let centre = at_pixel(random.between(0.0, 640.0), random.between(0.0, 480.0), random.between(0.01, 1.0));
        let sphere = WorldSphere { centre, radius: radius * radius * -centre.z * 0.7, colour: [200; 3] };
        let exact = ExactSphere::new(&sphere);
        let mut stats = SetupStats::default();
        let Some(screen) = spheres::transform().sphere(&sphere, &mut stats) else { continue };
        let setup = screen.phong(&Viewport::FRAME, &mut stats).setup;
        for y in 0..480 {
            for x in 0..640 {
                let touched = screen.regions.contains(support::native::region_of(x, y));
                let value = setup.silhouette.at(x, y);
                assert!(!touched || value.unsigned_abs() < 1 << 47, "48 bits at {x}, {y}");
                let found = touched && native(&setup, x, y).is_some();
                pixels += u32::from(found);
                assert_eq!(found, exact.covers(x, y), "{sphere:?} at {x}, {y}");
            }
        }
    }
    assert!(pixels > 100_000);
}

#[test]
fn depths_of_spheres_that_touch_the_near_or_the_far_plane_never_wrap() {
    let cases = [(-5.0, 3.999), (-2_000.0, 1_998.9), (-9_000.0, 8_998.0), (-16_380.0, 100.0), (-16_384.0, 600.0)];
    for (z, radius) in cases {
        let sphere = WorldSphere { centre: Vec3::new(0.0, 0.0, z), radius, colour: [1; 3] };
        let mut stats = SetupStats::default();
        let screen = spheres::transform().sphere(&sphere, &mut stats).unwrap_or_else(|| panic!("{z}: {stats:?}"));
        let setup = screen.phong(&Viewport::FRAME, &mut stats).setup;
        let exact = ExactSphere::new(&sphere);
        // The limit is one step of the root, and a few units for planes and pixels.
        let allowed = f64::from(1_u32 << setup.depth_shift) / 256.0 + 4.0;
        for (y, x) in (0..480).step_by(3).flat_map(|y| (0..640).step_by(3).map(move |x| (y, x))) {
            if let (true, Some(depth)) = (exact.covers(x, y), native(&setup, x, y)) {
                let off = (f64::from(depth) + 0.5 - exact.depth(x, y)).abs();
                assert!(off <= allowed, "{sphere:?} at {x}, {y}: off by {off}, {allowed} allowed");
            }
        }
    }
}

#[test]
fn a_sphere_of_a_field_is_every_second_line_of_the_frame() {
    let sphere = WorldSphere { centre: Vec3::new(20.0, 30.0, -200.0), radius: 60.0, colour: [200, 100, 50] };
    for parity in [FieldParity::Even, FieldParity::Odd] {
        let [frame, field] = [Viewport::FRAME, Viewport::field(parity)].map(|viewport| {
            let view = pixel_view(1.0, 16_384.0);
            let transform = Transform::new(&view, viewport, Culling::None).expect("a finite view");
            let mut stats = SetupStats::default();
            let screen = transform.sphere(&sphere, &mut stats).expect("it is in sight");
            screen.gouraud(&viewport, &Light::HEADLIGHT, &mut stats)
        });
        for row in 0..240 {
            let line = 2 * row + parity.first_line() as i32;
            for x in 0..640 {
                let a = native(&field.setup, x, row);
                let b = native(&frame.setup, x, line);
                assert_eq!(a.is_some(), b.is_some(), "{x}, {row}");
                // Planes may be rounded around different pixels, which changes depth by one unit.
                assert!(a.unwrap_or(0).abs_diff(b.unwrap_or(0)) <= 1);
            }
        }
    }
}

#[test]
fn a_sphere_in_a_parallel_projection_is_a_circle_whose_depth_is_a_square_root() {
    // The view has 64 px per unit along both axes. Depth is 0 at distance 1, and 1 at distance 9.
    let view = ViewTransform {
        model_view: Mat4::IDENTITY,
        projection: Mat4::orthographic_rh(-5.0, 5.0, -3.75, 3.75, 1.0, 9.0),
    };
    let transform = Transform::new(&view, Viewport::FRAME, Culling::None).expect("a finite view");
    let sphere = WorldSphere { centre: Vec3::new(1.0, -0.5, -5.0), radius: 1.5, colour: [255; 3] };
    let mut stats = SetupStats::default();
    let setup = transform.sphere(&sphere, &mut stats).expect("in sight").phong(&Viewport::FRAME, &mut stats).setup;
    let mut seen = 0;
    for y in 0..480 {
        for x in 0..640 {
            let dx = (f64::from(x) + 0.5 - 384.0) / 64.0;
            let dy = (f64::from(y) + 0.5 - 272.0) / 64.0;
            let square = 2.25 - dx * dx - dy * dy;
            if square.abs() > 1e-4 {
                assert_eq!(native(&setup, x, y).is_some(), square > 0.0, "{x}, {y}");
            }
            if let (true, Some(depth)) = (square > 0.0, native(&setup, x, y)) {
                seen += 1;
                let exact = (4.0 - square.sqrt()) / 8.0 * 16_777_216.0;
                // The limit is half a step of a 12-bit root that spans 1.5 / 8 of the depth range. Near the rim, the
                // root is steep.
                let allowed = 1.5 / 8.0 * 16_777_216.0 / 2048.0 + 20.0;
                assert!((f64::from(depth) - exact).abs() <= allowed, "{depth} {exact}");
            }
        }
    }
    assert!(seen > 28_000);
}

#[test]
fn a_gouraud_sphere_under_a_headlight_is_bright_in_the_middle_and_ambient_at_the_rim() {
    let sphere = WorldSphere { centre: Vec3::new(0.0, 0.0, -1920.0), radius: 600.0, colour: [200, 0, 0] };
    let mut stats = SetupStats::default();
    let screen = spheres::transform().sphere(&sphere, &mut stats).expect("in sight");
    let sphere = screen.gouraud(&Viewport::FRAME, &Light::HEADLIGHT, &mut stats);
    let middle = red(&sphere, 320, 240);
    assert!((198..=200).contains(&middle), "{middle}");
    // A radius of 600 at distance 1920 is 105 px. The rim has only the ambient light, a quarter of the colour.
    let rim = red(&sphere, 320 + 104, 240);
    assert!((50..=70).contains(&rim), "{rim}");
}

/// Returns the red value that the renderer stores, computed as the documentation of the operands states.
fn red(sphere: &GouraudSphere, x: i32, y: i32) -> i32 {
    let value = sphere.setup.silhouette.at(x, y).max(0) >> sphere.setup.root_shift;
    let root = (value as u64 & 0xff_ffff).isqrt() as i32;
    (sphere.rgb[0].at(x, y) >> 12) + (((root >> 4) * i32::from(sphere.root_factor[0])) >> 8)
}
