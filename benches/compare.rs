//! Benchmarks of the comparison and of just-in-time pixels, in host time.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use criterion::{Criterion, criterion_group, criterion_main};
use pxpl5::compare::{CompareQuery, RowChoice};
use pxpl5::scene::builtin;
use pxpl5::tracking::motion::Synthetic;
use pxpl5::tracking::predict::PredictorKind;
use pxpl5::tracking::tracker::TrackerConfig;
use pxpl5::{Experiment, ExperimentFile, Head, Jitp, MachineConfig, Pixels, Study, Viewpoint};
use std::sync::Arc;

fn head() -> Arc<Head> {
    let motion = Arc::new(Synthetic::recorded_use(1));
    let head = Head::new(motion, TrackerConfig::optical_ceiling(), PredictorKind::Kalman, 1);
    Arc::new(head.expect("the presets are in range"))
}

/// Returns the comparison with one seed, without the search for limits.
fn query() -> CompareQuery {
    let mut shared = ExperimentFile::new();
    for (key, value) in [("scene", "mig"), ("machine.preset", "small-hmd"), ("head.motion", "synthetic")] {
        shared.set(key, value, "bench").expect("known");
    }
    shared.set("fields", 600, "bench").expect("known");
    CompareQuery { only: RowChoice::All, seeds: vec![1], ..CompareQuery::new(shared) }
}

/// Measures all pipelines with every predictor and with each cause of error removed in turn. The runs have 10 s of head
/// motion and the Mig, without pixels.
fn all_pipelines(criterion: &mut Criterion) {
    let query = query();
    let mut group = criterion.benchmark_group("compare");
    group.sample_size(10);
    group.bench_function("mig, 600 fields", |bencher| {
        bencher.iter(|| query.run(&mut ()).expect("it runs"));
    });
    group.finish();
}

/// Measures one second of strips of one line, drawn just before the beam.
fn scanlines(criterion: &mut Criterion) {
    let scene = Arc::new(builtin("full-screen:4").expect("built in"));
    let head = head();
    let mut group = criterion.benchmark_group("jitp");
    group.sample_size(10);
    group.bench_function("scanline, 60 fields", |bencher| {
        bencher.iter(|| {
            Experiment::with(
                MachineConfig::small_hmd(),
                Arc::new(Jitp::new(Viewpoint::Strip, true)),
                Arc::clone(&scene),
            )
            .head(Arc::clone(&head))
            .fields(60)
            .pixels(Pixels::Off)
            .run()
            .expect("it runs")
        });
    });
    group.finish();
}

criterion_group!(benches, all_pipelines, scanlines);
criterion_main!(benches);
