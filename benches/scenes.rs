//! Host time to generate scenes, to load scenes and to compute a pose.

use std::hint::black_box;

use criterion::Criterion;
use pxpl5_scene::{Format, Hmd, builtin, from_bytes};

fn scenes(c: &mut Criterion) {
    for name in ["mig", "molecules", "head", "full-screen:12"] {
        c.bench_function(name, |b| b.iter(|| builtin(black_box(name))));
    }
    let motion = *builtin("mig").expect("a built-in scene").motion();
    let hmd = Hmd::unc();
    let mut time_ps = 0;
    c.bench_function("pose and stereo views", |b| {
        b.iter(|| {
            time_ps += 16_683_333_333;
            hmd.stereo(&motion.pose(time_ps))
        });
    });
}

/// Returns an OBJ file of 20,000 quads over 20,000 points.
fn strip() -> String {
    let mut text = String::new();
    for i in 0..20_000 {
        text += &format!("v {i} {} 0.5\n", i % 7);
    }
    for i in 0..20_000 {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| (i + k) % 20_000 + 1);
        text += &format!("f {a} {b} {c} {d}\n");
    }
    text
}

fn files(c: &mut Criterion) {
    let obj = strip();
    c.bench_function("OBJ, 40,000 triangles", |b| {
        b.iter(|| from_bytes(black_box(obj.as_bytes()), Format::Obj, "strip.obj"));
    });
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    scenes(&mut criterion);
    files(&mut criterion);
    criterion.final_summary();
}
