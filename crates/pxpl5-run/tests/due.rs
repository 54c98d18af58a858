//! Tests of the pictures due. Each picture has exactly one result, the window depends on the load and not on the length
//! of the run, and heavier loads have worse results.

use proptest::prelude::*;
use pxpl5_run::PictureResult::{Incomplete, Late, Shown};
use pxpl5_run::{DuePictures, PictureResult, WARM_UP_PERIODS};
use pxpl5_wire::PeriodNumber;

fn count(pictures: &[(u64, PictureResult)], every: u64, periods: u64) -> DuePictures {
    counted(pictures, every, periods).expect("a window")
}

fn counted(pictures: &[(u64, PictureResult)], every: u64, periods: u64) -> Option<DuePictures> {
    let pictures = pictures.iter().map(|(period, end)| (PeriodNumber(*period), *end));
    DuePictures::count(pictures, every, PeriodNumber(periods))
}

/// Returns the number of periods from the first to the last period of the window.
fn window(due: &DuePictures) -> u64 {
    due.last_period.next().since(due.first_period)
}

/// Returns a picture every `apart` periods from `first` on, all with the same result.
fn regular(first: u64, apart: u64, periods: u64, end: PictureResult) -> Vec<(u64, PictureResult)> {
    (first..periods).step_by(apart as usize).map(|period| (period, end)).collect()
}

#[test]
fn if_every_field_shows_a_new_picture_all_due_pictures_are_shown() {
    let due = count(&regular(2, 1, 100, Shown), 1, 100);
    assert_eq!((due.first_period.0, due.last_period.0), (WARM_UP_PERIODS, 99));
    assert_eq!((due.due, due.shown, due.not_shown()), (92, 92, 0));
}

#[test]
fn late_incomplete_and_missed_pictures_are_each_counted_once() {
    let mut pictures = regular(2, 1, 108, Shown);
    pictures[10].1 = Late;
    pictures[11].1 = Incomplete;
    pictures.remove(12);
    // The window begins with the first picture that was not shown, in period 12.
    let due = count(&pictures, 1, 108);
    assert_eq!((due.first_period.0, due.last_period.0, due.due), (12, 107, 96));
    assert_eq!((due.shown, due.late, due.incomplete, due.missed), (93, 1, 1, 1));
}

#[test]
fn pictures_three_periods_apart_but_due_every_second_period_miss_a_third() {
    // Swaps come at 9, 12, 15, 18 ..., due periods at 9, 11, 13, 15, 17, 19 .... Two of three due pictures are new.
    let due = count(&regular(9, 3, 609, Shown), 2, 609);
    assert!((due.not_shown_share() - 1.0 / 3.0).abs() < 1.0 / due.due as f64, "{due:?}");
    assert_eq!(window(&due), 2 * due.due);
}

#[test]
fn two_pictures_in_one_due_interval_count_as_one_due_picture_shown() {
    let due = count(&regular(4, 1, 40, Shown), 2, 40);
    assert_eq!((due.due, due.shown, due.pictures), (16, 16, 32));
    // The rate counts the pictures shown: one in each field.
    let hz = due.updates_hz(1001.0 / 60.0).expect("shown");
    assert!((hz - 60_000.0 / 1_001.0).abs() < 1e-9, "{hz}");
}

#[test]
fn a_run_that_showed_nothing_missed_all_pictures() {
    let due = count(&[], 1, 60);
    assert_eq!((due.due, due.missed, due.updates_hz(1001.0 / 60.0)), (52, 52, None));
}

#[test]
fn a_run_shorter_than_the_warm_up_has_no_counts() {
    for periods in 0..=WARM_UP_PERIODS {
        assert_eq!(counted(&regular(2, 1, periods, Shown), 1, periods), None);
    }
}

/// Frames come every second period, beginning with period 5. The fifth frame is swapped in at period 13 and due in
/// periods 12 and 13.
///
/// With a picture in every period, the ninth period comes later than the fifth picture.
#[test]
fn the_window_begins_at_the_later_of_ninth_period_and_fifth_picture() {
    for (first, apart, every, expected) in [(5, 2, 2, 12), (2, 1, 1, 8), (0, 2, 2, 9), (20, 10, 10, 51)] {
        let due = count(&regular(first, apart, 200, Shown), every, 200);
        assert_eq!(due.first_period.0, expected, "{first} {apart} {every}");
    }
}

/// The first four pictures have no latency, so they do not count as shown unless a fifth was shown. A picture every tenth
/// period is too rare if one is due every third: of the 16 due at 12, 15 ... 57, those of 18, 28, 38 and 48 are shown.
#[test]
fn pictures_of_the_warm_up_count_as_shown_only_if_a_later_picture_was_shown() {
    assert_eq!(counted(&regular(8, 3, 18, Shown), 3, 24), None, "too short, and not too heavy");
    let due = count(&regular(8, 10, 40, Shown), 3, 60);
    assert_eq!((due.due, due.shown, due.missed, due.pictures), (13, 0, 13, 0));
    let due = count(&regular(8, 10, 50, Shown), 3, 60);
    assert_eq!((due.due, due.shown, due.missed, due.pictures), (16, 4, 12, 4));
}

/// The second half of a run does not move its window.
#[test]
fn a_failure_in_the_second_half_is_counted_over_the_whole_window() {
    let mut pictures = regular(2, 1, 100, Shown);
    pictures.retain(|picture| picture.0 != 80);
    let due = count(&pictures, 1, 100);
    assert_eq!((due.first_period.0, due.due, due.missed), (WARM_UP_PERIODS, 92, 1));
}

#[test]
fn a_run_with_one_shown_picture_has_no_rate() {
    let mut pictures = regular(2, 1, 60, Incomplete);
    pictures[20].1 = Shown;
    let due = count(&pictures, 1, 60);
    assert_eq!((due.shown, due.updates_hz(1001.0 / 60.0)), (1, None));
}

/// Returns the pictures of a pipeline whose queues are empty at first. Pictures are in time until `filled`. Later, only
/// every `apart`-th picture is in time.
fn filling(filled: u64, apart: u64, periods: u64) -> Vec<(u64, PictureResult)> {
    let in_time = |period: u64| period < filled || (period - filled) % apart == apart - 1;
    (2..periods).map(|period| (period, if in_time(period) { Shown } else { Incomplete })).collect()
}

fn ends() -> impl Strategy<Value = Vec<(u64, PictureResult)>> {
    let end = prop_oneof![Just(None), Just(Some(Shown)), Just(Some(Late)), Just(Some(Incomplete))];
    proptest::collection::vec(end, 0..200)
        .prop_map(|ends| (0..).zip(ends).filter_map(|(period, end)| Some((period, end?))).collect())
}

proptest! {
    #[test]
    fn every_picture_due_has_exactly_one_result(pictures in ends(), every in 1u64..12, periods in 0u64..260) {
        if let Some(due) = counted(&pictures, every, periods) {
            prop_assert_eq!(due.shown + due.late + due.incomplete + due.missed, due.due);
            // Only pictures of the warm-up without a later one are left out.
            let left_out = window(&due) - due.due * every;
            prop_assert!(left_out.is_multiple_of(every) && (left_out == 0 || due.shown + due.pictures == 0 && left_out <= 4 * every));
            prop_assert!(due.last_period.0 < periods && due.due > 0);
        }
    }

    /// The warm-up does not affect the rate if it takes less than half of the run. A run of twice the length has the
    /// same rate, to within one picture.
    #[test]
    fn a_rate_does_not_depend_on_the_length_of_the_run(filled in 2u64..190, apart in 1u64..9) {
        let [short, long] = [400, 800].map(|periods| count(&filling(filled, apart, periods), 1, periods));
        let expected = long.shown as f64 / long.due as f64 * short.due as f64;
        prop_assert!((short.shown as f64 - expected).abs() <= 1.0, "{:?} {:?}", short, long);
    }

    #[test]
    fn the_share_of_missed_pictures_rises_with_the_time_of_a_picture(first in 0u64..40, every in 1u64..4, apart in 1u64..20) {
        let share = |apart| count(&regular(first, apart, 2_000, Shown), every, 2_000).not_shown_share();
        prop_assert!(share(apart + 1) + 1e-2 >= share(apart));
    }

    #[test]
    fn the_window_holds_every_picture_that_was_not_shown(at in WARM_UP_PERIODS..300, periods in 300u64..400) {
        let mut pictures = regular(0, 1, periods, Shown);
        pictures.retain(|picture| picture.0 != at);
        let due = count(&pictures, 1, periods);
        prop_assert_eq!(due.missed, 1);
        prop_assert!(due.due >= (periods - WARM_UP_PERIODS) / 2);
    }
}
