//! Comparison of the levels of detail by speed and error, with the same experiments at every level.

use super::random::{compared_ms, experiment};
use super::record::{LevelRecord, LevelReport, LevelSpeed, SCHEMA, Spread};
use super::{deviation_percent, summarise};
use crate::error::StudyError;
use crate::estimate::{BUSY, Estimate};
use crate::figures::{FigureRow, FigureSettings, Headline, Measurement, at_all_levels};
use crate::parallel;
use crate::study::{Study, check};
use pxpl5_run::{Experiment, ExperimentError, Level, Pixels, Summary};
use pxpl5_sim::{SharedWatcher, StopFlag, Watcher};
use std::sync::Arc;
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

/// Number of experiments whose speed is measured. They run one after the other on an otherwise idle computer.
const TIMED: u64 = 16;

/// Parameters of a comparison of the levels of detail.
#[derive(Clone, Debug)]
pub struct LevelQuery {
    /// Number of random experiments in which each level is compared with the cycle level.
    pub experiments: u64,
    /// True if speeds are measured as well, which requires an otherwise idle computer.
    pub speeds: bool,
}

impl Default for LevelQuery {
    fn default() -> Self {
        Self { experiments: 200, speeds: true }
    }
}

/// CPU seconds to simulate the published figures at all levels, one random experiment at all levels, and all speeds; on
/// one core of 3 GHz with the build profile `dist`.
const LEVELS_S: f64 = 56.0;
const EXPERIMENT_S: f64 = 0.52;
const SPEEDS_S: f64 = 23.0;
/// Peak memory in bytes with two threads, rounded up.
const BYTES: f64 = 800e6;

impl Study for LevelQuery {
    type Report = LevelRecord;

    fn estimate(&self, threads: usize) -> Estimate {
        let speeds = if self.speeds { SPEEDS_S } else { 0.0 };
        let seconds = LEVELS_S + EXPERIMENT_S * self.experiments as f64 + speeds;
        Estimate { bytes: BYTES, seconds: BUSY * seconds / threads.max(1) as f64 }
    }

    fn run(&self, watcher: &mut dyn Watcher) -> Result<LevelRecord, StudyError> {
        let query = self;
        let of_variant = at_all_levels().count() as u64 + query.experiments;
        let watcher = SharedWatcher::new(watcher, VARIANTS.len() as u64 * of_variant);
        let stop = watcher.stop();
        // Speeds come first, because they need an idle computer.
        let timed = VARIANTS.iter().map(|variant| timed(*variant, query, &stop)).collect::<Result<Vec<_>, _>>()?;
        // The cycle level starts first, because its runs take longest.
        let variants = || (0..VARIANTS.len()).rev();
        let experiments: Vec<(usize, u64)> =
            variants().flat_map(|variant| (0..query.experiments).map(move |number| (variant, number))).collect();
        let figures: Vec<(usize, &Measurement)> =
            variants().flat_map(|variant| at_all_levels().map(move |figure| (variant, figure))).collect();
        let value = |(variant, number): &(usize, u64)| {
            // Timed runs have a value already.
            watcher.part(|| match timed[*variant].values.get(*number as usize) {
                Some(value) => Ok(*value),
                None => value(VARIANTS[*variant], *number, &stop),
            })
        };
        let settings = settings(&stop);
        let row = |(variant, figure): &(usize, &Measurement)| watcher.part(|| figure.measured_row(&settings[*variant]));
        let (values, rows) = parallel::both(|| parallel::map(&experiments, value), || parallel::map(&figures, row));
        let values = values.into_iter().collect::<Result<Vec<f64>, _>>()?;
        let rows = rows.into_iter().collect::<Result<Vec<FigureRow>, StudyError>>()?;
        let values_of = |variant: usize| {
            let first = experiments.partition_point(|(other, _)| *other > variant);
            &values[first..first + query.experiments as usize]
        };
        let reports = VARIANTS.into_iter().zip(timed).enumerate().map(|(place, ((level, times_of_code), timed))| {
            // Compare each level with the cycle level, the last variant, experiment by experiment.
            let both = values_of(place).iter().zip(values_of(VARIANTS.len() - 1));
            let deviations = both.map(|(value, of_cycle)| deviation_percent(*value, *of_cycle)).collect();
            let of_level = rows.iter().zip(&figures).filter(|(_, (variant, _))| *variant == place);
            let rows: Vec<FigureRow> = of_level.map(|(row, _)| row.clone()).collect();
            LevelReport {
                level,
                times_of_code,
                published_error_percent: Some(Headline::of(&rows).mean_error_percent()),
                from_cycle_percent: if level == Level::Cycle { None } else { Spread::of(deviations) },
                speeds: timed.speeds,
            }
        });
        Ok(LevelRecord {
            schema: SCHEMA.to_owned(),
            experiments: query.experiments,
            note: None,
            date: None,
            host: None,
            levels: reports.collect(),
        })
    }
}

/// Returns the settings with which each variant measures figures. All variants share one cache, because some results do
/// not depend on the level of detail.
fn settings(stop: &StopFlag) -> Vec<FigureSettings> {
    let by_table = FigureSettings { stop: stop.clone(), ..FigureSettings::new(Level::Transaction) };
    let by_code = by_table.clone().with_times_of_code();
    let of = |(level, times_of_code)| {
        let settings = if times_of_code { &by_code } else { &by_table };
        FigureSettings { level, ..settings.clone() }
    };
    VARIANTS.into_iter().map(of).collect()
}

fn of_variant((level, times_of_code): (Level, bool), number: u64) -> Result<Experiment, ExperimentError> {
    let experiment = experiment(number)?.level(level);
    if !times_of_code || level == Level::Cycle {
        return Ok(experiment);
    }
    let machine = experiment.config().clone().with_times_of_code(experiment.pipeline().properties().code_use);
    let other = Experiment::with(machine, Arc::clone(experiment.pipeline()), Arc::clone(experiment.scene()));
    Ok(other.fields(experiment.fields).seed(experiment.seed).pixels(Pixels::Off).level(level))
}

/// Runs the random experiment `number`, and returns the time that is compared between levels, in milliseconds. The
/// value is NaN if no picture is shown.
fn value(variant: (Level, bool), number: u64, stop: &StopFlag) -> Result<f64, ExperimentError> {
    check(stop)?;
    let experiment = of_variant(variant, number)?.stopped_by(stop.clone());
    compared(&experiment, summarise(&crate::registry(), &experiment))
}

fn compared(experiment: &Experiment, summary: Result<Summary, ExperimentError>) -> Result<f64, ExperimentError> {
    match summary {
        Ok(summary) => Ok(compared_ms(experiment, &summary)),
        Err(ExperimentError::TooShort { .. } | ExperimentError::Run { .. }) => Ok(f64::NAN),
        Err(error) => Err(error),
    }
}

/// Measured speeds of a variant, and results of the timed runs.
struct Timed {
    speeds: Vec<LevelSpeed>,
    /// The result of [`value`] for the first random experiments. Empty if no speed is measured.
    values: Vec<f64>,
}

fn timed(variant: (Level, bool), query: &LevelQuery, stop: &StopFlag) -> Result<Timed, ExperimentError> {
    let choices = if variant.0 == Level::Analytic { &PIXELS[..1] } else { &PIXELS[..] };
    let mut timed = Timed { speeds: Vec::new(), values: Vec::new() };
    for pixels in choices.iter().copied() {
        let mut simulated_seconds_per_second = None;
        if query.speeds {
            let (speed, values) = speed(variant, pixels, stop)?;
            simulated_seconds_per_second = Some(speed);
            // Pixels change no simulated time, so all choices have the same values.
            timed.values = values;
        }
        timed.speeds.push(LevelSpeed { pixels, simulated_seconds_per_second });
    }
    Ok(timed)
}

/// Runs all timed experiments. Returns the simulated seconds per second of computing time, and the result of [`value`]
/// for each experiment.
fn speed(variant: (Level, bool), pixels: Pixels, stop: &StopFlag) -> Result<(f64, Vec<f64>), ExperimentError> {
    let registry = crate::registry();
    let (mut simulated, mut taken, mut values) = (0.0, 0.0, Vec::new());
    for number in 0..TIMED {
        let experiment = of_variant(variant, number)?.pixels(pixels).stopped_by(stop.clone());
        simulated += experiment.fields as f64 * experiment.config().period()?.as_ms() * 1e-3;
        // The construction of the scene is not timed.
        let begin = Instant::now();
        let summary = summarise(&registry, &experiment);
        // The time of runs that are too short counts too.
        taken += begin.elapsed().as_secs_f64();
        values.push(compared(&experiment, summary)?);
    }
    Ok((simulated / taken, values))
}
