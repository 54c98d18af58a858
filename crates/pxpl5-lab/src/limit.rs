//! Searches for the largest number of triangles that a pipeline can draw in time.
//!
//! The search simulates scenes of several sizes. If the pipeline has a closed form, the closed form only gives hints:
//! the number of triangles at which the search starts, and numbers that may miss the goal.
//!
//! ```text
//!   analytic level --about this many; least margin at these--> Hints
//!   Hints --near: bracket, bisect--> first miss --sizes below it, doubtful sizes--> least size that misses
//! ```
//!
//! A larger scene can reach a goal that a smaller scene misses. The reason is that a nearly empty clump (group of
//! triangles) costs as many messages as a full clump. The search therefore also tries smaller numbers than the result
//! of the bisection. The smallest number that misses the goal determines the limit. [`most`] states the guarantee.

mod over;
mod search;

pub use over::{OverLimit, OverQuery, STEPS, USUAL_VALUES, Values};
pub use search::{Hints, Limit, about, most};

use crate::edges::{NEAR_FIELDS, to_other_retraces};
use crate::error::StudyError;
use crate::estimate::{Estimate, RunWork};
use crate::experiment_file::{HeadChoice, Plan, SceneChoice};
use crate::levels::{LevelChoice, choose_level, summarise};
use crate::study::{Study, check};
use pxpl5_machine::MachineConfig;
use pxpl5_run::{
    Coverage, Experiment, ExperimentError, Goal, Head, Level, LimitCriterion, Pipeline, PipelineSettings, Pixels,
    Registry, Summary, TestScene,
};
use pxpl5_scene::{Decimation, Scene};
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{StopFlag, Watcher};
use std::sync::Arc;

/// A search for the largest number of triangles: a pipeline, a machine, the kind of triangles and the goal.
#[derive(Clone, Debug)]
pub struct LimitQuery {
    /// Registry that contains the pipeline's closed form.
    pub registry: Arc<Registry>,
    /// Machine on which the pipeline runs.
    pub config: MachineConfig,
    /// Pipeline whose limit is searched.
    pub pipeline: Arc<dyn Pipeline>,
    /// Kind of triangles, goal, and number of simulated fields for each number of triangles.
    pub criterion: LimitCriterion,
    /// Model that replaces the test scene of `criterion`, if any.
    pub model: Option<Model>,
    /// Tracked head of the viewer, if any. The closed form of the hints leaves it out.
    pub head: Option<Arc<Head>>,
    /// Level of detail of all simulations.
    pub level: Level,
    /// Bound of the deviation from the cycle level in percent, if the level is chosen for each scene instead.
    pub within_percent: Option<f64>,
    /// True if the closed form gives hints, which reduce the number of simulations and not their results.
    pub uses_hints: bool,
    /// True if sizes above the first miss are tried too, which about doubles the number of simulations.
    pub looks_above: bool,
    /// Flag that stops single experiments. A search takes that of its watcher.
    pub stop: StopFlag,
}

/// A scene that the search simplifies to different numbers of triangles. The scene's own number of triangles is the
/// largest.
#[derive(Clone, Debug)]
pub struct Model {
    /// Settings of the model's scene, whose number of triangles is ignored.
    pub choice: SceneChoice,
    /// The model with all of its primitives.
    pub whole: Arc<Scene>,
    /// Decimation of `whole`. Its first steps (collapses of edges) are the same for all numbers of triangles.
    decimation: Arc<Decimation>,
}

impl Model {
    /// Reads or generates the model.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`SceneChoice::load`].
    pub fn load(choice: SceneChoice) -> Result<Self, SettingError> {
        let whole = Arc::new(choice.load_whole()?);
        Ok(Self::new(choice, whole))
    }

    /// Creates the model of a loaded scene. The number of triangles in `choice` is ignored.
    pub fn new(choice: SceneChoice, whole: Arc<Scene>) -> Self {
        let decimation = Arc::new(Decimation::new(Arc::clone(&whole)));
        Self { choice: SceneChoice { triangles: None, ..choice }, whole, decimation }
    }

    fn with_triangles(&self, triangles: u32) -> Result<Arc<Scene>, SettingError> {
        let triangles = Some(triangles as usize).filter(|n| *n < self.whole.triangles().len());
        let choice = SceneChoice { triangles, ..self.choice.clone() };
        choice.prepared_by(Arc::clone(&self.whole), |n| self.decimation.decimated(n))
    }
}

/// Field rate of NTSC divided by the rounded rate: 59.94 Hz divided by 60 Hz.
const NTSC: f64 = 0.999;

/// Maximum number of triangles that a search tries.
pub const CEILING: u32 = 1_000_000;

/// Maximum number of scene sizes for which the closed form computes the margin to the goal.
const MARGINS: u32 = 1_000;
/// Maximum number of scene sizes that are tried because the closed form predicts a small margin to the goal.
const DOUBTFUL: usize = 8;

/// Estimated maximum number of simulated scene sizes: twice the number of bisection steps over all sizes.
pub const USUAL_SIZES: u64 = 40;

/// Minimum number of pictures after the warm-up. With fewer pictures, the update rate is unknown, and the goal counts
/// as missed.
const PICTURES: usize = 4;

impl Study for LimitQuery {
    type Report = Limit;

    fn estimate(&self, _: usize) -> Estimate {
        // Closed forms cost almost nothing.
        if self.level == Level::Analytic {
            return Estimate::NOTHING;
        }
        let scene = || Arc::new(self.criterion.scene.with_triangles(1));
        let scene = self.model.as_ref().map_or_else(scene, |model| Arc::clone(&model.whole));
        // A level that is chosen for each size may be the slowest.
        let level = if self.within_percent.is_some() { Level::Cycle } else { self.level };
        let one = RunWork::of(&self.experiment_of(scene).level(level), false).estimate();
        Estimate::of_all([one; USUAL_SIZES as usize], 1)
    }

    /// Searches for the limit. A scene that does not fit into a board's memory, or is never shown, misses the goal.
    fn run(&self, watcher: &mut dyn Watcher) -> Result<Limit, StudyError> {
        let query = Self { stop: watcher.stop(), ..self.clone() };
        let mut tried = 0;
        let limit = most(query.ceiling(), &query.hints(), self.looks_above, |triangles| {
            tried += 1;
            watcher.progress(tried, tried.max(USUAL_SIZES));
            let reached = query.reached(triangles)?;
            let misses = if reached { "reach" } else { "miss" };
            watcher.row("sizes", &format_args!("{triangles} triangles {misses} the goal"));
            Ok::<_, ExperimentError>(reached)
        })?;
        if limit.triangles == 0 {
            query.check_rate()?;
        }
        Ok(limit)
    }
}

impl LimitQuery {
    /// Creates a query from the machine, pipeline and level of an experiment, with the pipeline's own criterion.
    pub fn of_plan(plan: &Plan) -> Self {
        let (registry, pipeline) = (Arc::clone(&plan.registry), Arc::clone(&plan.pipeline));
        let head = plan.head.as_ref().map(HeadChoice::head);
        let query = Self::new(registry, plan.machine.clone(), pipeline, plan.limit);
        Self { head, level: plan.level, within_percent: plan.within_percent, ..query }
    }

    /// Creates a query whose scenes are those of an experiment with other numbers of triangles: a test scene if the
    /// experiment draws one, otherwise its own scene with fewer triangles.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Model::load`].
    pub fn of_scene(plan: &Plan) -> Result<Self, SettingError> {
        let mut query = Self::of_plan(plan);
        match plan.scene.name.split(':').next().unwrap_or_default().parse() {
            Ok(scene) => query.criterion.scene = scene,
            Err(_) => query.model = Some(Model::load(plan.scene.clone())?),
        }
        Ok(query)
    }

    /// Creates a query with the pipeline's own criterion.
    ///
    /// # Errors
    ///
    /// Returns [`ExperimentError::Config`] if the built-in registry does not contain the pipeline.
    pub fn of_papers(config: MachineConfig, pipeline: impl Pipeline) -> Result<Self, ExperimentError> {
        let registry = crate::registry();
        let unknown = |_| SettingError::combination(format_args!("no pipeline {} is known", pipeline.name()));
        let criterion = (registry.pipeline(pipeline.name()).map_err(unknown)?.limit)(&PipelineSettings::default());
        Ok(Self::new(registry, config, Arc::new(pipeline), criterion))
    }

    fn new(
        registry: Arc<Registry>,
        config: MachineConfig,
        pipeline: Arc<dyn Pipeline>,
        criterion: LimitCriterion,
    ) -> Self {
        Self {
            registry,
            config,
            pipeline,
            criterion,
            model: None,
            head: None,
            level: Level::Transaction,
            within_percent: None,
            uses_hints: true,
            looks_above: true,
            stop: StopFlag::default(),
        }
    }

    /// Returns an error if the goal is an update rate that cannot be measured for the scene. A pipeline that draws all
    /// directions may show fewer than two updates, because it redraws only a small part of the scene.
    fn check_rate(&self) -> Result<(), ExperimentError> {
        let (Goal::RateHz(hz), true) =
            (self.criterion.goal, self.pipeline.properties().coverage == Coverage::Surroundings)
        else {
            return Ok(());
        };
        let outcome = self.experiment(1)?.run()?;
        if outcome.shown() == 0 || outcome.updates_hz().is_some() {
            return Ok(());
        }
        let (shown, fields) = (outcome.shown(), self.criterion.fields);
        Err(ExperimentError::Scene(format!(
            "goal: expected a scene with a rate of updates, to reach {hz} Hz; found a scene that is drawn once and stays right \
             (updates in {fields} fields: {shown}, fewer than two of them after the warm-up)"
        )))
    }

    /// Returns the hints of the analytic level. The hints are empty if the pipeline has no closed form, or if the
    /// search itself uses the analytic level or no hints.
    ///
    /// The hints for a model use a test scene of small triangles instead of the model. A model must be decimated to
    /// each number of triangles, which takes as long at the analytic level as at any other level.
    fn hints(&self) -> Hints {
        if !self.uses_hints || self.level == Level::Analytic && self.model.is_none() {
            return Hints::default();
        }
        // Small triangles stand for a model, because the decimated sizes of a model are expensive to build.
        let scene = if self.model.is_some() { TestScene::Typical } else { self.criterion.scene };
        let criterion = LimitCriterion { scene, ..self.criterion };
        let plain = Self { model: None, head: None, within_percent: None, ..self.clone() };
        let analytic = Self { level: Level::Analytic, criterion, ..plain };
        let near = about(self.ceiling(), |triangles| analytic.reached(triangles)).ok();
        let doubtful = near.filter(|_| self.model.is_none()).map(|near| analytic.doubtful(near));
        Hints { near, doubtful: doubtful.unwrap_or_default() }
    }

    /// Returns numbers of triangles, up to 5 % above `near`, with a smaller margin to the goal than their neighbours.
    /// The smallest margin comes first.
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

    /// Returns the update rate, the negative latency, or the negative time of the first copy. A greater result is
    /// closer to the goal.
    fn margin(&self, triangles: u32) -> Option<f64> {
        let summary = self.summary(triangles).ok()?;
        match self.criterion.goal {
            Goal::NoMissedRetrace => Some(-summary.copy_begins_ms),
            Goal::RateHz(_) => summary.updates_hz,
            Goal::LatencyFields(_) => Some(-summary.latency_fields().mean),
        }
    }

    fn ceiling(&self) -> u32 {
        let of_model = self.model.as_ref().map(|model| model.whole.triangles().len());
        of_model.map_or(CEILING, |triangles| u32::try_from(triangles).unwrap_or(CEILING).min(CEILING))
    }

    fn scene(&self, triangles: u32) -> Result<Arc<Scene>, ExperimentError> {
        match &self.model {
            Some(model) => model.with_triangles(triangles).map_err(|error| ExperimentError::Scene(error.to_string())),
            None => Ok(Arc::new(self.criterion.scene.with_triangles(triangles))),
        }
    }

    fn experiment(&self, triangles: u32) -> Result<Experiment, ExperimentError> {
        check(&self.stop)?;
        Ok(self.experiment_of(self.scene(triangles)?))
    }

    fn experiment_of(&self, scene: Arc<Scene>) -> Experiment {
        let experiment = Experiment::with(self.config.clone(), Arc::clone(&self.pipeline), scene)
            .fields(self.criterion.fields)
            .pixels(Pixels::Off)
            .level(self.level)
            .stopped_by(self.stop.clone());
        self.head.iter().fold(experiment, |experiment, head| experiment.head(Arc::clone(head)))
    }

    fn summary(&self, triangles: u32) -> Result<Summary, ExperimentError> {
        summarise(&self.registry, &self.chosen(triangles)?.0)
    }

    fn chosen(&self, triangles: u32) -> Result<(Experiment, Option<LevelChoice>), ExperimentError> {
        let experiment = self.experiment(triangles)?;
        let Some(within) = self.within_percent else { return Ok((experiment, None)) };
        let (choice, chosen) = choose_level(&self.registry, &experiment, within, false);
        Ok((chosen, Some(choice)))
    }

    /// Returns the level of detail that was chosen for the scene with this number of triangles. `None` if the level is
    /// not chosen for each scene.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as the run of the query.
    pub fn level_choice(&self, triangles: u32) -> Result<Option<LevelChoice>, ExperimentError> {
        if self.within_percent.is_none() { Ok(None) } else { Ok(self.chosen(triangles)?.1) }
    }

    /// Returns true if the pipeline reaches the goal with this number of triangles.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Study::run`].
    pub fn reached(&self, triangles: u32) -> Result<bool, ExperimentError> {
        match self.summary(triangles) {
            Ok(summary) => Ok(is_reached(self.criterion.goal, &summary)),
            Err(ExperimentError::TooShort { .. } | ExperimentError::Run { .. }) => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Returns a warning if the answer `triangles` lies within [`NEAR_FIELDS`] of its edge: how near, and how many
    /// triangles this distance is worth.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Study::run`].
    pub fn near_edge(&self, triangles: u32) -> Result<Option<String>, ExperimentError> {
        // The same scene with fewer triangles shows how much of a field a triangle takes.
        let fewer = triangles - triangles.div_ceil(4).min(60);
        let distance = |triangles: u32| -> Result<Option<f64>, ExperimentError> {
            let summary = self.summary(triangles)?;
            Ok(match self.criterion.goal {
                Goal::NoMissedRetrace => to_other_retraces(&summary).map(|[later, _]| later),
                Goal::LatencyFields(most) => Some(most - summary.latency_fields().mean),
                Goal::RateHz(_) => None,
            })
        };
        let (Some(at_limit), Some(below)) = (distance(triangles)?, distance(fewer.max(1))?) else { return Ok(None) };
        let of_triangle = (below - at_limit) / f64::from((triangles - fewer).max(1));
        Ok((at_limit < NEAR_FIELDS && of_triangle > 0.0).then(|| {
            format!(
                "the limit lies {at_limit:.3} field before its edge: {NEAR_FIELDS} field more work is worth about {:.0} triangles",
                NEAR_FIELDS / of_triangle
            )
        }))
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
