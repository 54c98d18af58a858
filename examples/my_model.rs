//! Runs a model of your own on a machine of your own, with two pipelines, and prints latencies and pixels. The Python
//! version is my_model.py.
//!
//! `cargo run --release --example my_model [MODEL]`

use pxpl5::scene::{self, Format};
use pxpl5::{ExperimentFile, Eye, Measured, Parameter, picture};
use std::error::Error;
use std::sync::Arc;

/// A pyramid in the format of a model file.
const PYRAMID: &str =
    "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nv 0 1.5 0\nf 1 5 2\nf 2 5 3\nf 3 5 4\nf 4 5 1\nf 1 2 3\nf 1 3 4\n";

/// The machine of the papers with more graphics processors and faster code.
const MACHINE: &str = "[machine]\npreset = \"small-hmd\"\nn_gps = 20\ngp.triangle_ns = 18_000\n";

fn main() -> Result<(), Box<dyn Error>> {
    // The model is a file (PLY, OBJ or PDB), or the pyramid in memory.
    let model = match std::env::args().nth(1) {
        Some(path) => scene::load(path)?,
        None => scene::from_bytes(PYRAMID.as_bytes(), Format::Obj, "pyramid")?,
    };
    let model = Arc::new(model);
    for pipeline in ["rendering-control", "slats"] {
        // The settings have the format of an experiment file. The model replaces the scene in the settings.
        let settings = format!("pipeline = \"{pipeline}\"\nscene = \"mig\"\nfields = 80\n{MACHINE}");
        let plan = ExperimentFile::parse(&settings, "settings")?.resolve()?;
        for warning in plan.out_of_range().iter().map(Parameter::warning) {
            println!("warning: {warning}");
        }
        let outcome = plan.experiment(Arc::clone(&model)).run()?;
        let latency = outcome.latency_ms();
        let rate = outcome.report().updates_hz.unwrap_or_default();
        println!("{pipeline}: {:.1} ms (sd {:.1}, n {}), {rate:.1} Hz", latency.mean, latency.sd, latency.n);
        let seen = picture(&outcome, Eye::Left).ok_or("nothing was shown")?;
        let background = *seen.get_pixel(0, 0);
        let of_model = seen.pixels().filter(|pixel| **pixel != background).count();
        println!("  {of_model} pixels of the model, trace {}", outcome.report().trace_hash);
    }
    Ok(())
}
