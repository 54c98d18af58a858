//! Speed of the pixel arrays: host time per command.
//!
//! Every list has 64 commands, about twice as many as a message. The reported throughput is in commands. Each list
//! starts with a cleared or a covered array. Each primitive of a list is nearer than the previous primitive, so all its
//! inside pixels are stored.

#![allow(missing_docs)] // The macros of criterion make items without docs.

use criterion::{Bencher, BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pxpl5_renderer::{
    BitSerial, Clear, Command, Lanes, Layout, PhongSphereCommand, PhongTriangleCommand, PixelArray, Shade, SphereBody,
    SphereCommand, TriangleCommand, Vectors,
};
use pxpl5_wire::format::COLOUR_FRACTION_BITS;
use pxpl5_wire::{Linear, Quadratic};
use std::hint::black_box;
use std::time::{Duration, Instant};

const COMMANDS: u64 = 64;

/// Returns the edge from p to q in pixels, with its inside on the left.
fn edge(p: [i32; 2], q: [i32; 2]) -> Linear {
    let dx = 16 * (q[0] - p[0]);
    let dy = 16 * (q[1] - p[1]);
    Linear { a: -dy, b: dx, c: dy * p[0] - dx * p[1] }
}

/// Returns a colour component that changes slowly over the region, from `level` (0 to 255) at its upper left pixel.
const fn component(level: i32) -> Linear {
    Linear { a: 311, b: -277, c: level << COLOUR_FRACTION_BITS }
}

/// Returns triangle `i` of a series in which each triangle is nearer than the previous triangle.
fn triangle(v: [[i32; 2]; 3], i: i32) -> TriangleCommand {
    TriangleCommand {
        edges: [edge(v[0], v[1]), edge(v[1], v[2]), edge(v[2], v[0])],
        depth: Linear { a: -1000, b: 3000, c: (1 << 30) - i * 1000 },
        colour: [component(200), component(100), component(50)],
    }
}

fn phong(t: TriangleCommand) -> PhongTriangleCommand {
    PhongTriangleCommand { edges: t.edges, depth: t.depth, normal: t.colour, colour: 0x80_c0_f0 }
}

/// Returns the same shape at a place of the region that depends on `i`.
fn moved(v: [[i32; 2]; 3], room: i32, i: i32) -> [[i32; 2]; 3] {
    v.map(|[x, y]| [x + i * 37 % room, y + i * 53 % room])
}

/// A triangle with legs of 14 pixels, which covers 98 pixels.
const HUNDRED: [[i32; 2]; 3] = [[0, 0], [14, 0], [0, 14]];
const TEN: [[i32; 2]; 3] = [[0, 0], [5, 0], [0, 4]];
const SLIVER: [[i32; 2]; 3] = [[0, 0], [100, 93], [98, 93]];
const WHOLE: [[i32; 2]; 3] = [[-10, -10], [300, -10], [-10, 300]];

fn list(commands: impl Iterator<Item = Command>) -> Vec<u32> {
    let mut words = Vec::new();
    for command in commands {
        command.encode(&Layout::rendering_control_phong(), &mut words).expect("the layout holds all commands");
    }
    words
}

fn triangles(shape: [[i32; 2]; 3], room: i32) -> Vec<u32> {
    list((0..COMMANDS as i32).map(|i| Command::Triangle(triangle(moved(shape, room, i), i))))
}

fn phong_triangles(shape: [[i32; 2]; 3], room: i32) -> Vec<u32> {
    list((0..COMMANDS as i32).map(|i| Command::PhongTriangle(phong(triangle(moved(shape, room, i), i)))))
}

fn clears() -> Vec<u32> {
    list((0..COMMANDS as u32).map(|i| Command::Clear(Clear { colour: i })))
}

/// Returns sphere `i` of a series. Each sphere has a radius of `r` pixels, has its centre in the middle, and is nearer
/// than the previous sphere.
fn body(r: i64, i: i32) -> SphereBody {
    let depth = Linear::constant((1 << 30) - i * 1000);
    SphereBody { silhouette: silhouette(r), root_shift: 8, depth, depth_shift: 10 }
}

fn silhouette(r: i64) -> Quadratic {
    let scale = 1 << 16;
    Quadratic { xx: -scale, xy: 0, yy: -scale, x: 128 * scale, y: 128 * scale, one: scale * (r * r - 2 * 64 * 64) }
}

fn spheres(r: i64) -> Vec<u32> {
    list((0..COMMANDS as i32).map(|i| {
        Command::Sphere(SphereCommand {
            body: body(r, i),
            colour: [Linear { a: 900, b: 500, c: 30 << 12 }; 3],
            root_factor: [200; 3],
        })
    }))
}

fn phong_spheres(r: i64) -> Vec<u32> {
    list((0..COMMANDS as i32).map(|i| {
        Command::PhongSphere(PhongSphereCommand {
            body: body(r, i),
            normal: [Linear { a: 16 << 10, b: 0, c: -(1 << 20) }, Linear { a: 0, b: 16 << 10, c: -(1 << 20) }],
            colour: 0x80_c0_f0,
        })
    }))
}

fn shades() -> Vec<u32> {
    let shade = Shade { light: [400, 500, 800], half: [200, 250, 970], ambient: 40, diffuse: 180, specular: 255 };
    list((0..COMMANDS).map(|_| Command::Shade(shade)))
}

/// Measures the time of `words` on an array that is cleared, or covered, before each run.
fn timed(bencher: &mut Bencher<'_>, array: &mut impl PixelArray, words: &[u32], covered: bool) {
    let mut before = list(std::iter::once(Command::Clear(Clear { colour: 0 })));
    if covered {
        before.extend(list(std::iter::once(Command::PhongTriangle(phong(triangle(WHOLE, 0))))));
    }
    bencher.iter_custom(|times| {
        (0..times).fold(Duration::ZERO, |time, _| {
            array.execute(&before).expect("legal words");
            let start = Instant::now();
            black_box(array.execute(black_box(words))).expect("legal words");
            time + start.elapsed()
        })
    });
}

fn lanes(c: &mut Criterion) {
    let lists = [
        ("triangle 100 px", triangles(HUNDRED, 110), false),
        ("triangle 10 px", triangles(TEN, 120), false),
        ("triangle sliver", triangles(SLIVER, 25), false),
        ("triangle whole region", triangles(WHOLE, 1), false),
        ("phong triangle 100 px", phong_triangles(HUNDRED, 110), false),
        ("phong triangle whole region", phong_triangles(WHOLE, 1), false),
        ("clear", clears(), false),
        ("sphere of radius 10", spheres(10), false),
        ("sphere of radius 60", spheres(60), false),
        ("phong sphere of radius 60", phong_spheres(60), false),
        ("shade covered region", shades(), true),
        ("shade empty region", shades(), false),
    ];
    for vectors in Vectors::available() {
        let mut group = c.benchmark_group(format!("lanes/{vectors:?}"));
        group.throughput(Throughput::Elements(COMMANDS));
        for (name, words, covered) in &lists {
            let mut array = Lanes::with_vectors(&Layout::rendering_control_phong(), vectors);
            group.bench_function(BenchmarkId::from_parameter(name), |b| timed(b, &mut array, words, *covered));
        }
        group.finish();
    }
}

fn bit_serial(c: &mut Criterion) {
    let lists = [
        ("triangle whole region", triangles(WHOLE, 1), false),
        ("sphere of radius 60", spheres(60), false),
        ("shade covered region", shades(), true),
    ];
    bit_planes(c, "bit serial", &lists, BitSerial::with_vectors);
    let small = [("triangle 100 px", triangles(HUNDRED, 110), false), ("sphere of radius 10", spheres(10), false)];
    bit_planes(c, "bit serial, skipping", &[&small[..], &lists].concat(), skipping_array);
}

fn skipping_array(layout: &Layout, vectors: Vectors) -> BitSerial {
    BitSerial::with_vectors(layout, vectors).skipping()
}

fn bit_planes(
    c: &mut Criterion,
    name: &str,
    lists: &[(&str, Vec<u32>, bool)],
    array: impl Fn(&Layout, Vectors) -> BitSerial,
) {
    for vectors in Vectors::available() {
        let mut group = c.benchmark_group(format!("{name}/{vectors:?}"));
        group.throughput(Throughput::Elements(COMMANDS));
        for (name, words, covered) in lists {
            let mut array = array(&Layout::rendering_control_phong(), vectors);
            group.bench_function(BenchmarkId::from_parameter(name), |b| timed(b, &mut array, words, *covered));
        }
        group.finish();
    }
}

fn quick() -> Criterion {
    Criterion::default()
        .sample_size(20)
        .warm_up_time(std::time::Duration::from_millis(200))
        .measurement_time(std::time::Duration::from_millis(700))
}

criterion_group! { name = pixels; config = quick(); targets = lanes, bit_serial }
criterion_main!(pixels);
