//! Limits: the most triangles that a pipeline can draw in time.
//!
//! A limit is found by simulation, not by a formula. A formula says where to begin and which sizes to doubt: the closed form of the
//! analytic level, where the pipeline has one.
//!
//! ```text
//!   analytic level --about this many; least margin at these--> Hints
//!   Hints --near: bracket, bisect--> first miss --sizes below it, doubtful sizes--> least size that misses
//! ```
//!
//! The answer need not be monotone (a clump that is nearly empty costs as many messages as a full one). So the sizes below the bisection's
//! answer are tried as well, and of two answers the smaller one counts; [`most`] says what that guarantees.

mod search;

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

/// Which pipeline, on which machine, must draw what in time.
#[derive(Clone, Debug)]
pub struct LimitQuery {
    /// Where the pipeline's closed form is found.
    pub registry: Arc<Registry>,
    /// The machine that it runs on.
    pub config: MachineConfig,
    /// The pipeline whose limit is sought.
    pub pipeline: Arc<dyn Pipeline>,
    /// The triangles, what must hold, and for how many fields each size is simulated.
    pub criterion: LimitCriterion,
    /// A model in place of the criterion's triangles.
    pub model: Option<Model>,
    /// The level of modelling at which every size is tried.
    pub level: Level,
}

/// A model that is thinned out evenly to every size; more triangles than it has are not tried.
#[derive(Clone, Debug)]
pub struct Model {
    /// As the experiment chose it, whatever number of triangles that names.
    pub choice: SceneChoice,
    /// The model with all of its primitives.
    pub whole: Arc<Scene>,
}

impl Model {
    /// Reads or generates it.
    ///
    /// # Errors
    ///
    /// As [`SceneChoice::load`].
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

/// NTSC's rates over the round ones.
const NTSC: f64 = 0.999;

/// Most triangles that are tried.
pub const CEILING: u32 = 1_000_000;

/// Sizes at most of which the analytic level tells the margin, and those of them that are tried.
const MARGINS: u32 = 1_000;
const DOUBTFUL: usize = 8;

/// Pictures after the warm-up without which nothing can be said of a rate: the goal counts as missed.
const PICTURES: usize = 4;

impl LimitQuery {
    /// Of a checked experiment: its machine, pipeline and level, and the pipeline's own criterion.
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

    /// The most triangles by the pipeline's own criterion, which its registry entry states.
    ///
    /// # Errors
    ///
    /// [`ExperimentError::Config`] when the registry of the papers does not know the pipeline.
    pub fn of_papers(config: MachineConfig, pipeline: impl Pipeline) -> Result<Self, ExperimentError> {
        let registry = crate::registry();
        let unknown = |_| ConfigError::Board(format!("no pipeline {} is known", pipeline.name()));
        let criterion = (registry.pipeline(pipeline.name()).map_err(unknown)?.limit)(&PipelineSettings::default());
        Ok(Self { registry, config, pipeline: Arc::new(pipeline), criterion, model: None, level: Level::Transaction })
    }

    /// Searches.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`] when the machine cannot be built or the pipeline cannot run on it. A scene that does not
    /// fit into a board's memory, or that is too slow to be shown at all, misses the goal.
    pub fn search(&self) -> Result<Limit, ExperimentError> {
        let limit = most(self.ceiling(), &self.hints(), |triangles| self.reached(triangles))?;
        if limit.triangles == 0 {
            self.check_rate()?;
        }
        Ok(limit)
    }

    /// Refuses a goal that means nothing: a rate where so little is redrawn that there is none, on a display that goes on turning what
    /// was drawn.
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

    /// The same search without the analytic level's help, which takes longer.
    ///
    /// # Errors
    ///
    /// As [`search`](Self::search).
    pub fn search_without_hints(&self) -> Result<Limit, ExperimentError> {
        most(self.ceiling(), &Hints::default(), |triangles| self.reached(triangles))
    }

    /// What the analytic level says of the sizes; nothing where the pipeline has no closed form, or where that is what is searched.
    ///
    /// A model is thinned and seen from all views for each size, which takes as long at that level as at any other. So small triangles stand
    /// for it, of which a size takes a moment.
    fn hints(&self) -> Hints {
        if self.level == Level::Analytic && self.model.is_none() {
            return Hints::default();
        }
        let scene = if self.model.is_some() { TestScene::Typical } else { self.criterion.scene };
        let criterion = LimitCriterion { scene, ..self.criterion };
        let analytic = Self { level: Level::Analytic, model: None, criterion, ..self.clone() };
        let near = about(self.ceiling(), |triangles| analytic.reached(triangles)).ok();
        let doubtful = near.filter(|_| self.model.is_none()).map(|near| analytic.doubtful(near));
        Hints { near, doubtful: doubtful.unwrap_or_default() }
    }

    /// Returns sizes up to a little above one that have less margin than their neighbours, the least margin first.
    fn doubtful(&self, near: u32) -> Vec<u32> {
        let most = near + near / 20;
        let step = most.div_ceil(MARGINS).max(1) as usize;
        let margin = |triangles: u32| Some((self.margin(triangles)?, triangles));
        let margins: Vec<(f64, u32)> = (1..=most).step_by(step).filter_map(margin).collect();
        let dips = margins.windows(3).filter(|of| of[1].0 < of[0].0 && of[1].0 <= of[2].0);
        let mut least: Vec<(f64, u32)> = dips.map(|of| of[1]).collect();
        least.sort_by(|a, b| a.0.total_cmp(&b.0));
        least.into_iter().take(DOUBTFUL).map(|(_, triangles)| triangles).collect()
    }

    /// How far a size is from missing the goal, in units of the goal's own: more is better.
    fn margin(&self, triangles: u32) -> Option<f64> {
        let summary = self.summary(triangles).ok()?;
        match self.criterion.goal {
            Goal::NoMissedRetrace => Some(-summary.copy_begins_ms),
            Goal::RateHz(_) => summary.updates_hz,
            Goal::LatencyFields(_) => Some(-summary.latency_fields().mean),
        }
    }

    /// Most triangles that are tried.
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
    /// As [`search`](Self::search).
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

/// A scene of so many triangles, at least one.
///
/// # Panics
///
/// Above the scene generator's largest number of triangles.
#[must_use]
pub fn test_scene(kind: TestScene, triangles: u32) -> Scene {
    builtin(&format!("{}:{}", kind.name(), triangles.max(1))).expect("in range")
}
