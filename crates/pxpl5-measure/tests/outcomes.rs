//! Measurements of an outcome besides its report: parts of the latency, latencies by eye, and pictures.

use crate::support::experiment;
use pxpl5_gp::Stage;
use pxpl5_measure::{Measure, Measured, Results, screen};
use pxpl5_run::{ExperimentError, Outcome, Pixels};
use pxpl5_wire::display::Counter;
use pxpl5_wire::{Eye, PeriodNumber, SurfaceId};

fn run(pipeline: &str, fields: u64, pixels: Pixels) -> Outcome {
    match experiment(pipeline, "sphere:10").fields(fields).pixels(pixels).run() {
        Ok(outcome) => outcome,
        Err(ExperimentError::TooShort { partial, .. }) => *partial,
        Err(error) => panic!("{error}"),
    }
}

#[test]
fn statistics_of_stages_equal_those_of_the_single_pictures() {
    let outcome = run("rendering-control", 60, Pixels::Off);
    let parts = outcome.latency_parts();
    let report = outcome.report();
    assert!(parts.len() > 3, "pictures after the warm-up");
    assert!(!report.latency_parts_ms.is_empty());
    for (k, named) in report.latency_parts_ms.iter().enumerate() {
        let mean = parts.iter().map(|part| part.spans[k].as_ms()).sum::<f64>() / parts.len() as f64;
        let found = &named.statistics.statistics;
        assert_eq!(found.n, parts.len() as u64, "{}", named.name);
        assert!((found.mean - mean).abs() < 1e-9, "{}: {} {mean}", named.name, found.mean);
    }
}

/// The latency of a pair lasts from the start of the first eye's TRANSFORM to the event of the later eye.
#[test]
fn the_latency_of_a_stereo_pair_is_at_least_the_latency_of_each_eye() {
    let outcome = run("rendering-control", 60, Pixels::Off);
    let latencies = outcome.latency_by_surface();
    assert_eq!(latencies, outcome.report().latency_by_eye_ms);
    let mean = |of: &str, until: &str| {
        let found = latencies.iter().find(|latency| latency.of == of && latency.until == until);
        found.unwrap_or_else(|| panic!("{of} {until}: {latencies:?}")).statistics.statistics.mean
    };
    for until in ["end_of_copy", "swap", "light"] {
        let [left, right, pair] = ["left", "right", "pair"].map(|of| mean(of, until));
        assert!(pair > right && pair >= left, "{until}: {left} {right} {pair}");
    }
    for latency in &latencies {
        let eye = if latency.of == "right" { "right" } else { "left" };
        let begin = format!("from the start of the {eye} eye's TRANSFORM");
        assert!(latency.statistics.definition.starts_with(&begin), "{latency:?}");
    }
}

#[test]
fn stages_equal_those_of_the_machine_and_are_null_before_the_first_picture() {
    let results = |fields| Results::of_run(run("rendering-control", fields, Pixels::Off));
    let value = |results: &Results, name: &str| Measure::named(name).expect("a quantity").of(results);
    let [long, short] = [results(60), results(3)];
    let tally = long.run.as_ref().expect("a run").0.tally();
    for (name, stage) in [("transform_ms", Stage::Transform), ("render_ms", Stage::Render)] {
        let samples = tally.stage_ms.iter().find_map(|(of, samples)| (*of == stage).then_some(samples));
        assert_eq!(value(&long, name), Some(samples.expect("a stage").statistics().mean), "{name}");
        assert_eq!(value(&short, name), None, "{name}");
    }
}

#[test]
fn the_outcome_has_the_picture_of_the_display_and_without_pixels_no_picture() {
    let outcome = run("rendering-control", 14, Pixels::All);
    for eye in Eye::BOTH {
        let picture = outcome.picture(eye).expect("pixels are on");
        assert_eq!(picture.dimensions(), (640, 480));
        let expected = outcome.pipeline().picture(outcome.record(), eye.into()).expect("shown");
        assert!(picture == expected, "{eye:?}");
        assert!(picture.pixels().any(|pixel| *pixel != picture[(0, 0)]), "a sphere before the background");
    }
    assert_eq!(run("rendering-control", 14, Pixels::Off).picture(Eye::Left), None);
}

#[test]
fn a_missing_surface_is_black() {
    let outcome = run("rendering-control", 14, Pixels::All);
    let nowhere = screen(outcome.record(), SurfaceId(9), PeriodNumber(12), None);
    assert_eq!(nowhere.dimensions(), (640, 480));
    assert!(nowhere.pixels().all(|pixel| pixel.0 == [0; 3]));
}

#[test]
fn the_reported_number_of_lines_never_shown_is_the_counter_with_this_name() {
    let mut report = run("slats", 4, Pixels::Off).report();
    let counter = |name, count| Counter { name, count };
    report.display_counters = vec![counter("swaps", 3), counter(Counter::LINES_NEVER_SHOWN, 7), counter("more", 5)];
    assert_eq!(report.lines_never_shown(), Some(7));
    report.display_counters.remove(1);
    assert_eq!(report.lines_never_shown(), None);
}
