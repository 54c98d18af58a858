//! What each saving is worth: the same run with it and without it, in one process. Neither changes what comes out
//! (`tests/savings.rs`). What nobody looks at is measured by `machine` (no pixels against all), lazily drawn fields by
//! `machine/looked-at`.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pxpl5::levels::Level;
use pxpl5::{Experiment, MachineConfig, Pixels, RenderingControl, Saving, Slats, scene};
use std::hint::black_box;

/// The aircraft leaves regions empty under both pipelines.
fn experiments() -> [(&'static str, Experiment); 2] {
    let mig = |triangles| scene::builtin("mig").and_then(|mig| mig.truncated(triangles)).expect("it has 417 triangles");
    [
        ("rendering-control-mig", Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), mig(417))),
        ("slats-140", Experiment::new(MachineConfig::slats(), Slats::split(), mig(140))),
    ]
}

/// Fields long enough to show something, short enough for the slowest way.
const fn fields(saving: Saving) -> u64 {
    if matches!(saving, Saving::IdleBoards) { 2 } else { 20 }
}

/// An element is a field.
fn savings(criterion: &mut Criterion) {
    for (name, experiment) in experiments() {
        for saving in Saving::ALL {
            let pixels = if saving == Saving::EmptyRegions { Pixels::All } else { Pixels::Off };
            let level = if saving == Saving::RepeatedCode { Level::Cycle } else { Level::Transaction };
            let with = experiment.clone().pixels(pixels).level(level).threads(1);
            let mut group = criterion.benchmark_group(format!("savings/{name}/{saving}"));
            group.throughput(Throughput::Elements(fields(saving)));
            for (way, experiment) in [("with", with.clone()), ("without", with.without(saving))] {
                let run = || {
                    let mut machine = experiment.build().expect("the presets are valid");
                    let end = machine.video().retrace(fields(saving));
                    machine.run_until(end).expect("it runs");
                    black_box(machine.finish_pixels())
                };
                group.bench_function(BenchmarkId::from_parameter(way), |b| b.iter(run));
            }
            group.finish();
        }
    }
}

fn quick() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(2))
}

criterion_group! { name = benches; config = quick(); targets = savings }
criterion_main!(benches);
