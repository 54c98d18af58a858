//! Tests that an automatically chosen level of detail stays within its bound of the cycle level.

use pxpl5_lab::levels::{choose_level, compared_ms, deviation_percent, random_experiment, summarise};
use pxpl5_lab::registry;
use pxpl5_run::{Experiment, ExperimentError, Level};
use rayon::prelude::*;
use std::time::Instant;

/// Bounds in percent.
const BOUNDS: [f64; 4] = [1.0, 2.0, 5.0, 10.0];

/// Returns the compared time in milliseconds and the computing time in seconds.
fn run(experiment: &Experiment) -> (f64, f64) {
    let begun = Instant::now();
    let value = match summarise(&registry(), experiment) {
        Ok(summary) => compared_ms(experiment, &summary),
        Err(ExperimentError::TooShort { .. } | ExperimentError::Run { .. }) => f64::NAN,
        Err(error) => panic!("{error}"),
    };
    (value, begun.elapsed().as_secs_f64())
}

/// Tests that at least 95 % of the chosen runs of 200 experiments lie within the bound. By day, a sample is run. By
/// night, runs for a bound of 5 % or more must also take at most half of the time of the transaction level, and the same
/// holds for the 400 experiments that were in view when the margins were chosen (docs/speed.md).
#[test]
fn at_least_95_percent_of_chosen_levels_lie_within_the_bound() {
    let by_night = std::env::var_os("PXPL5_ALL_CASES").is_some();
    let numbers: Vec<u64> = if by_night { (0..600).collect() } else { (400..600).step_by(14).collect() };
    let of_number = |number: &u64| {
        let experiment = random_experiment(*number).expect("in range");
        let cycle = run(&experiment.clone().level(Level::Cycle));
        let transaction_s = if by_night { run(&experiment.clone().level(Level::Transaction)).1 } else { 0.0 };
        let chosen = BOUNDS.map(|bound| {
            let begun = Instant::now();
            let (choice, chosen) = choose_level(&registry(), &experiment, bound, false);
            let choosing_s = begun.elapsed().as_secs_f64();
            let (value, seconds) = if choice.level == Level::Cycle { cycle } else { run(&chosen) };
            (choice.level, deviation_percent(value, cycle.0), choosing_s + seconds)
        });
        (*number, chosen, transaction_s)
    };
    let all: Vec<_> = numbers.par_iter().map(of_number).collect();
    let transaction_s: f64 = all.iter().map(|(.., seconds)| seconds).sum();
    for (i, bound) in BOUNDS.into_iter().enumerate() {
        for (set, range) in [("seen", 0..400), ("new", 400..600)] {
            let of_set: Vec<_> = all.iter().filter(|(number, ..)| range.contains(number)).collect();
            let outside: Vec<_> = of_set.iter().filter(|(_, chosen, _)| chosen[i].1 > bound).collect();
            let taken = Level::ALL.map(|level| of_set.iter().filter(|(_, chosen, _)| chosen[i].0 == level).count());
            let outside: Vec<_> = outside.iter().map(|(number, chosen, _)| (number, chosen[i])).collect();
            println!("{bound} %, {set}: {taken:?}, outside of {}: {outside:?}", of_set.len());
            assert!(outside.len() * 20 <= of_set.len(), "{bound} %: {outside:?}");
        }
        let chosen_s: f64 = all.iter().map(|(_, chosen, _)| chosen[i].2).sum();
        println!("{bound} %: {chosen_s:.1} s, transaction {transaction_s:.1} s");
        assert!(!by_night || bound < 5.0 || 2.0 * chosen_s <= transaction_s, "{bound} %: {chosen_s} s");
    }
}
