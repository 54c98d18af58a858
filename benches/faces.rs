//! Draws 10,000 triangles into six faces of 512 x 512 texels. Compares the time with a plain loop that tests every
//! texel of a triangle's rows.

#![allow(missing_docs, reason = "criterion's macro writes an undocumented function")]

use address_recalculation::{CubeFace, FaceGeometry, FaceSet, TexelAddress, TexelFormat};
use criterion::{Criterion, criterion_group, criterion_main};
use glam::DVec3;
use pxpl5_arp::cube_faces::{Corner, CubeView, DepthRange};
use std::hint::black_box;

const VIEW: FaceGeometry = FaceGeometry { texels: 512, guard: 1 };
const FORMAT: TexelFormat = TexelFormat { colour_bits: 24, depth_bits: 24 };

/// Returns a hall with six sides of 2 n x n triangles each, and a shell inside the hall. Every texel is thus drawn more
/// than once.
fn scene(n: u32) -> Vec<[Corner; 3]> {
    let mut triangles = Vec::new();
    for (size, every) in [(10.0, 1), (4.0, 2)] {
        for face in CubeFace::ALL {
            let axis = |axis: [i64; 3]| DVec3::from_array(axis.map(|component| component as f64));
            let place = |i: u32, j: u32| {
                let [u, v] = [i, j].map(|k| 2.0 * f64::from(k) / f64::from(n) - 1.0);
                (axis(face.forward()) + axis(face.right()) * u + axis(face.up()) * v) * size
            };
            for k in (0..n * n).filter(|k| k % every == 0) {
                let corners = [(0, 0), (1, 0), (1, 1), (0, 1)].map(|(i, j)| place(k % n + i, k / n + j));
                for three in [[0, 1, 2], [0, 2, 3]] {
                    triangles.push(
                        three.map(|i| Corner { place: corners[i], colour: (k * 7919 + i as u32 * 64) & 0xFF_FFFF }),
                    );
                }
            }
        }
    }
    triangles
}

/// Draws triangles by barycentric coordinates (Moeller and Trumbore), for each texel of a triangle's rows and columns.
fn plain(eye: DVec3, triangles: &[[Corner; 3]], faces: &mut FaceSet) {
    for corners in triangles {
        let [a, b, c] = corners.map(|corner| corner.place - eye);
        for face in CubeFace::ALL {
            let axis = |axis: [i64; 3]| DVec3::from_array(axis.map(|component| component as f64));
            let [right, down, forward] = [axis(face.right()), -axis(face.up()), axis(face.forward())];
            let ahead = [a, b, c].map(|p| p.dot(forward));
            if ahead.iter().any(|w| *w < 0.1) {
                continue;
            }
            let range = |along: DVec3| {
                let places = [a, b, c].map(|p| p.dot(along) / p.dot(forward));
                let texel = |place: f64| ((place + 1.0) / 2.0 * 510.0 + 1.0).clamp(0.0, 511.0) as u32;
                let low = places.iter().fold(f64::INFINITY, |low, place| low.min(*place));
                texel(low)..=texel(places.iter().fold(f64::NEG_INFINITY, |high, place| high.max(*place)))
            };
            for row in range(down) {
                for column in range(right) {
                    let address = TexelAddress { face, column, row };
                    let ray = DVec3::from_array(VIEW.direction(address));
                    let normal = ray.cross(c - a);
                    let scale = 1.0 / (b - a).dot(normal);
                    let u = -a.dot(normal) * scale;
                    let q = (-a).cross(b - a);
                    let v = ray.dot(q) * scale;
                    let distance = (c - a).dot(q) * scale;
                    if u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.1 {
                        let depth = (1.001 * (1.0 - 0.1 / distance) * 16_777_215.0) as u32;
                        faces.keep_nearer(address, &[corners[0].colour], &[depth]);
                    }
                }
            }
        }
    }
}

fn faces(criterion: &mut Criterion) {
    let triangles = scene(24);
    assert!((9_900..10_500).contains(&triangles.len()), "{}", triangles.len());
    let view = CubeView { geometry: VIEW, depth: DepthRange::new(0.1, 100.0).expect("a range") };
    let eye = DVec3::new(0.1, 0.2, 0.3);
    let mut group = criterion.benchmark_group("six faces of 512 texels, 10,368 triangles");
    group.sample_size(10);
    group.bench_function("drawn", |bencher| {
        bencher.iter(|| {
            let mut faces = FaceSet::new(512, FORMAT);
            black_box(view.draw(eye, triangles.iter().copied(), &mut faces));
            faces
        });
    });
    group.bench_function("plain loop", |bencher| {
        bencher.iter(|| {
            let mut faces = FaceSet::new(512, FORMAT);
            plain(eye, &triangles, &mut faces);
            faces
        });
    });
    group.finish();
}

criterion_group!(benches, faces);
criterion_main!(benches);
