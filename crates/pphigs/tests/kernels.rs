//! The triangle kernels against the native transform and set-up, word for word.

mod kernel;

use glam::Vec3;
use i860::Config;
use kernel::{Bench, Output, Strip, frame, native, strips, triangles, triangles_of};
use pxpl5_geometry::kernel::{Kernel, KernelList, KernelSurface, Schedule};
use pxpl5_geometry::{Culling, Triangle, Viewport};
use pxpl5_wire::FieldParity;

/// Small, middling and large triangles, among them ones outside the guard band.
fn mixture() -> Vec<Triangle> {
    let mut all = triangles(3000, 0.12, 1);
    all.extend(triangles(1500, 0.8, 2));
    all.extend(triangles(1500, 6.0, 3));
    all
}

/// Triangles with corners about the near and the far plane, where rounding decides whether they are clipped, and where a
/// depth may come out beyond the far plane.
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
    let (expected, flattened) = native(surface, viewport, Culling::None, input);
    assert_eq!(flattened, 0, "the kernels do not flatten planes");
    let kernel = Kernel::for_picture(schedule, surface, &viewport, true).expect("frames and fields have kernels");
    let mut bench = Bench::new(kernel, viewport, Config::functional(), input);
    bench.run();
    let found = bench.output();
    assert!(!expected.clipped.is_empty() && 3 * expected.commands.len() > input.len(), "{}", expected.commands.len());
    assert_same_output(&found, &expected, kernel);
}

fn assert_same_output(found: &Output, expected: &Output, kernel: Kernel) {
    assert_eq!(found.clipped, expected.clipped);
    assert_eq!(found.commands.len(), expected.commands.len());
    for (n, (f, e)) in found.commands.iter().zip(&expected.commands).enumerate() {
        assert_eq!(f, e, "command {n} of {kernel:?}");
        assert_eq!(found.regions[n], expected.regions[n], "regions of command {n} of {kernel:?}");
    }
}

/// Strips of 1 to 100 triangles, some longer than a batch, small to large; and one about the near and the far plane.
fn strips_of_all_sizes() -> Vec<Strip> {
    let lengths: Vec<usize> = (1..60).chain([1, 2, 74, 75, 76, 77, 78, 79, 151, 152, 153, 400]).collect();
    [0.12, 0.8, 6.0].into_iter().zip(5..).flat_map(|(size, seed)| strips(&lengths, size, seed)).collect()
}

fn assert_same_words_of_strips(schedule: Schedule, surface: KernelSurface, viewport: Viewport) {
    let input = strips_of_all_sizes();
    let (alone, places) = triangles_of(&input);
    let (mut expected, flattened) = native(surface, viewport, Culling::None, &alone);
    assert_eq!(flattened, 0, "the kernels do not flatten planes");
    expected.clipped.iter_mut().for_each(|number| *number = places[*number]);
    assert!(!expected.clipped.is_empty() && 2 * expected.commands.len() > alone.len(), "{}", expected.commands.len());
    let kernel = Kernel::for_picture(schedule, surface, &viewport, true).expect("frames and fields have kernels");
    let kernel = Kernel { list: KernelList::Strips, ..kernel };
    let mut bench = Bench::of_strips(kernel, viewport, Config::functional(), &input);
    bench.run();
    assert_same_output(&bench.output(), &expected, kernel);
}

const PICTURES: [Viewport; 3] =
    [Viewport::FRAME, Viewport::field(FieldParity::Even), Viewport::field(FieldParity::Odd)];

#[test]
fn the_straight_kernel_gives_the_native_words_and_bins() {
    for surface in [KernelSurface::Gouraud, KernelSurface::Phong] {
        PICTURES.into_iter().for_each(|picture| assert_same_words(Schedule::Straight, surface, picture));
    }
}

#[test]
fn the_compiled_kernel_gives_the_native_words_and_bins() {
    for surface in [KernelSurface::Gouraud, KernelSurface::Phong] {
        PICTURES.into_iter().for_each(|picture| assert_same_words(Schedule::Compiled, surface, picture));
    }
}

#[test]
fn the_dual_kernel_gives_the_native_words_and_bins() {
    for surface in [KernelSurface::Gouraud, KernelSurface::Phong] {
        PICTURES.into_iter().for_each(|picture| assert_same_words(Schedule::Dual, surface, picture));
    }
}

#[test]
fn the_kernels_of_strips_give_the_native_words_and_bins() {
    for schedule in [Schedule::Straight, Schedule::Compiled, Schedule::Dual] {
        for surface in [KernelSurface::Gouraud, KernelSurface::Phong] {
            PICTURES.into_iter().for_each(|picture| assert_same_words_of_strips(schedule, surface, picture));
        }
    }
}

/// About half of the triangles face away; those that reach beyond the guard band are the clipper's, whichever way they face.
#[test]
fn kernels_that_cull_give_the_native_words_and_bins() {
    let input = mixture();
    for schedule in [Schedule::Straight, Schedule::Compiled, Schedule::Dual] {
        for surface in [KernelSurface::Gouraud, KernelSurface::Phong] {
            for viewport in PICTURES {
                let (expected, _) = native(surface, viewport, Culling::Back, &input);
                let (all, _) = native(surface, viewport, Culling::None, &input);
                let share = expected.commands.len() as f64 / all.commands.len() as f64;
                assert!((0.4..0.6).contains(&share), "{share}");
                let kernel = Kernel::for_picture(schedule, surface, &viewport, true).expect("frames and fields");
                let kernel = Kernel { culls: true, ..kernel };
                let mut bench = Bench::new(kernel, viewport, Config::functional(), &input);
                bench.run();
                assert_same_output(&bench.output(), &expected, kernel);
            }
        }
    }
}

#[test]
fn each_loop_of_the_dual_kernel_fits_the_instruction_cache() {
    for (surface, field) in [(KernelSurface::Gouraud, false), (KernelSurface::Phong, true)] {
        let program = kernel::program(Kernel { surface, field, ..frame(Schedule::Dual) });
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

/// Independent triangles of about 30 pixels streamed from memory, all tests and bins included; the second call, so that
/// the caches are as they always are.
#[test]
fn the_dual_kernel_takes_800_clocks_a_phong_triangle_at_most() {
    let input = triangles(1000, 0.12, 1);
    let kernel = Kernel { surface: KernelSurface::Phong, ..frame(Schedule::Dual) };
    let mut bench = Bench::new(kernel, Viewport::FRAME, Config::cycle(), &input);
    bench.run();
    bench.cpu.clear_profile();
    bench.run();
    let profile = bench.profile();
    assert!(profile.clocks() <= 800 * input.len() as u64, "{profile}");
}

/// The same for strips, which share vertices: one vertex a triangle.
#[test]
fn the_dual_kernel_takes_500_clocks_a_phong_triangle_of_a_strip_at_most() {
    let input = strips(&[1000], 0.12, 1);
    let kernel = Kernel { surface: KernelSurface::Phong, list: KernelList::Strips, ..frame(Schedule::Dual) };
    let mut bench = Bench::of_strips(kernel, Viewport::FRAME, Config::cycle(), &input);
    bench.run();
    bench.cpu.clear_profile();
    bench.run();
    let profile = bench.profile();
    assert!(profile.clocks() <= 500 * 1000, "{profile}");
}
