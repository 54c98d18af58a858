//! Tests of the arithmetic below the drawing: packed words, the quadratic of a clip, exact angles, and halftones.

use proptest::prelude::*;
use spatialgl::*;

proptest! {
    #[test]
    fn dense_words_have_ten_pixels_of_three_bits(pixels in prop::collection::vec(0u8..8, 0..64)) {
        let words = pack_dense(&pixels);
        prop_assert_eq!(words.len(), pixels.len().div_ceil(10));
        for (i, pixel) in pixels.iter().enumerate() {
            prop_assert_eq!(words[i / 10] >> (3 * (i % 10)) & 7, u32::from(*pixel));
        }
    }

    #[test]
    fn a_word_is_unpacked_to_its_pixels(pixels: [u8; 8]) {
        let byte = |channel: u32| (0..8).fold(0, |byte, i| byte << 1 | (pixels[i] >> channel & 1));
        let word = packed_word(byte(0), byte(1), byte(2));
        for i in 0..8 {
            prop_assert_eq!(pixel_of_word(word, i), pixels[i as usize] & 7);
        }
    }
}

const WEDGE: fn() -> HalfWedge = || HalfWedge::new(396, 384.0);

#[test]
fn case_27_the_quadratic_of_a_plane_has_the_computed_coefficients_and_values() {
    let q = ClipQuadratic::of_plane([0.5, -0.25], -20.0, WEDGE(), 0.25);
    let expected = [-0.2499213, 0.2499843, -0.0624961, 19.9987413, -9.9993706, -399.7248255];
    for (found, expected) in [q.uu, q.uv, q.vv, q.u, q.v, q.one].into_iter().zip(expected) {
        assert!((found - expected).abs() < 6e-8, "{found}, not {expected}");
    }
    for (u, v, expected) in [(40.0, 0.0, 0.350_698), (39.0, -4.0, 0.095_742), (-200.0, -480.0, 2.767_447)] {
        assert!((q.at(u, v) - expected).abs() < 6e-7, "({u}, {v}): {}", q.at(u, v));
    }
}

/// Tests the number of fraction bits of the coefficients. S is the sine of half the angle between slices. With the
/// 16 fraction bits of the renderers' format, S^2 would be 4 units, which is too coarse. With 26 bits, S^2 is 4,224
/// units, and the quadratic fits into 48 bits.
#[test]
fn a_quadratic_with_26_fraction_bits_fits_into_48_bits_and_16_fraction_bits_are_too_coarse() {
    let square = WEDGE().sin * WEDGE().sin;
    assert!((square * f64::from(1 << 16) - 4.12).abs() < 0.01);
    assert!((square * f64::from(1 << 26) - 4_223.6).abs() < 0.1);
    assert!(768.0 * 768.0 * f64::from(1 << 26) < 2f64.powi(46));
}

proptest! {
    #[test]
    fn a_quadratic_has_the_sign_of_the_biased_product(
        corners in prop::array::uniform3(prop::array::uniform3(-300.0f64..300.0)),
        u in -384.0f64..384.0, v in -384.0f64..384.0, bias in 0.0f64..4.0,
    ) {
        let Some(q) = ClipQuadratic::of_corners(corners, WEDGE(), bias) else { return Ok(()) };
        let wedge = WEDGE();
        let [first, second, third] = corners;
        let weight = |p: [f64; 3], r: [f64; 3]| (p[0] - u) * (r[1] - v) - (p[1] - v) * (r[0] - u);
        let weights = [weight(second, third), weight(third, first), weight(first, second)];
        let area: f64 = weights.iter().sum();
        prop_assume!(area.abs() > 100.0);
        let s = (weights[0] * first[2] + weights[1] * second[2] + weights[2] * third[2]) / area;
        let a = u * wedge.sin + s * wedge.cos;
        let b = u * wedge.sin - s * wedge.cos;
        prop_assume!((a * b + bias).abs() > 1e-6 * (1.0 + s * s));
        prop_assert_eq!(q.at(u, v) >= 0.0, a * b + bias >= 0.0);
    }
}

#[test]
fn sine_and_cosine_of_quarter_turns_and_eighth_turns_are_exact() {
    assert_eq!(sin_cos_of_turn(0, 4), (0.0, 1.0));
    assert_eq!(sin_cos_of_turn(1, 4), (1.0, 0.0));
    assert_eq!(sin_cos_of_turn(2, 4), (0.0, -1.0));
    assert_eq!(sin_cos_of_turn(-1, 4), (-1.0, 0.0));
    let (s, c) = sin_cos_of_turn(99, 792);
    assert_eq!(s.to_bits(), c.to_bits());
}

proptest! {
    #[test]
    fn half_a_turn_changes_only_the_signs_of_sine_and_cosine(n in -5000i64..5000, half in 2u32..1000) {
        let (s, c) = sin_cos_of_turn(n, 2 * half);
        let (t, d) = sin_cos_of_turn(n + i64::from(half), 2 * half);
        prop_assert_eq!((t, d), (-s, -c));
    }

    #[test]
    fn the_functions_of_a_fraction_of_a_turn_approximate_sine_and_cosine(n in -5000i64..5000, whole in 1u32..2000) {
        let (s, c) = sin_cos_of_turn(n, whole);
        let angle = std::f64::consts::TAU * n as f64 / f64::from(whole);
        prop_assert!((s - angle.sin()).abs() < 1e-11 && (c - angle.cos()).abs() < 1e-11);
    }
}

fn thresholds(size: u32) -> Vec<u8> {
    let halftone = Halftone::bayer(size).expect("a size");
    (0..size).flat_map(|y| (0..size).map(move |x| (x, y))).map(|(x, y)| halftone.threshold(x, y)).collect()
}

#[test]
fn the_first_rows_of_the_halftone_matrix_equal_bayers_matrix() {
    // The number of smaller thresholds is the element of the matrix.
    let all = thresholds(8);
    let element = |threshold: &u8| all.iter().filter(|other| *other < threshold).count();
    let found: Vec<usize> = all[..16].iter().map(element).collect();
    assert_eq!(found, [0, 32, 8, 40, 2, 34, 10, 42, 48, 16, 56, 24, 50, 18, 58, 26]);
}

#[test]
fn a_colour_value_lights_the_stated_number_of_64_pixels() {
    let counts = [0u8, 1, 2, 64, 127, 128, 200, 253, 254, 255]
        .map(|c| thresholds(8).iter().filter(|threshold| c > **threshold).count());
    assert_eq!(counts, [0, 0, 1, 16, 32, 32, 50, 63, 64, 64]);
}

#[test]
fn a_halftone_matrix_of_any_size_lights_the_rounded_fraction_of_its_pixels() {
    for size in [2u32, 4, 8, 16] {
        for c in 0..=255u8 {
            let lit = thresholds(size).iter().filter(|threshold| c > **threshold).count();
            let share = f64::from(size * size) * f64::from(c) / 255.0;
            assert!((lit as f64 - share).abs() <= 0.5 + 1e-9 + share * 0.01, "{size} {c}: {lit} of {share}");
        }
    }
}
