//! Compares the pipeline with an exact oracle on hard cases and writes docs/numerics.md.
//!
//! `cargo run -p pxpl5-geometry --release --example numerics`

#[path = "../tests/support/mod.rs"]
mod support;

fn main() {
    for case in support::cases::all() {
        if case.name.contains("origin") {
            let row = support::measure::measure(&case);
            println!("{} {:?}", case.name, row);
        }
    }
    for f in support::fighting::all() {
        println!("{f:?}");
    }
    for f in support::spheres::all() {
        let t = std::time::Instant::now();
        println!("{} {:?} {:?}", f.name, support::spheres::measure(&f), t.elapsed());
    }
}
