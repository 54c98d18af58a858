//! What a user can hand in is answered by key, expected and found.

use address_recalculation::{ArpConfig, ArpTiming, Lens, Picture, ScanTiming};
use proptest::prelude::*;
use pxpl5_display::DisplayConfig;
use std::io::Cursor;

fn refusal(timing: ArpTiming) -> String {
    ArpConfig { timing, ..ArpConfig::IDEAL }.check().expect_err("refused").to_string()
}

#[test]
fn numbers_are_refused_by_name() {
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
    let scan = ScanTiming { left_blanking: 141, ..ScanTiming::PAPERS };
    let error = ArpConfig { scan, ..ArpConfig::IDEAL }.check().expect_err("refused").to_string();
    assert_eq!(error, "arp_scan.left_blanking must be 0 to 140, found 141");
    let scan = ScanTiming { pixel_ps: u64::MAX, ..ScanTiming::PAPERS };
    ArpConfig { scan, ..ArpConfig::IDEAL }.build(&[]).expect_err("refused");
}

const TINY: Picture = Picture { width: 2, height: 1, horizontal_deg: 60.0 };

fn table(text: &str) -> Result<Lens, String> {
    Lens::read(Cursor::new(text), &TINY).map_err(|error| error.to_string())
}

#[test]
fn a_table_of_vectors_is_read_and_its_lengths_do_not_matter() {
    let lens = table("# two pixels\n\n  1 0 -1\n-2e0 0 -2\n").expect("two vectors");
    assert_eq!(lens.view(&TINY, 0, 0), [1.0, 0.0, -1.0]);
    lens.check(&TINY).expect("fits");
    let wider = lens.check(&Picture { width: 3, ..TINY }).expect_err("another picture").to_string();
    assert_eq!(wider, "arp.lens: expected 3 vectors for 3 x 1 pixels, found 2 vectors");
}

#[test]
fn a_table_that_cannot_be_read_is_refused_by_its_line() {
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
    fn no_table_makes_it_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
        let _ = Lens::read(Cursor::new(bytes), &TINY);
    }

    #[test]
    fn no_lens_makes_it_panic(k1 in any::<f64>(), k2 in any::<f64>(), horizontal_deg in any::<f64>()) {
        let picture = Picture { horizontal_deg, ..TINY };
        let lens = Lens::Radial { k1, k2 };
        if lens.check(&picture).is_ok() {
            prop_assert!(lens.view(&picture, 0, 0).iter().all(|component| component.is_finite()));
        }
    }
}
