//! Definition and execution of a comparison of pipelines.

use super::contender::{ComparedPipeline, DELAYED_VIDEO, compared_pipelines};
use super::predictors::predictor_means;
use super::row::ComparisonRow;
use super::trial::{Trial, common_window_from};
use crate::experiment_file::{ExperimentFile, FileError, Plan, plain};
use crate::limit::LimitQuery;
use crate::parallel;
use pxpl5_measure::Showing;
use pxpl5_run::{Goal, Pixels, WARM_UP_PERIODS};
use pxpl5_scene::Scene;
use pxpl5_sim::parameters::nearest;
use pxpl5_wire::PeriodNumber;
use serde::Serialize;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use thiserror::Error;

/// Maximum number of fields of a compared run: a little over an hour. The number is limited because a comparison keeps
/// all observations of a run in memory to evaluate its errors in several ways.
const MOST_FIELDS: u64 = 250_000;

/// Maximum difference between the first evaluated display periods of two rows. A row with a larger difference starts
/// late. Due pictures can be several periods apart.
const MOST_PERIODS_APART: u64 = 4;

/// Minimum number of seeds for meaningful confidence intervals.
pub const LEAST_SEEDS: usize = 5;

/// A comparison to run, with the settings shared by all rows. Each row adds its pipeline and a few settings of its own.
#[derive(Clone, Debug)]
pub struct CompareQuery {
    /// Machine, scene, head and number of fields, without a pipeline. The compared pipelines come from the registry of
    /// this file. If `head.motion` is `synthetic`, every seed has a different motion.
    pub shared: ExperimentFile,
    /// Names of the rows to run. An empty list runs all rows.
    pub only: Vec<String>,
    /// Seeds of the random numbers of tracker, host and motion. Every row has one run for each seed.
    pub seeds: Vec<u64>,
    /// True if the comparison also searches for the largest number of triangles that each row can draw.
    pub limits: bool,
    /// True if the runs of the first seed compute pixels, for [`ComparisonRow::picture`].
    pub pictures: bool,
    /// Confidence of all intervals, between 0 and 1; usually [`CONFIDENCE`](super::CONFIDENCE).
    pub confidence: f64,
}

/// Error that prevents a comparison.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CompareError {
    /// A setting is invalid.
    #[error(transparent)]
    Settings(#[from] FileError),
    /// The number of fields is too small or too large.
    #[error("expected {} to {} fields, found {found}", expected.0, expected.1)]
    Fields {
        /// Minimum and maximum number of fields.
        expected: (u64, u64),
        /// Number of fields in the settings.
        found: u64,
    },
    /// The query has no seeds.
    #[error("expected at least one seed, found none")]
    NoSeed,
    /// The registry has no pipeline that is to be compared.
    #[error("expected a registry with a pipeline that is compared, found none")]
    NoPipeline,
    /// A row in the query does not exist.
    #[error("expected one of {expected}; found `{found}`, did you mean `{nearest}`?")]
    Row {
        /// Names of all rows, separated by commas.
        expected: String,
        /// Name of the row in the query.
        found: String,
        /// Name of the existing row that is most similar to the name in the query.
        nearest: String,
    },
    /// The settings have no head motion, so there is no error to compare.
    #[error("expected a head.motion, found none: without a head there is no error to compare")]
    NoHead,
}

/// Result of a comparison: the shared settings, and one row for each method.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name and version of the JSON layout.
    pub schema: &'static str,
    /// Name of the machine's preset.
    pub machine: String,
    /// Number of graphics processors and number of renderers.
    pub boards: [u64; 2],
    /// Name of the scene that all rows draw.
    pub scene: String,
    /// Number of triangles in the scene.
    pub triangles: usize,
    /// Keys of the head's settings with their values.
    pub head: Vec<(String, String)>,
    /// Number of fields simulated for each seed.
    pub fields: u64,
    /// Seeds of the runs. Every row ran once for each seed.
    pub seeds: Vec<u64>,
    /// Confidence of all intervals, between 0 and 1.
    pub confidence: f64,
    /// First display period in which rows are evaluated, exact to within one interval between due pictures. Rows that
    /// start up later are evaluated from a later period on ([`ComparisonRow::window`]).
    pub evaluated_from: PeriodNumber,
    /// Results of the compared pipelines, in the order of the registry.
    pub pipelines: Vec<ComparisonRow>,
}

impl CompareQuery {
    /// Runs every row with every seed. After each run, `finished` is called with the number of finished runs and the
    /// number of all runs.
    ///
    /// The result has a row for every pipeline. A pipeline may be unable to run on the machine, or show no picture of
    /// the scene. Its row then holds the reason, and the number of triangles that the pipeline could draw.
    ///
    /// # Errors
    ///
    /// Returns [`CompareError`] when a setting is invalid, or when the run is too short to evaluate.
    pub fn run(&self, finished: impl Fn(u64, u64) + Sync) -> Result<Comparison, CompareError> {
        self.run_with(finished, |_| {})
    }

    /// Runs every row with every seed, as [`CompareQuery::run`] does. `ended` is called with each row as soon as all
    /// runs of this row have ended.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`CompareQuery::run`].
    pub fn run_with(
        &self,
        finished: impl Fn(u64, u64) + Sync,
        ended: impl Fn(&ComparisonRow) + Sync,
    ) -> Result<Comparison, CompareError> {
        let compared_pipelines = self.compared_pipelines()?;
        // The first row serves to check the settings that all rows share.
        let any = self.any_plan(&compared_pipelines)?;
        let scene = any.load_scene()?;
        let searches = if self.limits { compared_pipelines.len() } else { 0 };
        let all = (compared_pipelines.len() * self.seeds.len() + searches) as u64;
        let done = AtomicU64::new(0);
        let step = || finished(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        // Rows and the seeds of each row execute in parallel. So each row is known as soon as its own runs have ended.
        let pipelines = parallel::map(&compared_pipelines, |contender| {
            let trials = parallel::map(&self.seeds, |seed| {
                let trial = self.trial(contender, *seed, &scene);
                step();
                trial
            });
            let row = self.row(contender, &trials, &scene)?;
            if self.limits {
                step();
            }
            ended(&row);
            Ok::<_, CompareError>(row)
        });
        Ok(Comparison {
            schema: "pxpl5-comparison/2",
            machine: any.machine.preset.clone(),
            boards: any.machine.boards(),
            scene: scene.name().to_owned(),
            triangles: scene.triangles().len(),
            head: any.head.iter().flat_map(|head| head.settings()).map(|(key, value)| (key, plain(&value))).collect(),
            fields: any.fields,
            seeds: self.seeds.clone(),
            confidence: self.confidence,
            evaluated_from: common_window_from(any.fields),
            pipelines: pipelines.into_iter().collect::<Result<_, _>>()?,
        })
    }

    /// Returns the plan of each row with the first seed, from which the cost can be estimated. Rows that cannot run are
    /// left out.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`CompareQuery::run`].
    pub fn plans(&self) -> Result<Vec<Plan>, CompareError> {
        let compared_pipelines = self.compared_pipelines()?;
        let seed = self.any_plan(&compared_pipelines)?.seed;
        Ok(compared_pipelines.iter().filter_map(|contender| contender.plan(&self.shared, seed).ok()).collect())
    }

    /// Returns the pipelines to compare, in the order of the registry.
    fn compared_pipelines(&self) -> Result<Vec<ComparedPipeline>, CompareError> {
        let mut chosen = compared_pipelines(self.shared.registry());
        let names: Vec<String> = chosen.iter().map(|contender| contender.name.clone()).collect();
        for found in &self.only {
            if !names.contains(found) {
                let nearest = nearest(found, names.iter().map(String::as_str)).unwrap_or_default().to_owned();
                return Err(CompareError::Row { expected: names.join(", "), found: found.clone(), nearest });
            }
        }
        chosen.retain(|contender| self.only.is_empty() || self.only.contains(&contender.name));
        Ok(chosen)
    }

    /// Returns the plan of the first row with the first seed, to check the shared settings.
    fn any_plan(&self, compared_pipelines: &[ComparedPipeline]) -> Result<Plan, CompareError> {
        let seed = *self.seeds.first().ok_or(CompareError::NoSeed)?;
        let first = compared_pipelines.first().ok_or(CompareError::NoPipeline)?;
        let plan = first.plan(&self.shared, seed)?;
        if plan.head.is_none() {
            return Err(CompareError::NoHead);
        }
        // The run must be longer than the warm-up of every pipeline.
        let expected = (WARM_UP_PERIODS + 1, MOST_FIELDS);
        if !(expected.0..=expected.1).contains(&plan.fields) {
            return Err(CompareError::Fields { expected, found: plan.fields });
        }
        Ok(plan)
    }

    fn trial(&self, contender: &ComparedPipeline, seed: u64, scene: &Arc<Scene>) -> Result<Trial, String> {
        // Pixels are needed only for the picture of the first seed.
        let is_seen = self.pictures && self.seeds.first() == Some(&seed) && !contender.is_reference();
        let pixels = if is_seen { Pixels::Lazy } else { Pixels::Off };
        let plan = contender.plan(&self.shared, seed).map_err(|error| error.to_string())?;
        contender.trial(&plan, scene, pixels)
    }

    fn row(
        &self,
        contender: &ComparedPipeline,
        trials: &[Result<Trial, String>],
        scene: &Arc<Scene>,
    ) -> Result<ComparisonRow, CompareError> {
        let plan = contender.plan(&self.shared, self.seeds[0])?;
        // Failed runs are left out, and their first error is reported below.
        let ran: Vec<&Trial> = trials.iter().flatten().collect();
        let mut row = ComparisonRow::of(contender, plan.pipeline.as_ref(), &ran, self.confidence);
        if let Some(Ok(first)) = trials.first()
            && !contender.is_reference()
        {
            let experiment = plan.experiment(Arc::clone(scene)).with_dry_run(first.rehearsed.clone());
            // The dry run of the first trial is reused for every predictor.
            row.predictors = predictor_means(&experiment, contender.showing, first.errors.pixels.mean);
        }
        if self.limits && !contender.is_reference() {
            row.triangles_definition = definition(&plan);
            row.triangles_possible = LimitQuery::of_plan(&plan).search().ok().map(|limit| limit.triangles);
        }
        let error = trials.iter().find_map(|trial| trial.as_ref().err().cloned());
        // A row that showed no picture explains the reason.
        let shown: usize = ran.iter().map(|trial| trial.shown).sum();
        row.failure = error.or_else(|| (shown == 0 && !row.was_evaluated()).then(|| nothing_shown(&row, plan.fields)));
        Ok(row)
    }
}

impl ComparedPipeline {
    fn is_reference(&self) -> bool {
        self.showing == Showing::Ideal
    }
}

/// Returns the error message of a row that showed no picture in the evaluated part of the run.
fn nothing_shown(row: &ComparisonRow, fields: u64) -> String {
    let could = row
        .triangles_possible
        .map_or_else(String::new, |n| format!("; it could draw {n} {}", row.triangles_definition));
    match row.due.filter(|due| *due > 0) {
        Some(due) => format!(
            "cannot draw the scene: of {due} pictures due none was complete in time, so the scene is too heavy{could}"
        ),
        None => format!("no picture was shown behind start-up in {fields} fields: simulate more fields{could}"),
    }
}

/// Returns the criterion of the triangle limit in words.
fn definition(plan: &Plan) -> String {
    let goal = match plan.limit.goal {
        Goal::NoMissedRetrace => "with no retrace missed".to_owned(),
        Goal::RateHz(hz) => format!("at {hz} Hz"),
        Goal::LatencyFields(fields) => format!("at a mean latency of {fields} fields"),
    };
    format!("{} triangles {goal}", plan.limit.scene.name())
}

impl Comparison {
    /// Returns the row with the least mean error.
    ///
    /// Four kinds of rows are never the best:
    ///
    /// - rows with pictures that were due and not shown
    /// - the reference
    /// - rows that were evaluated over other display periods
    /// - the row of delayed video, whose error leaves out the delay of the world
    #[must_use]
    pub fn best(&self) -> Option<&ComparisonRow> {
        let judged =
            self.pipelines.iter().filter(|row| row.was_evaluated() && row.failure.is_none() && row.shows_all());
        let rivals = judged.filter(|row| row.pipeline != DELAYED_VIDEO);
        let timed = rivals.filter(|row| row.head_to_light_ms.mean.is_finite() && !self.starts_late(row));
        timed.min_by(|one, other| one.error.mean_px.mean.total_cmp(&other.error.mean_px.mean))
    }

    /// Returns true if the evaluation of this row begins in a later display period than the evaluation of the other
    /// rows.
    #[must_use]
    pub fn starts_late(&self, row: &ComparisonRow) -> bool {
        row.window.is_some_and(|window| window.first_period.0 >= self.evaluated_from.0 + MOST_PERIODS_APART)
    }

    /// Returns the row of the pipeline with this name.
    #[must_use]
    pub fn row(&self, pipeline: &str) -> Option<&ComparisonRow> {
        self.pipelines.iter().find(|row| row.pipeline == pipeline)
    }
}
