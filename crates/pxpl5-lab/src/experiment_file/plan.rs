//! The plan of one experiment: all settings, after defaults and checks.

use super::head::HeadChoice;
use super::hmd;
use super::origin::Origin;
use super::read::{not_applicable, plain, wrong};
use super::scene::SceneChoice;
use super::{ExperimentFile, Setting, display};
use crate::Workstation;
use crate::levels::{LevelChoice, choose_level, summarise};
use pxpl5_gp::CodeVersion;
use pxpl5_machine::MachineConfig;
use pxpl5_measure::{HeadSum, Measure, Results};
use pxpl5_run::{
    Experiment, ExperimentError, Goal, Level, LimitCriterion, Pipeline, PipelineEntry, PipelineSettings, Pixels,
    Registry, check_coverage, out_of_range, warning_without_code,
};
use pxpl5_scene::{Hmd, Scene};
use pxpl5_sim::Time;
use pxpl5_sim::parameters::{Parameter, SettingError, Value as Number};
use pxpl5_wire::NodeId;
use std::collections::BTreeMap;
use std::sync::Arc;
use toml::Value;

/// Files that a run writes in addition to its report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outputs {
    /// True to write the last pictures as PNG.
    pub pictures: bool,
    /// True to write a timeline of all boards and pictures as SVG.
    pub timeline: bool,
    /// True to write the measured quantities as CSV.
    pub csv: bool,
}

/// A published figure that the experiment reproduces.
#[derive(Clone, Debug, PartialEq)]
pub struct Published {
    /// Number of the figure in the paper. `None` if the paper does not number the figure.
    pub figure: Option<u64>,
    /// Short name of the paper that prints the figure.
    pub source: Option<String>,
    /// Quantity of the printed value.
    pub quantity: Measure,
    /// Printed value, in the unit of the quantity.
    pub value: f64,
}

impl Published {
    fn read(file: &ExperimentFile) -> Result<Option<Self>, SettingError> {
        let Some(value) = file.number("published.value")? else { return Ok(None) };
        let missing = || SettingError::missing("published.quantity", "the published quantity");
        let name = file.text("published.quantity")?.ok_or_else(missing)?;
        let quantity = measure(file, "published.quantity", name)?;
        let source = file.text("published.source")?.map(str::to_owned);
        Ok(Some(Self { figure: file.whole("published.figure")?, source, quantity, value }))
    }
}

fn measure(file: &ExperimentFile, key: &str, name: &str) -> Result<Measure, SettingError> {
    Measure::named(name).map_err(|error| match file.get(key) {
        Some(setting) => error.at(setting.place_of(key)),
        None => SettingError::missing("measure", "quantities that are measured"),
    })
}

/// The settings of an experiment after defaults and checks. No two settings contradict each other.
#[derive(Clone, Debug)]
pub struct Plan {
    /// Title of the experiment in one line.
    pub title: Option<String>,
    /// Registry of the pipelines and displays that the experiment can name.
    pub registry: Arc<Registry>,
    /// Pipeline with the values of its keys.
    pub pipeline: Arc<dyn Pipeline>,
    /// Criterion of a search for the largest number of triangles that are drawn in time.
    pub limit: LimitCriterion,
    /// Machine: a preset, adapted to the pipeline, with the parameters in the file.
    pub machine: MachineConfig,
    /// Scene by name and settings, not yet loaded.
    pub scene: SceneChoice,
    /// Number of simulated display fields; default 120.
    pub fields: u64,
    /// Seed of the random head motion; default 1.
    pub seed: u64,
    /// Level of detail; default transaction. Without effect for `level = "auto"`.
    pub level: Level,
    /// Bound, in percent, of the deviation from the cycle level for `level = "auto"`. `None` for a level by name.
    pub within_percent: Option<f64>,
    /// Tracked head. `None` if the head follows the scene's own motion without delay.
    pub head: Option<HeadChoice>,
    /// Head-mounted display of the viewer.
    pub hmd: Hmd,
    /// Choice of the pixels that are computed. By default, only pixels that are read later are computed.
    pub pixels: Pixels,
    /// Quantities in tables and rows of results.
    pub measure: Vec<Measure>,
    /// Files that a run writes in addition to its report.
    pub output: Outputs,
    /// Published figure to compare with, if any.
    pub published: Option<Published>,
    /// Origin of the results beside the experiment file, if a command wrote the file with its results.
    pub origin: Origin,
    /// Values that are written as they were given.
    pub(super) given: BTreeMap<String, Value>,
}

/// Name of the level that the program chooses.
pub(super) const AUTO: &str = "auto";
/// Bound of the deviation from the cycle level without a key `within`, in percent.
const WITHIN_PERCENT: f64 = 5.0;

/// Largest seed that TOML can represent.
pub(super) const MAX_SEED: u64 = i64::MAX as u64;

impl ExperimentFile {
    /// Checks all settings together and returns the plan.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] that names the first setting that is wrong or missing.
    pub fn resolve(&self) -> Result<Plan, SettingError> {
        // The pipeline comes first, because other settings depend on it.
        let (entry, given) = self.pipeline()?;
        let pipeline = (entry.build)(&given);
        let seed = self.seed()?;
        let head = HeadChoice::read(self, pipeline.as_ref(), seed)?;
        let (own, goal) = ((entry.limit)(&given), self.goal()?);
        Ok(Plan {
            title: self.text("title")?.map(str::to_owned),
            registry: Arc::clone(self.registry()),
            machine: self.machine(entry, pipeline.as_ref())?,
            scene: SceneChoice::read(self)?,
            fields: self.whole("fields")?.unwrap_or(120),
            seed,
            level: self.level(entry, head.is_some())?.unwrap_or(Level::Transaction),
            within_percent: self.within()?,
            limit: LimitCriterion { goal: goal.unwrap_or(own.goal), ..own },
            hmd: hmd::read(self, pipeline.as_ref())?,
            pipeline,
            head,
            pixels: self.choice("pixels", &Pixels::ALL)?.unwrap_or(Pixels::Lazy),
            measure: self.measures()?,
            output: Outputs {
                pictures: self.flag("output.pictures")?.unwrap_or(true),
                timeline: self.flag("output.timeline")?.unwrap_or(true),
                csv: self.flag("output.csv")?.unwrap_or(true),
            },
            published: Published::read(self)?,
            origin: Origin::read(self)?,
            given: self.given()?,
        })
    }

    fn goal(&self) -> Result<Option<Goal>, SettingError> {
        let rate = self.number("limit.rate_hz")?.map(Goal::RateHz);
        let latency = self.number("limit.latency_fields")?.map(Goal::LatencyFields);
        match self.get("limit.latency_fields").filter(|_| rate.is_some()) {
            Some(setting) => Err(wrong("limit.latency_fields", setting, "nothing beside limit.rate_hz")),
            None => Ok(rate.or(latency)),
        }
    }

    /// Returns the quantities in the key `measure`, or the default quantities.
    fn measures(&self) -> Result<Vec<Measure>, SettingError> {
        match self.texts("measure")? {
            Some(names) => names.iter().map(|name| measure(self, "measure", name)).collect(),
            None => Ok(Measure::usual()),
        }
    }

    fn pipeline(&self) -> Result<(&PipelineEntry, PipelineSettings), SettingError> {
        let names: Vec<(&str, &PipelineEntry)> =
            self.registry().pipelines().iter().map(|entry| (entry.name, entry)).collect();
        let missing = || SettingError::missing("pipeline", "a pipeline, such as slats");
        let entry = self.choice("pipeline", &names)?.ok_or_else(missing)?;
        self.refuse_keys_of_others(entry)?;
        let mut given = PipelineSettings::default();
        // Collect the values of the pipeline's own keys.
        for key in entry.keys {
            if let Some(value) = self.value(key)? {
                given.set(key.name, value);
            }
        }
        Ok((entry, given))
    }

    fn refuse_keys_of_others(&self, entry: &PipelineEntry) -> Result<(), SettingError> {
        for (key, families) in self.registry().keys() {
            if let Some(setting) = self.get(key.name).filter(|_| !families.contains(&entry.family)) {
                return Err(not_applicable(key.name, entry.name, &families.join(", ")).at(&setting.place));
            }
        }
        Ok(())
    }

    /// Returns the bound of `level = "auto"`, or `None` for another level.
    fn within(&self) -> Result<Option<f64>, SettingError> {
        let bound = self.number("within")?;
        match (self.text("level")? == Some(AUTO), self.get("within")) {
            (true, _) => Ok(Some(bound.unwrap_or(WITHIN_PERCENT))),
            (false, None) => Ok(None),
            (false, Some(setting)) => Err(not_applicable("within", "a level by name", AUTO).at(&setting.place)),
        }
    }

    /// Returns the level of detail, or `None` for a level that the program chooses.
    fn level(&self, entry: &PipelineEntry, has_head: bool) -> Result<Option<Level>, SettingError> {
        let choices = Level::ALL.map(|level| (level.name(), Some(level))).into_iter().chain([(AUTO, None)]);
        let level = self.choice("level", &choices.collect::<Vec<_>>())?.unwrap_or(Some(Level::Transaction));
        // A closed form does not cover tracked heads.
        let has_form = entry.closed_form.is_some() && !has_head;
        match self.get("level").filter(|_| level == Some(Level::Analytic) && !has_form) {
            Some(setting) => Err(wrong("level", setting, "transaction or cycle for this pipeline or a head.motion")),
            None => Ok(level),
        }
    }

    // The order matters: the preset, then the display, then the pipeline's adaptation, then single parameters.
    fn machine(&self, entry: &PipelineEntry, pipeline: &dyn Pipeline) -> Result<MachineConfig, SettingError> {
        let preset = self.text("machine.preset")?.unwrap_or(entry.preset);
        let place = self.get("machine.preset").map_or("machine", |setting| &setting.place);
        let machine = MachineConfig::preset(preset).map_err(|error| error.at(place))?;
        // Start from the preset, with the parameters of every pipeline's firmware.
        let mut machine = self.registry().machine_of(machine);
        if let Some(display) = display::read(self)? {
            machine.displays = vec![display];
            let place = self.get("display").map_or("display", |setting| &setting.place);
            check_coverage(&machine, pipeline).map_err(|error| error.at(place))?;
        }
        // The pipeline adapts the machine to its needs.
        let mut machine = pipeline.adapt(machine);
        if let Some(code) = self.choice("machine.code", &CODES)? {
            machine.code = code;
        }
        match self.choice("machine.times", &TIMES)? {
            Some(true) => machine = machine.with_times_of_code(pipeline.properties().code_use),
            Some(false) => machine = machine.with_times_of_papers(),
            None => {}
        }
        // Remember the adapted machine to detect parameters that are set twice.
        let adapted = machine.clone();
        for (path, setting) in &self.settings {
            if let Some(parameter) =
                path.strip_prefix("machine.").filter(|path| !["preset", "code", "times"].contains(path))
            {
                let value = Self::parameter_value(path, setting)?;
                self.refuse_twice(entry, &adapted, (path, parameter, setting), value)?;
                machine.set(parameter, value).map_err(|error| error.at(&setting.place))?;
            }
        }
        // Parameters are valid one by one, but may contradict each other.
        machine.check().map_err(|error| {
            let place = self.get(&format!("machine.{}", error.name)).map_or("machine", |setting| &setting.place);
            error.at(place)
        })?;
        Ok(machine)
    }

    /// Returns an error if a machine parameter and a key of the pipeline set different values for the same number.
    fn refuse_twice(
        &self,
        entry: &PipelineEntry,
        adapted: &MachineConfig,
        (path, parameter, setting): (&str, &str, &Setting),
        value: Number,
    ) -> Result<(), SettingError> {
        let changed = adapted.parameters().iter().any(|own| own.path == parameter && own.value != value);
        for key in entry.keys.iter().filter(|key| changed && key.sets.contains(&parameter)) {
            if let Some(given) = self.get(key.name) {
                let other = format!("{} = {}", key.name, plain(&given.value));
                let reason = format_args!("{path} and {other} set the same numbers; leave one out");
                return Err(SettingError::combination(reason).at(&setting.place));
            }
        }
        Ok(())
    }
}

pub(super) const CODES: [(&str, Option<CodeVersion>); 4] = [
    ("none", None),
    (CodeVersion::Unoptimised.name(), Some(CodeVersion::Unoptimised)),
    (CodeVersion::Compiled.name(), Some(CodeVersion::Compiled)),
    (CodeVersion::Scheduled.name(), Some(CodeVersion::Scheduled)),
];

/// Names of the two sources of times for primitives: the papers (false) or executed code (true).
pub(super) const TIMES: [(&str, bool); 2] = [("papers", false), ("code", true)];

impl PartialEq for Plan {
    fn eq(&self, other: &Self) -> bool {
        self.settings() == other.settings() && self.machine == other.machine && self.head == other.head
    }
}

impl Plan {
    /// Generates the scene or reads its file.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`SceneChoice::load`].
    pub fn load_scene(&self) -> Result<Arc<Scene>, SettingError> {
        self.scene.load()
    }

    /// Returns all parameters of the machine. With a tracked head, the parameters of the tracker, the host's serial
    /// port and the predictor follow. Their paths begin with `tracking.`.
    pub fn parameters(&self) -> Vec<Parameter> {
        let of_head = self.head.iter().flat_map(HeadChoice::parameters);
        self.machine.parameters().into_iter().chain(of_head).collect()
    }

    /// Returns the parameters with values outside the range that their sources allow.
    pub fn out_of_range(&self) -> Vec<Parameter> {
        let of_head = self.head.iter().flat_map(|head| head.head().unsupported_parameters.clone());
        out_of_range(&self.machine, self.pipeline.as_ref()).into_iter().chain(of_head).collect()
    }

    /// Returns warnings about settings that do not represent the real machine. The warnings concern parameters out of
    /// range, the recording of the head motion, and former names of keys. A warning also appears if executed code was
    /// requested but the times come from a table.
    pub fn warnings(&self) -> Vec<String> {
        let of_table = warning_without_code(self.level, self.pipeline.as_ref());
        let of_head = self.head.iter().flat_map(HeadChoice::warnings);
        let of_machine = self.out_of_range().into_iter().map(|parameter| parameter.warning());
        of_machine.into_iter().chain(of_table).chain(of_head).collect()
    }

    /// Returns the name of the level of detail.
    pub fn level_name(&self) -> String {
        self.within_percent.map_or(self.level.name(), |_| AUTO).to_owned()
    }

    /// Returns the experiment with its loaded scene, and the choice of its level for `level = "auto"`. The analytic level
    /// is not chosen if the caller needs events.
    pub fn with_chosen_level(&self, scene: Arc<Scene>, needs_events: bool) -> (Experiment, Option<LevelChoice>) {
        let experiment = self.at_named_level(scene);
        let Some(within) = self.within_percent else { return (experiment, None) };
        let (choice, chosen) = choose_level(&self.registry, &experiment, within, needs_events);
        (chosen, Some(choice))
    }

    /// Returns the name of the display on which the pipeline shows its pictures.
    pub fn display(&self) -> &'static str {
        self.machine.displays.first().map_or("", |display| display.name())
    }

    /// Returns the number of whole periods of the display until the instant `time`. Returns `None` if the display cannot
    /// be built.
    pub fn display_periods(&self, time: Time) -> Option<u64> {
        let config = self.machine.displays.first()?;
        let ports = config.ports(self.pipeline.properties().eyes);
        let nodes: Vec<NodeId> = (0..ports).filter_map(|n| Some(NodeId(n.try_into().ok()?))).collect();
        Some(config.build(&nodes, self.machine.ring.word()).ok()?.period_at(time).0)
    }

    /// Returns the experiment with its loaded scene, for a run with events on this computer.
    pub fn experiment(&self, scene: Arc<Scene>) -> Experiment {
        self.with_chosen_level(scene, true).0
    }

    fn at_named_level(&self, scene: Arc<Scene>) -> Experiment {
        let entry = self.registry.pipeline(self.pipeline.name()).ok();
        let mut experiment = Experiment::with(self.machine.clone(), Arc::clone(&self.pipeline), scene)
            .observed_by(Some(HeadSum::begin))
            .fields(self.fields)
            .seed(self.seed)
            .pixels(self.pixels)
            .level(self.level)
            .host(Workstation::new());
        experiment.estimates = entry.and_then(|entry| Some(entry.closed_form?.estimates));
        experiment.hmd = self.hmd;
        match &self.head {
            Some(head) => experiment.head(head.head()),
            None => experiment,
        }
    }

    /// Runs the experiment at its level of detail without computing pixels.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Experiment::run`].
    pub fn run(&self, scene: Arc<Scene>) -> Result<Results, ExperimentError> {
        let needs_events = self.measure.iter().any(Measure::needs_events);
        let (experiment, _) = self.with_chosen_level(scene, needs_events);
        self.results_of(experiment.host(Workstation::with_threads(1)))
    }

    /// Runs an experiment of this plan, which may have another host or a flag that stops it, as [`run`](Self::run) does.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`Experiment::run`].
    pub fn results_of(&self, experiment: Experiment) -> Result<Results, ExperimentError> {
        let experiment = experiment.pixels(Pixels::Off);
        match experiment.level {
            Level::Analytic => Ok(Results::of_closed_form(summarise(&self.registry, &experiment)?)),
            Level::Transaction | Level::Cycle => Ok(Results::of_run(experiment.run()?)),
        }
    }
}
