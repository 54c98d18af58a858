//! Measures the host computer's time for each simulated instruction of the triangle kernels. There are three modes:
//! with memoized clock counts, with all clocks counted, and without timing.
//!
//! Unlike the loops of instructions.rs, these kernels do not stay in the simulated caches.

#![allow(missing_docs, reason = "criterion_group makes an undocumented function")]

#[path = "../crates/pphigs/tests/kernel/mod.rs"]
mod kernel;
#[path = "../crates/pphigs/tests/numbers/mod.rs"]
mod numbers;

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use i860::Config;
use kernel::{Bench, frame, triangles};
use pxpl5_geometry::Viewport;
use pxpl5_geometry::kernel::Schedule;

fn modes() -> [(&'static str, Config); 3] {
    let counted = Config { memoise: false, ..Config::cycle() };
    [("memoised", Config::cycle()), ("counted", counted), ("functional", Config::functional())]
}

/// Benchmarks the kernels with triangles of about the size in the published figures.
fn kernels(c: &mut Criterion) {
    let mut group = c.benchmark_group("kernels");
    let input = triangles(500, 0.12, 1);
    for schedule in [Schedule::Straight, Schedule::Compiled, Schedule::Dual] {
        for (mode, config) in modes() {
            let prepare = || Bench::new(frame(schedule), Viewport::FRAME, config, &input);
            let instructions = run(prepare()).profile().instructions;
            group.throughput(Throughput::Elements(instructions)).sample_size(20);
            group.bench_function(format!("{schedule:?}/{mode}"), |b| {
                b.iter_batched(prepare, run, BatchSize::LargeInput);
            });
        }
    }
    group.finish();
}

fn run(mut bench: Bench) -> Bench {
    bench.run();
    bench
}

criterion_group!(benches, kernels);
criterion_main!(benches);
