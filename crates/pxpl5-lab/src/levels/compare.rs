//! Comparison of the levels of detail by speed and error, with the same experiments at every level.

use super::random::{compared_ms, experiment};
use super::record::{LevelRecord, LevelReport, LevelSpeed, SCHEMA, Spread};
use super::{deviation_percent, summarise};
use crate::StopFlag;
use crate::figures::{Bench, FIGURES, Figure, FigureRow, mean_error_percent};
use crate::parallel;
use pxpl5_run::{Experiment, ExperimentError, Level, Pixels};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Instant;

/// Levels of detail to compare. The boolean is true if the timing table has times that were measured by executing i860
/// code, instead of published or fitted times. The cycle level appears once, because it does not use the timing table.
const VARIANTS: [(Level, bool); 5] = [
    (Level::Analytic, false),
    (Level::Analytic, true),
    (Level::Transaction, false),
    (Level::Transaction, true),
    (Level::Cycle, true),
];

/// Choices of computed pixels for which the speed is measured. The analytic level has no pixels.
const PIXELS: [Pixels; 3] = [Pixels::Off, Pixels::Lazy, Pixels::All];

/// Number of seeds and of frames of the scene "mig". Small numbers suffice, because only the levels are compared.
const MIG: (u64, u64) = (2, 60);

/// Number of experiments whose speed is measured. They run one after the other on an otherwise idle computer.
const TIMED: u64 = 16;

/// Parameters of a comparison of the levels of detail.
#[derive(Clone, Debug)]
pub struct LevelQuery {
    /// Number of random experiments in which each level is compared with the cycle level.
    pub experiments: u64,
    /// True if speeds are measured as well, which requires an otherwise idle computer.
    pub speeds: bool,
    /// Flag with which another thread stops the comparison.
    pub stop: StopFlag,
}

impl Default for LevelQuery {
    fn default() -> Self {
        Self { experiments: 200, speeds: true, stop: StopFlag::default() }
    }
}

/// Compares all levels on this host. Calls `finished` with the number of finished steps and the number of all steps.
///
/// # Errors
///
/// Returns the first [`ExperimentError`], and [`ExperimentError::Stopped`] if another thread sets the query's flag.
pub fn compare_with(query: LevelQuery, finished: impl Fn(u64, u64) + Sync) -> Result<LevelRecord, ExperimentError> {
    let of_variant = FIGURES.len() as u64 + query.experiments;
    let steps = VARIANTS.len() as u64 * of_variant;
    let done = AtomicU64::new(0);
    let step = || finished(done.fetch_add(1, Ordering::Relaxed) + 1, steps);
    let numbers: Vec<u64> = (0..query.experiments).collect();
    let mut of_experiments = Vec::new();
    // Run the random experiments at every level first. The last level, cycle, is the reference for the deviations.
    for variant in VARIANTS {
        let values = parallel::map(&numbers, |number| {
            let value = value(variant, *number, &query.stop);
            step();
            value
        });
        of_experiments.push(values.into_iter().collect::<Result<Vec<f64>, _>>()?);
    }
    let of_cycle = of_experiments.last().cloned().unwrap_or_default();
    let mut levels = Vec::new();
    for (variant, values) in VARIANTS.into_iter().zip(&of_experiments) {
        let rows = rows_of(variant, &query.stop, &step)?;
        // Compare each level with the cycle level, experiment by experiment.
        let deviations = values.iter().zip(&of_cycle).map(|(value, of_cycle)| deviation_percent(*value, *of_cycle));
        let is_cycle = variant.0 == Level::Cycle;
        levels.push(LevelReport {
            level: variant.0,
            times_of_code: variant.1,
            published_error_percent: Some(mean_error_percent(&rows)),
            from_cycle_percent: if is_cycle { None } else { Spread::of(deviations.collect()) },
            speeds: speeds(variant, &query)?,
        });
    }
    Ok(LevelRecord {
        schema: SCHEMA.to_owned(),
        experiments: query.experiments,
        note: None,
        date: None,
        host: None,
        levels,
    })
}

fn of_variant((level, times_of_code): (Level, bool), number: u64) -> Result<Experiment, ExperimentError> {
    let experiment = experiment(number)?.level(level);
    if !times_of_code || level == Level::Cycle {
        return Ok(experiment);
    }
    let machine = experiment.config().clone().with_times_of_code(experiment.pipeline().code_use());
    let other = Experiment::with(machine, Arc::clone(experiment.pipeline()), Arc::clone(experiment.scene()));
    Ok(other.fields(experiment.length()).seed(experiment.motion_seed()).pixels(Pixels::Off).level(level))
}

/// Runs the random experiment `number`, and returns the time that is compared between levels, in milliseconds. The
/// value is NaN if no picture is shown.
fn value(variant: (Level, bool), number: u64, stop: &StopFlag) -> Result<f64, ExperimentError> {
    stop.check()?;
    let experiment = of_variant(variant, number)?.host(stop.clone());
    match summarise(&crate::registry(), &experiment) {
        Ok(summary) => Ok(compared_ms(&experiment, &summary)),
        Err(ExperimentError::TooShort { .. } | ExperimentError::Run { .. }) => Ok(f64::NAN),
        Err(error) => Err(error),
    }
}

fn rows_of(
    (level, times_of_code): (Level, bool),
    stop: &StopFlag,
    step: &(impl Fn() + Sync),
) -> Result<Vec<FigureRow>, ExperimentError> {
    let bench = Bench::new(level).with_mig(MIG.0, MIG.1).with_stop(stop.clone());
    let bench = if times_of_code { bench.with_times_of_code() } else { bench };
    let row = |figure: &Figure| {
        let measured = bench.measure(figure.id)?;
        step();
        Ok(figure.row(measured))
    };
    parallel::map(&FIGURES, row).into_iter().collect()
}

fn speeds(variant: (Level, bool), query: &LevelQuery) -> Result<Vec<LevelSpeed>, ExperimentError> {
    let choices = if variant.0 == Level::Analytic { &PIXELS[..1] } else { &PIXELS[..] };
    let speed = |pixels: &Pixels| {
        let simulated_seconds_per_second =
            if query.speeds { Some(speed(variant, *pixels, &query.stop)?) } else { None };
        Ok(LevelSpeed { pixels: *pixels, simulated_seconds_per_second })
    };
    choices.iter().map(speed).collect()
}

/// Runs all timed experiments, and returns the simulated seconds per second of computing time.
fn speed(variant: (Level, bool), pixels: Pixels, stop: &StopFlag) -> Result<f64, ExperimentError> {
    let registry = crate::registry();
    let (mut simulated, mut taken) = (0.0, 0.0);
    for number in 0..TIMED {
        let experiment = of_variant(variant, number)?.pixels(pixels).host(stop.clone());
        simulated += experiment.length() as f64 * experiment.config().period()?.as_ms() * 1e-3;
        // Only the simulation is timed, not the construction of the scene.
        let begin = Instant::now();
        let result = if variant.0 == Level::Analytic {
            summarise(&registry, &experiment).map(|_| ())
        } else {
            experiment.run().map(|_| ())
        };
        taken += begin.elapsed().as_secs_f64();
        // The time of runs that are too short counts too.
        match result {
            Ok(()) | Err(ExperimentError::TooShort { .. } | ExperimentError::Run { .. }) => {}
            Err(error) => return Err(error),
        }
    }
    Ok(simulated / taken)
}
