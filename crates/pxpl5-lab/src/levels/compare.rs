//! Speed against error: the same experiments at every level.

use super::{deviation_percent, summarise};
use crate::figures::{Bench, FIGURES, Figure, FigureRow, mean_error_percent};
use pxpl5_analytic::{PerTriangle, SlatsModel};
use pxpl5_machine::MachineConfig;
use pxpl5_run::{Experiment, ExperimentError, Level, Pixels, RenderingControl, Slats};
use pxpl5_scene::{Scene, builtin};
use serde::Serialize;
use std::cell::Cell;
use std::sync::Arc;
use std::time::Instant;

/// A level's speed and error.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelReport {
    /// The level that was timed and judged.
    pub level: Level,
    /// Whether the times of primitives in the table are those of the code, instead of published or fitted ones.
    pub times_of_code: bool,
    /// Simulated fields per second of this host's time, over the experiments of [`cases`], without pixels.
    pub fields_per_host_second: f64,
    /// Machine configurations per second: for the analytic level the field of Slats alone, for the others whole
    /// experiments of 16 fields.
    pub configurations_per_host_second: f64,
    /// Mean absolute error over the figures that are free checks, percent.
    pub mean_error_percent: f64,
    /// Mean and greatest absolute deviation of all figures from those of the cycle level with the same table, percent. At the cycle
    /// level the table's times are those of what has no code.
    pub deviation_percent: [f64; 2],
    /// Every figure at this level.
    pub figures: Vec<(&'static str, f64)>,
}

/// Seeds and frames of the Mig here: the levels are compared, not the Mig.
const MIG: (u64, u64) = (2, 60);

/// The experiments whose speed is measured.
///
/// # Errors
///
/// [`ExperimentError::Scene`] never, as the scenes are built in.
pub fn cases() -> Result<Vec<Experiment>, ExperimentError> {
    let slats = MachineConfig::slats();
    let stereo = MachineConfig::small_hmd();
    let all = [
        Experiment::new(slats, Slats::split(), scene("full-screen:140")?).fields(240),
        Experiment::new(stereo.clone(), RenderingControl::stereo(), scene("full-screen:12")?),
        Experiment::new(stereo, RenderingControl::stereo(), scene("mig")?),
    ];
    Ok(all.into_iter().map(|experiment| experiment.pixels(Pixels::Off)).collect())
}

fn scene(name: &str) -> Result<Arc<Scene>, ExperimentError> {
    builtin(name).map(Arc::new).map_err(|error| ExperimentError::Scene(error.to_string()))
}

/// Compares all levels on this host, now.
///
/// # Errors
///
/// The first [`ExperimentError`].
pub fn compare() -> Result<Vec<LevelReport>, ExperimentError> {
    compare_with(|_, _| {})
}

/// The same; `finished` hears how many of all steps are done: every figure at every level, and the speed of each.
///
/// # Errors
///
/// As [`compare`].
pub fn compare_with(finished: impl Fn(u64, u64)) -> Result<Vec<LevelReport>, ExperimentError> {
    let steps = (2 * Level::ALL.len() * (FIGURES.len() + 1)) as u64;
    let done = Cell::new(0);
    let step = || {
        done.set(done.get() + 1);
        finished(done.get(), steps);
    };
    let mut reports = Vec::new();
    for times_of_code in [false, true] {
        let rows: Vec<Vec<FigureRow>> =
            Level::ALL.into_iter().map(|level| rows_of(level, times_of_code, &step)).collect::<Result<_, _>>()?;
        let cycle = rows.last().cloned().unwrap_or_default();
        for (level, rows) in Level::ALL.into_iter().zip(&rows) {
            reports.push(report((level, times_of_code), rows, &cycle)?);
            step();
        }
    }
    Ok(reports)
}

/// A level's figures beside those of the cycle level, and its speed on this host, now.
fn report(
    (level, times_of_code): (Level, bool),
    rows: &[FigureRow],
    cycle: &[FigureRow],
) -> Result<LevelReport, ExperimentError> {
    let deviations = rows.iter().zip(cycle).map(|(a, b)| deviation_percent(a.simulated, b.simulated));
    let worst = deviations.clone().fold(0.0, f64::max);
    let (fields_per_host_second, configurations_per_host_second) = speed(level)?;
    Ok(LevelReport {
        level,
        times_of_code,
        fields_per_host_second,
        configurations_per_host_second,
        mean_error_percent: mean_error_percent(rows),
        deviation_percent: [deviations.sum::<f64>() / rows.len().max(1) as f64, worst],
        figures: rows.iter().map(|row| (row.id, row.simulated)).collect(),
    })
}

fn rows_of(level: Level, times_of_code: bool, step: &impl Fn()) -> Result<Vec<FigureRow>, ExperimentError> {
    let bench = Bench::new(level).with_mig(MIG.0, MIG.1);
    let bench = if times_of_code { bench.with_times_of_code() } else { bench };
    let row = |figure: &Figure| {
        let measured = bench.measure(figure.id)?;
        step();
        Ok(FigureRow::new(figure, measured))
    };
    FIGURES.iter().map(row).collect()
}

fn speed(level: Level) -> Result<(f64, f64), ExperimentError> {
    let mut fields = 0;
    let mut seconds = 0.0;
    let registry = crate::registry();
    for experiment in cases()? {
        let host_time = Instant::now();
        summarise(&registry, &experiment.clone().level(level))?;
        seconds += host_time.elapsed().as_secs_f64();
        fields += experiment.length();
    }
    let fields_per_second = fields as f64 / seconds;
    let configurations = if level == Level::Analytic { analytic_speed()? } else { fields_per_second / 16.0 };
    Ok((fields_per_second, configurations))
}

/// Times per triangle that are tried, one configuration each.
const CONFIGURATIONS: u64 = 20_000;

fn analytic_speed() -> Result<f64, ExperimentError> {
    let mut machine = MachineConfig::slats();
    let every_region = PerTriangle { entries: 10.0, clipped: 0.0 };
    let host_time = Instant::now();
    let mut in_time = 0;
    for i in 0..CONFIGURATIONS {
        machine.gp.triangle_ns = 20_000 + i;
        in_time += u64::from(SlatsModel::new(&machine, Slats::split())?.field(140.0, every_region).in_time);
    }
    std::hint::black_box(in_time);
    Ok(CONFIGURATIONS as f64 / host_time.elapsed().as_secs_f64())
}
