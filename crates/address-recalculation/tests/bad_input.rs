//! Tests of invalid user input: errors name the parameter, the expected and the found value.

use address_recalculation::{ArpConfig, ArpTiming, Lens, LensPicture, ScanTiming};
use proptest::prelude::*;
use pxpl5_wire::display::DisplayConfig;
use std::io::Cursor;

fn refusal(timing: ArpTiming) -> String {
    ArpConfig { timing, ..ArpConfig::IDEAL }.check().expect_err("refused").to_string()
}

#[test]
fn invalid_numbers_are_refused_with_their_name() {
    let papers = ArpTiming::PAPERS;
    let cases = [
        (ArpTiming { face_texels: 200, ..papers }, "arp.face_texels: expected a multiple of 128, found 200"),
        (ArpTiming { face_texels: 4096, ..papers }, "arp.face_texels must be 128 to 2048, found 4096"),
        (ArpTiming { display_memories: 0, ..papers }, "arp.display_memories must be 1 to 8, found 0"),
        (ArpTiming { display_memories: 9, ..papers }, "arp.display_memories must be 1 to 8, found 9"),
        (ArpTiming { depth_bits: 20, ..papers }, "arp.depth_bits: expected 16 or 24, found 20"),
        (ArpTiming { vector_bits: 25, ..papers }, "arp.vector_bits must be 8 to 24, found 25"),
        (ArpTiming { weight_bits: 9, ..papers }, "arp.weight_bits must be 0 to 8, found 9"),
    ];
    for (timing, expected) in cases {
        assert_eq!(refusal(timing), expected);
    }
    assert!(refusal(ArpTiming { horizontal_deg: f64::NAN, ..papers }).contains("arp.horizontal_deg"));
    assert!(
        refusal(ArpTiming { horizontal_deg: 200.0, ..papers })
            .contains("expected a horizontal angle above 0 and up to 170 deg")
    );
    // A line has 780 pixels, of which 640 are visible. A field has 262 whole lines, of which 240 are visible.
    for (scan, expected) in [
        (ScanTiming { left_blanking: 141, ..ScanTiming::PAPERS }, "arp_scan.left_blanking must be 0 to 140, found 141"),
        (ScanTiming { top_blanking: 23, ..ScanTiming::PAPERS }, "arp_scan.top_blanking must be 0 to 22, found 23"),
        (ScanTiming { visible_lines: 263, ..ScanTiming::PAPERS }, "arp_scan.visible_lines must be 1 to 262, found 263"),
    ] {
        let error = ArpConfig { scan, ..ArpConfig::IDEAL }.check().expect_err("refused").to_string();
        assert_eq!(error, expected);
    }
    let scan = ScanTiming { pixel_ps: u64::MAX, ..ScanTiming::PAPERS };
    ArpConfig { scan, ..ArpConfig::IDEAL }.build(&[], pxpl5_sim::Span::from_ns(50)).expect_err("refused");
}

const TINY: LensPicture = LensPicture { width: 2, height: 1, horizontal_deg: 60.0 };

fn table(text: &str) -> Result<Lens, String> {
    Lens::read(Cursor::new(text), &TINY).map_err(|error| error.to_string())
}

#[test]
fn a_table_of_vectors_is_read_whatever_the_lengths_of_the_vectors() {
    let lens = table("# two pixels\n\n  1 0 -1\n-2e0 0 -2\n").expect("two vectors");
    assert_eq!(lens.view(&TINY, 0, 0), [1.0, 0.0, -1.0]);
    lens.check(&TINY).expect("fits");
    let wider = lens.check(&LensPicture { width: 3, ..TINY }).expect_err("another picture").to_string();
    assert_eq!(wider, "arp.lens: expected 3 vectors for 3 x 1 pixels, found 2 vectors");
}

#[test]
fn a_table_of_vectors_lists_the_pixels_row_by_row() {
    let picture = LensPicture { width: 3, height: 2, ..TINY };
    let text: Vec<String> = (1..=6).map(|n| format!("{n} 0 -1\n")).collect();
    let read = |lines: &[String]| Lens::read(Cursor::new(lines.concat()), &picture).map_err(|error| error.to_string());
    let lens = read(&text).expect("six vectors");
    lens.check(&picture).expect("fits");
    for (place, x) in (1..=6).zip([0, 1, 2].into_iter().cycle()) {
        assert_eq!(lens.view(&picture, x, (place - 1) / 3), [f64::from(place), 0.0, -1.0]);
    }
    assert_eq!(lens.view(&picture, 2, 2), [0.0, 0.0, -1.0], "beyond the table it looks straight ahead");
    let short = read(&text[..5]).expect_err("five vectors");
    assert_eq!(short, "arp.lens table, line 6: expected 6 vectors, one for each pixel, found 5 vectors");
    let other = lens.check(&LensPicture { height: 3, ..picture }).expect_err("another picture").to_string();
    assert_eq!(other, "arp.lens: expected 9 vectors for 3 x 3 pixels, found 6 vectors");
}

/// Checks a lens whose slope is zero in the corner of a picture of 2 x 1 pixels. The squared distance of this corner
/// from the middle is 1/4, so the slope is `1 + 3 x 1/4 x -4/3 = 0`.
#[test]
fn a_lens_with_zero_slope_and_a_picture_with_a_zero_angle_are_refused() {
    let error = Lens::Radial { k1: -4.0 / 3.0, k2: 0.0 }.check(&TINY).expect_err("flat there").to_string();
    assert!(error.contains("found 0 for k1"), "{error}");
    for lens in [Lens::Flat, Lens::Equidistant] {
        lens.check(&LensPicture { horizontal_deg: 0.0, ..TINY }).expect_err("no angle");
    }
    Lens::Equidistant.check(&LensPicture { horizontal_deg: 360.0, ..TINY }).expect("all around");
}

#[test]
fn an_invalid_table_of_vectors_is_refused_with_its_line() {
    let numbers = "expected three numbers, finite and not all 0, found";
    let cases = [
        ("1 0 -1\n1 0\n", format!("arp.lens table, line 2: {numbers} 1 0")),
        ("1 0 x\n", format!("arp.lens table, line 1: {numbers} 1 0 x")),
        ("\n0 0 0\n", format!("arp.lens table, line 2: {numbers} 0 0 0")),
        ("1 0 inf\n", format!("arp.lens table, line 1: {numbers} 1 0 inf")),
        ("1e300 0 0\n", format!("arp.lens table, line 1: {numbers} 1e300 0 0")),
        ("1 0 -1\n", "arp.lens table, line 2: expected 2 vectors, one for each pixel, found 1 vectors".to_owned()),
        ("1 0 0\n1 0 0\n1 0 0\n", "arp.lens table, line 3: expected nothing after 2 vectors, found 1 0 0".to_owned()),
    ];
    for (text, expected) in cases {
        assert_eq!(table(text), Err(expected));
    }
    let not_text = Lens::read(Cursor::new([0xFF, 0xFE, b'\n']), &TINY).expect_err("no text").to_string();
    assert!(not_text.contains("line 1: expected text in UTF-8"), "{not_text}");
}

proptest! {
    #[test]
    fn no_text_of_a_table_causes_a_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = Lens::read(Cursor::new(bytes), &TINY);
    }

    /// Compares the check of a lens with the smallest slope found in a thousand steps from the middle to the corner.
    ///
    /// The steps are equal in the squared radius. The slope is a parabola of the squared radius with the second
    /// coefficient 5 k2. Between two steps, it falls at most 5 |k2| (step / 2)^2 below both values. Lenses whose
    /// smallest slope is positive and within this bound are left out.
    #[test]
    fn a_lens_whose_slope_is_not_positive_inside_the_picture_is_refused(
        k1 in -1.5..1.5_f64,
        k2 in -1.0..1.0_f64,
        width in 1_u32..700,
        height in 1_u32..700,
    ) {
        let picture = LensPicture { width, height, horizontal_deg: 60.0 };
        let [right, down] = [width, height].map(|n| (f64::from(n) - 1.0) / f64::from(width));
        let step = (right.powi(2) + down.powi(2)) / 1_000.0;
        let slope = |squared: f64| 1.0 + 3.0 * k1 * squared + 5.0 * k2 * squared.powi(2);
        let least = (0..=1_000).map(|n| slope(step * f64::from(n))).fold(f64::INFINITY, f64::min);
        prop_assume!(least < 0.0 || least > 5.0 * k2.abs() * (step / 2.0).powi(2));
        prop_assert_eq!(Lens::Radial { k1, k2 }.check(&picture).is_ok(), least > 0.0, "least slope {}", least);
    }

    #[test]
    fn no_coefficients_of_a_lens_cause_a_panic(k1 in any::<f64>(), k2 in any::<f64>(), horizontal_deg in any::<f64>()) {
        let picture = LensPicture { horizontal_deg, ..TINY };
        let lens = Lens::Radial { k1, k2 };
        if lens.check(&picture).is_ok() {
            prop_assert!(lens.view(&picture, 0, 0).iter().all(|component| component.is_finite()));
        }
    }
}
