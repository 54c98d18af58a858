//! Benchmarks of whole machines in host time, without pixels and with all pixels.
//!
//! Goals: Slats with 140 triangles runs 3,000 fields/s without pixels and 600 fields/s with all pixels. Rendering
//! Control with the scene `head` takes 10 ms per stereo pair without pixels and 20 ms with all pixels. An idle machine
//! runs 100,000 fields/s. Slats at the cycle level runs 3 fields/s.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pxpl5::{
    Experiment, Level, Machine, MachineConfig, Outcome, PeriodNumber, Pipeline, PipelineProperties, Pixels,
    RenderingControl, Slats, Workstation, scene,
};
use std::hint::black_box;

/// Choices of pixels, each with the number of threads that compute pixels in addition to the simulating thread.
const PIXELS: [(&str, Pixels, usize); 3] =
    [("no pixels", Pixels::Off, 0), ("all pixels", Pixels::All, 0), ("all pixels, a second thread", Pixels::All, 1)];

fn run(experiment: &Experiment, pixels: Pixels, threads: usize) -> Outcome {
    experiment.clone().pixels(pixels).host(Workstation::with_threads(threads)).run().expect("the preset runs")
}

/// Measures Slats with 140 triangles. The throughput counts fields.
fn slats_140(criterion: &mut Criterion) {
    const FIELDS: u64 = 120;
    let aircraft = scene::builtin("mig").and_then(|mig| mig.decimated(140)).expect("it has 417 triangles");
    let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), aircraft).fields(FIELDS);
    let mut group = criterion.benchmark_group("machine/slats-140");
    group.throughput(Throughput::Elements(FIELDS));
    for (name, pixels, threads) in PIXELS {
        group.bench_function(BenchmarkId::from_parameter(name), |b| b.iter(|| run(&experiment, pixels, threads)));
    }
    group.finish();
}

/// Measures Slats at the cycle level with 110 triangles, the largest load that is drawn in every field. The throughput
/// counts fields. The goal is 3 fields a second, a twentieth of real time.
fn slats_110_cycle(criterion: &mut Criterion) {
    const FIELDS: u64 = 24;
    let aircraft = scene::builtin("mig").and_then(|mig| mig.decimated(110)).expect("it has 417 triangles");
    let machine = MachineConfig::preset("slats-optimised").expect("listed");
    let experiment = Experiment::new(machine, Slats::split(), aircraft).fields(FIELDS).level(Level::Cycle);
    let mut group = criterion.benchmark_group("machine/slats-110");
    group.throughput(Throughput::Elements(FIELDS));
    group.bench_function("cycle level, no pixels", |b| b.iter(|| run(&experiment, Pixels::Off, 0)));
    group.finish();
}

/// Measures Rendering Control. The throughput counts stereo pairs that were shown. The run is long, because three pairs
/// in progress at its end are additional work.
fn rendering_control_head(criterion: &mut Criterion) {
    let head = scene::builtin("head").expect("built in");
    let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), head).fields(960);
    let pairs = run(&experiment, Pixels::Off, 0).pictures().len() as u64;
    let mut group = criterion.benchmark_group("machine/rendering-control-head");
    group.throughput(Throughput::Elements(pairs));
    for (name, pixels, threads) in PIXELS {
        group.bench_function(BenchmarkId::from_parameter(name), |b| b.iter(|| run(&experiment, pixels, threads)));
    }
    group.finish();
}

/// Measures a machine without programs, which handles retraces only. The throughput counts fields.
fn idle(criterion: &mut Criterion) {
    const FIELDS: u64 = 1_000;
    let pipeline = RenderingControl::stereo();
    let mut group = criterion.benchmark_group("machine");
    group.throughput(Throughput::Elements(FIELDS));
    group.bench_function("idle", |b| {
        b.iter(|| {
            let PipelineProperties { eyes, layout, .. } = pipeline.properties();
            let machine = Machine::new(&MachineConfig::small_hmd(), eyes, layout);
            let mut machine = machine.expect("the preset is valid");
            machine.switch_on();
            let end = machine.record().tick(PeriodNumber(FIELDS));
            machine.run_until(end).expect("nothing can fail");
            black_box(machine.events())
        });
    });
    group.finish();
}

fn quick() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(std::time::Duration::from_millis(500))
        .measurement_time(std::time::Duration::from_secs(3))
}

criterion_group! { name = machine; config = quick(); targets = slats_140, slats_110_cycle, rendering_control_head, idle }
criterion_main!(machine);
