//! Compares the host time of a field in short and in long runs, in one process. The goal is a difference of at most 2
//! %. The throughput counts fields. The runs keep statistics only (`KeptRecords::Statistics`), as `pxpl5 run` without
//! `--out` does.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pxpl5::tracking::motion::Synthetic;
use pxpl5::tracking::predict::PredictorKind;
use pxpl5::tracking::tracker::TrackerConfig;
use pxpl5::{
    Experiment, Frameless, Head, HeadSum, KeptRecords, MachineConfig, Pixels, RenderingControl, Slats, scene,
    scene::Scene,
};
use std::hint::black_box;
use std::sync::Arc;

/// Returns a scene with at most `triangles` triangles. 0 stands for all.
fn scene_of(name: &str, triangles: usize) -> Scene {
    let scene = scene::builtin(name).expect("built in");
    if triangles > 0 { scene.decimated(triangles).expect("so many") } else { scene }
}

/// Adds a head with a predicted pose, and all results of a report: latencies to light and pixel errors of each field.
fn tracked(experiment: Experiment) -> Experiment {
    let motion = Arc::new(Synthetic::recorded_use(3));
    let head = Head::new(motion, TrackerConfig::fastrak(), PredictorKind::Kalman, 1).expect("in range");
    experiment.head(head).observed_by(Some(HeadSum::begin))
}

/// Returns experiments with the number of fields of a short run. A long run has twenty times as many fields.
fn experiments() -> [(&'static str, Experiment, u64); 5] {
    let small = MachineConfig::small_hmd;
    let control = Experiment::new(small(), RenderingControl::stereo(), scene_of("mig", 0));
    let slats = Experiment::new(MachineConfig::slats(), Slats::split(), scene_of("mig", 60));
    [
        ("rendering-control-mig-tracked", tracked(control.clone()), 250),
        ("rendering-control-mig", control, 250),
        ("slats-60-tracked", tracked(slats.clone()), 500),
        ("slats-60", slats, 500),
        ("frameless", Experiment::new(small(), Frameless::new(), scene_of("full-screen:4", 0)), 25),
    ]
}

fn long_runs(criterion: &mut Criterion) {
    for (name, experiment, short) in experiments() {
        let experiment = experiment.pixels(Pixels::Off).keep(KeptRecords::Statistics);
        let mut group = criterion.benchmark_group(format!("long-runs/{name}"));
        for (length, fields) in [("short", short), ("twenty times as long", 20 * short)] {
            let experiment = experiment.clone().fields(fields);
            group.throughput(Throughput::Elements(fields));
            group.bench_function(BenchmarkId::from_parameter(length), |b| {
                b.iter(|| black_box(experiment.run().expect("it runs").tally().pictures));
            });
        }
        group.finish();
    }
}

fn quick() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(std::time::Duration::from_millis(300))
        .measurement_time(std::time::Duration::from_secs(4))
}

criterion_group! { name = benches; config = quick(); targets = long_runs }
criterion_main!(benches);
