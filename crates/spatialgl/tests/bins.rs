//! Tests of the numbered cases 12 and 21, which were computed by hand: vertex codes, sectors, slices drawn, and
//! fragments that bins without a tolerance lose.

use crate::support::*;
use spatialgl::*;

fn slices_drawn(triangle: Triangle, binning: Binning, tolerance: BinTolerance) -> u64 {
    let config = VolumeConfig { binning, bin_tolerance: tolerance, ..half(VolumeConfig::paper()) };
    volume(&swept(SliceClip::ShaderPlanes, Projection::Orthographic), &recording(&[triangle]), &config).stats.draws
}

#[test]
fn case_12_triangles_have_the_computed_codes_sectors_and_numbers_of_slices() {
    let layout = BinLayout::double_wedges(0.0);
    let cases = [
        (T1, [0b0001, 0b1111, 0b1011], 0b0000_1111, 198),
        (T2, [0b1111, 0b1111, 0b1111], 0b0000_0001, 50),
        (T5, [0b1111, 0b1110, 0b1011], 0b1000_0011, 149),
    ];
    for (triangle, codes, sectors, slices) in cases {
        assert_eq!(triangle.map(|corner| layout.code(corner)), codes);
        assert_eq!(layout.touched_regions(&triangle, BinTolerance::Codes), sectors);
        assert_eq!(slices_drawn(triangle, Binning::AllPlanes, BinTolerance::Codes), slices);
    }
}

#[test]
fn d9_each_double_wedge_bin_serves_50_slices() {
    let display = swept(SliceClip::ShaderPlanes, Projection::Orthographic);
    let views = &display.views()[..198];
    let served = [0, 1, 2, 3].map(|j| views.iter().filter(|view| view.bins >> j & 1 == 1).count());
    assert_eq!(served, [50; 4]);
    let straddling: Vec<usize> = (0..396).filter(|k| display.views()[*k].bins.count_ones() == 2).collect();
    assert_eq!(straddling, [0, 99, 198, 297]);
}

#[test]
fn two_bin_planes_exclude_fewer_slices_than_all_bin_planes() {
    for triangle in [T1, T2, T4, T5, T8] {
        let two = slices_drawn(triangle, Binning::TwoPlanes, BinTolerance::OfTheClip);
        let all = slices_drawn(triangle, Binning::AllPlanes, BinTolerance::OfTheClip);
        assert!(all <= two && two <= slices_drawn(triangle, Binning::Off, BinTolerance::OfTheClip));
    }
}

#[test]
fn case_21_dilated_clips_lose_fragments_without_a_tolerance() {
    let cases =
        [(T8, SliceClip::Hyperbolic(0.25), 476, 118, 100..=102), (T2, SliceClip::Prism, 110_101, 39_363, 195..=197)];
    for (triangle, clip, all, lost, slices) in cases {
        let display = swept(clip, Projection::Orthographic);
        let draw = |bin_tolerance| {
            let config = VolumeConfig { bin_tolerance, ..half(VolumeConfig::paper()) };
            volume(&display, &recording(&[triangle]), &config).stats
        };
        let plain = volume(&display, &recording(&[triangle]), &half(VolumeConfig::plain())).stats;
        let codes = draw(BinTolerance::Codes);
        let tolerant = draw(BinTolerance::OfTheClip);
        assert!(plain.fragments_accepted.abs_diff(all) <= 2, "{}", plain.fragments_accepted);
        assert_eq!(tolerant.fragments_accepted, plain.fragments_accepted);
        let missing = plain.fragments_accepted - codes.fragments_accepted;
        assert!(missing.abs_diff(lost) <= 2, "{missing}");
        for (k, (with, without)) in codes.slices.iter().zip(&plain.slices).enumerate() {
            assert!(with.accepted == without.accepted || slices.contains(&k), "slice {k}");
        }
    }
}
