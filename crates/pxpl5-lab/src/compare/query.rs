//! The comparison itself.

use super::contender::{Contender, contenders};
use super::predictors::predictor_means;
use super::row::ComparisonRow;
use super::trial::Trial;
use crate::experiment_file::{ExperimentFile, FileError, Plan, plain};
use crate::limit::LimitQuery;
use crate::parallel;
use parameters::nearest;
use pxpl5_measure::Showing;
use pxpl5_run::{Goal, Pixels, WARM_UP_PERIODS};
use pxpl5_scene::Scene;
use serde::Serialize;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use thiserror::Error;

/// Most fields of a run that is compared, an hour and more: everything is kept of each, since its errors are judged in several ways.
const MOST_FIELDS: u64 = 250_000;

/// Fewest seeds of a comparison whose intervals mean something.
pub const LEAST_SEEDS: usize = 5;

/// What is compared: settings that all rows share, each of which has a pipeline and a few settings of its own.
#[derive(Clone, Debug)]
pub struct CompareQuery {
    /// Machine, scene, head and fields, with the registry whose pipelines are compared; no pipeline. A `head.motion` of
    /// `synthetic` is a motion of its own for every seed.
    pub shared: ExperimentFile,
    /// Names of the rows that are run; all where there is none.
    pub only: Vec<String>,
    /// Seeds of tracker, host and motion: a run for each.
    pub seeds: Vec<u64>,
    /// Whether the most triangles that each row can draw are searched for.
    pub limits: bool,
    /// Whether the first seed's runs compute pixels, for [`ComparisonRow::picture`].
    pub pictures: bool,
}

/// Why nothing can be compared.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum CompareError {
    /// A setting is wrong.
    #[error(transparent)]
    Settings(#[from] FileError),
    /// Too few or too many fields.
    #[error("expected {} to {} fields, found {found}", expected.0, expected.1)]
    Fields {
        /// Least and most.
        expected: (u64, u64),
        /// The number given.
        found: u64,
    },
    /// There is nothing to take a mean over.
    #[error("expected at least one seed, found none")]
    NoSeed,
    /// The registry has no pipeline that is compared.
    #[error("expected a registry with a pipeline that is compared, found none")]
    NoPipeline,
    /// A row was asked for that there is not.
    #[error("expected one of {expected}; found `{found}`, did you mean `{nearest}`?")]
    Row {
        /// Names of all rows.
        expected: String,
        /// The name given.
        found: String,
        /// The row whose name is most like it.
        nearest: String,
    },
    /// There is nothing to track.
    #[error("expected a head.motion, found none: without a head there is no error to compare")]
    NoHead,
}

/// A row for each way to fight latency, and what all of them share.
#[derive(Clone, Debug, Serialize)]
pub struct Comparison {
    /// Name and version of this record's layout.
    pub schema: &'static str,
    /// Preset of the machine.
    pub machine: String,
    /// Graphics processors and renderers.
    pub boards: [u64; 2],
    /// Name of the scene that all draw.
    pub scene: String,
    /// How many triangles that scene has.
    pub triangles: usize,
    /// The settings of the head, with their keys.
    pub head: Vec<(String, String)>,
    /// Fields simulated for each seed.
    pub fields: u64,
    /// The seeds, of each of which every row had a run.
    pub seeds: Vec<u64>,
    /// A row for each way to fight latency.
    pub pipelines: Vec<ComparisonRow>,
}

impl CompareQuery {
    /// Runs every row with every seed; `finished` hears how many of all runs are done.
    ///
    /// A pipeline that cannot run on the machine, or that shows nothing of the scene, has a row that says why and what it could draw.
    ///
    /// # Errors
    ///
    /// [`CompareError`] when a setting is wrong, or the run too short to judge anything.
    pub fn run(&self, finished: impl Fn(u64, u64) + Sync) -> Result<Comparison, CompareError> {
        let contenders = self.contenders()?;
        let any = self.any_plan(&contenders)?;
        let scene = any.load_scene()?;
        let runs = self.runs(&contenders);
        let searches = if self.limits { contenders.len() } else { 0 };
        let all = (runs.len() + searches) as u64;
        let done = AtomicU64::new(0);
        let step = || finished(done.fetch_add(1, Ordering::Relaxed) + 1, all);
        let trials = parallel::map(&runs, |(contender, seed)| {
            let trial = self.trial(&contenders[*contender], *seed, &scene);
            step();
            trial
        });
        let mut of_row = trials.into_iter();
        let rows: Vec<_> = contenders
            .iter()
            .map(|contender| (contender, of_row.by_ref().take(self.seeds.len()).collect::<Vec<_>>()))
            .collect();
        let pipelines = parallel::map(&rows, |(contender, trials)| {
            let row = self.row(contender, trials, &scene);
            if self.limits {
                step();
            }
            row
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
            pipelines: pipelines.into_iter().collect::<Result<_, _>>()?,
        })
    }

    /// What each row runs with the first seed, of those that can run: for whoever wants to know before what all of them take.
    ///
    /// # Errors
    ///
    /// As [`CompareQuery::run`].
    pub fn plans(&self) -> Result<Vec<Plan>, CompareError> {
        let contenders = self.contenders()?;
        let seed = self.any_plan(&contenders)?.seed;
        Ok(contenders.iter().filter_map(|contender| contender.plan(&self.shared, seed).ok()).collect())
    }

    /// The rows that are run, in the order of all.
    fn contenders(&self) -> Result<Vec<Contender>, CompareError> {
        let mut chosen = contenders(self.shared.registry());
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

    /// The settings checked with some pipeline.
    fn any_plan(&self, contenders: &[Contender]) -> Result<Plan, CompareError> {
        let seed = *self.seeds.first().ok_or(CompareError::NoSeed)?;
        let first = contenders.first().ok_or(CompareError::NoPipeline)?;
        let plan = first.plan(&self.shared, seed)?;
        if plan.head.is_none() {
            return Err(CompareError::NoHead);
        }
        let expected = (WARM_UP_PERIODS + 1, MOST_FIELDS);
        if !(expected.0..=expected.1).contains(&plan.fields) {
            return Err(CompareError::Fields { expected, found: plan.fields });
        }
        Ok(plan)
    }

    /// Contenders by place and seeds, in the order of rows.
    fn runs(&self, contenders: &[Contender]) -> Vec<(usize, u64)> {
        (0..contenders.len()).flat_map(|contender| self.seeds.iter().map(move |seed| (contender, *seed))).collect()
    }

    fn trial(&self, contender: &Contender, seed: u64, scene: &Arc<Scene>) -> Result<Trial, String> {
        let is_seen = self.pictures && self.seeds.first() == Some(&seed) && !contender.is_reference();
        let pixels = if is_seen { Pixels::Lazy } else { Pixels::Off };
        let plan = contender.plan(&self.shared, seed).map_err(|error| error.to_string())?;
        contender.trial(&plan, scene, pixels)
    }

    fn row(
        &self,
        contender: &Contender,
        trials: &[Result<Trial, String>],
        scene: &Arc<Scene>,
    ) -> Result<ComparisonRow, CompareError> {
        let plan = contender.plan(&self.shared, self.seeds[0])?;
        let ran: Vec<&Trial> = trials.iter().flatten().collect();
        let mut row = ComparisonRow::of(contender, plan.pipeline.as_ref(), &ran);
        if let Some(Ok(first)) = trials.first()
            && !contender.is_reference()
        {
            let experiment = plan.experiment(Arc::clone(scene)).rehearsed_as(first.rehearsed.clone());
            row.predictors = predictor_means(&experiment, contender.showing, first.errors.pixels.mean);
        }
        if self.limits && !contender.is_reference() {
            row.triangles_definition = definition(&plan);
            row.triangles_possible = LimitQuery::of_plan(&plan).search().ok().map(|limit| limit.triangles);
        }
        let error = trials.iter().find_map(|trial| trial.as_ref().err().cloned());
        let shown: usize = ran.iter().map(|trial| trial.shown).sum();
        row.failure = error.or_else(|| (shown == 0 && !row.is_judged()).then(|| nothing_shown(&row, plan.fields)));
        Ok(row)
    }
}

impl Contender {
    fn is_reference(&self) -> bool {
        self.showing == Showing::Ideal
    }
}

/// What a row without a single picture in the window says.
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

/// What the number of triangles means.
fn definition(plan: &Plan) -> String {
    let goal = match plan.limit.goal {
        Goal::NoMissedRetrace => "with no retrace missed".to_owned(),
        Goal::RateHz(hz) => format!("at {hz} Hz"),
        Goal::LatencyFields(fields) => format!("at a mean latency of {fields} fields"),
    };
    format!("{} triangles {goal}", plan.limit.scene.name())
}

impl Comparison {
    /// A row by name.
    #[must_use]
    pub fn row(&self, pipeline: &str) -> Option<&ComparisonRow> {
        self.pipelines.iter().find(|row| row.pipeline == pipeline)
    }
}
