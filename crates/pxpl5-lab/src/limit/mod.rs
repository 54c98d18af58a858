//! Limits: the most triangles that a pipeline can draw in time.
//!
//! A limit is found by simulation, not by a formula: the scene grows until the goal is missed. The answer need not be
//! monotone (a clump that is nearly empty costs as many messages as a full one), so after a bisection the next two
//! clumps' worth of sizes above the answer are tried as well.

mod search;

pub use search::{Limit, most};

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
        let limit = most(self.ceiling(), |triangles| self.reached(triangles))?;
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

    fn reached(&self, triangles: u32) -> Result<bool, ExperimentError> {
        let experiment = self.experiment(triangles)?;
        match summarise(&self.registry, &experiment) {
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
