//! Tests of views with several kinds of displays.

use pxpl5_framebuffer::HiResConfig;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::Report;
use pxpl5_run::{Experiment, Outcome, Pixels, RenderingControl, Slats};
use pxpl5_scene::builtin;
use pxpl5_sim::Time;
use pxpl5_views::results::origin;
use pxpl5_views::timeline::{Bar, Timeline, TimelineOptions, svg};
use pxpl5_views::trace_export::{Events, Trace, Track};
use pxpl5_views::{Film, FilmSurfaces};
use pxpl5_wire::{PeriodNumber, SurfaceId};
use std::io::Cursor;

/// Returns an experiment with a display of 1280 x 1024 pixels, 72 times a second.
fn hires(fields: u64) -> Experiment {
    let config = MachineConfig { displays: vec![Box::new(HiResConfig::PAPERS)], ..MachineConfig::small_hmd() };
    let scene = builtin("full-screen:1").expect("built in");
    Experiment::new(config, RenderingControl::mono(), scene).fields(fields)
}

fn run(experiment: Experiment) -> Outcome {
    experiment.pixels(Pixels::Off).run().expect("runs")
}

fn slats(pipeline: Slats) -> Outcome {
    let scene = builtin("full-screen:100").expect("built in");
    run(Experiment::new(MachineConfig::slats(), pipeline, scene).fields(20))
}

fn copies<'a>(timeline: &'a Timeline, row: &str) -> Vec<&'a Bar> {
    timeline.rows.iter().filter(|it| it.name == row).flat_map(|row| &row.bars).collect()
}

fn track<'a>(trace: &'a Trace, group: &str, name: &str) -> Option<&'a Track> {
    trace.tracks.iter().find(|track| trace.groups[track.group] == group && track.name == name)
}

#[test]
fn a_timeline_counts_the_periods_of_its_display() {
    let outcome = run(hires(40));
    let timeline = Timeline::of(&outcome, &TimelineOptions::default());
    for (n, time) in &timeline.retraces {
        assert_eq!(*time, Time(n.0 * 1_000_000_000_000 / 72), "tick {n}");
    }
    let scan = timeline.scans.first().expect("in the drawing");
    // A scan of this display takes its whole period.
    assert_eq!(scan.begin, Time(scan.period.0 * 1_000_000_000_000 / 72));
    assert!(!copies(&timeline, "frame buffer").is_empty());
    assert!(timeline.bars().all(|bar| bar.surface.is_none() && bar.bottom.is_none()));
    let drawing = svg(&outcome, &TimelineOptions::default());
    assert!(roxmltree::Document::parse(&drawing).is_ok());
}

#[test]
fn the_command_that_repeats_a_file_names_the_display() {
    let report = Report::of(&run(hires(40)));
    assert!(origin(&report).contains(&("display", "hires".to_owned())));
}

#[test]
fn only_a_picture_that_a_surface_receives_in_two_parts_has_a_bottom_half_in_the_timeline() {
    let split = Timeline::of(&slats(Slats::split()), &TimelineOptions::default());
    for row in ["left frame buffer", "right frame buffer"] {
        let bars = copies(&split, row);
        let bottoms: Vec<&&Bar> = bars.iter().filter(|bar| bar.bottom == Some(true)).collect();
        assert!(!bottoms.is_empty() && bars.iter().all(|bar| bar.bottom.is_some()));
        // The second row of regions of a field begins at line 120 of the field, which is line 240 of the frame.
        assert!(bottoms.iter().all(|bar| bar.first_line == 240));
    }
    let whole = Timeline::of(&slats(Slats::whole()), &TimelineOptions::default());
    assert!(whole.bars().all(|bar| bar.bottom.is_none() && bar.first_line == 0));
}

#[test]
fn rendering_control_copies_the_picture_of_each_eye_in_one_part() {
    let scene = builtin("full-screen:12").expect("built in");
    let outcome = run(Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(40));
    let timeline = Timeline::of(&outcome, &TimelineOptions::default());
    let right = copies(&timeline, "right frame buffer");
    assert!(!right.is_empty());
    assert!(right.iter().all(|bar| bar.bottom.is_none() && bar.surface == Some(SurfaceId(1))));
}

#[test]
fn every_display_of_a_machine_has_its_groups() {
    let mut config = MachineConfig::small_hmd();
    config.displays.push(Box::new(HiResConfig::PAPERS));
    let scene = builtin("full-screen:12").expect("built in");
    let outcome = run(Experiment::new(config, RenderingControl::stereo(), scene).fields(40));
    let trace = Trace::of(&outcome);
    for (display, hz) in [("ntsc", 60_000.0 / 1_001.0), ("hires", 72.0)] {
        let retraces = track(&trace, &format!("video, {display}"), "retraces").expect("it ticks");
        let Events::Instants(instants) = &retraces.events else { panic!("instants") };
        let expected = (outcome.end().since(Time::ZERO).as_ms() * 1e-3 * hz).floor() as usize + 1;
        assert!(instants.len().abs_diff(expected) <= 1, "{display}: {} instead of {expected}", instants.len());
    }
    assert!(track(&trace, "left frame buffer, ntsc", "COPY").is_some());
    assert!(track(&trace, "left frame buffer, hires", "COPY").is_none(), "no pipeline draws for it");
}

#[test]
fn a_film_has_the_size_and_the_rate_of_its_display() {
    let mut bytes = Vec::new();
    Film::new(hires(10), PeriodNumber(6), 2, FilmSurfaces::All)
        .write(&[("seed", "1".to_owned())], &mut bytes)
        .expect("written");
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().expect("PNG");
    let info = reader.info();
    assert_eq!(info.size(), (1_280, 1_024));
    assert_eq!(info.animation_control().map(|control| control.num_frames), Some(2));
    assert_eq!(info.frame_control().map(|frame| (frame.delay_num, frame.delay_den)), Some((1, 72)));
    assert_eq!(info.utf8_text[0].keyword, "pxpl5 seed");
}

#[test]
fn a_film_of_a_missing_surface_is_refused() {
    let film = Film::new(hires(10), PeriodNumber(6), 2, FilmSurfaces::One(SurfaceId(1)));
    let error = film.write(&[], Vec::new()).expect_err("there is one surface");
    assert_eq!(error.to_string(), "a film of surface 1: the display has 1, counted from 0");
    let nothing = Film::new(hires(10), PeriodNumber(6), 0, FilmSurfaces::All);
    let error = nothing.write(&[], Vec::new()).expect_err("no period").to_string();
    assert!(error.starts_with("a film has 1 to ") && error.ends_with("found 0"), "{error}");
}
