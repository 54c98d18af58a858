//! Tests of hard cases, and of all kinds of input that cannot be drawn.

use crate::support::*;
use glam::{DMat4, DVec3};
use spatialgl::*;

const ORTHOGRAPHIC: Projection = Projection::Orthographic;

fn config(slices: u32, width: u32, height: u32, clip: SliceClip, projection: Projection) -> SweptConfig {
    SweptConfig { slices, width, height, ..SweptConfig::perspecta(clip, projection) }
}

/// Draws triangles with both renderers in all clip variants and projections, with and without bins. Returns the number
/// of fragments of each variant.
fn everywhere(triangles: &[Triangle]) -> Vec<u64> {
    let commands = recording(triangles);
    let near = Projection::Perspective { eye: [5.0, 3.0], distance: 40.0, shear: [0.0, 0.1] };
    let mut counts = Vec::new();
    for clip in SliceClip::ALL {
        for projection in [ORTHOGRAPHIC, near, Projection::Jittered(Jitter::new(5))] {
            let display = SweptDisplay::new(config(36, 96, 64, clip, projection)).expect("valid");
            let plain = both(&display, &commands, &VolumeConfig::plain());
            let binned = both(&display, &commands, &VolumeConfig::paper());
            assert!(plain.planes == binned.planes, "{clip:?} {projection:?}");
            counts.push(plain.stats.fragments_accepted);
        }
    }
    counts
}

#[test]
fn slivers_of_any_width_are_drawn_as_in_the_reference_model() {
    for width in [1.0, 1e-2, 1e-4, 1e-6] {
        everywhere(&[[[-30.0, -20.3, 9.1], [-30.0 + width, -20.3, 9.1], [31.0, 24.9, 10.2]]]);
        everywhere(&[[[10.0, -20.3, 9.1], [10.0, -20.3 + width, 9.1], [10.0, 24.9, -30.2]]]);
    }
}

#[test]
fn triangles_without_area_draw_nothing() {
    let [a, b] = [[-20.3, -10.1, 4.0], [30.1, 12.7, 5.0]];
    let middle = [0, 1, 2].map(|i| (a[i] + b[i]) / 2.0);
    assert!(everywhere(&[[a, a, a], [a, b, a], [a, b, b]]).iter().all(|count| *count == 0));
    // Because of rounding, three points on a line may form a thin triangle with at most one sample.
    assert!(everywhere(&[[a, middle, b]]).iter().all(|count| *count <= 1));
}

#[test]
fn vertices_on_the_axis_the_rim_or_pixel_centres_are_drawn_as_in_the_reference_model() {
    let rim = 48.0;
    let (sin, cos) = sin_cos_of_turn(1, 72);
    everywhere(&[[[0.0, -20.0, 0.0], [0.0, 20.0, 0.0], [30.0, 5.0, 2.0]]]);
    everywhere(&[[[30.0 * cos, -20.0, 30.0 * sin], [30.0 * cos, 20.0, 30.0 * sin], [0.0, 5.0, 12.0]]]);
    everywhere(&[[[rim, -20.0, 0.0], [-rim, -20.0, 0.0], [0.5, 20.5, 0.0]]]);
    everywhere(&[[[0.5, 0.5, 0.0], [10.5, 0.5, 0.0], [0.5, 10.5, 0.0]]]);
}

#[test]
fn corners_a_million_pixels_away_are_drawn_as_in_the_reference_model() {
    let far = 1e6;
    let counts = everywhere(&[[[-far, -far, 3.0], [far, -far, 3.0], [0.0, far, 3.0]]]);
    assert!(counts.iter().all(|count| *count > 0));
    everywhere(&[[[-far, 0.3, -far], [far, 0.3, 0.2 * far], [0.0, 3.0, far]]]);
}

#[test]
fn corners_behind_the_eye_are_drawn_as_in_the_reference_model() {
    // The eye of `everywhere` is 40 px off the slice. These corners lie up to 400 px off some slices.
    let counts = everywhere(&[[[-20.0, -20.0, -400.0], [20.0, -20.0, 400.0], [0.0, 25.0, 10.0]]]);
    assert!(counts.iter().any(|count| *count > 0));
    everywhere(&[[[-300.0, -20.0, 100.0], [300.0, -20.0, 120.0], [0.0, 25.0, 400.0]]]);
}

#[test]
fn a_plane_perpendicular_to_the_screen_draws_nothing() {
    // All corners have v = 0.5 exactly, so the triangle has no area and its edges run through samples.
    let floor = [[-20.3, 0.5, -10.4], [25.6, 0.5, -15.3], [3.7, 0.5, 26.9]];
    let display = SweptDisplay::new(config(36, 96, 64, SliceClip::Prism, ORTHOGRAPHIC)).expect("valid");
    assert_eq!(both(&display, &recording(&[floor]), &VolumeConfig::plain()).stats.fragments_accepted, 0);
}

#[test]
fn small_displays_of_unusual_size_are_drawn_as_in_the_reference_model() {
    for (slices, width, height, batch) in [(4, 40, 17, 4), (6, 72, 33, 5), (398, 104, 50, 4), (44, 64, 64, 1000)] {
        for projection in [ORTHOGRAPHIC, Projection::Jittered(Jitter::new(3))] {
            let clip = SliceClip::Hyperbolic(0.25);
            let display = SweptDisplay::new(config(slices, width, height, clip, projection)).expect("valid");
            let commands = recording(&[T4.map(|p| p.map(|x| x / 4.0)), T5.map(|p| p.map(|x| x / 2.0))]);
            let tiling = Tiling { tile: Some(32), batch };
            let tiled = both(&display, &commands, &VolumeConfig { tiling, ..VolumeConfig::paper() });
            assert!(tiled.planes == both(&display, &commands, &VolumeConfig::plain()).planes);
            assert!(tiled.stats.fragments_accepted > 0);
        }
    }
}

#[test]
fn the_slices_of_any_phase_and_direction_cover_each_point_once() {
    for rotation in [Rotation::XToZ, Rotation::ZToX] {
        for phase in [0.0, 0.3, -2.0, 5.0] {
            let config = SweptConfig { phase, rotation, ..config(36, 96, 64, SliceClip::ShaderPlanes, ORTHOGRAPHIC) };
            let display = SweptDisplay::new(config).expect("valid");
            for (x, z) in [(20.0, 0.0), (-3.1, 7.7), (0.0, -30.0), (12.0, 12.0)] {
                let planes = (0..36).filter(|k| display.accepts(*k, DVec3::new(x, 1.0, z))).count();
                assert_eq!(planes, 2, "({x}, {z}) of {rotation:?} {phase}: once in each half turn");
            }
            let commands = recording(&[T4.map(|p| p.map(|x| x / 4.0))]);
            let binned = both(&display, &commands, &VolumeConfig::paper());
            assert!(binned.planes == volume(&display, &commands, &VolumeConfig::plain()).planes, "{phase}");
        }
    }
}

#[test]
fn an_empty_recording_is_a_dark_volume() {
    let display = swept(SliceClip::Hyperbolic(0.25), ORTHOGRAPHIC);
    let frame = volume(&display, &DrawContext::default().present(), &VolumeConfig::paper());
    assert_eq!((frame.planes.lit_voxels(), frame.stats.tiles_occupied, frame.stats.slices_empty), (0, 0, 396));
    assert_eq!(frame.stats.bytes_sent, 99 * 72, "the bitmaps alone");
}

#[test]
fn a_cleared_colour_fills_every_slice() {
    let mut context = DrawContext::default();
    let buffer = VertexBuffer::new(vec![ColouredVertex::new(DVec3::ZERO, [9; 3])]).expect("finite");
    context.draw(&buffer, 0..1, Topology::Points).expect("valid");
    context.clear([255, 0, 255]);
    let commands = context.present();
    assert_eq!(commands.primitives(), 0, "what was drawn before is forgotten");
    let display = SweptDisplay::new(config(8, 64, 64, SliceClip::Prism, ORTHOGRAPHIC)).expect("valid");
    let frame = both(&display, &commands, &VolumeConfig::paper());
    assert_eq!(frame.planes.lit_voxels(), 8 * 64 * 64);
    assert_eq!(frame.planes.pixel(3, 17, 40), 0b101);
}

/// Returns the number of lit pixels of slice 0.
fn lit_of(frame: &VolumeFrame) -> u64 {
    let pixels = (0..768).flat_map(|y| (0..768).map(move |x| (x, y)));
    pixels.filter(|(x, y)| frame.planes.pixel(0, *x, *y) != 0).count() as u64
}

/// Checks lines. A line perpendicular to a slice leaves a dot of the line's width. A line in the slice is a bar with
/// round ends.
#[test]
fn lines_and_points_have_their_size_on_the_slice() {
    let draw = |a: DVec3, b: DVec3, width: f64| {
        let buffer = VertexBuffer::new([a, b].map(|p| ColouredVertex::new(p, [255; 3])).to_vec()).expect("finite");
        let mut context = DrawContext::default();
        context.line_width = width;
        context.draw(&buffer, 0..2, Topology::Lines).expect("valid");
        let frame =
            both(&swept(SliceClip::ShaderPlanes, ORTHOGRAPHIC), &context.present(), &half(VolumeConfig::plain()));
        lit_of(&frame) as f64
    };
    let disc = std::f64::consts::PI * 100.0;
    let dot = draw(DVec3::new(100.0, 7.0, -30.0), DVec3::new(100.0, 7.0, 30.0), 20.0);
    // The disc is a polygon of twelve corners: 3 / pi of its area, and its rim is off by part of a pixel.
    assert!((dot - disc * 3.0 / std::f64::consts::PI).abs() < 20.0, "{dot}");
    let bar = draw(DVec3::new(100.0, 7.0, 0.0), DVec3::new(200.0, 7.0, 0.0), 20.0);
    assert!((bar - 2_000.0 - disc * 3.0 / std::f64::consts::PI).abs() < 40.0, "{bar}");
    let buffer = VertexBuffer::new(vec![ColouredVertex::new(DVec3::new(100.2, 7.3, 0.0), [255; 3])]).expect("finite");
    let mut context = DrawContext::default();
    context.point_size = 9.0;
    context.draw(&buffer, 0..1, Topology::Points).expect("valid");
    let frame = both(&swept(SliceClip::Hyperbolic(0.25), ORTHOGRAPHIC), &context.present(), &VolumeConfig::plain());
    assert_eq!(lit_of(&frame), 81);
}

#[test]
fn strips_and_fans_give_the_triangles_of_opengl() {
    let corners: Vec<ColouredVertex> =
        (0..5).map(|i| ColouredVertex::new(DVec3::new(f64::from(i), 0.0, 0.0), [255; 3])).collect();
    let buffer = VertexBuffer::new(corners).expect("finite");
    let firsts = |topology| {
        let mut context = DrawContext::default();
        context.draw(&buffer, 0..5, topology).expect("valid");
        let commands = context.present();
        let triangles =
            commands.triangles().map(|triangle| triangle.map(|corner| corner[0] as i32)).collect::<Vec<_>>();
        (commands.primitives(), triangles)
    };
    assert_eq!(firsts(Topology::Triangles), (1, vec![[0, 1, 2]]));
    assert_eq!(firsts(Topology::TriangleStrip), (3, vec![[0, 1, 2], [1, 2, 3], [2, 3, 4]]));
    assert_eq!(firsts(Topology::TriangleFan), (3, vec![[0, 1, 2], [0, 2, 3], [0, 3, 4]]));
    assert_eq!(firsts(Topology::LineStrip).0, 4);
    assert_eq!(firsts(Topology::Lines).0, 2);
    assert_eq!(firsts(Topology::Points).0, 5);
}

#[test]
fn impossible_settings_of_a_display_are_refused_by_name() {
    let valid = SweptConfig::perspecta(SliceClip::Hyperbolic(0.25), ORTHOGRAPHIC);
    let clip = |clip| SweptConfig { clip, ..valid };
    let at = |distance| SweptConfig {
        projection: Projection::Perspective { eye: [0.0; 2], distance, shear: [0.0; 2] },
        ..valid
    };
    let cases = [
        (SweptConfig { slices: 395, ..valid }, "display.slices: expected an even number, found 395"),
        (SweptConfig { slices: 2, ..valid }, "display.slices: expected 4 to 65536, found 2"),
        (SweptConfig { width: 100, ..valid }, "display.width: expected a multiple of 8, found 100"),
        (SweptConfig { height: 0, ..valid }, "display.height: expected 1 to 4096, found 0"),
        (SweptConfig { phase: f64::NAN, ..valid }, "display.phase: expected a finite angle, found NaN"),
        (clip(SliceClip::Parallel(-0.5)), "clip.offset_px: expected 0 to 384, found -0.5"),
        (clip(SliceClip::Hyperbolic(-1.0)), "clip.bias_px2: expected 0 to 147456, found -1"),
        (clip(SliceClip::Tapered(3.1)), "clip.offset_px: expected 0 to 3.046"),
        (at(3.0), "jitter.eye_distance: expected more than 3.087"),
        (at(f64::INFINITY), "jitter.eye_distance"),
    ];
    for (config, expected) in cases {
        let error = SweptDisplay::new(config).expect_err(expected).to_string();
        assert!(error.starts_with(expected), "{error}, not {expected}");
    }
    let display = swept(SliceClip::Prism, ORTHOGRAPHIC);
    for (tiling, expected) in [
        (Tiling { tile: Some(12), batch: 4 }, "tile.size: expected a multiple of 8, found 12"),
        (Tiling { tile: Some(32), batch: 0 }, "tile.batch: expected 1 or more, found 0"),
    ] {
        let config = VolumeConfig { tiling, ..VolumeConfig::paper() };
        let error = render_volume(&display, &CommandBuffer::default(), &config, &HostRenderer, &OneThread);
        assert_eq!(error.expect_err(expected).to_string(), expected);
    }
    assert_eq!(Halftone::bayer(3).expect_err("3").to_string(), "halftone.matrix: expected 2, 4, 8 or 16, found 3");
    assert!(FlatDisplay::new([63, 64], DMat4::IDENTITY, DMat4::IDENTITY).is_err());
}

#[test]
fn invalid_vertices_and_indices_are_refused_by_name() {
    let bad =
        vec![ColouredVertex::new(DVec3::ONE, [0; 3]), ColouredVertex::new(DVec3::new(0.0, f64::NAN, 1.0), [0; 3])];
    let error = VertexBuffer::new(bad).expect_err("not finite").to_string();
    assert!(error.starts_with("vertex 1: expected a finite position, found"), "{error}");
    let buffer = VertexBuffer::new(vec![ColouredVertex::new(DVec3::ONE, [0; 3]); 3]).expect("finite");
    let mut context = DrawContext::default();
    let error = context.draw_indexed(&buffer, &[0, 1, 3], Topology::Triangles).expect_err("3 of 3");
    assert_eq!(error.to_string(), "index 2: expected below 3, found 3");
    let error = context.draw(&buffer, 1..4, Topology::Triangles).expect_err("beyond");
    assert_eq!(error.to_string(), "vertices 1..4: expected a range within 0..3");
    context.line_width = 0.0;
    assert!(context.draw(&buffer, 0..3, Topology::Lines).is_err());
    context.model_view = DMat4::from_cols_array(&[f64::INFINITY; 16]);
    assert!(context.draw(&buffer, 0..3, Topology::Triangles).is_err());
    assert_eq!(context.present().primitives(), 0);
}
