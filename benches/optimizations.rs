//! Measures the effect of each optimization: the same run with the optimization enabled and disabled, in one process.
//! The results are equal (`tests/optimizations.rs`).
//!
//! Also measures the cost of reading pictures: without pixels, with one of 60 fields read, and with all pixels. The
//! goal is that reading one of 60 fields takes at most 10 % longer than no pixels.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pxpl5::{
    Experiment, Level, MachineConfig, NtscDisplay, Optimization, PeriodNumber, Pixels, RenderingControl, Slats,
    Workstation, scene, scene::Scene,
};
use std::hint::black_box;

/// Returns the Mig with at most `triangles` of its 417 triangles.
fn mig(triangles: usize) -> Scene {
    scene::builtin("mig").and_then(|mig| mig.decimated(triangles)).expect("so many")
}

/// Returns the experiments. The aircraft leaves regions empty under both pipelines, and twelve of its triangles leave
/// nearly all empty.
fn experiments() -> [(&'static str, Experiment); 3] {
    [
        ("rendering-control-mig", Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), mig(417))),
        ("rendering-control-12", Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), mig(12))),
        ("slats-140", Experiment::new(MachineConfig::slats(), Slats::split(), mig(140))),
    ]
}

/// Returns a number of fields that is large enough to show a picture and small enough for the slowest run.
const fn fields(optimization: Optimization) -> u64 {
    if matches!(optimization, Optimization::IdleBoards) { 2 } else { 20 }
}

/// Measures every optimization. The throughput counts fields.
fn optimizations(criterion: &mut Criterion) {
    for (name, experiment) in experiments() {
        for optimization in Optimization::ALL {
            let pixels = if optimization == Optimization::EmptyRegions { Pixels::All } else { Pixels::Off };
            let level = if optimization == Optimization::RepeatedCode { Level::Cycle } else { Level::Transaction };
            let with = experiment.clone().pixels(pixels).level(level).host(Workstation::with_threads(1));
            let mut group = criterion.benchmark_group(format!("optimizations/{name}/{optimization}"));
            group.throughput(Throughput::Elements(fields(optimization)));
            for (way, experiment) in [("with", with.clone()), ("without", with.without(optimization))] {
                group.bench_function(BenchmarkId::from_parameter(way), |b| {
                    b.iter(|| run(&experiment, fields(optimization)))
                });
            }
            group.finish();
        }
    }
}

fn run(experiment: &Experiment, fields: u64) -> u64 {
    let mut machine = experiment.build().expect("the presets are valid");
    let end = machine.record().tick(PeriodNumber(fields));
    machine.run_until(end).expect("it runs");
    black_box(machine.finish_pixels())
}

/// Runs an experiment. Reads the left eye's picture `looks` times at the end of every 60th field.
fn run_looking(experiment: &Experiment, fields: u64, looks: usize) -> u64 {
    let mut machine = experiment.build().expect("the preset is valid");
    for field in (60..=fields).step_by(60) {
        let end = machine.record().tick(PeriodNumber(field));
        machine.run_until(end).expect("it runs");
        for _ in 0..looks {
            let display = machine.record().display_of_kind::<NtscDisplay>().expect("the papers' machine");
            black_box(display.boards()[0].last_seen().map(|seen| seen.picture()));
        }
    }
    black_box(machine.finish_pixels())
}

/// Measures the scene `head` of 59,592 triangles in stereo. The throughput counts fields.
fn looking(criterion: &mut Criterion) {
    const FIELDS: u64 = 120;
    let head = scene::builtin("head").expect("built in");
    let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), head)
        .host(Workstation::with_threads(1));
    let mut group = criterion.benchmark_group("optimizations/rendering-control-head");
    group.throughput(Throughput::Elements(FIELDS));
    let looks = [
        ("none", Pixels::Off, 0),
        ("none, lazily", Pixels::Lazy, 0),
        ("one field of 60", Pixels::Lazy, 1),
        ("all", Pixels::All, 0),
    ];
    for (name, pixels, looks) in looks {
        let experiment = experiment.clone().pixels(pixels);
        group.bench_function(BenchmarkId::new("looked at", name), |b| {
            b.iter(|| run_looking(&experiment, FIELDS, looks))
        });
    }
    group.finish();
}

fn quick() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(2))
}

criterion_group! { name = benches; config = quick(); targets = optimizations, looking }
criterion_main!(benches);
