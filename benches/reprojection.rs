//! Host time of moving one picture to another pose on one thread: by rotation, and by the depths of its pixels.
//!
//! The limits are 4 ms for a rotation and 8 ms with depth for a picture of 640 x 480, and in proportion for other
//! sizes.

#![allow(missing_docs, reason = "the macros of criterion make public functions without any")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::DVec3;
use image::{Rgb, RgbImage};
use pxpl5_measure::{DepthPicture, reproject, reproject_with_depth};
use pxpl5_run::Warp;
use std::hint::black_box;
use tracking::view::Hmd;
use tracking::{Pose, rotation};

/// Sizes of a picture: NTSC and the rolling OLED.
const SIZES: [(u32, u32); 2] = [(640, 480), (1_080, 1_200)];

fn picture(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| Rgb([x as u8, y as u8, (x ^ y) as u8]))
}

/// Returns the depths of a room: a floor, and near boxes before a far wall.
fn depths(width: u32, height: u32) -> DepthPicture {
    DepthPicture::from_fn(width, height, |x, y| match (x / 97 + y / 83) % 3 {
        0 if y < height / 2 => 1.0,
        _ if y < height / 2 => 5.0,
        _ => 5.0 * height as f32 / (2 * y) as f32,
    })
}

/// Moves pictures to the pose of a head after 50 ms of motion at 100 degrees per second and 1 m per second.
fn fields(criterion: &mut Criterion) {
    let now = Pose {
        position: DVec3::new(0.05, 0.0, -0.02),
        orientation: rotation::from_yaw_pitch_roll(5_f64.to_radians(), 0.02, 0.01),
    };
    let mut group = criterion.benchmark_group("reprojection");
    for (width, height) in SIZES {
        let view = Hmd::unc().with_pixels(width, height);
        let (picture, depths) = (picture(width, height), depths(width, height));
        let name = format!("{width} x {height}");
        group.throughput(Throughput::Elements(u64::from(width) * u64::from(height)));
        group.bench_function(BenchmarkId::new("rotation", &name), |bencher| {
            bencher.iter(|| reproject(black_box(&picture), &view, Warp::Rotation, &Pose::IDENTITY, black_box(&now)));
        });
        group.bench_function(BenchmarkId::new("depth", &name), |bencher| {
            bencher
                .iter(|| reproject_with_depth(black_box(&picture), &depths, &view, &Pose::IDENTITY, black_box(&now)));
        });
    }
    group.finish();
}

criterion_group!(benches, fields);
criterion_main!(benches);
