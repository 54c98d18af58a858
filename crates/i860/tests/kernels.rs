//! The triangle kernels against the native transform and set-up, word for word.

mod kernel;

use i860::Config;
use kernel::{Bench, Kernel, native, triangles};
use pxpl5_geometry::Triangle;

/// Small, middling and large triangles, among them ones outside the guard band.
fn mixture() -> Vec<Triangle> {
    let mut all = triangles(3000, 0.12, 1);
    all.extend(triangles(1500, 0.8, 2));
    all.extend(triangles(500, 6.0, 3));
    all
}

fn assert_same_words(kernel: Kernel) {
    let input = mixture();
    let (expected, flattened) = native(&input);
    assert_eq!(flattened, 0, "the kernels do not flatten planes");
    let mut bench = Bench::new(kernel, Config::functional(), &input);
    bench.run();
    let found = bench.output();
    assert_eq!(found.clipped, expected.clipped);
    assert!(!expected.clipped.is_empty() && expected.commands.len() > 4000);
    assert_eq!(found.commands.len(), expected.commands.len());
    for (n, (f, e)) in found.commands.iter().zip(&expected.commands).enumerate() {
        assert_eq!(f, e, "command {n}");
    }
    assert_eq!(found.regions, expected.regions);
}

#[test]
fn the_straight_kernel_gives_the_native_words_and_bins() {
    assert_same_words(Kernel::Straight);
}

#[test]
fn the_dual_kernel_gives_the_native_words_and_bins() {
    assert_same_words(Kernel::Dual);
}

#[test]
fn each_pass_of_the_dual_kernel_fits_the_instruction_cache() {
    let program = kernel::program(Kernel::Dual);
    let at = |label: &str| program.symbol(label).expect("label");
    let end = program.base + program.bytes.len() as u32;
    let (first, second) = (at("second") - at("batch"), end - at("second"));
    assert!(first <= 4096 && second <= 4096, "{first} and {second} bytes");
}

#[test]
fn the_straight_kernel_is_larger_than_the_instruction_cache() {
    let program = kernel::program(Kernel::Straight);
    assert!(program.symbol("bins").expect("label") - program.base > 4096);
}
