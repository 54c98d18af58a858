//! Compares the pipeline with exact geometry on hard cases, and writes docs/numerics.md.
//!
//! `cargo run -p pxpl5-geometry --release --example numerics`

#[path = "../tests/support/mod.rs"]
mod support;

use std::path::Path;

fn main() -> std::io::Result<()> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/numerics.md");
    std::fs::write(&path, support::report::text(&support::report::Measured::all()))?;
    println!("wrote {}", path.display());
    Ok(())
}
