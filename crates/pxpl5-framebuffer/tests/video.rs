//! Tests of retraces, lines and pixels with an accuracy of one picosecond. Expected values are exact fractions from the
//! NTSC standard.

use crate::support::field_target;
use proptest::prelude::*;
use pxpl5_framebuffer::{Video, VideoTiming};
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{ParameterTable, SettingErrorKind, Value};
use pxpl5_wire::{FieldParity, PeriodNumber};

fn ntsc() -> Video {
    VideoTiming::PAPERS.video().expect("valid")
}

/// Returns floor(n x 1001/60000 s) in picoseconds.
fn retrace_ps(n: u64) -> u64 {
    (u128::from(n) * 1_001_000_000_000_000 / 60_000) as u64
}

/// Returns floor(lines x 4004/63 us + pixels x 11/135 us) in picoseconds.
fn beam_ps(lines: u64, pixels: u64) -> u64 {
    // The common denominator is 945 = 63 x 15 = 135 x 7.
    let us_945 = u128::from(lines) * 4_004 * 15 + u128::from(pixels) * 11 * 7;
    (us_945 * 1_000_000 / 945) as u64
}

#[test]
fn retraces_do_not_drift_in_a_million_fields() {
    let video = ntsc();
    assert_eq!(video.retrace(PeriodNumber(1)), Time(16_683_333_333));
    assert_eq!(video.retrace(PeriodNumber(60_000)), Time(1_001_000_000_000_000));
    for n in [2, 3, 999_999, 1_000_000, 1_000_001, 12_345_678] {
        assert_eq!(video.retrace(PeriodNumber(n)).0, retrace_ps(n));
    }
}

#[test]
fn a_field_begins_at_the_picosecond_of_its_retrace() {
    let video = ntsc();
    for n in [1, 2, 3, 60, 1_000_000, 1_000_001] {
        let begin = video.retrace(PeriodNumber(n));
        assert_eq!(video.field_at(Time(begin.0 - 1)), PeriodNumber(n - 1));
        assert_eq!(video.field_at(begin), PeriodNumber(n));
    }
    assert_eq!(video.field_at(Time::ZERO), PeriodNumber::FIRST);
}

#[test]
fn an_even_field_begins_on_a_line_and_an_odd_one_in_the_middle_of_a_line() {
    let video = ntsc();
    for frame in [0, 1, 2, 500_000] {
        let even_field = PeriodNumber(2 * frame);
        let odd_field = even_field.next();
        let even = video.line_start(0, even_field).expect("even");
        assert_eq!(even.0, beam_ps(525 * frame + 22, 0));
        let odd = video.line_start(1, odd_field).expect("odd");
        assert_eq!(odd.0, beam_ps(525 * frame + 262 + 23, 0));
        // The blanking takes 22 lines in one field and 22.5 lines in the other, with 4004/63 us for each line. Each
        // instant is rounded down to a picosecond.
        let blank_even = even - video.retrace(even_field);
        let blank_odd = odd - video.retrace(odd_field);
        assert!(blank_even.0.abs_diff(22 * 4_004_000_000 / 63) <= 1, "{blank_even}");
        assert!(blank_odd.0.abs_diff(45 * 2_002_000_000 / 63) <= 1, "{blank_odd}");
    }
}

#[test]
fn the_visible_pixels_of_a_line_take_the_published_52_15_us() {
    let video = ntsc();
    let first = video.when(0, 100, PeriodNumber(8)).expect("scanned");
    let last = video.when(639, 100, PeriodNumber(8)).expect("scanned");
    let visible = (last - first).0 + 11_000_000 / 135;
    assert!(visible.abs_diff(52_150_000) < 5_000, "{visible} ps");
    let blanked = first - video.line_start(100, PeriodNumber(8)).expect("scanned");
    // 140 + 640 = 780 pixel periods are a whole line. Three instants and a period are rounded down.
    assert!((blanked.0 + visible).abs_diff(4_004_000_000 / 63) <= 2, "{blanked} + {visible} ps");
}

#[test]
fn a_field_scans_only_the_lines_of_its_parity() {
    let video = ntsc();
    for (y, even, odd) in
        [(0, true, false), (1, false, true), (478, true, false), (479, false, true), (480, false, false)]
    {
        assert_eq!(video.when(0, y, PeriodNumber(6)).is_some(), even, "line {y}");
        assert_eq!(video.line_start(y, PeriodNumber(7)).is_some(), odd, "line {y}");
    }
    assert_eq!(video.when(640, 0, PeriodNumber(0)), None);
}

#[test]
fn the_beam_reaches_a_region_at_the_first_pixel_of_the_region_in_that_field() {
    let video = ntsc();
    let bottom = field_target(0, FieldParity::Odd, 7, 0);
    assert_eq!(video.reaches(&bottom, PeriodNumber(3)), video.when(256, 241, PeriodNumber(3)));
    assert_eq!(video.reaches(&bottom, PeriodNumber(4)), None);
    assert_eq!(video.reaches(&field_target(0, FieldParity::Odd, 10, 0), PeriodNumber(3)), None);
}

#[test]
fn video_timings_that_cannot_be_scanned_are_refused_by_name() {
    for (name, value) in [
        ("pixel_ps", 0),
        ("pixel_divisor", 0),
        ("line_pixels", 0),
        ("frame_lines", u64::MAX),
        ("visible_pixels", 781),
        ("visible_lines", 0),
        ("left_blanking", 141),
        ("top_blanking", 23),
    ] {
        let mut timing = VideoTiming::PAPERS;
        let value = Value::Whole(value);
        timing.set(name, value).expect("known");
        let error = timing.video().expect_err(name);
        assert_eq!((error.kind, &*error.found), (SettingErrorKind::Limits, &*value.to_string()), "{name}: {error}");
    }
}

proptest! {
    #[test]
    fn the_position_of_the_beam_equals_exact_arithmetic(x in 0u32..640, row in 0u32..240, field in (0u64..1_100_000_000).prop_map(PeriodNumber)) {
        let video = ntsc();
        let y = 2 * row + FieldParity::of_field(field).first_line();
        let half_lines = field.0 * 525;
        let line = half_lines / 2 + half_lines % 2 + 22 + u64::from(row);
        let when = video.when(x, y, field).expect("scanned");
        prop_assert_eq!(when.0, beam_ps(line, 140 + u64::from(x)));
        prop_assert_eq!(video.field_at(when), field);
        prop_assert!(when < video.retrace(field.next()));
    }

    #[test]
    fn no_number_causes_a_panic(x in any::<u32>(), y in any::<u32>(), field in any::<u64>().prop_map(PeriodNumber), values in any::<[u64; 8]>()) {
        let _ = ntsc().when(x, y, field);
        let mut timing = VideoTiming::PAPERS;
        for (info, value) in VideoTiming::INFOS.iter().zip(values) {
            timing.set(info.name, Value::Whole(value)).expect("listed");
        }
        if let Ok(video) = timing.video() {
            let _ = video.when(x, y, field);
        }
    }
}
