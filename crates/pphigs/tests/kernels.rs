//! The triangle kernels against the native transform and set-up, word for word.

mod kernel;

use i860::Config;
use kernel::{Bench, frame, native, triangles};
use pxpl5_geometry::kernel::{Kernel, KernelSurface, Schedule};
use pxpl5_geometry::{Triangle, Viewport};
use pxpl5_wire::FieldParity;

/// Small, middling and large triangles, among them ones outside the guard band.
fn mixture() -> Vec<Triangle> {
    let mut all = triangles(3000, 0.12, 1);
    all.extend(triangles(1500, 0.8, 2));
    all.extend(triangles(1500, 6.0, 3));
    all
}

fn assert_same_words(schedule: Schedule, surface: KernelSurface, viewport: Viewport) {
    let input = mixture();
    let (expected, flattened) = native(surface, viewport, &input);
    assert_eq!(flattened, 0, "the kernels do not flatten planes");
    let kernel = Kernel::for_picture(schedule, surface, &viewport, true).expect("frames and fields have kernels");
    let mut bench = Bench::new(kernel, viewport, Config::functional(), &input);
    bench.run();
    let found = bench.output();
    assert_eq!(found.clipped, expected.clipped);
    assert!(!expected.clipped.is_empty() && expected.commands.len() > 3900, "{}", expected.commands.len());
    assert_eq!(found.commands.len(), expected.commands.len());
    for (n, (f, e)) in found.commands.iter().zip(&expected.commands).enumerate() {
        assert_eq!(f, e, "command {n} of {kernel:?}");
        assert_eq!(found.regions[n], expected.regions[n], "regions of command {n} of {kernel:?}");
    }
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
fn the_dual_kernel_gives_the_native_words_and_bins() {
    for surface in [KernelSurface::Gouraud, KernelSurface::Phong] {
        PICTURES.into_iter().for_each(|picture| assert_same_words(Schedule::Dual, surface, picture));
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
