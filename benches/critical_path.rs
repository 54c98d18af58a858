//! Benchmark of the critical path in host time: the time to follow it, relative to the time of its run.
//!
//! Goal: following the critical path takes at most 2 % of its run. Both are measured in one process, in turn, so that
//! the load of the host has the same effect on both.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use criterion::{Criterion, criterion_group, criterion_main};
use pxpl5::{CriticalPath, Experiment, MachineConfig, Pixels, RenderingControl, scene};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Number of pairs of measurements. The ratio compares the shortest times.
const ROUNDS: usize = 7;

/// Largest ratio of the time to follow the path to the time of the run.
const GOAL: f64 = 0.02;

/// Scenes with their numbers of fields, from many short pictures to few long ones.
const RUNS: [(&str, u64); 3] = [("mig", 960), ("typical:8000", 240), ("head", 960)];

/// Returns the shortest time of a function, and its last result.
fn shortest<T>(rounds: usize, mut run: impl FnMut() -> T) -> (Duration, T) {
    let mut timed = || {
        let begin = Instant::now();
        let result = run();
        (begin.elapsed(), result)
    };
    let mut best = timed();
    for _ in 1..rounds {
        let next = timed();
        best = (best.0.min(next.0), next.1);
    }
    best
}

fn critical_path(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("critical path");
    for (name, fields) in RUNS {
        let scene = scene::builtin(name).expect("built in");
        let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene);
        let experiment = experiment.fields(fields).pixels(Pixels::Off);
        let (of_run, outcome) = shortest(ROUNDS, || experiment.run().expect("it fits"));
        let (of_path, path) = shortest(ROUNDS, || CriticalPath::of(&outcome).expect("pictures were shown"));
        let ratio = of_path.as_secs_f64() / of_run.as_secs_f64();
        let verdict = if ratio <= GOAL { "within the goal" } else { "beyond the goal" };
        println!(
            "{name}, {fields} fields: {:.2} % of the time of the run, {verdict} of {:.0} % ({} pictures)",
            100.0 * ratio,
            100.0 * GOAL,
            path.pictures
        );
        group.bench_function(name, |b| b.iter(|| black_box(CriticalPath::of(&outcome))));
    }
    group.finish();
}

criterion_group!(benches, critical_path);
criterion_main!(benches);
