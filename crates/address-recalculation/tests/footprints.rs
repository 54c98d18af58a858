//! Tests of the texels that a pixel reads: beyond edges and corners, in which banks, and in which regions of the faces.

use crate::support::{texels, turned};
use address_recalculation::{
    AddressUnit, ArpConfig, ArpTiming, CompositionOrder, CubeFace, DEPTH_FARTHEST, FaceGeometry, FaceSet, Footprint,
    Lookup, Orientation, ScanTiming, TexelAddress, Vector,
};
use glam::DQuat;
use pxpl5_sim::SplitMix64;
use std::collections::BTreeMap;

const SIZE: u32 = 128;
const BARE: ArpTiming = ArpTiming { face_texels: SIZE as u64, guard_texels: 0, ..ArpTiming::PAPERS };
const FACE: FaceGeometry = FaceGeometry { texels: SIZE, guard: 0 };

/// The distance of a face's plane from the eye, in units of directions. At this distance, words hold directions
/// exactly.
const ONE: i64 = 1 << 20;

/// Returns the texel of the cube in the direction of a position beside a face, computed in floating point.
fn neighbour(face: CubeFace, column: f64, row: f64) -> Option<TexelAddress> {
    let [u, v] = [column, row].map(|n| (2.0 * n + 1.0) / f64::from(SIZE) - 1.0);
    let (forward, right, up) = (face.forward(), face.right(), face.up());
    FACE.texel([0, 1, 2].map(|i| forward[i] as f64 + u * right[i] as f64 - v * up[i] as f64))
}

/// Returns the footprint (the four texels and their weights) of a position on a face. `right` and `down` are distances
/// from the middle, in units of 1/[`ONE`].
fn footprint(face: CubeFace, right: i64, down: i64) -> Footprint {
    let axes = [face.forward(), face.right(), face.up()];
    let direction = [0, 1, 2].map(|i| ONE * axes[0][i] + right * axes[1][i] - down * axes[2][i]);
    AddressUnit::new(&BARE).footprint(direction).expect("a direction")
}

/// Returns the middle of a row or column, in units of 1/[`ONE`] from the middle of the face.
const fn middle(n: u32) -> i64 {
    (2 * n as i64 + 1 - SIZE as i64) * ONE / SIZE as i64
}

#[test]
fn texels_beyond_an_edge_belong_to_the_neighbouring_face() {
    let edge = f64::from(SIZE);
    for face in CubeFace::ALL {
        for n in 1..SIZE - 2 {
            let along = middle(n) + 5;
            let near = f64::from(n);
            for (right, down, beyond) in [
                (ONE - 1, along, [(1, edge, near), (3, edge, near + 1.0)]),
                (1 - ONE, along, [(0, -1.0, near), (2, -1.0, near + 1.0)]),
                (along, ONE - 1, [(2, near, edge), (3, near + 1.0, edge)]),
                (along, 1 - ONE, [(0, near, -1.0), (1, near + 1.0, -1.0)]),
            ] {
                let found = footprint(face, right, down);
                assert!(found.is_split, "{face:?} {right} {down}");
                for (k, texel) in found.texels.into_iter().enumerate() {
                    match beyond.iter().find(|(place, ..)| *place == k) {
                        Some((_, column, row)) => {
                            assert_eq!(texel, neighbour(face, *column, *row), "{face:?} {right} {down}")
                        }
                        None => assert_eq!(texel.map(|texel| texel.face), Some(face), "{face:?} {right} {down}"),
                    }
                }
            }
        }
    }
}

/// Checks corners, where three faces meet. One of the four texels around a corner lies on no face.
#[test]
fn at_a_corner_the_two_adjacent_texels_are_neighbours_and_the_diagonal_texel_does_not_exist() {
    let (first, last) = (-1.0, f64::from(SIZE));
    for face in CubeFace::ALL {
        for (right, down, none) in
            [(1 - ONE, 1 - ONE, 0), (ONE - 1, 1 - ONE, 1), (1 - ONE, ONE - 1, 2), (ONE - 1, ONE - 1, 3)]
        {
            let column = if right > 0 { last } else { first };
            let row = if down > 0 { last } else { first };
            let inside = [column, row].map(|n| n.clamp(0.0, last - 1.0));
            let mut expected = [None; 4];
            expected[none ^ 1] = neighbour(face, inside[0], row);
            expected[none ^ 2] = neighbour(face, column, inside[1]);
            expected[none ^ 3] = Some(TexelAddress { face, column: inside[0] as u32, row: inside[1] as u32 });
            let found = footprint(face, right, down);
            assert_eq!(found.texels, expected, "{face:?} {right} {down}");
            let faces: Vec<CubeFace> = found.texels.iter().flatten().map(|texel| texel.face).collect();
            assert!(faces[0] != faces[1] && faces[1] != faces[2] && faces[0] != faces[2], "{faces:?}");
        }
    }
}

/// Checks second accesses. A bank holds the texels with one parity of column and row. Two different texels of a
/// footprint in one bank need two accesses.
#[test]
fn two_texels_of_a_footprint_in_the_same_bank_need_a_second_access() {
    let mut random = SplitMix64::new(7);
    let mut met = [0; 2];
    for face in CubeFace::ALL {
        for _ in 0..2_000 {
            let along = (random.bits() % (2 * ONE as u64)) as i64 - ONE;
            let [right, down] = if random.bits() & 1 == 0 { [ONE - 1, along] } else { [along, 1 - ONE] };
            let found = footprint(face, right, down);
            let mut texels: Vec<TexelAddress> = found.texels.into_iter().flatten().collect();
            texels.sort();
            texels.dedup();
            let mut parities: Vec<[u32; 2]> = texels.iter().map(|texel| [texel.column % 2, texel.row % 2]).collect();
            parities.sort_unstable();
            let of_all = parities.len();
            parities.dedup();
            if texels.len() == found.texels.iter().flatten().count() {
                let is_twice = parities.len() < of_all;
                assert_eq!(found.has_conflict(), is_twice, "{found:?}");
                met[usize::from(is_twice)] += 1;
            }
        }
    }
    assert!(met.iter().all(|count| *count > 100), "{met:?} without and with a second access");
    let inside = footprint(CubeFace::NegY, 12_345, -54_321);
    assert!(!inside.has_conflict() && !inside.is_split);
    let nearest = AddressUnit::new(&ArpTiming { weight_bits: 0, ..BARE }).footprint([3, 4, 5]).expect("a direction");
    assert!(!nearest.has_conflict(), "the nearest texel is read once");
}

#[test]
fn drawing_into_faces_keeps_the_nearer_pixel_and_at_equal_depth_the_first_pixel() {
    let config = ArpConfig { timing: BARE, ..ArpConfig::MACHINE };
    let mut faces = FaceSet::new(SIZE, config.format());
    let mut expected: BTreeMap<TexelAddress, (u32, u32)> = BTreeMap::new();
    let mut random = SplitMix64::new(3);
    for _ in 0..4_000 {
        let count = 1 + random.below(9) as u32;
        let first = TexelAddress {
            face: CubeFace::ALL[random.below(6) as usize],
            column: if random.bits() & 1 == 0 { SIZE - count } else { random.below(20) as u32 },
            row: random.below(4) as u32,
        };
        let colours: Vec<u32> = (0..count).map(|_| random.bits() as u32 & 0xFF_FFFF).collect();
        let depths: Vec<u32> =
            (0..count).map(|_| [DEPTH_FARTHEST, 0, 1, 2, 3, 0xFF_FFFE][random.below(6) as usize]).collect();
        faces.keep_nearer(first, &colours, &depths);
        for ((column, colour), depth) in (first.column..).zip(&colours).zip(&depths) {
            let there = expected.entry(TexelAddress { column, ..first }).or_insert((0, DEPTH_FARTHEST));
            if *depth < there.1 {
                *there = (*colour, *depth);
            }
        }
    }
    for texel in texels(SIZE) {
        let there = expected.get(&texel).copied().filter(|(_, depth)| *depth < DEPTH_FARTHEST);
        assert_eq!(faces.texel(texel), there, "{texel:?}");
    }
}

/// Checks a pixel with three texels around a corner. Their mean colour is rounded to the nearest, and the mean nearness
/// is rounded down.
#[test]
fn a_corner_shows_the_mean_colour_of_its_three_texels_in_either_order_of_composition() {
    let corner = footprint(CubeFace::NegZ, ONE - 1, 1 - ONE);
    let [a, b, c] = [0, 2, 3].map(|k| corner.texels[k].expect("on a face"));
    for (order, depths, expected) in [
        // The mean of 10, 20 and 31 is 20.33.
        (0, [[5, 5, 5], [9, 9, 9]], 20),
        // The nearest texels are 10, 20 and 93, whose mean is 41.
        (0, [[5, 5, 9], [9, 9, 5]], 41),
        // The depths 5, 5 and 9 have the nearer mean.
        (1, [[5, 5, 9], [9, 9, 5]], 20),
        // A mean depth of 5.33 counts as 6. The mean of 30, 62 and 93 is 61.67.
        (1, [[5, 5, 6], [5, 5, 5]], 62),
        // The mean depths 5.67 and 5.33 both count as 6, so the first memory wins.
        (1, [[5, 6, 6], [5, 5, 6]], 20),
        // Both mean depths are 5.33, so the first memory wins.
        (1, [[5, 5, 6], [5, 6, 5]], 20),
    ] {
        let timing = ArpTiming { display_memories: 2, ..BARE };
        let order = CompositionOrder::ALL[order].1;
        let scan = ScanTiming { visible_pixels: 1, visible_lines: 1, ..ScanTiming::PAPERS };
        let config = ArpConfig { timing, order, scan, ..ArpConfig::MACHINE };
        let memories = [[10, 20, 31], [30, 62, 93]].into_iter().zip(depths).map(|(colours, depths)| {
            let mut faces = FaceSet::new(SIZE, config.format());
            [a, b, c]
                .iter()
                .zip(colours)
                .zip(depths)
                .for_each(|((texel, colour), depth)| faces.set(*texel, colour, depth));
            faces
        });
        let memories: Vec<FaceSet> = memories.collect();
        let table = config.table().expect("valid");
        // Both pixels of this picture (one column, two lines) look almost straight ahead. The rotation of the head
        // turns the pixels towards the corner.
        let towards = corner_turn(table.entry(0, 0));
        let mut pixel = [0];
        Lookup::new(&config, &table, memories.iter().collect(), None).run(0, &towards.words(16), &mut pixel);
        assert_eq!(pixel[0], expected, "{order:?} {depths:?}");
    }
}

/// Returns the orientation that rotates a viewing vector to slightly inside the upper right corner of the front face.
fn corner_turn(vector: [i32; 3]) -> Orientation {
    let from = glam::DVec3::from_array(vector.map(f64::from)).normalize();
    let to = glam::DVec3::new(0.9995, 0.9995, -1.0).normalize();
    turned(DQuat::from_rotation_arc(from, to))
}

#[test]
fn faces_are_numbered_in_the_order_of_the_buffer() {
    let axes: Vec<[i64; 3]> = CubeFace::ALL.into_iter().map(CubeFace::forward).collect();
    assert_eq!(axes, [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]);
    for (number, face) in CubeFace::ALL.into_iter().enumerate() {
        assert_eq!(face.index(), number);
        let first = TexelAddress { face, column: 0, row: 0 };
        assert_eq!(first.index(SIZE), number * (SIZE * SIZE) as usize);
        let seen: Vector = face.forward().map(|axis| axis as f64);
        assert_eq!(CubeFace::of(seen), Some(face));
    }
}
