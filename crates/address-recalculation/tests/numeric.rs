//! Tests of the display against numbered cases that were computed by hand: 640 x 480 pixels, 60 degrees, faces of 512
//! texels.

use address_recalculation::{
    AddressUnit, ArpConfig, ArpTiming, CubeFace, FaceGeometry, Latch, Lens, LensPicture, Orientation, TexelAddress,
    Vector,
};
use glam::DQuat;
use pxpl5_sim::SplitMix64;
use pxpl5_wire::PeriodNumber;

const PICTURE: LensPicture = LensPicture { width: 640, height: 480, horizontal_deg: 60.0 };
const GUARDED: FaceGeometry = FaceGeometry { texels: 512, guard: 1 };
const BARE: FaceGeometry = FaceGeometry { texels: 512, guard: 0 };

fn near(found: Vector, expected: Vector, tolerance: f64) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= tolerance, "{found:?}, expected {expected:?}");
    }
}

fn texel(geometry: FaceGeometry, direction: Vector) -> (CubeFace, u32, u32) {
    let texel = geometry.texel(direction).expect("a direction");
    (texel.face, texel.column, texel.row)
}

/// Returns the texel for a direction of 30 bits, computed in the word lengths of the hardware.
fn texel_by_words(guard: u64, direction: Vector) -> (CubeFace, u32, u32) {
    let timing = ArpTiming { face_texels: 512, guard_texels: guard, weight_bits: 0, ..ArpTiming::PAPERS };
    let longest = direction.iter().fold(0.0_f64, |most, component| most.max(component.abs()));
    let words = direction.map(|component| (component / longest * f64::from(1 << 30)).round() as i64);
    let footprint = AddressUnit::new(&timing).footprint(words).expect("a direction");
    let texel = footprint.texels[0].expect("on a face");
    (texel.face, texel.column, texel.row)
}

#[test]
fn case_1_the_corner_pixel_of_a_flat_picture_has_the_computed_direction_and_words() {
    near(Lens::Flat.view(&PICTURE, 0, 0), [-0.576448159, 0.432110592, -1.0], 1e-9);
    let table = ArpConfig::IDEAL.table().expect("valid");
    assert_eq!(table.entry(0, 0), [-15326, 11488, -26586]);
}

#[test]
fn case_2_the_pixel_beside_the_middle_has_the_computed_direction() {
    near(Lens::Flat.view(&PICTURE, 320, 240), [0.000902110, -0.000902110, -1.0], 1e-9);
}

#[test]
fn cases_3_and_4_a_radial_lens_stretches_corner_and_edge_by_the_computed_factors() {
    let lens = Lens::Radial { k1: 0.32, k2: 0.0 };
    let flat = Lens::Flat.view(&PICTURE, 0, 0);
    let seen = lens.view(&PICTURE, 0, 0);
    assert!([0, 1].iter().all(|i| (seen[*i] / flat[*i] - 1.498251563).abs() < 1e-9));
    assert_eq!(seen[2], -1.0, "straight ahead");
    let off_axis = seen[0].hypot(seen[1]).atan().to_degrees();
    assert!((off_axis - 47.186136).abs() < 1e-6, "{off_axis}");
    let edge = lens.view(&PICTURE, 639, 240);
    assert!((edge[0] / Lens::Flat.view(&PICTURE, 639, 240)[0] - 1.319001563).abs() < 1e-9);
    assert!((edge[0] - 0.760336023).abs() < 1e-9);
}

#[test]
fn case_5_a_lens_that_folds_is_refused() {
    let lens = |k1| Lens::Radial { k1, k2: 0.0 }.check(&PICTURE);
    let error = lens(-0.215).expect_err("folds").to_string();
    assert!(error.starts_with("arp.lens: expected 1 + 3 k1 rho^2") && error.contains("found -0.00"), "{error}");
    lens(-0.214).expect("does not fold");
    lens(-0.214_081_950).expect("just inside of the limit");
    lens(-0.214_081_952).expect_err("just beyond the limit");
    lens(f64::NAN).expect_err("no number");
    // With t = rho^2, the slope 1 - 3 t + 2 t^2 is positive at the corner (t = 1.557), but negative between 0.5 and 1.
    let turning = Lens::Radial { k1: -1.0, k2: 0.4 };
    turning.check(&PICTURE).expect_err("folds before the corner");
}

#[test]
fn case_6_an_equidistant_lens_sees_behind_the_head() {
    let wide = LensPicture { horizontal_deg: 200.0, ..PICTURE };
    let seen = Lens::Equidistant.view(&wide, 639, 240);
    near(seen, [0.985276071, -0.001541903, 0.170963991], 1e-9);
    assert_eq!(CubeFace::of(seen), Some(CubeFace::PosX));
    Lens::Equidistant.check(&wide).expect("up to 360 degrees");
    Lens::Flat.check(&wide).expect_err("a plane has less than 180");
    let odd = LensPicture { width: 3, height: 3, horizontal_deg: 200.0 };
    assert_eq!(Lens::Equidistant.view(&odd, 1, 1), [0.0, 0.0, -1.0], "no distance has no direction");
}

/// Checks a direction exactly on the border between two texels: 1 + (1 + 1/3) / 2 x 510 = 341.
///
/// In 16 bits the quotient 2/3 is 43,690. Then 43,690 x 510 + 255 = 22,282,155 is 85 less than 340 x 65,536, so it
/// selects the previous texel.
#[test]
fn case_7_a_direction_selects_the_computed_face_and_texel() {
    let direction = [0.3, -0.2, -0.9];
    let (face, [u, v]) = GUARDED.place(direction).expect("a direction");
    assert_eq!(face, CubeFace::NegZ);
    assert!((u - 1.0 / 3.0).abs() < 1e-15 && (v - 2.0 / 9.0).abs() < 1e-15);
    assert_eq!(texel(GUARDED, direction), (CubeFace::NegZ, 341, 312));
    assert_eq!(texel_by_words(1, direction), (CubeFace::NegZ, 340, 312));
    assert_eq!(texel_by_words(1, [0.3001, -0.2, -0.9]), (CubeFace::NegZ, 341, 312));
}

/// Checks an interpolated value. The exact fractions 1/2 and 1/6 give 18.3333. With fractions rounded to 3/16, the
/// result is 15 + 20 x 3/16 = 18.75.
#[test]
fn case_8_the_four_texels_of_a_pixel_lie_in_four_banks() {
    let (_, [a, b]) = GUARDED.between_texels([0.3, -0.2, -0.9]).expect("a direction");
    assert_eq!([a.floor(), b.floor()], [340.0, 312.0]);
    assert!((a.fract() - 0.5).abs() < 1e-9 && (b.fract() - 1.0 / 6.0).abs() < 1e-9);
    let timing = ArpTiming { face_texels: 512, ..ArpTiming::PAPERS };
    let footprint = AddressUnit::new(&timing).footprint([300_000, -200_000, -900_000]).expect("a direction");
    let texels = footprint.texels.map(|texel| texel.expect("on the face"));
    assert_eq!(texels.map(|texel| [texel.column, texel.row]), [[340, 312], [341, 312], [340, 313], [341, 313]]);
    assert_eq!(texels.map(|texel| texel.bank()), [0, 1, 2, 3]);
    assert_eq!(texels.map(|texel| texel.word(512)), [40106; 4]);
    assert!(!footprint.has_conflict() && !footprint.is_split);
    assert_eq!(footprint.fractions, [8, 3]);
    let values = [10, 20, 30, 40];
    let sum: u32 = footprint.weights(4).iter().zip(values).map(|(weight, value)| weight * value).sum();
    assert_eq!(f64::from(sum) / 256.0, 18.75);
}

#[test]
fn cases_9_and_10_directions_of_corners_and_edges_select_the_expected_texels() {
    use CubeFace::{NegX, PosX, PosY};
    let cases = [
        (1, [1.0, 1.0, 1.0], (PosX, 510, 1)),
        (1, [-1.0, -1.0, -1.0], (NegX, 510, 510)),
        (0, [1.0, 1.0, 1.0], (PosX, 511, 0)),
        (0, [-1.0, -1.0, -1.0], (NegX, 511, 511)),
        (0, [1.0, 0.0, -1.0], (PosX, 0, 256)),
        (0, [0.0, 1.0, -1.0], (PosY, 256, 511)),
        (0, [-1.0, 0.0, 1.0], (NegX, 0, 256)),
    ];
    for (guard, direction, expected) in cases {
        assert_eq!(texel(FaceGeometry { texels: 512, guard }, direction), expected, "{direction:?}");
        assert_eq!(texel_by_words(guard.into(), direction), expected, "{direction:?} in words");
    }
}

#[test]
fn case_11_an_invalid_direction_has_no_texel() {
    assert_eq!(BARE.texel([0.0; 3]), None);
    assert_eq!(BARE.texel([f64::NAN, 1.0, 0.0]), None);
    assert_eq!(BARE.texel([f64::INFINITY, 1.0, 0.0]), None);
    assert_eq!(texel(BARE, [1e-300, 0.0, 0.0]), (CubeFace::PosX, 256, 256));
    assert_eq!(texel(BARE, [-0.0, 0.0, -1.0]), (CubeFace::NegZ, 256, 256));
    assert_eq!(AddressUnit::new(&ArpTiming::PAPERS).footprint([0; 3]), None);
}

fn yaw(degrees: f64) -> Orientation {
    turned(DQuat::from_rotation_y(degrees.to_radians()))
}

fn turned(quaternion: DQuat) -> Orientation {
    Orientation::from_quaternion(quaternion.to_array()).expect("a rotation")
}

#[test]
fn cases_12_and_13_pixels_of_a_rotated_head_select_the_computed_texels() {
    use CubeFace::{NegX, NegZ, PosY};
    let pitch = turned(DQuat::from_rotation_x(60_f64.to_radians()));
    let pixel = |x, y| Lens::Flat.view(&PICTURE, x, y);
    let cases = [
        (yaw(30.0), [0.0, 0.0, -1.0], (NegZ, 108, 256)),
        (yaw(30.0), pixel(0, 0), (NegX, 403, 145)),
        (yaw(30.0), pixel(639, 479), (NegZ, 255, 351)),
        (yaw(100.0), pixel(0, 0), (NegX, 42, 131)),
        (pitch, pixel(320, 240), (PosY, 256, 403)),
    ];
    for (orientation, direction, expected) in cases {
        assert_eq!(texel(GUARDED, orientation.turn(direction)), expected, "{direction:?}");
    }
}

#[test]
fn case_14_the_solid_angles_of_all_texels_add_up_to_a_sphere() {
    let at = |column, row| BARE.solid_angle(TexelAddress { face: CubeFace::PosX, column, row });
    let face: f64 = (0..512).flat_map(|row| (0..512).map(move |column| (column, row))).map(|(c, r)| at(c, r)).sum();
    assert!((6.0 * face - 4.0 * std::f64::consts::PI).abs() < 1e-9);
    assert!((at(256, 256) - 1.525856e-5).abs() < 1e-11, "{}", at(256, 256));
    assert!((at(0, 0) - 2.948055e-6).abs() < 1e-12, "{}", at(0, 0));
    let wider = FaceGeometry { texels: 516, guard: 2 };
    for (column, row) in [(0, 0), (256, 256), (511, 3)] {
        let inside = TexelAddress { face: CubeFace::NegY, column: column + 2, row: row + 2 };
        assert_eq!(wider.solid_angle(inside), at(column, row), "a guard moves texels and changes none");
    }
}

fn any_rotation(random: &mut SplitMix64) -> DQuat {
    let mut uniform = || (random.bits() >> 11) as f64 / (1_u64 << 53) as f64;
    let [u, v, w] = [uniform(), uniform() * std::f64::consts::TAU, uniform() * std::f64::consts::TAU];
    let short = (1.0 - u).sqrt();
    let long = u.sqrt();
    DQuat::from_xyzw(short * v.sin(), short * v.cos(), long * w.sin(), long * w.cos())
}

/// Returns the largest distance in texels between two positions of a direction: computed in hardware words, and in
/// floating point.
///
/// The sample has 40,000 pairs of a rotation and a pixel for which both computations hit the same face.
fn worst_address(bits: u64) -> f64 {
    let timing = ArpTiming { face_texels: 512, vector_bits: bits, matrix_bits: bits, ..ArpTiming::PAPERS };
    let config = ArpConfig { timing, ..ArpConfig::IDEAL };
    let table = config.table().expect("valid");
    let mut random = SplitMix64::new(15);
    let mut worst = 0.0_f64;
    for _ in 0..40_000 {
        let orientation = turned(any_rotation(&mut random));
        let x = (random.bits() % 640) as u32;
        let y = (random.bits() % 480) as u32;
        let exact = GUARDED.between_texels(orientation.turn(Lens::Flat.view(&PICTURE, x, y))).expect("a direction");
        let words = orientation.words(bits).turn(table.entry(x, y)).map(|word| word as f64);
        let found = GUARDED.between_texels(words).expect("a direction");
        if found.0 == exact.0 {
            let off = [0, 1].map(|i| (found.1[i] - exact.1[i]).abs());
            worst = worst.max(off[0]).max(off[1]);
        }
    }
    worst
}

/// Checks address errors for several word lengths. The printed errors come from another sample, so each limit is 1.5
/// times as large.
#[test]
fn case_15_address_errors_follow_from_the_word_lengths() {
    for (bits, printed) in [(8, 5.7), (10, 1.39), (12, 0.33), (14, 0.088), (16, 0.021)] {
        let worst = worst_address(bits);
        assert!(worst <= 1.5 * printed && worst >= printed / 2.0, "{bits} bits: {worst}, printed {printed}");
    }
}

#[test]
fn case_30_a_pixel_is_latched_read_and_lit_at_the_computed_times() {
    let scan = ArpConfig::IDEAL.scan().expect("valid");
    let field = PeriodNumber(0);
    assert_eq!(ArpConfig::IDEAL.timing.stages(), 26);
    assert_eq!(scan.when(320, 240, field).map(|time| time.0), Some(9_062_370_370));
    assert_eq!(scan.reads(320, 240, field).map(|time| time.0), Some(9_062_270_370));
    assert_eq!(scan.latches(Latch::Pixel, 320, 240, field).map(|time| time.0), Some(9_061_720_370));
    assert_eq!(scan.when(320, 241, field), None, "an odd line");
}

/// Checks the error with an ideal tracker. It is the head's rotation from reading the orientation to displaying the
/// pixel: f tan(200 deg/s x age).
#[test]
fn case_31_a_pan_of_200_degrees_a_second_causes_the_computed_error_for_each_latch_mode() {
    let scan = ArpConfig::IDEAL.scan().expect("valid");
    let focal = 320.0 / 30_f64.to_radians().tan();
    let lit = scan.when(320, 240, PeriodNumber(0)).expect("an even line");
    for (latch, printed, tolerance) in
        [(Latch::Field, 14.81, 0.005), (Latch::Line, 0.0517, 5e-5), (Latch::Pixel, 0.00126, 5e-6)]
    {
        let latched = scan.latches(latch, 320, 240, PeriodNumber(0)).expect("an even line");
        let age = lit.since(latched).0 as f64 * 1e-12;
        let error = focal * (200.0 * age).to_radians().tan();
        assert!((error - printed).abs() < tolerance, "{latch:?}: {error}");
    }
}

/// Checks statement A17 of the papers: the orientation is less than 1 us old at the first pixel. A stage must therefore
/// take less than 38.46 ns.
#[test]
fn the_pipeline_is_shorter_than_a_microsecond() {
    assert_eq!(ArpTiming::PAPERS.depth().0, 650_000);
    let slowest = ArpTiming { stage_ps: 38_461, ..ArpTiming::PAPERS };
    assert!(slowest.depth().0 < 1_000_000);
    let stages = [1, 2, 3, 4, 5, 8].map(|n| ArpTiming { display_memories: n, ..ArpTiming::PAPERS }.stages());
    assert_eq!(stages, [24, 25, 26, 26, 27, 27]);
    // The stages after the read of the orientation are the memory, the interpolation, and one level of comparators for
    // each doubling of memories.
    let ahead = [1, 2, 3, 4, 5, 8].map(|n| ArpTiming { display_memories: n, ..ArpTiming::PAPERS }.read_ahead().0);
    assert_eq!(ahead, [2, 3, 4, 4, 5, 5].map(|stages| 25_000 * stages));
}

/// Checks that the scan equals the scan of the frame buffer of Pixel-Planes 5. Crates of boards do not depend on each
/// other, but their numbers must agree.
#[test]
fn the_scan_times_equal_those_of_the_frame_buffer_of_pixel_planes_5() {
    let video = pxpl5_framebuffer::VideoTiming::PAPERS.video().expect("valid");
    let scan = ArpConfig::IDEAL.scan().expect("valid");
    for n in [0, 1, 2, 59, 60, 1_000_001] {
        let field = PeriodNumber(n);
        assert_eq!(scan.retrace(field), video.retrace(field));
        assert_eq!(scan.field_at(scan.retrace(field)), field);
        for (x, y) in [(0, 0), (0, 1), (639, 479), (320, 240), (17, 478), (640, 0), (0, 480)] {
            assert_eq!(scan.when(x, y, field), video.when(x, y, field), "field {n}: {x}, {y}");
        }
    }
}

/// Checks angles. The half angle of a face has the tangent N/M, which gives 90.2242 degrees for 512 texels and 1 guard
/// texel.
///
/// An NTSC pixel of a picture of 60 degrees covers 0.1034 degrees in the middle.
#[test]
fn a_face_spans_90_2242_degrees_and_the_middle_pixel_spans_0_1034_degrees() {
    let degrees = 2.0 * GUARDED.tangent().atan().to_degrees();
    assert!((degrees - 90.2242).abs() < 1e-4, "{degrees}");
    let [across, ..] = Lens::Flat.view(&PICTURE, 320, 240);
    assert!((2.0 * across.atan().to_degrees() - 0.1034).abs() < 5e-5);
}

/// Checks the example of docs/guide/address-recalculation.md: the upper left pixel of a head that looks 30 degrees to
/// the left.
///
/// 28,377 is 32,767 cos 30 degrees, and 16,383 is its sine (in doubles just below 16,383.5). The other values were
/// computed by hand.
#[test]
fn the_example_pixel_of_the_guide_has_the_printed_values() {
    let half = 15_f64.to_radians();
    let matrix = Orientation::from_quaternion([0.0, half.sin(), 0.0, half.cos()]).expect("a rotation").words(16);
    assert_eq!(matrix.0, [[28_377, 0, 16_383], [0, 32_767, 0], [-16_383, 0, 28_377]]);
    let turned = matrix.turn([-15_326, 11_488, -26_586]);
    assert_eq!(turned, [-870_464_340, 376_427_296, -503_345_064]);
    let timing = ArpTiming { face_texels: 512, ..ArpTiming::PAPERS };
    let footprint = AddressUnit::new(&timing).footprint(turned).expect("a direction");
    let texels = footprint.texels.map(|texel| texel.expect("on the face"));
    assert!(texels.iter().all(|texel| texel.face == CubeFace::NegX));
    assert_eq!(texels.map(|texel| [texel.column, texel.row]), [[402, 145], [403, 145], [402, 146], [403, 146]]);
    assert_eq!(texels.map(|texel| texel.bank()), [2, 3, 0, 1]);
    assert_eq!(footprint.fractions, [15, 4]);
    assert_eq!(footprint.weights(4), [12, 180, 4, 60]);
}

/// Checks the example of the guide on a complete display: the upper left pixel of a head that looks 30 degrees to the
/// left.
#[test]
fn a_display_returns_the_texels_of_a_pixel() {
    let half = 15.0_f64.to_radians();
    let turned = Orientation::from_quaternion([0.0, half.sin(), 0.0, half.cos()]).expect("a rotation");
    let footprint = ArpConfig::IDEAL.footprint(0, 0, &turned).expect("valid").expect("in the picture");
    let texel = |column, row| Some(TexelAddress { face: CubeFace::NegX, column, row });
    assert_eq!(footprint.texels, [texel(402, 145), texel(403, 145), texel(402, 146), texel(403, 146)]);
    assert_eq!((footprint.fractions, footprint.weights(4)), ([15, 4], [12, 180, 4, 60]));
    assert_eq!(ArpConfig::IDEAL.footprint(640, 0, &turned), Ok(None));
    assert!(
        ArpConfig { lens: Lens::Radial { k1: -0.3, k2: 0.0 }, ..ArpConfig::IDEAL }.footprint(0, 0, &turned).is_err()
    );
}

#[test]
fn a_lens_is_parsed_from_text() {
    let read = |text: &str| text.parse::<Lens>();
    assert_eq!(read("flat"), Ok(Lens::Flat));
    assert_eq!(read("equidistant"), Ok(Lens::Equidistant));
    assert_eq!(read("radial:0.32"), Ok(Lens::Radial { k1: 0.32, k2: 0.0 }));
    assert_eq!(read("radial:0.3:-0.1"), Ok(Lens::Radial { k1: 0.3, k2: -0.1 }));
    for wrong in ["", "radial", "radial:x", "radial:1:2:3", "flat:1", "table:a.txt"] {
        let error = read(wrong).expect_err(wrong).to_string();
        assert!(error.contains("radial:K1:K2") && error.contains(wrong), "{error}");
    }
}
