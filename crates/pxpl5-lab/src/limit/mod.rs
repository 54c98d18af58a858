//! Limits: the largest number of triangles that a pipeline can draw in time.
//!
//! A limit is found by simulation, not by a formula. The closed form of the analytic level, if the pipeline has one,
//! only gives the size at which the search starts, and sizes that are doubtful.
//!
//! ```text
//!   analytic level --about this many; least margin at these--> Hints
//!   Hints --near: bracket, bisect--> first miss --sizes below it, doubtful sizes--> least size that misses
//! ```
//!
//! The result need not be monotone, because a nearly empty clump costs as many messages as a full one. The search
//! therefore also tries sizes below the result of the bisection, and the smallest miss counts. [`most`] states the
//! guarantee.

mod over;
mod search;

pub use over::{OverError, OverLimit, OverQuery, STEPS, Values};
pub use search::{Hints, Limit, about, most};

use crate::experiment_file::{FileError, Plan, SceneChoice};
use crate::levels::summarise;
use pxpl5_machine::{ConfigError, MachineConfig};
use pxpl5_run::{
    Experiment, ExperimentError, Goal, Level, LimitCriterion, Pipeline, PipelineSettings, Pixels, Registry, Summary,
    TestScene,
};
use pxpl5_scene::{Scene, builtin};
use std::sync::Arc;

/// A search for a limit: a pipeline, a machine, the triangles and the goal.
#[derive(Clone, Debug)]
pub struct LimitQuery {
    /// Registry with the pipeline's closed form.
    pub registry: Arc<Registry>,
    /// Machine on which the pipeline runs.
    pub config: MachineConfig,
    /// Pipeline whose limit is searched.
    pub pipeline: Arc<dyn Pipeline>,
    /// Triangles, goal, and number of fields simulated for each size.
    pub criterion: LimitCriterion,
    /// Model whose triangles replace the criterion's triangles, if any.
    pub model: Option<Model>,
    /// Level of modelling at which every size is tried.
    pub level: Level,
}

/// A model that is thinned out evenly to every size. Its number of triangles bounds the search.
#[derive(Clone, Debug)]
pub struct Model {
    /// Settings of the model's scene. Its number of triangles is ignored.
    pub choice: SceneChoice,
    /// The model with all of its primitives.
    pub whole: Arc<Scene>,
}

impl Model {
    /// Reads or generates the model.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`SceneChoice::load`].
    pub fn load(choice: SceneChoice) -> Result<Self, FileError> {
        let choice = SceneChoice { triangles: None, ..choice };
        let whole = Arc::new(choice.load_whole()?);
        Ok(Self { choice, whole })
    }

    fn with_triangles(&self, triangles: u32) -> Result<Arc<Scene>, FileError> {
        let triangles = Some(triangles as usize).filter(|n| *n < self.whole.triangles().len());
        SceneChoice { triangles, ..self.choice.clone() }.prepared(Arc::clone(&self.whole))
    }
}

/// Ratio of NTSC's rates to round rates.
const NTSC: f64 = 0.999;

/// Maximum number of triangles that is tried.
pub const CEILING: u32 = 1_000_000;

/// Maximum number of sizes whose margin the analytic level computes.
const MARGINS: u32 = 1_000;
/// Maximum number of doubtful sizes that are tried.
const DOUBTFUL: usize = 8;

/// Minimum number of pictures after the warm-up. With fewer pictures no rate is known, and the goal counts as missed.
const PICTURES: usize = 4;

impl LimitQuery {
    /// Creates a query from a checked experiment: its machine, pipeline and level, and the pipeline's own criterion.
    #[must_use]
    pub fn of_plan(plan: &Plan) -> Self {
        Self {
            registry: Arc::clone(&plan.registry),
            config: plan.machine.clone(),
            pipeline: Arc::clone(&plan.pipeline),
            criterion: plan.limit,
            model: None,
            level: plan.level,
        }
    }

    /// Creates a query with the pipeline's own criterion, as stated in its registry entry.
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError::Config`] if the built-in registry does not contain the pipeline.
    pub fn of_papers(config: MachineConfig, pipeline: impl Pipeline) -> Result<Self, ExperimentError> {
        let registry = crate::registry();
        let unknown = |_| ConfigError::Board(format!("no pipeline {} is known", pipeline.name()));
        let criterion = (registry.pipeline(pipeline.name()).map_err(unknown)?.limit)(&PipelineSettings::default());
        Ok(Self { registry, config, pipeline: Arc::new(pipeline), criterion, model: None, level: Level::Transaction })
    }

    /// Searches for the limit.
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError`] if the machine cannot be built or the pipeline cannot run on it. A scene that does
    /// not fit into a board's memory, or is never shown, misses the goal.
    pub fn search(&self) -> Result<Limit, ExperimentError> {
        self.search_with(|_| {})
    }

    /// Searches; `progress` hears how many sizes were tried.
    ///
    /// # Errors
    ///
    /// As [`search`](Self::search).
    pub fn search_with(&self, mut progress: impl FnMut(u64)) -> Result<Limit, ExperimentError> {
        let mut tried = 0;
        let limit = most(self.ceiling(), &self.hints(), |triangles| {
            tried += 1;
            progress(tried);
            self.reached(triangles)
        })?;
        // A limit of zero may mean that the goal cannot be evaluated.
        if limit.triangles == 0 {
            self.check_rate()?;
        }
        Ok(limit)
    }

    /// Refuses a rate as the goal if the scene has no rate of updates. A display with cube faces redraws so little of
    /// some scenes that fewer than two updates occur.
    fn check_rate(&self) -> Result<(), ExperimentError> {
        let (Goal::RateHz(hz), Some(_)) = (self.criterion.goal, self.pipeline.draws_faces()) else { return Ok(()) };
        let outcome = self.experiment(1)?.run()?;
        if outcome.shown() == 0 || outcome.updates_hz().is_some() {
            return Ok(());
        }
        let (shown, fields) = (outcome.shown(), self.criterion.fields);
        Err(ExperimentError::Scene(format!(
            "goal: expected a scene whose updates have a rate, to reach {hz} Hz; found one that is drawn and stays right (updates in \
             {fields} fields: {shown}, fewer than two of them behind start-up)"
        )))
    }

    /// Searches for the limit without the hints of the analytic level, which takes longer.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`search`](Self::search).
    pub fn search_without_hints(&self) -> Result<Limit, ExperimentError> {
        most(self.ceiling(), &Hints::default(), |triangles| self.reached(triangles))
    }

    /// Returns the hints of the analytic level. There are none if the pipeline has no closed form, or if the search
    /// itself uses the analytic level.
    ///
    /// A model would be thinned out and viewed for each size, which takes as long at the analytic level as at any
    /// other. Small triangles therefore replace the model.
    fn hints(&self) -> Hints {
        if self.level == Level::Analytic && self.model.is_none() {
            return Hints::default();
        }
        // Small triangles stand for a model, whose sizes are expensive to build.
        let scene = if self.model.is_some() { TestScene::Typical } else { self.criterion.scene };
        let criterion = LimitCriterion { scene, ..self.criterion };
        let analytic = Self { level: Level::Analytic, model: None, criterion, ..self.clone() };
        let near = about(self.ceiling(), |triangles| analytic.reached(triangles)).ok();
        let doubtful = near.filter(|_| self.model.is_none()).map(|near| analytic.doubtful(near));
        Hints { near, doubtful: doubtful.unwrap_or_default() }
    }

    /// Returns sizes up to 5 % above `near` with a smaller margin than their neighbours, smallest margin first.
    fn doubtful(&self, near: u32) -> Vec<u32> {
        let most = near + near / 20;
        let step = most.div_ceil(MARGINS).max(1) as usize;
        let margin = |triangles: u32| Some((self.margin(triangles)?, triangles));
        let margins: Vec<(f64, u32)> = (1..=most).step_by(step).filter_map(margin).collect();
        // A local minimum of the margin may hide a miss.
        let dips = margins.windows(3).filter(|of| of[1].0 < of[0].0 && of[1].0 <= of[2].0);
        let mut least: Vec<(f64, u32)> = dips.map(|of| of[1]).collect();
        least.sort_by(|a, b| a.0.total_cmp(&b.0));
        least.into_iter().take(DOUBTFUL).map(|(_, triangles)| triangles).collect()
    }

    /// Returns the distance of a size from missing the goal, in the unit of the goal. A larger margin is better.
    fn margin(&self, triangles: u32) -> Option<f64> {
        let summary = self.summary(triangles).ok()?;
        match self.criterion.goal {
            Goal::NoMissedRetrace => Some(-summary.copy_begins_ms),
            Goal::RateHz(_) => summary.updates_hz,
            Goal::LatencyFields(_) => Some(-summary.latency_fields().mean),
        }
    }

    /// Returns the maximum number of triangles that is tried.
    fn ceiling(&self) -> u32 {
        let of_model = self.model.as_ref().map(|model| model.whole.triangles().len());
        of_model.map_or(CEILING, |triangles| u32::try_from(triangles).unwrap_or(CEILING).min(CEILING))
    }

    fn scene(&self, triangles: u32) -> Result<Arc<Scene>, ExperimentError> {
        match &self.model {
            Some(model) => model.with_triangles(triangles).map_err(|error| ExperimentError::Scene(error.to_string())),
            None => Ok(Arc::new(test_scene(self.criterion.scene, triangles))),
        }
    }

    fn experiment(&self, triangles: u32) -> Result<Experiment, ExperimentError> {
        let scene = self.scene(triangles)?;
        Ok(Experiment::with(self.config.clone(), Arc::clone(&self.pipeline), scene)
            .fields(self.criterion.fields)
            .pixels(Pixels::Off)
            .level(self.level))
    }

    fn summary(&self, triangles: u32) -> Result<Summary, ExperimentError> {
        summarise(&self.registry, &self.experiment(triangles)?)
    }

    /// Returns true if a size reaches the goal.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`search`](Self::search).
    pub fn reached(&self, triangles: u32) -> Result<bool, ExperimentError> {
        match self.summary(triangles) {
            Ok(summary) => Ok(is_reached(self.criterion.goal, &summary)),
            Err(ExperimentError::TooShort { .. } | ExperimentError::Run { .. }) => Ok(false),
            Err(error) => Err(error),
        }
    }
}

fn is_reached(goal: Goal, summary: &Summary) -> bool {
    if summary.latencies_ms.len() < PICTURES {
        return false;
    }
    match goal {
        Goal::NoMissedRetrace => summary.due.is_some_and(|due| due.not_shown() == 0),
        Goal::RateHz(least) => summary.updates_hz.is_some_and(|hz| hz >= least * NTSC),
        Goal::LatencyFields(most) => summary.latency_fields().mean <= most,
    }
}

/// Returns a scene with a number of triangles, at least one.
///
/// # Panics
///
/// Panics above the scene generator's maximum number of triangles.
#[must_use]
pub fn test_scene(kind: TestScene, triangles: u32) -> Scene {
    builtin(&format!("{}:{}", kind.name(), triangles.max(1))).expect("in range")
}
