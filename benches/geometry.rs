//! Host time of transform, binning and set-up, per triangle.
#![allow(missing_docs, reason = "criterion's macro writes an undocumented function")]

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use glam::{Mat4, Vec3};
use pxpl5_geometry::{
    Culling, LANES, Light, SetupStats, SurfaceVertex, Transform, Triangle, TriangleLanes, ViewTransform, Viewport,
};
use std::hint::black_box;

/// A sphere of `2 * 186 * 160` = 59,520 triangles, nearly as many as the 59,592 triangles of the head model in the
/// published measurements.
struct Ball {
    positions: Vec<Vec3>,
    colours: Vec<[u8; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Ball {
    const COLUMNS: u32 = 186;
    const ROWS: u32 = 160;

    fn new() -> Self {
        let mut ball = Self { positions: Vec::new(), colours: Vec::new(), triangles: Vec::new() };
        for row in 0..=Self::ROWS {
            let polar = part_of_turn(row, 2 * Self::ROWS);
            for column in 0..Self::COLUMNS {
                let around = part_of_turn(column, Self::COLUMNS);
                ball.positions.push(Vec3::new(polar.sin() * around.cos(), polar.cos(), polar.sin() * around.sin()));
                ball.colours.push([200, (row % 256) as u8, (column % 256) as u8]);
            }
        }
        for row in 0..Self::ROWS {
            for column in 0..Self::COLUMNS {
                let here = Self::vertex(row, column);
                let diagonal = Self::vertex(row + 1, column + 1);
                ball.triangles.push([here, Self::vertex(row + 1, column), diagonal]);
                ball.triangles.push([here, diagonal, Self::vertex(row, column + 1)]);
            }
        }
        ball
    }

    fn vertex(row: u32, column: u32) -> u32 {
        row * Self::COLUMNS + column % Self::COLUMNS
    }

    fn each(&self) -> impl Iterator<Item = Triangle> {
        self.triangles.iter().map(|corners| {
            let corners = corners.map(|i| i as usize);
            let positions = corners.map(|i| self.positions[i]);
            Triangle { positions, normals: positions, colours: corners.map(|i| self.colours[i]) }
        })
    }
}

/// Returns the angle of step `n` of `steps` steps around a circle, in radians.
fn part_of_turn(n: u32, steps: u32) -> f32 {
    std::f32::consts::TAU * n as f32 / steps as f32
}

fn view() -> Transform {
    let view = ViewTransform {
        model_view: Mat4::from_translation(Vec3::new(0.1, 0.05, -2.6)),
        projection: Mat4::perspective_rh(0.9, 4.0 / 3.0, 0.1, 10.0),
    };
    Transform::new(&view, Viewport::FRAME, Culling::None).expect("a finite view")
}

fn transform(c: &mut Criterion) {
    let ball = Ball::new();
    let triangles: Vec<Triangle> = ball.each().collect();
    let view = view();
    let mut group = c.benchmark_group("transform");
    group.throughput(Throughput::Elements(triangles.len() as u64));
    group.bench_function("bin/triangle", |b| {
        let mut bins = Vec::new();
        b.iter(|| {
            bins.clear();
            let mut stats = SetupStats::default();
            for t in &triangles {
                view.bin(black_box(&t.positions), &mut stats, |mask| bins.push(mask));
            }
            stats
        });
    });
    group.bench_function("bin/shared vertices", |b| {
        let mut vertices = Vec::new();
        b.iter(|| {
            vertices.clear();
            vertices.extend(view.screen_vertices(black_box(&ball.positions)));
            view.touched(&vertices, 0, &ball.triangles)
        });
    });
    group.bench_function("gouraud/triangle", |b| {
        let mut out = Vec::new();
        b.iter(|| {
            out.clear();
            let mut stats = SetupStats::default();
            for t in &triangles {
                view.gouraud(black_box(t), &Light::HEADLIGHT, &mut stats, |t| out.push(t));
            }
            stats
        });
    });
    group.bench_function("phong/triangle", |b| {
        let mut out = Vec::new();
        b.iter(|| {
            out.clear();
            let mut stats = SetupStats::default();
            for t in &triangles {
                view.phong(black_box(t), &mut stats, |t| out.push(t));
            }
            stats
        });
    });
    group.finish();
}

/// Adds to the lanes those triangles that need no clipping.
fn fill<'a>(lanes: &mut TriangleLanes<'a>, some: &[[u32; 3]], vertices: &'a [SurfaceVertex]) {
    lanes.clear();
    for corners in some {
        let [a, b, c] = corners.map(|i| i as usize);
        let _ = lanes.push([&vertices[a], &vertices[b], &vertices[c]]);
    }
}

fn setup(c: &mut Criterion) {
    let ball = Ball::new();
    let view = view();
    let mut stats = SetupStats::default();
    let mut gouraud = Vec::new();
    let mut phong = Vec::new();
    for t in ball.each() {
        view.gouraud(&t, &Light::HEADLIGHT, &mut stats, |t| gouraud.push(t));
        view.phong(&t, &mut stats, |t| phong.push(t));
    }
    let mut group = c.benchmark_group("setup");
    group.throughput(Throughput::Elements(gouraud.len() as u64));
    group.bench_function("gouraud", |b| {
        b.iter(|| {
            for t in &gouraud {
                black_box(black_box(t).gouraud(&Viewport::FRAME, &mut stats));
            }
        });
    });
    group.bench_function("phong", |b| {
        b.iter(|| {
            for t in &phong {
                black_box(black_box(t).phong(&Viewport::FRAME, &mut stats));
            }
        });
    });
    let vertices = view.screen_vertices(&ball.positions);
    let positions = &ball.positions;
    let colours = view.vertex_colours(&Light::HEADLIGHT, &vertices, positions, positions, &ball.colours);
    let normals = view.vertex_normals(&vertices, positions, positions);
    let mut lanes = TriangleLanes::default();
    group.bench_function("gouraud/together", |bencher| {
        bencher.iter(|| {
            for some in ball.triangles.chunks(LANES) {
                fill(&mut lanes, some, &colours);
                let expressions = view.gouraud_lanes(&lanes, &mut stats);
                (0..some.len()).for_each(|i| _ = black_box(expressions.get(i)));
            }
        });
    });
    group.bench_function("phong/together", |bencher| {
        bencher.iter(|| {
            for some in ball.triangles.chunks(LANES) {
                fill(&mut lanes, some, &normals);
                let expressions = view.phong_lanes(&lanes, &mut stats);
                (0..some.len()).for_each(|i| _ = black_box(expressions.get(i, [200; 3])));
            }
        });
    });
    group.finish();
}

criterion_group!(benches, transform, setup);
criterion_main!(benches);
