//! Measures the host time of a volume of 198 distinct slices of the head scene. Measurements that are compared run in
//! one process.
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
use std::cell::{Cell, RefCell};
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

/// Compares bins and tiles with drawing without them, and one thread with two. The volume has 396 slices, of which 198
/// are drawn.
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

/// The values that are interpolated linearly over a triangle.
#[derive(Clone, Copy)]
struct Carried<const N: usize>([f32; N]);

impl<const N: usize> Interpolate for Carried<N> {
    #[inline(always)]
    fn lerp2(Self(a): Self, Self(b): Self, x: f32, y: f32) -> Self {
        Self(std::array::from_fn(|i| a[i] * x + b[i] * y))
    }

    #[inline(always)]
    fn lerp3(Self(a): Self, Self(b): Self, Self(c): Self, x: f32, y: f32, z: f32) -> Self {
        Self(std::array::from_fn(|i| a[i] * x + b[i] * y + c[i] * z))
    }
}

/// A rendering pipeline of the crate `euc` for one slice, with the hyperbola in the fragment program. `euc` 0.5 cannot
/// discard fragments, so rejected fragments are drawn as zero.
struct EucSlice<'a> {
    commands: &'a CommandBuffer,
    view: &'a SliceView,
    planes: [[f64; 2]; 2],
    accepted: Cell<u64>,
}

impl<'a> EucSlice<'a> {
    fn new(view: &'a SliceView, commands: &'a CommandBuffer) -> Self {
        let SliceVolume::Wedge(planes, _) = view.volume else { panic!("a slice of a swept display") };
        Self { commands, view, planes: [planes.a, planes.b], accepted: Cell::new(0) }
    }

    /// Returns the clip coordinates of a vertex, and its distances from the two boundary planes.
    #[inline(always)]
    fn placed(&self, vertex: u32) -> ([f32; 4], [f32; 2]) {
        let world = self.commands.positions()[vertex as usize];
        let clip = self.view.projection * self.view.local(DVec3::from_array(world)).extend(1.0);
        let planes = self.planes.map(|plane| (plane[0] * world[0] + plane[1] * world[2]) as f32);
        (clip.as_vec4().to_array(), planes)
    }
}

impl euc::Pipeline for EucSlice<'_> {
    type Vertex = u32;
    type VsOut = Carried<3>;
    type Pixel = u32;

    #[inline(always)]
    fn vert(&self, vertex: &u32) -> ([f32; 4], Carried<3>) {
        let (clip, [a, b]) = self.placed(*vertex);
        (clip, Carried([a, b, 200.0]))
    }

    #[inline(always)]
    fn frag(&self, Carried([a, b, light]): &Carried<3>) -> u32 {
        let is_accepted = a * b + 0.25 >= 0.0;
        self.accepted.set(self.accepted.get() + u64::from(is_accepted));
        if is_accepted { *light as u32 } else { 0 }
    }

    #[inline(always)]
    fn get_depth_strategy(&self) -> DepthStrategy {
        DepthStrategy::None
    }
}

/// A rendering pipeline for the same slice, which records the pixels of accepted fragments. The fragment program
/// receives window coordinates, because the target does not show rejected fragments.
struct EucCoverage<'a> {
    slice: EucSlice<'a>,
    covered: RefCell<Vec<bool>>,
}

impl euc::Pipeline for EucCoverage<'_> {
    type Vertex = u32;
    type VsOut = Carried<4>;
    type Pixel = u32;

    fn vert(&self, vertex: &u32) -> ([f32; 4], Carried<4>) {
        let (clip, [a, b]) = self.slice.placed(*vertex);
        (clip, Carried([a, b, 384.0 * (1.0 + clip[0]), 384.0 * (1.0 - clip[1])]))
    }

    fn frag(&self, Carried([a, b, x, y]): &Carried<4>) -> u32 {
        if a * b + 0.25 >= 0.0 {
            self.covered.borrow_mut()[*y as usize * 768 + *x as usize] = true;
        }
        0
    }

    fn get_depth_strategy(&self) -> DepthStrategy {
        DepthStrategy::None
    }
}

/// Draws 198 slices with the crate `euc`, without bins, dither and packing. Returns the number of fragments that `euc`
/// accepts.
fn draw_by_euc(display: &SweptDisplay, commands: &CommandBuffer, indices: &[u32], target: &mut Buffer2d<u32>) -> u64 {
    let views = display.views()[..198].iter();
    let accepted = views.map(|view| {
        target.clear(0);
        let slice = EucSlice::new(view, commands);
        slice.draw::<Triangles<'_, (f32,), BackfaceCullingDisabled>, _>(indices, target, None);
        slice.accepted.get()
    });
    accepted.sum()
}

/// Largest allowed percentage of covered pixels that only one of the two rasterizers covers. `euc` works in single
/// precision and has another rule for samples on edges.
const MAX_DIFFERING_PERCENT: f64 = 2.0;

/// Returns the percentage of pixels that only one of the two rasterizers covers, in the slices of half a turn.
fn differing_percent(
    display: &SweptDisplay,
    commands: &CommandBuffer,
    indices: &[u32],
    target: &mut Buffer2d<u32>,
) -> f64 {
    let config = VolumeConfig { keeps_colours: true, ..half(VolumeConfig::paper()) };
    let frame = render_volume(display, commands, &config, &HostRenderer, &OneThread).expect("valid");
    let colours = frame.colours.expect("they were to be kept");
    let mut either = 0usize;
    let mut one_alone = 0usize;
    for (view, own) in display.views().iter().zip(&colours) {
        let covered = RefCell::new(vec![false; 768 * 768]);
        let slice = EucCoverage { slice: EucSlice::new(view, commands), covered };
        slice.draw::<Triangles<'_, (f32,), BackfaceCullingDisabled>, _>(indices, target, None);
        let theirs = slice.covered.into_inner();
        let common = own.iter().filter(|sample| theirs[sample.pixel as usize]).count();
        let covered = theirs.iter().filter(|is_covered| **is_covered).count();
        either += own.len() + covered - common;
        one_alone += own.len() + covered - 2 * common;
    }
    100.0 * one_alone as f64 / either as f64
}

/// Measures the same slices with the published rasterizer `euc`, which tests the clip in its fragment program.
fn peers(c: &mut Criterion) {
    let scene = builtin("head").expect("built in");
    let commands = head();
    let orthographic = display(Projection::Orthographic);
    let indices = scene.triangles().as_flattened().to_vec();
    let mut target = Buffer2d::new([768, 768], 0);
    let paper = half(VolumeConfig::paper());
    let differing = differing_percent(&orthographic, &commands, &indices, &mut target);
    assert!(differing < MAX_DIFFERING_PERCENT, "not the same slices: {differing} % of the covered pixels differ");
    println!("{differing:.3} % of the pixels that either covers are covered by one alone");
    let mut group = c.benchmark_group("peers/198 slices of the head");
    group.sample_size(10).sampling_mode(SamplingMode::Flat).measurement_time(Duration::from_secs(10));
    group.bench_function("euc 0.5", |b| b.iter(|| draw_by_euc(&orthographic, &commands, &indices, &mut target)));
    group.bench_function("ours", |b| b.iter(|| draw(&orthographic, &commands, &paper, &OneThread)));
    group.finish();
}

criterion_group!(benches, volumes, peers);
criterion_main!(benches);
