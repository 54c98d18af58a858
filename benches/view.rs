//! Host time of the view of one revolution of the head scene, and of drawing the viewed volume.
#![allow(missing_docs, reason = "criterion's macro writes an undocumented function")]

use criterion::{Criterion, SamplingMode, criterion_group, criterion_main};
use pxpl5_scene::builtin;
use spatialgl::perspecta::{Camera, PerspectaConfig, ViewOptions, view_planes, view_undithered};
use spatialgl::{
    HostRenderer, Jitter, OneThread, Projection, SliceClip, Threads, VolumeConfig, record_scene, render_volume,
};
use std::num::NonZero;
use std::time::Duration;

fn views(c: &mut Criterion) {
    let commands = record_scene(&builtin("head").expect("built in"), 384.0, true).expect("valid");
    let projection = Projection::Jittered(Jitter::new(1));
    let display = PerspectaConfig::PAPERS.swept(SliceClip::Hyperbolic(0.25), projection).expect("valid");
    let config = VolumeConfig { keeps_colours: true, ..VolumeConfig::paper() };
    let draw = || render_volume(&display, &commands, &config, &HostRenderer, &OneThread).expect("valid");
    let frame = draw();
    let camera = Camera::around(384.0, 40.0, 25.0, 512);
    let plain = ViewOptions::default();
    let lambert = ViewOptions { lambert: true, ..plain };
    let two = Threads(NonZero::new(2).expect("not zero"));
    let mut group = c.benchmark_group("view of the head");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).measurement_time(Duration::from_secs(5));
    group.bench_function("the volume, 396 slices", |b| b.iter(draw));
    group.bench_function("swept", |b| b.iter(|| view_planes(&frame.planes, &camera, plain, &OneThread)));
    group.bench_function("swept, two threads", |b| b.iter(|| view_planes(&frame.planes, &camera, plain, &two)));
    group.bench_function("Lambert", |b| b.iter(|| view_planes(&frame.planes, &camera, lambert, &OneThread)));
    group.bench_function("undithered", |b| b.iter(|| view_undithered(&frame, &camera, plain, &OneThread)));
    group.finish();
}

criterion_group!(benches, views);
criterion_main!(benches);
