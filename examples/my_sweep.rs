//! Runs a sweep: latency as a function of the numbers of triangles and graphics processors, as a table. The Python
//! version is my_sweep.py.
//!
//! `cargo run --release --example my_sweep [FOLDER]`

use pxpl5::ExperimentFile;
use pxpl5::Study;
use pxpl5::sweep::{RunOptions, Shard, Store, Sweep, SweepQuery};
use std::error::Error;
use std::path::PathBuf;
use std::thread::available_parallelism;

const SPACE: &str = r#"
pipeline = "rendering-control"
scene = "typical:8000"
fields = 120
measure = ["latency_ms.mean", "latency_ms.sd", "updates_hz"]
[machine]
preset = "small-hmd"
[sweep]
seeds = 2
[sweep.grid]
triangles = [1000, 4000, 8000]
machine.n_gps = [4, 13]
"#;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("out/my_sweep"), PathBuf::from);
    let sweep = Sweep::new(ExperimentFile::parse(SPACE, "space")?)?;
    let header = sweep.header()?;
    for (name, definition) in &header.measure {
        println!("{name:>20}  {definition}");
    }
    // Finished points are kept. After an interruption, the same call continues the sweep.
    let mut store = Store::open(&folder, header, true)?;
    let threads = available_parallelism().map_or(1, usize::from);
    SweepQuery::new(&sweep, &mut store, RunOptions { shard: Shard::ALL, threads }).run(&mut ())?;
    for point in 0..sweep.space().points() {
        let row = store.row(point)?.ok_or("a point without a row")?;
        let setting = |key: &str| row.parameters[key].to_string();
        let measured = |key: &str| row.measured.get(key).copied().flatten().unwrap_or(f64::NAN);
        let settings = [setting("triangles"), setting("machine.n_gps"), setting("seed")].join(" ");
        println!("{settings} {:.1} ms {:.1} Hz", measured("latency_ms.mean"), measured("updates_hz"));
    }
    store.finish()?;
    Ok(())
}
