//! Host time of a volume of 198 distinct slices of the head, and the ratios that the issue asks for, in one process.
#![allow(missing_docs, reason = "criterion's macro writes an undocumented function")]

use criterion::{Criterion, SamplingMode, criterion_group, criterion_main};
use euc::buffer::Buffer2d;
use euc::rasterizer::{BackfaceCullingDisabled, Triangles};
use euc::{DepthStrategy, Interpolate, Pipeline as _, Target as _};
use glam::DVec3;
use pxpl5_scene::builtin;
use spatialgl::{
    CommandBuffer, HostRenderer, Jitter, OneThread, Projection, SliceClip, SliceView, SliceVolume, SpatialDisplay,
    Strobes, SweptConfig, SweptDisplay, Threads, VolumeConfig, Workers, record_scene, render_volume,
};
use std::cell::Cell;
use std::num::NonZero;
use std::time::Duration;

fn head() -> CommandBuffer {
    record_scene(&builtin("head").expect("built in"), 384.0, true).expect("valid")
}

fn display(projection: Projection) -> SweptDisplay {
    SweptDisplay::new(SweptConfig::perspecta(SliceClip::Hyperbolic(0.25), projection)).expect("valid")
}

fn half(config: VolumeConfig) -> VolumeConfig {
    VolumeConfig { strobes: Strobes::Mirror, ..config }
}

fn draw(display: &SweptDisplay, commands: &CommandBuffer, config: &VolumeConfig, workers: &dyn Workers) -> u64 {
    let frame = render_volume(display, commands, config, &HostRenderer, workers).expect("valid");
    frame.stats.fragments_accepted
}

/// Bins and tiles against brute force, one thread against two; the volume has 396 slices, of which 198 are drawn.
fn volumes(c: &mut Criterion) {
    let commands = head();
    let mut group = c.benchmark_group("volume");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).measurement_time(Duration::from_secs(10));
    let orthographic = display(Projection::Orthographic);
    let jittered = display(Projection::Jittered(Jitter::new(1)));
    let two = Threads(NonZero::new(2).expect("not zero"));
    let paper = half(VolumeConfig::paper());
    let plain = half(VolumeConfig::plain());
    group.bench_function("head, binned and tiled", |b| b.iter(|| draw(&orthographic, &commands, &paper, &OneThread)));
    group.bench_function("head, jittered", |b| b.iter(|| draw(&jittered, &commands, &paper, &OneThread)));
    group.bench_function("head, two threads", |b| b.iter(|| draw(&orthographic, &commands, &paper, &two)));
    group.bench_function("head, plain", |b| b.iter(|| draw(&orthographic, &commands, &plain, &OneThread)));
    group.finish();
}

/// Distances from the two boundary planes, and the brightness.
#[derive(Clone, Copy)]
struct Carried([f32; 3]);

impl Interpolate for Carried {
    #[inline(always)]
    fn lerp2(Self(a): Self, Self(b): Self, x: f32, y: f32) -> Self {
        Self([0, 1, 2].map(|i| a[i] * x + b[i] * y))
    }

    #[inline(always)]
    fn lerp3(Self(a): Self, Self(b): Self, Self(c): Self, x: f32, y: f32, z: f32) -> Self {
        Self([0, 1, 2].map(|i| a[i] * x + b[i] * y + c[i] * z))
    }
}

/// One slice with the hyperbola in the fragment program. `euc` 0.5 has no discard: what is rejected is drawn as zero.
struct EucSlice<'a> {
    commands: &'a CommandBuffer,
    view: &'a SliceView,
    planes: [[f64; 2]; 2],
    accepted: Cell<u64>,
}

impl euc::Pipeline for EucSlice<'_> {
    type Vertex = u32;
    type VsOut = Carried;
    type Pixel = u32;

    #[inline(always)]
    fn vert(&self, vertex: &u32) -> ([f32; 4], Carried) {
        let world = self.commands.positions()[*vertex as usize];
        let clip = self.view.projection * self.view.local(DVec3::from_array(world)).extend(1.0);
        let [a, b] = self.planes.map(|plane| (plane[0] * world[0] + plane[1] * world[2]) as f32);
        (clip.as_vec4().to_array(), Carried([a, b, 200.0]))
    }

    #[inline(always)]
    fn frag(&self, Carried([a, b, light]): &Carried) -> u32 {
        let is_accepted = a * b + 0.25 >= 0.0;
        self.accepted.set(self.accepted.get() + u64::from(is_accepted));
        if is_accepted { *light as u32 } else { 0 }
    }

    #[inline(always)]
    fn get_depth_strategy(&self) -> DepthStrategy {
        DepthStrategy::None
    }
}

/// Fragments that `euc` accepts in 198 slices: no bins, no dither, no packing.
fn draw_by_euc(display: &SweptDisplay, commands: &CommandBuffer, indices: &[u32], target: &mut Buffer2d<u32>) -> u64 {
    let mut accepted = 0;
    for view in &display.views()[..198] {
        let SliceVolume::Wedge(planes, _) = view.volume else { continue };
        target.clear(0);
        let slice = EucSlice { commands, view, planes: [planes.a, planes.b], accepted: Cell::new(0) };
        slice.draw::<Triangles<'_, (f32,), BackfaceCullingDisabled>, _>(indices, target, None);
        accepted += slice.accepted.get();
    }
    accepted
}

/// The same slices by a published rasteriser with the clip in its fragment program.
fn peers(c: &mut Criterion) {
    let scene = builtin("head").expect("built in");
    let commands = head();
    let orthographic = display(Projection::Orthographic);
    let indices = scene.triangles().as_flattened().to_vec();
    let mut target = Buffer2d::new([768, 768], 0);
    let paper = half(VolumeConfig::paper());
    let theirs = draw_by_euc(&orthographic, &commands, &indices, &mut target) as f64;
    let own = draw(&orthographic, &commands, &paper, &OneThread) as f64;
    assert!((theirs / own - 1.0).abs() < 0.05, "not the same slices: {theirs} and {own} fragments");
    let mut group = c.benchmark_group("peers/198 slices of the head");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).measurement_time(Duration::from_secs(10));
    group.bench_function("euc 0.5", |b| b.iter(|| draw_by_euc(&orthographic, &commands, &indices, &mut target)));
    group.bench_function("ours", |b| b.iter(|| draw(&orthographic, &commands, &paper, &OneThread)));
    group.finish();
}

criterion_group!(benches, volumes, peers);
criterion_main!(benches);
