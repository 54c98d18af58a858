//! Compares the software renderers `euc` and `retrofire` with two models of the machine's pixel array, without
//! simulated times. The scene `head` of 59,592 triangles is drawn for one eye, 640 x 480, Gouraud, Z-buffered. The
//! bit-serial model runs in both of its modes, the default mode and the skipping mode. The throughput counts pictures.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use pxpl5::scene;
use pxpl5_renderer::{BitSerial, Lanes};
use support::{Euc, Ours, Retrofire, views};

#[path = "speed/peers.rs"]
mod support;

fn peers(criterion: &mut Criterion) {
    let head = scene::builtin("head").expect("built in");
    let views = views(&head);
    let mut euc = Euc::new(&head);
    let mut ours = Ours::new(&head, Lanes::new);
    let mut skipping = Ours::new(&head, |layout| BitSerial::new(layout).skipping());
    let mut reference = Ours::new(&head, BitSerial::new);
    let mut retrofire = Retrofire::new(&head);
    euc.draw(&head, &views[0]);
    retrofire.draw(&head, &views[0]);
    ours.draw(&views[0]);
    let own = ours.covered() as f64;
    for theirs in [euc.covered(), retrofire.covered()].map(|pixels| pixels as f64) {
        assert!(own > 10_000.0 && (theirs / own - 1.0).abs() < 0.02, "not the same picture: {theirs} and {own} pixels");
    }
    let mut group = criterion.benchmark_group("peers/head, one eye");
    group.throughput(Throughput::Elements(1));
    let mut turn = views.iter().cycle();
    let mut next = || turn.next().unwrap_or(&views[0]);
    group.bench_function("euc 0.5", |b| b.iter(|| euc.draw(&head, next())));
    group.bench_function("retrofire 0.4", |b| b.iter(|| retrofire.draw(&head, next())));
    group.bench_function("ours", |b| b.iter(|| ours.draw(next())));
    group.bench_function("ours, bit serial, skipping", |b| b.iter(|| skipping.draw(next())));
    group.bench_function("ours, bit serial, reference model", |b| b.iter(|| reference.draw(next())));
    group.finish();
}

fn quick() -> Criterion {
    Criterion::default()
        .sample_size(10)
        .warm_up_time(std::time::Duration::from_millis(500))
        .measurement_time(std::time::Duration::from_secs(2))
}

criterion_group! { name = all; config = quick(); targets = peers }
criterion_main!(all);
