//! Measures the host time to compute 640 x 480 pixels with interpolation, from four display memories of 512 texels, on
//! one thread.
//!
//! The goal is at most 8 ms. `a plain loop` is the same computation pixel by pixel. `reading the texels once` measures
//! memory access alone: it reads all texels of the front face in all memories in order.
#![allow(missing_docs, reason = "criterion's macro writes an undocumented function")]

use address_recalculation::{
    AddressUnit, ArpConfig, CubeFace, FaceSet, LensTable, Lookup, MatrixWords, Orientation, TexelAddress,
};
use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use std::hint::black_box;

/// Returns four memories with stripes of alternating depths.
fn memories(config: &ArpConfig) -> Vec<FaceSet> {
    (0..config.timing.display_memories as u32).map(|memory| striped(config, memory)).collect()
}

fn striped(config: &ArpConfig, memory: u32) -> FaceSet {
    let size = config.geometry().texels;
    let mut faces = FaceSet::new(size, config.format());
    for face in CubeFace::ALL {
        for row in 0..size {
            let colours: Vec<u32> = (0..size).map(|column| (column ^ row) * 0x01_03_05 + memory).collect();
            let depths = (0..size).map(|column| 1_000 + ((column / 16 + row / 16 + memory) % 4) * 100);
            faces.set_row(TexelAddress { face, column: 0, row }, &colours, depths);
        }
    }
    faces
}

/// Returns the orientation of a head that is turned half to the right and looks up, so that several faces are visible.
fn orientation() -> MatrixWords {
    Orientation::from_quaternion([0.2, -0.35, 0.05, 0.9]).expect("a rotation").words(16)
}

/// Computes the same pixels one by one: the texel addresses, the nearest memory, and the weights of the texels.
fn plain(table: &LensTable, unit: &AddressUnit, matrix: &MatrixWords, memories: &[FaceSet], out: &mut [u32]) {
    for (place, pixel) in (0_u32..).zip(out) {
        let vector = table.entry(place % table.width(), place / table.width());
        let Some(footprint) = unit.footprint(matrix.turn(vector)) else { continue };
        let weights = footprint.weights(unit.weight_bits);
        let mut sums = [128; 3];
        for (texel, weight) in footprint.texels.iter().flatten().zip(weights) {
            let texels = memories.iter().filter_map(|faces| faces.texel(*texel));
            let nearest = texels.min_by_key(|(_, depth)| *depth).map_or(0, |(colour, _)| colour);
            for (sum, shift) in sums.iter_mut().zip([16, 8, 0]) {
                *sum += (nearest >> shift & 0xFF) * weight;
            }
        }
        *pixel = sums.iter().fold(0, |pixel, sum| pixel << 8 | sum >> 8);
    }
}

fn read_once(memories: &[FaceSet]) -> u32 {
    let face = |faces: &FaceSet| {
        let size = faces.texels();
        let rows =
            (0..size).flat_map(|row| (0..size).map(move |column| TexelAddress { face: CubeFace::NegZ, column, row }));
        rows.filter_map(|texel| faces.texel(texel)).fold(0, |sum: u32, (colour, _)| sum.wrapping_add(colour))
    };
    memories.iter().map(face).fold(0, u32::wrapping_add)
}

fn field(c: &mut Criterion) {
    let config = ArpConfig::IDEAL;
    let table = config.table().expect("valid");
    let memories = memories(&config);
    let unit = AddressUnit::new(&config.timing);
    let matrix = orientation();
    let pixels = table.width() as usize * table.height() as usize;
    let fresh = || Lookup::new(&config, &table, memories.iter().collect(), None);
    let mut fast = vec![0; pixels];
    let mut slow = vec![0; pixels];
    fresh().run(0, &matrix, &mut fast);
    plain(&table, &unit, &matrix, &memories, &mut slow);
    assert!(fast == slow, "both show the same picture");
    let mut group = c.benchmark_group("field");
    group.sample_size(20).throughput(Throughput::Elements(pixels as u64));
    // Each field starts with an empty composition.
    group.bench_function("64 pixels at a time", |b| b.iter(|| fresh().run(0, black_box(&matrix), &mut fast)));
    group.bench_function("a plain loop", |b| {
        b.iter(|| plain(&table, &unit, black_box(&matrix), &memories, &mut slow));
    });
    group.bench_function("reading the texels once", |b| b.iter(|| read_once(black_box(&memories))));
    group.bench_function("table of the lens", |b| {
        b.iter_batched(|| config.clone(), |config| config.table(), BatchSize::LargeInput);
    });
    group.finish();
}

criterion_group!(benches, field);
criterion_main!(benches);
