//! Tests of the numbered cases 13 to 20 and 25, computed by hand: fragments of every clip variant, by the reference
//! model and by the fast rasterizer.

use crate::support::*;
use spatialgl::*;

const ORTHOGRAPHIC: Projection = Projection::Orthographic;
const EXACT: SliceClip = SliceClip::ShaderPlanes;
const HYPERBOLA: SliceClip = SliceClip::Hyperbolic(0.25);

/// Checks that two numbers of fragments are equal within a tolerance. The tolerance allows for other orders of the same
/// sums in double precision.
fn same(found: u64, expected: u64, what: &str) {
    assert!(found.abs_diff(expected) <= 2, "{what}: {found}, not {expected}");
}

/// Compares two clips with the reference model too. `PXPL5_ALL_CASES=1` compares all of them.
fn check(name: &str, triangle: Triangle, expected: [(u64, u64); 5]) {
    let all = std::env::var_os("PXPL5_ALL_CASES").is_some();
    let clips = [EXACT, SliceClip::Prism, SliceClip::Parallel(0.5), HYPERBOLA, SliceClip::Tapered(0.5)];
    for (clip, (count, slices)) in clips.into_iter().zip(expected) {
        let display = swept(clip, ORTHOGRAPHIC);
        let draw = if all || [EXACT, HYPERBOLA].contains(&clip) { both } else { volume };
        let stats = draw(&display, &recording(&[triangle]), &half(VolumeConfig::plain())).stats;
        same(stats.fragments_accepted, count, &format!("{name} {clip:?}"));
        assert_eq!(stats.slices_rendered - stats.slices_empty, slices, "slices of {name} {clip:?}");
    }
}

#[test]
fn case_13_a_wall_off_the_axis_has_the_computed_fragments_for_each_clip() {
    check("T1", T1, [(50_066, 108), (240_867, 164), (88_976, 140), (65_331, 130), (83_457, 140)]);
}

#[test]
fn case_13_a_triangle_in_the_plane_of_a_slice_has_the_computed_fragments_for_each_clip() {
    check("T2", T2, [(31_375, 1), (110_101, 7), (37_719, 3), (31_375, 1), (33_363, 3)]);
}

#[test]
fn case_13_a_triangle_across_the_axis_has_the_computed_fragments_for_each_clip() {
    check("T4", T4, [(16_656, 192), (242_377, 198), (55_013, 198), (43_272, 198), (52_239, 198)]);
}

#[test]
fn case_13_a_sliver_beside_the_axis_has_the_computed_fragments_for_each_clip() {
    check("T5", T5, [(234, 68), (15_558, 130), (2_454, 84), (2_235, 84), (2_413, 84)]);
}

#[test]
fn case_14_a_wall_has_the_computed_fragments_in_single_slices() {
    for (clip, expected) in [(EXACT, [209, 282, 0, 342, 0]), (HYPERBOLA, [237, 282, 318, 342, 0])] {
        let frame = both(&swept(clip, ORTHOGRAPHIC), &recording(&[T1]), &half(VolumeConfig::plain()));
        for (slice, expected) in [13, 50, 70, 90, 99].into_iter().zip(expected) {
            same(frame.stats.slices[slice].accepted, expected, &format!("{clip:?} {slice}"));
        }
    }
}

#[test]
fn case_15_a_triangle_in_a_boundary_plane_is_in_one_slice() {
    let triangle = [[50.0, -100.2, 50.0], [200.3, -100.2, 200.3], [50.0, 120.4, 50.0]];
    for (clip, expected) in [(EXACT, [0, 23_338, 0]), (HYPERBOLA, [23_338, 23_338, 0])] {
        let frame = both(&swept(clip, ORTHOGRAPHIC), &recording(&[triangle]), &half(VolumeConfig::plain()));
        for (slice, expected) in [49, 50, 51].into_iter().zip(expected) {
            same(frame.stats.slices[slice].accepted, expected, &format!("{clip:?} {slice}"));
        }
        same(frame.stats.fragments_accepted, expected.iter().sum(), "all slices");
    }
}

/// Checks a triangle that lies in a bin plane. The half-open rule assigns the triangle of case 15 to slice 50 alone,
/// whose bin is on the other side of the diagonal plane. Bins must therefore count such a triangle on both sides, even
/// if the clip enlarges nothing.
#[test]
fn bins_keep_a_triangle_in_a_bin_plane() {
    let triangle = [[50.0, -100.2, 50.0], [200.3, -100.2, 200.3], [50.0, 120.4, 50.0]];
    let display = swept(EXACT, ORTHOGRAPHIC);
    let binned = volume(&display, &recording(&[triangle]), &half(VolumeConfig::paper()));
    same(binned.stats.fragments_accepted, 23_338, "with bins");
    let codes = VolumeConfig { bin_tolerance: BinTolerance::Codes, ..half(VolumeConfig::paper()) };
    let lost = volume(&display, &recording(&[triangle]), &codes);
    assert_eq!(lost.stats.fragments_accepted, 0, "the paper's codes give it to slices 0 to 49 alone");
}

#[test]
fn case_16_a_triangle_with_an_edge_on_the_axis_has_the_computed_fragments() {
    let triangle = [[0.0, -100.2, 0.0], [0.0, 100.3, 0.0], [200.4, 0.1, 10.0]];
    let (count, slices) = fragments(&[triangle], EXACT, ORTHOGRAPHIC);
    same(count, 20_100, "exact");
    assert_eq!(slices, 1);
    let (count, slices) = fragments(&[triangle], HYPERBOLA, ORTHOGRAPHIC);
    same(count, 78_304, "hyperbola");
    assert_eq!(slices, 99);
}

#[test]
fn case_17_a_triangle_over_the_rim_has_256_fragments_for_every_clip() {
    let triangle = [[380.2, -30.2, 1.0], [400.7, -30.2, 1.0], [380.2, 40.3, 1.0]];
    for clip in SliceClip::ALL {
        let frame = volume(&swept(clip, ORTHOGRAPHIC), &recording(&[triangle]), &counting());
        same(frame.stats.fragments_accepted, 256, &format!("{clip:?}"));
        assert_eq!(frame.stats.slices[0].accepted, frame.stats.fragments_accepted);
        assert_eq!(frame.stats.outside_volume, 1);
    }
}

#[test]
fn case_18_a_floor_is_lost_if_the_eye_is_not_moved_aside() {
    assert_eq!(fragments(&[T3], HYPERBOLA, ORTHOGRAPHIC), (0, 0));
    let (count, slices) = fragments(&[T3], HYPERBOLA, ASIDE);
    same(count, 4_554, "hyperbola");
    assert_eq!(slices, 120);
}

#[test]
fn case_19_a_triangle_seen_from_the_side_has_the_computed_fragments() {
    same(fragments(&[T4], EXACT, ASIDE).0, 16_865, "exact");
    same(fragments(&[T4], HYPERBOLA, ASIDE).0, 43_680, "hyperbola");
}

#[test]
fn case_20_a_quad_has_the_same_fragments_with_either_diagonal() {
    let [a, b, c, d] = [[-150.2, -80.1, 60.3], [140.7, -80.1, 20.6], [140.7, 90.4, 20.6], [-150.2, 90.4, 60.3]];
    for (clip, expected) in [(EXACT, 38_420), (SliceClip::Prism, 177_820), (HYPERBOLA, 48_790)] {
        let one = fragments(&[[a, b, c], [a, c, d]], clip, ORTHOGRAPHIC).0;
        let other = fragments(&[[a, b, d], [b, c, d]], clip, ORTHOGRAPHIC).0;
        same(one, expected, &format!("{clip:?}"));
        same(other, expected, &format!("{clip:?} by the other diagonal"));
    }
}

#[test]
fn case_25_a_wall_occupies_the_computed_number_of_tiles() {
    for (clip, single, batched) in [(EXACT, 1_810, 774), (HYPERBOLA, 2_238, 798)] {
        for (batch, expected) in [(1, single), (4, batched)] {
            let tiling = Tiling { tile: Some(32), batch };
            let config = VolumeConfig { tiling, ..VolumeConfig::paper() };
            let stats = volume(&swept(clip, ORTHOGRAPHIC), &recording(&[T1]), &config).stats;
            assert_eq!(stats.tiles_occupied, expected, "{clip:?} by {batch}");
            assert_eq!(stats.queries, 576 * 396 / u64::from(batch));
            assert_eq!(stats.bytes_sent, stats.tiles_occupied * 512 * u64::from(batch) + 396 / u64::from(batch) * 72);
        }
    }
}

/// Checks figure P5: the number of times that the commands are replayed for a slice.
#[test]
fn the_number_of_passes_is_as_published() {
    let passes = |clip| {
        let stats = volume(&swept(clip, ORTHOGRAPHIC), &recording(&[T5]), &counting()).stats;
        assert_eq!(stats.draws, 198 * stats.passes);
        stats.passes
    };
    assert_eq!(SliceClip::ALL.map(passes), [1, 2, 1, 2, 1, 1]);
}

/// Checks the number of generated fragments. Clip variants with one pass generate every fragment between the near and
/// far planes. Clip planes generate only accepted fragments.
#[test]
fn plane_clips_accept_all_generated_fragments() {
    let stats = |clip| volume(&swept(clip, ORTHOGRAPHIC), &recording(&[T1]), &counting()).stats;
    let prism = stats(SliceClip::Prism);
    assert_eq!(prism.fragments_generated, prism.fragments_accepted);
    assert_eq!(stats(EXACT).fragments_generated, prism.fragments_accepted);
    for clip in [SliceClip::UserPlanes, SliceClip::Tapered(0.5)].map(stats) {
        assert_eq!(clip.fragments_generated, clip.fragments_accepted);
    }
}
