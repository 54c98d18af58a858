//! Tests that the fast model and the reference model give identical bits for all word lengths, faces and contents.

use crate::support::{noise, texels, turned};
use address_recalculation::reference::{BankedMemory, ReferencePipeline};
use address_recalculation::{
    ArpConfig, ArpTiming, CompositionOrder, FaceSet, Lens, Lookup, Orientation, ScanTiming, Vector,
};
use glam::DQuat;
use proptest::prelude::*;
use pxpl5_sim::SplitMix64;

/// A scan of 31 x 14 pixels, whose lines are not a multiple of eight pixels.
const SMALL: ScanTiming = ScanTiming { visible_pixels: 31, visible_lines: 7, ..ScanTiming::PAPERS };

fn by_lookup(
    config: &ArpConfig,
    orientation: &Orientation,
    memories: &[FaceSet],
    behind: Option<&FaceSet>,
) -> (Vec<u32>, [u64; 2]) {
    let table = config.table().expect("valid");
    let mut lookup = Lookup::new(config, &table, memories.iter().collect(), behind);
    let mut pixels = vec![0; 31 * 14];
    let stats = lookup.run(0, &orientation.words(config.timing.matrix_bits), &mut pixels);
    (pixels, [stats.split, stats.conflicts])
}

/// Passes every pixel through all stages of the reference model, one stage per clock.
fn by_registers(
    config: &ArpConfig,
    orientation: &Orientation,
    memories: &[FaceSet],
    behind: Option<&FaceSet>,
) -> (Vec<u32>, [u64; 2]) {
    let banks: Vec<BankedMemory> = memories.iter().map(BankedMemory::of).collect();
    let behind = behind.map(BankedMemory::of);
    let mut pipeline = ReferencePipeline::new(config, config.table().expect("valid"));
    assert_eq!(pipeline.stages() as u64, config.timing.stages());
    let matrix = orientation.words(config.timing.matrix_bits);
    let mut pixels = vec![0; 31 * 14];
    let mut stats = [0; 2];
    for clock in 0..pixels.len() + pipeline.stages() - 1 {
        let entering = (clock < pixels.len()).then_some(([clock as u32 % 31, clock as u32 / 31], matrix));
        let lit = pipeline.clock(entering, &banks, behind.as_ref());
        assert_eq!(lit.is_some(), clock + 1 >= pipeline.stages(), "clock {clock}");
        if let Some(lit) = lit {
            let place = clock + 1 - pipeline.stages();
            assert_eq!(lit.pixel, [place as u32 % 31, place as u32 / 31]);
            pixels[place] = lit.colour;
            stats[0] += u64::from(lit.footprint.is_split);
            stats[1] += u64::from(lit.footprint.has_conflict());
        }
    }
    (pixels, stats)
}

fn check(config: &ArpConfig, orientation: &Orientation, seed: u64) {
    config.check().expect("valid");
    let mut random = SplitMix64::new(seed);
    let memories: Vec<FaceSet> = (0..config.timing.display_memories).map(|_| noise(config, &mut random)).collect();
    let behind = config.has_background_memory.then(|| noise(config, &mut random));
    compare(config, orientation, &memories, behind.as_ref());
}

fn compare(config: &ArpConfig, orientation: &Orientation, memories: &[FaceSet], behind: Option<&FaceSet>) {
    let fast = by_lookup(config, orientation, memories, behind);
    let reference = by_registers(config, orientation, memories, behind);
    assert_eq!(fast, reference, "{config:?} {orientation:?}");
}

/// Returns a strategy for random word lengths within the limits of the parameter table.
fn words() -> impl Strategy<Value = ArpTiming> {
    let bits = (8_u64..=24, 8_u64..=24, 8_u64..=20, 0_u64..=8);
    let usual = Just((16, 16, 16, 4));
    (prop_oneof![usual, bits], 1_u64..=8, 0_u64..=8, any::<bool>(), any::<bool>()).prop_map(
        |((vector_bits, matrix_bits, quotient_bits, weight_bits), display_memories, guard_texels, narrow, shallow)| {
            ArpTiming {
                display_memories,
                face_texels: 128,
                guard_texels,
                vector_bits,
                matrix_bits,
                quotient_bits,
                weight_bits,
                depth_bits: if shallow { 16 } else { 24 },
                colour_bits: if narrow { 16 } else { 24 },
                ..ArpTiming::PAPERS
            }
        },
    )
}

fn config() -> impl Strategy<Value = ArpConfig> {
    let lens = prop_oneof![
        (1.0..170.0_f64).prop_map(|angle| (Lens::Flat, angle)),
        (0.0..1.0_f64, 20.0..120.0_f64).prop_map(|(k1, angle)| (Lens::Radial { k1, k2: 0.01 }, angle)),
        (100.0..=360.0_f64).prop_map(|angle| (Lens::Equidistant, angle)),
    ];
    (words(), lens, any::<bool>(), any::<bool>(), 0_u32..0x100_0000).prop_map(
        |(timing, (lens, horizontal_deg), mixed_first, has_background_memory, background)| ArpConfig {
            timing: ArpTiming { horizontal_deg, ..timing },
            scan: SMALL,
            lens,
            order: CompositionOrder::ALL[usize::from(mixed_first)].1,
            background,
            has_background_memory,
            ..ArpConfig::MACHINE
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn the_fast_model_equals_the_register_model_bit_for_bit(
        config in config(),
        axes in prop::array::uniform4(-1.0..1.0_f64),
        seed in any::<u64>(),
    ) {
        prop_assume!(axes.iter().map(|a| a * a).sum::<f64>() > 1e-3);
        check(&config, &Orientation::from_quaternion(axes).expect("a rotation"), seed);
    }
}

/// Checks rotations by multiples of 45 degrees, which bring edges and corners of faces into the picture.
#[test]
fn fast_and_register_models_agree_where_faces_meet() {
    for guard_texels in [0, 1] {
        let timing = ArpTiming { face_texels: 128, guard_texels, horizontal_deg: 3.0, ..ArpTiming::PAPERS };
        let config = ArpConfig { timing, scan: SMALL, ..ArpConfig::MACHINE };
        for n in 0..64 {
            let yaw = DQuat::from_rotation_y(f64::from(n % 8).mul_add(45.0, 0.0).to_radians());
            let corner = (1.0 / 2_f64.sqrt()).atan();
            let pitch = [0.0, corner, -corner, 0.25 * std::f64::consts::PI][n as usize / 8 % 4];
            check(&config, &turned(yaw * DQuat::from_rotation_x(pitch)), u64::from(n as u32));
        }
    }
}

/// Checks depths that differ by one and whose means are rounded: near an edge, in a corner of three texels, and inside
/// a face.
#[test]
fn fast_and_register_models_agree_on_depths_that_differ_by_one() {
    let corner = (1.0 / 2_f64.sqrt()).atan();
    for (order, guard_texels) in CompositionOrder::ALL.into_iter().flat_map(|(_, order)| [(order, 0), (order, 1)]) {
        let timing =
            ArpTiming { face_texels: 128, guard_texels, display_memories: 3, horizontal_deg: 3.0, ..ArpTiming::PAPERS };
        let config = ArpConfig { timing, scan: SMALL, order, ..ArpConfig::MACHINE };
        for (seed, pitch) in (0..12).zip([0.0, corner, -corner].into_iter().cycle()) {
            let mut random = SplitMix64::new(seed);
            let mut any = || {
                let mut faces = FaceSet::new(128, config.format());
                texels(128).for_each(|texel| {
                    let bits = random.bits();
                    faces.set(texel, bits as u32 & 0xFF_FFFF, 500 + (bits >> 63) as u32);
                });
                faces
            };
            let memories = [any(), any(), any()];
            let turn = DQuat::from_rotation_y(45_f64.to_radians()) * DQuat::from_rotation_x(pitch);
            compare(&config, &turned(turn), &memories, None);
        }
    }
}

/// Checks directions on edges, whose two or three longest components are equal. A quotient there is 0 or 1, and 1 does
/// not fit into its word.
#[test]
fn fast_and_register_models_agree_on_directions_shared_by_faces() {
    let all = (0..27).map(|n| [n % 3, n / 3 % 3, n / 9].map(|digit| f64::from(digit) - 1.0));
    let shared: Vec<Vector> = all.filter(|vector| *vector != [0.0; 3]).collect();
    let lens = Lens::Table(shared.iter().copied().cycle().take(31 * 14).collect());
    for (quotient_bits, weight_bits) in [(8, 8), (8, 4), (16, 4), (8, 0)] {
        for guard_texels in [0, 1] {
            let timing = ArpTiming { face_texels: 128, guard_texels, quotient_bits, weight_bits, ..ArpTiming::PAPERS };
            let config = ArpConfig { timing, scan: SMALL, lens: lens.clone(), ..ArpConfig::MACHINE };
            check(&config, &Orientation::IDENTITY, quotient_bits + guard_texels);
        }
    }
}

/// Checks footprints in corners. Without guard texels such a footprint has texels on several faces. With guard texels
/// none has.
#[test]
fn split_footprints_occur_only_without_guard_texels() {
    let corner =
        turned(DQuat::from_rotation_y(45_f64.to_radians()) * DQuat::from_rotation_x((1.0 / 2_f64.sqrt()).atan()));
    let counts = [0, 1].map(|guard_texels| {
        let timing = ArpTiming { face_texels: 128, guard_texels, horizontal_deg: 10.0, ..ArpTiming::PAPERS };
        let config = ArpConfig { timing, scan: SMALL, ..ArpConfig::MACHINE };
        let faces: Vec<FaceSet> = (0..4).map(|seed| noise(&config, &mut SplitMix64::new(seed))).collect();
        by_lookup(&config, &corner, &faces, None).1
    });
    assert!(counts[0][0] > 0 && counts[0][1] > 0 && counts[0][1] <= counts[0][0], "{counts:?}");
    assert_eq!(counts[1], [0, 0]);
}

/// Checks all numbers of consecutive pixels with one orientation. Few pixels are computed one by one, more pixels in
/// groups.
#[test]
fn a_picture_is_the_same_in_runs_of_any_length() {
    for guard_texels in [0, 1] {
        let timing = ArpTiming { face_texels: 128, guard_texels, ..ArpTiming::PAPERS };
        let config = ArpConfig { timing, scan: SMALL, ..ArpConfig::MACHINE };
        let faces: Vec<FaceSet> = (0..4).map(|seed| noise(&config, &mut SplitMix64::new(seed))).collect();
        let orientation = turned(DQuat::from_rotation_y(0.7) * DQuat::from_rotation_x(0.6));
        let (whole, stats) = by_lookup(&config, &orientation, &faces, None);
        let table = config.table().expect("valid");
        for length in [1, 2, 3, 4, 5, 8, 63, 64, 65, 129] {
            let mut lookup = Lookup::new(&config, &table, faces.iter().collect(), None);
            let mut pixels = vec![0; whole.len()];
            let mut found = [0; 2];
            for (run, out) in pixels.chunks_mut(length).enumerate() {
                let stats = lookup.run(run * length, &orientation.words(config.timing.matrix_bits), out);
                found = [found[0] + stats.split, found[1] + stats.conflicts];
            }
            assert!(pixels == whole, "runs of {length}, guard {guard_texels}");
            assert_eq!(found, stats, "runs of {length}");
        }
    }
}
