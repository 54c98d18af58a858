//! The levels of modelling behind one interface, and how they differ: speed against error.

mod compare;

pub use compare::{LevelReport, cases, compare, compare_with};

use pxpl5_measure::summary;
use pxpl5_run::{Experiment, ExperimentError, Level, Registry, Summary};

/// What comes of an experiment at its level of modelling, without pixels.
///
/// # Errors
///
/// As [`Experiment::run`]; at the analytic level, the closed form's, or that there is none.
pub fn summarise(registry: &Registry, experiment: &Experiment) -> Result<Summary, ExperimentError> {
    if experiment.level_of_modelling() != Level::Analytic {
        return Ok(summary(&experiment.run()?));
    }
    let entry = registry.pipeline(experiment.pipeline().name()).ok();
    match entry.and_then(|entry| entry.closed_form) {
        Some(closed_form) => (closed_form.summary)(experiment),
        None => Err(ExperimentError::Level),
    }
}

/// How far a figure is from that of the cycle level, percent; none where both have no value, or both are 0: pictures that are never in
/// time have no latency.
#[must_use]
pub fn deviation_percent(value: f64, of_cycle: f64) -> f64 {
    match (value.is_finite(), of_cycle.is_finite()) {
        (true, true) if value == of_cycle => 0.0,
        (true, true) => 100.0 * (value / of_cycle - 1.0).abs(),
        (false, false) => 0.0,
        _ => 100.0,
    }
}
