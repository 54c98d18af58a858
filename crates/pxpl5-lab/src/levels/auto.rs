//! The cheapest level of detail whose deviation from the cycle level stays within a bound.
//!
//! The table has mean times of the i860 code, and the cycle level runs this code for every triangle. So the cheaper
//! levels deviate in three ways, and each gives a condition:
//!
//! - **Starts.** They know the start of the code for a pass or a chain of messages only as a mean. This costs a fixed
//!   time, which matters where the measured time is short.
//! - **Waits.** The closed form of Slats adds the preparation of two chains of copy commands where several processors
//!   overlap it with their clumps.
//! - **Edges.** A picture waits for a retrace, so a small change of a time moves a latency by a whole period. The closed
//!   form shows this: it is evaluated with triangles that take a little more or less time.

use super::{compared_ms, deviation_percent, summarise};
use pxpl5_run::{Experiment, ExperimentError, Level, Registry};

/// A level of detail for an experiment, with the reason for the choice.
#[derive(Clone, Debug, PartialEq)]
pub struct LevelChoice {
    /// Chosen level.
    pub level: Level,
    /// Expected deviation from the cycle level, in percent.
    pub expected_percent: f64,
    /// Reason, for a reader.
    pub reason: String,
}

/// Fixed deviation of the transaction level, in milliseconds. Assumed, 0.02 to 0.04: it covers the random experiments
/// with even and odd numbers below 200, of which half were used to find it.
const STARTS_MS: f64 = 0.03;
/// Relative deviations of the analytic and the transaction level, in percent. Assumed, found like `STARTS_MS`.
const RELATIVE: [f64; 2] = [0.6, 0.3];
/// Change of the time of a triangle with which edges are looked for. It is larger than the deviation of a mean time.
const CHANGE: f64 = 0.02;

/// Returns the experiment with the times of its code in the table, at a level and with triangles that take `factor`
/// times as long.
fn with_times(experiment: &Experiment, level: Level, factor: f64) -> Experiment {
    let mut machine = experiment.config().clone().with_times_of_code(experiment.pipeline().code_use());
    machine.gp.triangle_ns = (machine.gp.triangle_ns as f64 * factor).round() as u64;
    experiment.clone().with_machine(machine).level(level)
}

/// Chooses the cheapest level whose expected deviation from the cycle level is at most `within_percent`. Returns the
/// choice, and the experiment at this level with the times of its code. The analytic level is left out if
/// `needs_events` is true.
///
/// Pipelines without a closed form, and tracked heads, run at the cycle level, because nothing tells how near they are
/// to an edge.
pub fn choose_level(
    registry: &Registry,
    experiment: &Experiment,
    within_percent: f64,
    needs_events: bool,
) -> (LevelChoice, Experiment) {
    let chosen = |level, expected_percent, reason: String| {
        let choice = LevelChoice { level, expected_percent, reason };
        (
            choice,
            if level == Level::Cycle { experiment.clone().level(level) } else { with_times(experiment, level, 1.0) },
        )
    };
    let value = |factor| -> Result<f64, ExperimentError> {
        let changed = with_times(experiment, Level::Analytic, factor);
        Ok(compared_ms(&changed, &summarise(registry, &changed)?))
    };
    let values =
        match experiment.tracked_head() {
            Some(_) => Err("a tracked head has no closed form".to_owned()),
            None => [1.0, 1.0 - CHANGE, 1.0 + CHANGE].map(value).into_iter().collect::<Result<Vec<f64>, _>>().map_err(
                |error| match error {
                    ExperimentError::Level => format!("{} has no closed form", experiment.pipeline().name()),
                    other => format!("the closed form says: {other}"),
                },
            ),
        };
    let values = match values {
        Ok(values) if values[0].is_finite() => values,
        Ok(_) => return chosen(Level::Cycle, 0.0, "the closed form shows no picture in time".to_owned()),
        Err(reason) => return chosen(Level::Cycle, 0.0, reason),
    };
    let edge = values[1..].iter().map(|value| deviation_percent(*value, values[0])).fold(0.0, f64::max);
    if edge > 1.25 * 100.0 * CHANGE && edge > within_percent {
        let reason = format!(
            "a retrace is so near that triangles of {:.0} % more time change it by {edge:.0} %",
            100.0 * CHANGE
        );
        return chosen(Level::Cycle, 0.0, reason);
    }
    let gp = with_times(experiment, Level::Analytic, 1.0);
    let waits_ms = if gp.config().n_gps > 1 { 2e-6 * gp.config().gp.message_ns as f64 } else { 0.0 };
    let expected = |relative, fixed_ms| relative + 100.0 * fixed_ms / values[0];
    let analytic = expected(RELATIVE[0], waits_ms + STARTS_MS / 3.0);
    if !needs_events && analytic <= within_percent {
        return chosen(Level::Analytic, analytic, format!("{analytic:.1} % are expected, and no retrace is near"));
    }
    let why_not =
        if needs_events { "events are needed".into() } else { format!("analytic may be off by {analytic:.1} %") };
    let transaction = expected(RELATIVE[1], STARTS_MS);
    if transaction <= within_percent {
        return chosen(Level::Transaction, transaction, format!("{transaction:.1} % are expected; {why_not}"));
    }
    chosen(
        Level::Cycle,
        0.0,
        format!("transaction may be off by {transaction:.1} %, because {:.2} ms are short", values[0]),
    )
}
