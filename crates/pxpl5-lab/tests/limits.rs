//! Tests of limits found by simulation, and of the analytic level's predictions for random machines.
//!
//! Each case follows from a number, which a failure states. `PXPL5_FUZZ=10` runs ten times as many cases, and
//! `PXPL5_FUZZ_FROM` starts at another number.

use pxpl5_lab::ExperimentFile;
use pxpl5_lab::Study;
use pxpl5_lab::levels::summarise;
use pxpl5_lab::limit::LimitQuery;
use pxpl5_lab::sweep::{Sweep, Swept};
use pxpl5_run::{Experiment, Level, TestScene};
use pxpl5_sim::{SplitMix64, StopFlag};
use rayon::prelude::*;
use std::sync::Arc;

fn setting(name: &str, default: u64) -> u64 {
    std::env::var(name).map_or(default, |text| text.parse().unwrap_or_else(|_| panic!("{name}={text}")))
}

fn query(settings: &[String], scene: TestScene) -> LimitQuery {
    let mut file = ExperimentFile::new();
    for text in settings {
        file.set_text(text, "case").unwrap_or_else(|error| panic!("{text}: {error}"));
    }
    let mut query = LimitQuery::of_plan(&file.resolve().expect("a plan"));
    query.criterion.scene = scene;
    query
}

/// Returns the settings of a Slats machine with random parameters within the ranges of their sources.
fn machine(round: u64) -> (Vec<String>, TestScene) {
    let mut random = SplitMix64::new(round << 8 | 7);
    let mut settings = vec!["pipeline=slats".to_owned(), "scene=mig".to_owned()];
    settings.push(format!("machine.n_gps={}", random.between(1, 50)));
    settings.push(format!("machine.n_renderers={}", random.between(5, 24)));
    let copy = random.element(&["whole", "split"]);
    settings.push(format!("copy={copy}"));
    settings.push(format!("binning={}", random.element(&["all", "touched"])));
    settings.push(format!("code={}", random.element(&["1994", "1995", "optimised"])));
    settings.push(format!("machine.ring.source_channels={}", random.between(1, 2)));
    // Split copies need two of the eight channels while messages go out. The analytic level refuses machines without
    // two free channels.
    let most_channels = if copy == "split" { 6 } else { 7 };
    settings.push(format!("machine.ring.fifo_channels={}", random.between(5, most_channels)));
    settings.push(format!("machine.renderer.fifo_words={}", random.between(400, 512)));
    settings.push(format!("machine.gp.message_ns={}", random.between(10_000, 25_000)));
    (settings, random.element(&TestScene::ALL))
}

/// Largest difference in percent that the documents of the analytic level allow. A difference of so many triangles, or
/// one by which the first copy moves by so many milliseconds (1 % of a field), is also allowed.
const BOUND_PERCENT: f64 = 5.0;
const BOUND_TRIANGLES: u32 = 3;
const BOUND_MS: f64 = 0.167;

/// Returns the time in milliseconds from the retrace to the first copy of a field, at the analytic level.
fn copies_begin_ms(query: &LimitQuery, triangles: u32) -> f64 {
    let scene = query.criterion.scene.with_triangles(triangles);
    let experiment = Experiment::with(query.config.clone(), Arc::clone(&query.pipeline), Arc::new(scene));
    let summary = summarise(&query.registry, &experiment.fields(query.criterion.fields).level(Level::Analytic));
    summary.expect("a closed form").copy_begins_ms
}

#[test]
fn the_analytic_limit_of_slats_is_the_simulated_one_within_its_bound() {
    let from = setting("PXPL5_FUZZ_FROM", 0);
    let cases = 3 * setting("PXPL5_FUZZ", 1);
    let misses = |round| {
        let (settings, scene) = machine(round);
        let simulated = query(&settings, scene);
        let analytic = LimitQuery { level: Level::Analytic, ..simulated.clone() };
        let [found, expected] = [&analytic, &simulated].map(|query| query.run(&mut ()).expect("it runs").triangles);
        let percent = 100.0 * (f64::from(found) / f64::from(expected.max(1)) - 1.0);
        // `apart_ms` is the difference of the two limits as a time, by which the first copy begins later.
        let [at_found, at_expected] = [found + 1, expected + 1].map(|size| copies_begin_ms(&analytic, size));
        let apart_ms = (at_found - at_expected).abs();
        let line =
            format!("{round}: {expected} {found} {percent:+.1} % {apart_ms:.3} ms {scene:?} {}", settings.join(" "));
        if setting("PXPL5_SHOW", 0) == 1 {
            println!("{line}");
        }
        if percent.abs() > BOUND_PERCENT && found.abs_diff(expected) > BOUND_TRIANGLES && apart_ms > BOUND_MS {
            Some(line)
        } else {
            None
        }
    };
    let off: Vec<String> = (from..from + cases).into_par_iter().filter_map(misses).collect();
    assert!(off.is_empty(), "{} of {cases}:\n{}", off.len(), off.join("\n"));
}

#[test]
fn settings_outside_the_analytic_level_are_refused() {
    let of = |gps, channels| {
        let all = [boards(gps, 20), vec![format!("machine.ring.fifo_channels={channels}")]].concat();
        LimitQuery { level: Level::Analytic, ..query(&all, TestScene::Typical) }
            .reached(30)
            .map_err(|error| error.to_string())
    };
    // One GP sends on two channels, even if renderers could receive on more.
    assert_eq!([of(1, 7), of(25, 6)], [Ok(true), Ok(true)]);
    let error = of(25, 7).expect_err("seven and two are more than eight");
    assert!(error.contains("ring.channels: expected at least 9, found 8"), "{error}");
}

fn boards(gps: u32, renderers: u32) -> Vec<String> {
    vec![
        "pipeline=slats".to_owned(),
        "scene=mig".to_owned(),
        format!("machine.n_gps={gps}"),
        format!("machine.n_renderers={renderers}"),
    ]
}

/// Tests 34 GPs that share six channels to 20 renderers. An earlier version of the analytic level gave 1,299 triangles,
/// but only 850 are drawn in time.
#[test]
fn many_senders_are_limited_by_their_shared_channels() {
    let simulated = query(&boards(34, 20), TestScene::Typical);
    let analytic = LimitQuery { level: Level::Analytic, ..simulated.clone() };
    let [simulated, analytic] =
        [simulated, analytic].map(|query| f64::from(query.run(&mut ()).expect("it runs").triangles));
    assert!((analytic / simulated - 1.0).abs() < BOUND_PERCENT / 100.0, "{analytic} for {simulated}");
}

/// TR94 prints 110 triangles for whole copies, to which the papers' time of a triangle is fitted. The 31.2 ms for the
/// copies of a stereo pair allow 30 Hz and not 45.
#[test]
fn a_sweep_finds_the_triangles_of_a_point_for_its_goal() {
    let possible = |settings: &str| {
        let text =
            format!("{settings}\nmeasure = [\"triangles_possible\"]\nlevel = \"analytic\"\n[sweep.grid]\nseed = [1]");
        let sweep = Sweep::new(ExperimentFile::parse(&text, "test").expect("TOML")).expect("a sweep");
        let found = sweep.simulate(0, &StopFlag::default()).expect("it runs");
        assert_eq!((found.measured.len(), found.trace_hash), (1, None));
        found.measured["triangles_possible"]
    };
    assert_eq!(
        possible("pipeline = \"slats\"\nmachine.times = \"papers\"\ncopy = \"whole\"\nscene = \"full-screen:1\"\n"),
        Some(110.0)
    );
    let stereo =
        |hz: u32| possible(&format!("pipeline = \"rendering-control\"\nscene = \"typical:1\"\nlimit.rate_hz = {hz}"));
    assert!(stereo(30) > Some(0.0) && stereo(45) == Some(0.0), "{:?} {:?}", stereo(30), stereo(45));
}

/// Tests every size up to the result, although the search tries only some of them.
#[test]
fn the_first_miss_is_the_smallest_size_that_misses() {
    for (gps, renderers, copy) in [(1, 5, "split"), (3, 9, "whole")] {
        let settings = [boards(gps, renderers), vec![format!("copy={copy}"), "code=1995".to_owned()]].concat();
        let query = query(&settings, TestScene::FullScreen);
        let found = query.run(&mut ()).expect("it runs");
        let least = (1..=found.triangles + 1).find(|size| !query.reached(*size).expect("it runs"));
        assert_eq!(found.first_miss, least, "{settings:?}");
        let without = LimitQuery { uses_hints: false, ..query.clone() }.run(&mut ()).expect("it runs");
        assert_eq!((without.triangles, without.first_miss), (found.triangles, found.first_miss), "{settings:?}");
        assert!(found.tried <= without.tried, "{found:?} {without:?}");
    }
}
