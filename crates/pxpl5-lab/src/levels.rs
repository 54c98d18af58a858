//! A common interface to all levels of detail, and a comparison of the levels by speed and error.

mod auto;
mod compare;
mod random;
mod record;

pub use auto::{LevelChoice, choose_level};
pub use compare::LevelQuery;
pub use random::{compared_ms, experiment as random_experiment};
pub use record::{LevelRecord, LevelReport, LevelSpeed, SCHEMA, Spread};

use pxpl5_run::{Experiment, ExperimentError, Level, Registry, Summary};

/// Runs an experiment at its level of detail, and returns the summary.
///
/// # Errors
///
/// Fails in the same cases as [`Experiment::run`]. At the analytic level, returns the error of the pipeline's closed
/// form, or [`ExperimentError::Level`] if the pipeline has no closed form.
pub fn summarise(registry: &Registry, experiment: &Experiment) -> Result<Summary, ExperimentError> {
    if experiment.level != Level::Analytic {
        return Ok(experiment.run()?.summary());
    }
    let entry = registry.pipeline(experiment.pipeline().name()).ok();
    match entry.and_then(|entry| entry.closed_form) {
        Some(closed_form) => (closed_form.summary)(experiment),
        None => Err(ExperimentError::Level),
    }
}

/// Returns the deviation in percent of a value from the same quantity at the cycle level.
///
/// - The deviation is 0 if neither level has a value, because pictures that are never in time have no latency.
/// - The deviation is 0 if both values are 0.
/// - The deviation is 100 if only one level has a value, or if only the value of the cycle level is 0.
pub fn deviation_percent(value: f64, of_cycle: f64) -> f64 {
    match (value.is_finite(), of_cycle.is_finite()) {
        (true, true) if value == of_cycle => 0.0,
        (true, true) if of_cycle == 0.0 => 100.0,
        (true, true) => 100.0 * (value / of_cycle - 1.0).abs(),
        (false, false) => 0.0,
        _ => 100.0,
    }
}

#[cfg(test)]
mod tests {
    use super::deviation_percent;

    #[test]
    fn a_value_that_only_one_level_has_counts_as_a_hundred_percent() {
        assert!((deviation_percent(103.0, 100.0) - 3.0).abs() < 1e-9);
        assert_eq!([deviation_percent(0.0, 0.0), deviation_percent(f64::NAN, f64::NAN)], [0.0; 2]);
        let one_sided = [(59.94, 0.0), (0.0, 59.94), (1.0, f64::NAN), (f64::NAN, 1.0)];
        assert_eq!(one_sided.map(|(value, of_cycle)| deviation_percent(value, of_cycle)), [100.0; 4]);
    }
}
