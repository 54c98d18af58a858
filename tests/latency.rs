//! Tests of the latencies and limits of the papers, each with the tolerance that its derivation allows.
//! `tests/published.rs` covers the same and more through the table of figures. Here, each experiment is independent.

use crate::support::video;
use pxpl5::{
    Arrival, Code, Experiment, Eye, MachineConfig, Measured, Outcome, PeriodNumber, PictureNumber, PictureTimes,
    Pixels, RenderingControl, Slats, StageSpan, scene,
};
use pxpl5_framebuffer::Video;
use pxpl5_gp::Stage;

/// Time of a region of 15 messages with 1,024 + 16 words of 50 ns (TR94: 780 us).
const REGION_US: f64 = 780.0;

fn run(experiment: Experiment) -> Outcome {
    experiment.pixels(Pixels::Off).run().expect("it runs")
}

fn trivial() -> Outcome {
    let scene = scene::builtin("full-screen:12").expect("built in");
    run(Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60))
}

fn slats(machine: &str, pipeline: Slats, triangles: usize) -> Outcome {
    let scene = scene::builtin(&format!("full-screen:{triangles}")).expect("built in");
    run(Experiment::new(MachineConfig::preset(machine).expect("listed"), pipeline, scene).fields(16))
}

fn stages(outcome: &Outcome, stage: Stage, picture: PictureNumber) -> Vec<StageSpan> {
    let message = outcome.record().ring().timing().occupancy(1_024);
    outcome.observation().stages(message).into_iter().filter(|s| s.stage == stage && s.picture == picture).collect()
}

/// Returns the time from the first word of the first region to the last pixel of the last region, in microseconds.
fn copy_us<'a>(arrivals: impl Iterator<Item = &'a Arrival> + Clone) -> f64 {
    let begin = arrivals.clone().map(|a| a.first_part_at.0).min().expect("regions") - 52_000_000;
    let end = arrivals.map(|a| a.last_part_at.0).max().expect("regions");
    (end - begin) as f64 * 1e-6
}

#[test]
fn figure_1_a_region_of_15360_pixels_is_copied_in_780_us() {
    let outcome = slats("slats", Slats::split(), 60);
    for arrival in &outcome.observation().arrivals {
        assert!((copy_us([arrival].into_iter()) - REGION_US).abs() < 1e-6, "{arrival:?}");
    }
}

#[test]
fn figure_2_both_eyes_are_copied_in_31_2_ms() {
    // 2 x 640 x 480 pixels in messages of 1,024 words take 600 x 52 us = 31.2 ms of port time, one eye after the other.
    // At the begin and between the eyes, a renderer may keep a port waiting: 0.2 %.
    let outcome = trivial();
    let ms: f64 = stages(&outcome, Stage::Copy, PictureNumber(10))
        .iter()
        .map(|s| (s.end.expect("copied") - s.begin).as_ms())
        .sum();
    assert!((ms / 31.2 - 1.0).abs() < 0.002, "{ms} ms");
}

#[test]
fn figure_4_a_trivial_stereo_scene_is_6_percent_later_than_measured() {
    // FIXME(accuracy): the published value is 56.5 ms, as a mean over both eyes from the start of each TRANSFORM. The
    // frame rate is exact.
    let outcome = trivial();
    let both = outcome.summary().eye_swap_latencies_ms;
    let mean = both.iter().sum::<f64>() / both.len() as f64;
    assert!((mean / 56.5 - 1.057).abs() < 0.005, "{mean} ms");
    assert!((outcome.report().updates_hz.expect("two pictures") - 30_000.0 / 1_001.0).abs() < 1e-3);
}

/// Returns true if a picture begins with a field and is shown with the next one.
fn takes_one_field(times: &PictureTimes, video: &Video) -> bool {
    let started = video.field_at(times.transform_at);
    times.transform_at == video.retrace(started) && times.shown_at == video.retrace(started.next())
}

#[test]
fn figure_9_slats_shows_every_field_exactly_one_field_after_its_start() {
    for pipeline in [Slats::split(), Slats::whole()] {
        let outcome = slats("slats", pipeline, 100);
        assert!(outcome.steady_pictures().iter().all(|times| takes_one_field(times, video(&outcome))));
        assert!((outcome.report().updates_hz.expect("two pictures") - 60_000.0 / 1_001.0).abs() < 1e-3);
    }
}

#[test]
fn figure_10_twenty_field_regions_take_eleven_region_times() {
    // Left and right regions alternate in order of arrival, so at each end one board idles for one region. The change
    // between boards takes a renderer a cycle, a word and up to 8 hops: below 2 us in all.
    let outcome = slats("slats", Slats::whole(), 60);
    let us = copy_us(outcome.observation().arrivals.iter().filter(|a| a.target.picture == PictureNumber(6)));
    assert!((11.0 * REGION_US..11.0 * REGION_US + 2.0).contains(&us), "{us} us");
}

#[test]
fn figure_11_half_of_the_field_regions_take_3_9_ms() {
    let outcome = slats("slats", Slats::split(), 60);
    for bottom in [false, true] {
        let half = |a: &&Arrival| a.target.picture == PictureNumber(6) && (a.target.region.0 >= 5) == bottom;
        let us = copy_us(outcome.observation().arrivals.iter().filter(half));
        // The changes between renderers take less than a microsecond. The paths of the first and of the last renderer
        // differ by up to 8 hops.
        assert!((us - 5.0 * REGION_US).abs() < 1.5, "{us} us");
    }
}

#[test]
fn the_top_half_is_copied_before_the_retrace_and_the_bottom_half_after_it() {
    let outcome = slats("slats", Slats::split(), 100);
    let retrace = video(&outcome).retrace(PeriodNumber(6));
    for arrival in outcome.observation().arrivals.iter().filter(|a| a.target.picture == PictureNumber(6)) {
        let top = arrival.target.region.0 < 5;
        assert_eq!(arrival.last_part_at < retrace, top, "{arrival:?}");
    }
}

fn misses(machine: &str, pipeline: Slats, triangles: usize) -> bool {
    slats(machine, pipeline, triangles).report().missed_retraces > Some(0)
}

#[test]
fn figure_12_without_the_copy_optimisation_the_code_draws_122_triangles_where_110_were_measured() {
    // FIXME(accuracy): the limit is 11 % too high, although no number was fitted to it.
    assert!(!misses("slats", Slats::whole(), 122));
    assert!(misses("slats", Slats::whole(), 123));
}

#[test]
fn figure_13_with_the_copy_optimisation_the_code_draws_190_triangles_where_140_were_measured() {
    // FIXME(accuracy): the limit is 36 % too high, although no number was fitted to it.
    assert!(!misses("slats", Slats::split(), 140));
    assert!(!misses("slats", Slats::split(), 190));
    assert!(misses("slats", Slats::split(), 191));
}

#[test]
fn figure_14_the_code_of_1995_draws_about_100_triangles() {
    let of_1995 = Slats { code: Some(Code::Of1995), ..Slats::split() };
    for (machine, pipeline) in [("slats-1995", Slats::split()), ("slats", of_1995)] {
        assert!(!misses(machine, pipeline, 100));
        assert!(misses(machine, pipeline, 103));
    }
}

/// Returns the time at which the first region of a field is copied, in milliseconds after the retrace.
fn first_copy_ms(triangles: usize) -> f64 {
    let outcome = slats("slats", Slats::split(), triangles);
    let top =
        outcome.observation().arrivals.iter().filter(|a| a.target.picture == PictureNumber(6) && a.target.region.0 < 5);
    let begin = top.map(|a| a.first_part_at.0).min().expect("regions") - 52_000_000;
    (begin - video(&outcome).retrace(PeriodNumber(5)).0) as f64 * 1e-9
}

/// I3D95 prints "about 12.8 ms". The latest possible begin is 16.683 - 5 x 0.78 = 12.78 ms. 190 triangles are the most
/// that are in time. One more triangle begins later than a renderer's acknowledgement (two messages of 16 us and their
/// way) allows.
#[test]
fn figure_15_the_first_copy_begins_about_12_8_ms_after_the_retrace() {
    let [most, too_many] = [190, 191].map(first_copy_ms);
    let latest = 16.683 - 5.0 * 0.78;
    assert!((most / 12.8 - 1.0).abs() < 0.03, "{most} ms");
    assert!(most < latest && too_many > latest - 0.05, "{most} and {too_many} ms, at the latest {latest}");
}

#[test]
fn a_field_with_too_many_triangles_has_late_regions_and_a_picture_is_still_shown() {
    let scene = scene::builtin("full-screen:200").expect("built in");
    let outcome = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(16).run().expect("it runs");
    let report = outcome.report();
    assert!(report.missed_retraces > Some(0) && report.late_regions > 0);
    assert!(report.first_late_regions.iter().all(|late| late.lateness.0 > 0));
    assert!(outcome.picture(Eye::Left).is_some());
}
