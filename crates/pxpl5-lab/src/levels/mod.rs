//! The levels of modelling behind one interface, and how they differ: speed against error.

mod compare;

pub use compare::{LevelReport, cases, compare, compare_with, deviation_percent};

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
