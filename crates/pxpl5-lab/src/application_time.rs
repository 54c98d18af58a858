//! Effect of the application's time per frame on the latencies of fly-throughs.
//!
//! No paper prints this time.
//!
//! The host of a real viewer ran a loop under Unix that read input, changed its scene, and asked for the next frame.
//! The simulated host asks for the next frame immediately unless `host.application_ns` and `host.application_jitter_ns`
//! are set. This module varies both parameters and reports the mean and standard deviation of each figure. No parameter
//! is fitted to the results.
//!
//! TR94 prints 30 frames/s for a trivial scene. This rate limits the application's time for the trivial scene. TR94
//! prints no rate for the fly-throughs, whose application may therefore have been slower. This module assumes mean
//! times up to 40 ms and jitters up to 30 ms. A Unix host polled its serial ports once in 30 ms (TR94).

use crate::figures::{Bench, FIGURES};
use crate::parallel;
use pxpl5_run::{ExperimentError, Level};
use serde::Serialize;

const MEAN: &str = "host.application_ns";
const JITTER: &str = "host.application_jitter_ns";

/// Mean times of the application in milliseconds. Assumed: from no application to a loop of 25 frames a second.
const MEANS_MS: [u64; 5] = [0, 10, 20, 30, 40];

/// Jitters of the application's time in milliseconds. A jitter above the mean time is skipped, because some times would
/// be negative. Assumed: up to 30 ms, the period at which a Unix host polled its serial ports (TR94).
const JITTERS_MS: [u64; 4] = [0, 10, 20, 30];

/// Numbers of the fly-through latencies in [`FIGURES`].
const FLY_THROUGHS: [&str; 3] = ["7", "7b", "7c"];

/// Mean and standard deviation of one published latency of a fly-through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct FlyThroughLatency {
    /// Number of the figure in [`FIGURES`].
    pub id: &'static str,
    /// Mean of all latency samples, in the figure's unit.
    pub mean: f64,
    /// Standard deviation of all latency samples, in the figure's unit.
    pub sd: f64,
}

/// Latencies of all fly-throughs for one mean and one jitter of the application's time.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ApplicationTime {
    /// Mean time of the application for a frame, in milliseconds.
    pub mean_ms: u64,
    /// Half the width of the uniform distribution of the application's time, in milliseconds.
    pub jitter_ms: u64,
    /// Latencies of fly-throughs of the scenes "mig", "molecules" and "head", in this order.
    pub figures: Vec<FlyThroughLatency>,
}

/// Simulates the fly-throughs for all times of the application at the analytic level. `bench` holds the interpretation
/// of the papers and the numbers of seeds and frames.
///
/// # Errors
///
/// Fails in the same cases as [`Bench::measure`].
pub fn application_times(bench: &Bench) -> Result<Vec<ApplicationTime>, ExperimentError> {
    let times = MEANS_MS.iter().flat_map(|mean| JITTERS_MS.iter().map(|jitter| (*mean, *jitter)));
    // A jitter greater than the mean would need negative times.
    let times: Vec<_> = times.filter(|(mean, jitter)| jitter <= mean).collect();
    parallel::map(&times, |(mean_ms, jitter_ms)| measure(bench, *mean_ms, *jitter_ms)).into_iter().collect()
}

fn measure(bench: &Bench, mean_ms: u64, jitter_ms: u64) -> Result<ApplicationTime, ExperimentError> {
    let changes = [(MEAN, mean_ms), (JITTER, jitter_ms)].map(|(path, ms)| (path.to_owned(), ms * 1_000_000));
    let changes = bench.changes.iter().cloned().chain(changes).collect();
    // This bench differs from the argument only in these two parameters and in the level.
    let bench = Bench { level: Level::Analytic, changes, ..bench.clone() };
    let spread = |id: &'static str| {
        let measured = bench.measure(id)?;
        let sd = measured.details.iter().find(|detail| detail.name == "standard deviation");
        Ok(FlyThroughLatency { id, mean: measured.value, sd: sd.map_or(f64::NAN, |detail| detail.value) })
    };
    let figures = FLY_THROUGHS.into_iter().map(spread).collect::<Result<_, ExperimentError>>()?;
    Ok(ApplicationTime { mean_ms, jitter_ms, figures })
}

/// Returns the mean and the standard deviation that TR94 prints for the latency of each fly-through.
pub fn published() -> Vec<FlyThroughLatency> {
    let of_fly_throughs = FIGURES.iter().filter(|figure| FLY_THROUGHS.contains(&figure.id));
    of_fly_throughs
        .map(|figure| FlyThroughLatency { id: figure.id, mean: figure.value, sd: figure.spread.unwrap_or(f64::NAN) })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_application_time_of_zero_leaves_the_figures_unchanged() {
        let bench = Bench::new(Level::Analytic).with_mig(2, 60);
        let as_it_is = bench.measure("7").expect("the mig").value;
        let at_once = measure(&bench, 0, 0).expect("the scenes are there");
        assert_eq!(at_once.figures.iter().map(|spread| spread.id).collect::<Vec<_>>(), FLY_THROUGHS);
        assert_eq!(at_once.figures[0].mean, as_it_is);
    }

    #[test]
    fn the_studied_application_times_include_the_end_of_each_parameter_range() {
        let parameters = pxpl5_machine::MachineConfig::small_hmd().parameters();
        let last_ms = |path: &str| {
            let parameter = parameters.iter().find(|parameter| parameter.path == path).expect("a parameter");
            parameter.info.whole_range().expect("whole").1 / 1_000_000
        };
        assert!(MEANS_MS.contains(&last_ms(MEAN)) && JITTERS_MS.contains(&last_ms(JITTER)));
    }
}
