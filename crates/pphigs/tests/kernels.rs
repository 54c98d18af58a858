//! Tests of the triangle kernels against the native transform and set-up, word for word.

use crate::kernel::{self, Bench, Output, Strip, frame, native, strips, triangles, triangles_of};
use glam::{Mat4, Vec3, Vec4};
use i860::Config;
use pxpl5_geometry::kernel::{Kernel, KernelList, KernelPicture, KernelSurface, Schedule};
use pxpl5_geometry::{Triangle, ViewTransform, Viewport};
use pxpl5_sim::SplitMix64;
use pxpl5_wire::{FieldParity, Lines, REGION_SIZE, RegionGrid};

/// Returns small, medium and large triangles, some of them outside the guard band.
fn mixture() -> Vec<Triangle> {
    let mut all = triangles(3000, 0.12, 1);
    all.extend(triangles(1500, 0.8, 2));
    all.extend(triangles(1500, 6.0, 3));
    all
}

/// Returns triangles with corners near the near and far planes. At these planes, rounding decides whether a triangle is
/// clipped. A depth can even be beyond the far plane.
fn at_the_planes() -> Vec<Triangle> {
    let from_eye = kernel::view().model_view.inverse();
    let depths = [0.5, 0.500_000_1, 0.500_01, 40.0, 39.999_996, 39.999_9, 40.000_1];
    let mut all = triangles(490, 0.5, 4);
    for (n, triangle) in all.iter_mut().enumerate() {
        let distance = depths[n % depths.len()];
        let at = n as f32 / 490.0 - 0.5;
        let eye = Vec3::new(at * distance * 0.5, at * distance * 0.3, -distance);
        triangle.positions[n % 3] = from_eye.transform_point3(eye);
    }
    all
}

fn assert_same_words(schedule: Schedule, surface: KernelSurface, viewport: Viewport) {
    assert_same_words_of(&mixture(), schedule, surface, viewport);
    assert_same_words_of(&at_the_planes(), schedule, surface, viewport);
}

fn assert_same_words_of(input: &[Triangle], schedule: Schedule, surface: KernelSurface, viewport: Viewport) {
    let kernel = Kernel::for_picture(schedule, surface, &viewport, true).expect("frames and fields have kernels");
    let (expected, stats) = native(kernel, &kernel::view(), viewport, input);
    assert!(stats.clipped > 0 && 3 * expected.commands.len() > input.len(), "{stats:?}");
    let mut bench = Bench::new(kernel, viewport, Config::functional(), input);
    bench.run();
    assert_same_output(&bench.output(), &expected, kernel);
}

fn assert_same_output(found: &Output, expected: &Output, kernel: Kernel) {
    for (n, (f, e)) in found.commands.iter().zip(&expected.commands).enumerate() {
        assert_eq!(f, e, "command {n} of {kernel:?}");
        assert_eq!(found.regions[n], expected.regions[n], "regions of command {n} of {kernel:?}");
    }
    assert_eq!(found.commands.len(), expected.commands.len());
}

/// Returns small to large strips of 1 to 100 triangles. Some strips are longer than a batch, and one strip is close to
/// the near and far planes.
fn strips_of_all_sizes() -> Vec<Strip> {
    let lengths: Vec<usize> = (1..60).chain([1, 2, 74, 75, 76, 77, 78, 79, 151, 152, 153, 400]).collect();
    [0.12, 0.8, 6.0].into_iter().zip(5..).flat_map(|(size, seed)| strips(&lengths, size, seed)).collect()
}

fn assert_same_words_of_strips(schedule: Schedule, surface: KernelSurface, viewport: Viewport) {
    let input = strips_of_all_sizes();
    let alone = triangles_of(&input);
    let kernel = Kernel::for_picture(schedule, surface, &viewport, true).expect("frames and fields have kernels");
    let kernel = Kernel { list: KernelList::Strips, ..kernel };
    let (expected, stats) = native(kernel, &kernel::view(), viewport, &alone);
    assert!(stats.clipped > 0 && 2 * expected.commands.len() > alone.len(), "{stats:?}");
    let mut bench = Bench::of_strips(kernel, viewport, Config::functional(), &input);
    bench.run();
    assert_same_output(&bench.output(), &expected, kernel);
}

const SURFACES: [KernelSurface; 3] = [KernelSurface::Gouraud, KernelSurface::Precomputed, KernelSurface::Phong];

const PICTURES: [Viewport; 3] =
    [Viewport::FRAME, Viewport::field(FieldParity::Even), Viewport::field(FieldParity::Odd)];

#[test]
fn the_kernel_of_every_schedule_writes_the_native_words_and_bins() {
    for schedule in [Schedule::Straight, Schedule::Compiled, Schedule::Dual] {
        for surface in SURFACES {
            PICTURES.into_iter().for_each(|picture| assert_same_words(schedule, surface, picture));
        }
    }
}

#[test]
fn the_kernels_of_strips_write_the_native_words_and_bins() {
    for schedule in [Schedule::Straight, Schedule::Compiled, Schedule::Dual] {
        for surface in SURFACES {
            PICTURES.into_iter().for_each(|picture| assert_same_words_of_strips(schedule, surface, picture));
        }
    }
}

/// About half of the triangles are back faces, including some pieces of clipped triangles.
#[test]
fn kernels_that_cull_write_the_native_words_and_bins() {
    let input = mixture();
    for schedule in [Schedule::Straight, Schedule::Compiled, Schedule::Dual] {
        for surface in SURFACES {
            for viewport in PICTURES {
                let all = Kernel::for_picture(schedule, surface, &viewport, true).expect("frames and fields");
                let kernel = Kernel { culls: true, ..all };
                let [expected, all] = [kernel, all].map(|kernel| native(kernel, &kernel::view(), viewport, &input).0);
                let share = expected.commands.len() as f64 / all.commands.len() as f64;
                assert!((0.4..0.6).contains(&share), "{share}");
                let mut bench = Bench::new(kernel, viewport, Config::functional(), &input);
                bench.run();
                assert_same_output(&bench.output(), &expected, kernel);
            }
        }
    }
}

/// Returns triangles all around the eye, under mirroring and other matrices. Some triangles are far outside the
/// picture, and some cross several planes.
///
/// Some have a corner on a plane of the guard band, as exactly as single precision permits.
fn around_the_eye(seed: u64, mirrored: bool, viewport: Viewport) -> (ViewTransform, Vec<Triangle>) {
    let mut all = triangles(1000, 1.0, seed);
    let mut numbers = SplitMix64::new(seed);
    let mut view = kernel::view();
    if mirrored {
        view.model_view *= Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0));
    }
    let to_world = (view.projection * view.model_view).inverse();
    for (n, triangle) in all.iter_mut().enumerate() {
        // The sizes cover four powers of ten. Most triangles are in front of the eye.
        let eye = view.model_view.inverse().transform_point3(Vec3::ZERO);
        let ahead = view.model_view.inverse().transform_vector3(Vec3::new(numbers.unit() - 0.5, 0.0, -1.0));
        let size = 10.0_f32.powf(4.0 * numbers.unit() - 1.0);
        let centre = eye + ahead * numbers.unit() * 30.0;
        triangle.positions = triangle.positions.map(|p| centre + (p - triangle.positions[0] * 0.5) * size);
        if n % 3 == 0 {
            // The corner is 4,095 px from the middle of pixel 0, in each direction of the picture.
            let w = 0.5 + 30.0 * numbers.unit();
            let [width, height] = [viewport.grid().width, viewport.frame_lines()].map(|size| size as f32 / 2.0);
            let [x, y] = [(4095.0 - width) / width, (4095.0 - height) / height];
            let sign = if numbers.unit() < 0.5 { -1.0 } else { 1.0 };
            let [cx, cy] = if numbers.unit() < 0.5 { [sign * x, 0.3] } else { [0.3, sign * y] };
            let nudge = 1.0 + (numbers.unit() - 0.5) * 1e-6;
            let clip = Vec4::new(cx * w * nudge, cy * w * nudge, 0.9 * w, w);
            let world = to_world * clip;
            triangle.positions[n / 3 % 3] = world.truncate() / world.w;
        }
        if n % 4 == 1 {
            // Triangles that are seen nearly edge-on are slivers with steep planes.
            let [a, b, _] = triangle.positions.map(|p| p - eye);
            triangle.positions[2] = eye + a * (2.0 * numbers.unit() - 0.5) + b * numbers.unit();
        }
    }
    // The kernels do not flatten steep planes of unclipped triangles.
    let kernel = frame(Schedule::Dual);
    all.retain(|triangle| {
        let (_, stats) = native(kernel, &view, viewport, std::slice::from_ref(triangle));
        stats.clipped > 0 || stats.flattened_planes == 0
    });
    (view, all)
}

#[test]
fn the_clipper_writes_the_native_words_and_bins_of_triangles_all_around_the_eye() {
    let mut flattened = 0;
    for (seed, schedule) in (20..).zip([Schedule::Straight, Schedule::Compiled, Schedule::Dual]) {
        for mirrored in [false, true] {
            let (view, input) = around_the_eye(seed, mirrored, Viewport::FRAME);
            for surface in SURFACES {
                for (viewport, culls) in PICTURES.into_iter().flat_map(|picture| [(picture, false), (picture, true)]) {
                    let kernel = Kernel::for_picture(schedule, surface, &viewport, true).expect("frames and fields");
                    let kernel = Kernel { culls, ..kernel };
                    let (expected, stats) = native(kernel, &view, viewport, &input);
                    assert!(stats.clipped > 200 && stats.outside > 100 && stats.screen_triangles > 100, "{stats:?}");
                    flattened += stats.flattened_planes;
                    let mut bench = Bench::in_eye_space(kernel, &view, viewport, &input);
                    bench.run();
                    assert_same_output(&bench.output(), &expected, kernel);
                }
            }
        }
    }
    assert!(flattened > 0, "steep planes are among them");
}

/// Returns two eyes with some distance between them, and with equal or slightly different view directions.
fn two_eyes(left: &ViewTransform, parallel: bool) -> [ViewTransform; 2] {
    let mut model_view = left.model_view;
    if parallel {
        model_view.w_axis.x -= 0.4;
    } else {
        model_view = Mat4::from_translation(Vec3::new(-0.4, 0.01, 0.0)) * Mat4::from_rotation_y(0.04) * model_view;
    }
    [*left, ViewTransform { model_view, projection: left.projection }]
}

fn assert_same_words_for_both_eyes(kernel: Kernel, views: &[ViewTransform; 2], viewport: Viewport, input: &[Triangle]) {
    let mut bench = Bench::for_both_eyes(kernel, views, viewport, Config::functional(), input);
    bench.run();
    let made = bench.commands_of_both();
    for (eye, (found, view)) in made.iter().zip(views).enumerate() {
        let expected = native(kernel, view, viewport, input).0.commands;
        for (n, (found, expected)) in found.iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "command {n} of eye {eye}, {kernel:?}");
        }
        assert_eq!(found.len(), expected.len(), "eye {eye}, {kernel:?}");
    }
}

/// In this test each eye has a single bin for all regions. The kernels for both eyes also make commands for triangles
/// that touch no region. The native code leaves out such triangles. The test therefore uses only triangles that touch a
/// region.
#[test]
fn the_kernels_of_both_eyes_write_the_native_words_of_each_eye() {
    for viewport in &PICTURES[1..] {
        for schedule in [Schedule::Compiled, Schedule::Dual] {
            let kernel = Kernel::for_picture(schedule, KernelSurface::Precomputed, viewport, false)
                .expect("fields have kernels");
            assert!(kernel.can_serve_both_eyes());
            for seed in [20, 21] {
                let (view, around) = around_the_eye(seed, seed == 21, *viewport);
                let input = [mixture(), at_the_planes()].concat();
                for (view, input) in [(kernel::view(), input), (view, around)] {
                    for (culls, parallel) in [(false, true), (true, true), (false, false), (true, false)] {
                        let kernel = Kernel { culls, both_eyes: true, ..kernel };
                        let views = two_eyes(&view, parallel);
                        let seen = seen_by_both(kernel, &views, *viewport, &input);
                        assert!(seen.len() > 300, "{} of {}", seen.len(), input.len());
                        for count in [1, 25, 26, 27, 52, 53, seen.len()] {
                            assert_same_words_for_both_eyes(kernel, &views, *viewport, &seen[..count.min(seen.len())]);
                        }
                    }
                }
            }
        }
    }
}

/// Returns the triangles that have no piece outside the picture, for either eye.
fn seen_by_both(kernel: Kernel, views: &[ViewTransform; 2], viewport: Viewport, input: &[Triangle]) -> Vec<Triangle> {
    let is_seen = |triangle: &&Triangle| {
        views.iter().all(|view| {
            let (_, stats) = native(kernel, view, viewport, std::slice::from_ref(*triangle));
            // Only the clipper flattens steep planes.
            stats.untouched == 0 && (stats.flattened_planes == 0 || stats.clipped > 0)
        })
    };
    input.iter().filter(is_seen).copied().collect()
}

/// Returns frames that are not NTSC frames. The frames are faces of a cube with one region to 121 regions (the largest
/// number), and two frames with partial regions.
fn other_frames() -> impl Iterator<Item = Viewport> {
    let sizes = [(128, 128), (256, 256), (512, 512), (1408, 1408), (2048, 1024), (700, 500), (1280, 1000)];
    sizes.into_iter().map(|(width, height)| {
        let grid = RegionGrid { width, height, region_width: REGION_SIZE, region_height: REGION_SIZE };
        Viewport::new(grid, Lines::Frame).expect("at most 128 regions")
    })
}

/// Runs each frame size with three of the nine pairs of schedule and surface, so that each frame size has all schedules
/// and all surfaces. Seven frame sizes have all pairs. `PXPL5_ALL_CASES=1` runs all pairs for each frame size.
#[test]
fn the_kernels_of_other_frame_sizes_write_the_native_words_and_bins() {
    let all = std::env::var_os("PXPL5_ALL_CASES").is_some();
    for (n, viewport) in other_frames().enumerate() {
        for (s, schedule) in [Schedule::Straight, Schedule::Compiled, Schedule::Dual].into_iter().enumerate() {
            for (_, surface) in
                SURFACES.into_iter().enumerate().filter(|(place, _)| all || (n + s + place).is_multiple_of(3))
            {
                let kernel = Kernel::for_picture(schedule, surface, &viewport, true).expect("regions of 128 x 128");
                assert_eq!(kernel.picture, KernelPicture::Grid);
                assert_same_words(schedule, surface, viewport);
            }
        }
    }
}

#[test]
fn the_kernels_of_strips_of_other_frame_sizes_write_the_native_words_and_bins() {
    for viewport in other_frames() {
        assert_same_words_of_strips(Schedule::Compiled, KernelSurface::Gouraud, viewport);
        assert_same_words_of_strips(Schedule::Dual, KernelSurface::Phong, viewport);
    }
}

#[test]
fn the_clipper_writes_the_native_words_and_bins_of_other_frame_sizes() {
    let schedules = [Schedule::Straight, Schedule::Compiled, Schedule::Dual];
    for (n, (viewport, seed)) in other_frames().zip(40..).enumerate() {
        let (view, input) = around_the_eye(seed, n % 2 == 1, viewport);
        for surface in SURFACES {
            let kernel = Kernel::for_picture(schedules[n % 3], surface, &viewport, true).expect("it has one");
            for kernel in [kernel, Kernel { culls: true, ..kernel }] {
                let (expected, stats) = native(kernel, &view, viewport, &input);
                assert!(stats.clipped > 200 && stats.screen_triangles > 100, "{stats:?}");
                let mut bench = Bench::in_eye_space(kernel, &view, viewport, &input);
                bench.run();
                assert_same_output(&bench.output(), &expected, kernel);
            }
        }
    }
}

/// Tests fields of other sizes, regions of other sizes, and frames without bins.
#[test]
fn unsupported_pictures_have_no_kernel() {
    let kernel = |grid, lines, binned| {
        let viewport = Viewport::new(grid, lines).expect("a valid picture");
        Kernel::for_picture(Schedule::Compiled, KernelSurface::Phong, &viewport, binned)
    };
    let small = RegionGrid { width: 320, height: 240, ..RegionGrid::FRAME };
    assert!(kernel(small, Lines::Frame, true).is_some());
    assert_eq!(kernel(small, Lines::Frame, false), None);
    assert_eq!(kernel(small, Lines::Field(FieldParity::Even), true), None);
    assert_eq!(kernel(RegionGrid { region_width: 64, ..small }, Lines::Frame, true), None);
    assert_eq!(kernel(RegionGrid { region_height: 120, ..small }, Lines::Frame, true), None);
}

/// A triangle must draw nothing if a corner is NaN, or larger than clip coordinates can be.
#[test]
fn triangles_with_corners_that_cannot_be_represented_draw_nothing() {
    let mut input = triangles(30, 0.12, 1);
    for (n, value) in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 2e30, -3e38].into_iter().enumerate() {
        input[3 * n].positions[n % 3].x = value;
        input[3 * n + 1].positions[n % 3].z = value;
    }
    for schedule in [Schedule::Straight, Schedule::Compiled, Schedule::Dual] {
        let (expected, stats) = native(frame(schedule), &kernel::view(), Viewport::FRAME, &input);
        assert_eq!(stats.not_finite, 10);
        let mut bench = Bench::new(frame(schedule), Viewport::FRAME, Config::functional(), &input);
        bench.run();
        assert_same_output(&bench.output(), &expected, frame(schedule));
    }
}

#[test]
fn each_loop_of_the_dual_kernel_fits_the_instruction_cache() {
    use KernelPicture::{Field, Frame, Grid};
    use KernelSurface::{Gouraud, Phong};
    for (surface, picture) in [(Gouraud, Frame), (Phong, Field), (Gouraud, Grid), (Phong, Grid)] {
        let program = kernel::program(Kernel { surface, picture, ..frame(Schedule::Dual) });
        let [corners, again, finished] =
            ["corners", "again", "finished"].map(|label| program.symbol(label).expect("label"));
        let loops = [again - corners, finished - again];
        assert!(loops.iter().all(|bytes| *bytes <= 4096), "{loops:?} bytes");
    }
}

#[test]
fn the_straight_kernel_is_larger_than_the_instruction_cache() {
    let program = kernel::program(frame(Schedule::Straight));
    assert!(program.symbol("bins").expect("label") - program.symbol("start").expect("label") > 4096);
}

/// Independent triangles of about 30 pixels are streamed from memory, with all tests and bins. The second call is
/// measured, with warm caches.
#[test]
fn the_dual_kernel_takes_at_most_800_clocks_for_a_phong_triangle() {
    let input = triangles(1000, 0.12, 1);
    let kernel = Kernel { surface: KernelSurface::Phong, ..frame(Schedule::Dual) };
    let mut bench = Bench::new(kernel, Viewport::FRAME, Config::cycle(), &input);
    bench.run();
    bench.cpu.clear_profile();
    bench.run();
    let profile = bench.profile();
    assert!(profile.clocks() <= 800 * input.len() as u64, "{profile}");
}

/// The triangles of a strip share vertices, so there is about one vertex for each triangle.
#[test]
fn the_dual_kernel_takes_at_most_500_clocks_for_a_phong_triangle_of_a_strip() {
    let input = strips(&[1000], 0.12, 1);
    let kernel = Kernel { surface: KernelSurface::Phong, list: KernelList::Strips, ..frame(Schedule::Dual) };
    let mut bench = Bench::of_strips(kernel, Viewport::FRAME, Config::cycle(), &input);
    bench.run();
    bench.cpu.clear_profile();
    bench.run();
    let profile = bench.profile();
    assert!(profile.clocks() <= 500 * 1000, "{profile}");
}
