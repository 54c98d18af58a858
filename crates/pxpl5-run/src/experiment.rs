use crate::dry_run::DryRun;
use crate::fingerprint::Fingerprint;
use crate::head::Head;
use crate::head_views::HeadViews;
use crate::host::{BareHost, Host};
use crate::kept_records::{KeptRecords, MIN_RECORDS};
use crate::level::Level;
use crate::observe::observers::{FinalResults, ObserverFactory};
use crate::pipeline::Pipeline;
use pxpl5_machine::{MachineConfig, Optimization, Record};
use pxpl5_scene::{Hmd, HmdConfig, Scene};
use pxpl5_sim::StopFlag;
use pxpl5_sim::parameters::Parameter;
use pxpl5_wire::PeriodNumber;
use pxpl5_wire::display::Aim;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The pixels that a run computes.
///
/// The choice changes no simulated time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pixels {
    /// No pixel is computed. The firmware counts commands, but does not store the commands in bins.
    Off,
    /// A pixel is computed when it is read.
    Lazy,
    /// Every pixel is computed, on worker threads, while the simulation runs.
    All,
}

impl Pixels {
    /// All choices of [`Pixels`], with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("off", Self::Off), ("lazy", Self::Lazy), ("all", Self::All)];
}

pxpl5_sim::parameters::named!(Pixels, "choice of pixels", Pixels::ALL);

/// Smallest and largest number of fields that an experiment may simulate.
pub const FIELDS_RANGE: (u64, u64) = (1, 10_000_000);

/// Returns the parameters that the user set to values outside the range that the sources support.
pub fn out_of_range(config: &MachineConfig, pipeline: &dyn Pipeline) -> Vec<Parameter> {
    let usual = MachineConfig::preset(&config.preset).map(|preset| pipeline.adapt(preset).parameters());
    let usual = usual.unwrap_or_default();
    config.out_of_range().into_iter().filter(|parameter| !usual.contains(parameter)).collect()
}

/// Returns a warning if an experiment at the cycle level contains work without i860 code.
///
/// The times of work without code come from the parameters `gp.*` of the timing table. Returns `None` if all work has
/// code, or if the level is not [`Level::Cycle`].
pub fn warning_without_code(level: Level, pipeline: &dyn Pipeline) -> Option<String> {
    let what = pipeline.properties().without_code.filter(|_| level == Level::Cycle)?;
    let name = pipeline.name();
    Some(format!(
        "{name} at the cycle level: there is no i860 code for {what}; this work takes the times of the timing table (gp.*)"
    ))
}

/// An experiment: a machine, a pipeline, a scene, a number of fields and all further settings of a run.
#[derive(Clone, Debug)]
pub struct Experiment {
    pub(crate) config: MachineConfig,
    pub(crate) pipeline: Arc<dyn Pipeline>,
    pub(crate) scene: Arc<Scene>,
    /// Number of fields to simulate.
    pub fields: u64,
    /// The pixels that the run computes.
    pub pixels: Pixels,
    /// Seed of the pseudo-random head motion.
    pub seed: u64,
    pub(crate) host: Arc<dyn Host>,
    pub(crate) stop: StopFlag,
    pub(crate) shuffle: Option<u64>,
    pub(crate) traffic: bool,
    pub(crate) keep: KeptRecords,
    pub(crate) least_records: usize,
    pub(crate) disabled: BTreeSet<Optimization>,
    /// Level of detail of the simulation.
    pub level: Level,
    /// The head with its tracker, if the experiment has one.
    pub head: Option<Arc<Head>>,
    pub(crate) on_demand: bool,
    pub(crate) results_from: Option<PeriodNumber>,
    /// Head-mounted display with the resolution of the papers' display. A run uses the resolution of the machine's
    /// display instead.
    pub hmd: Hmd,
    /// Functions that compute the estimates in error messages, such as a sufficient number of fields.
    ///
    /// This field is hidden, because the estimates change error messages only.
    #[doc(hidden)]
    pub estimates: Option<Estimates>,
    pub(crate) observer: Option<ObserverFactory>,
    /// Dry run that [`Experiment::after_dry_run`] has stored.
    ///
    /// This field is hidden, because a wrong dry run would give wrong results. A comparison of predictors copies it to
    /// experiments that differ only in the predictor.
    #[doc(hidden)]
    pub dry_run: Option<Arc<DryRun>>,
}

/// Functions by which a pipeline's closed form estimates results of an experiment, before or after a run.
#[derive(Clone, Copy, Debug)]
pub struct Estimates {
    /// Function that estimates the number of fields until the first picture after the warm-up is shown.
    ///
    /// The function returns `None` if no such picture will be shown, or if the formulas give no estimate.
    pub fields_needed: fn(&Experiment) -> Option<u64>,
    /// Function that estimates how many primitives the scene can have, after decimation, so that all pictures are in
    /// time. Returns `None` if the formulas give no estimate.
    pub primitives_in_time: fn(&Experiment) -> Option<u64>,
}

impl Experiment {
    /// Creates an experiment with a pipeline, a machine and a scene. The defaults are 120 fields, [`Pixels::Lazy`] and
    /// seed 1.
    pub fn new(config: MachineConfig, pipeline: impl Pipeline + 'static, scene: impl Into<Arc<Scene>>) -> Self {
        Self::with(config, Arc::new(pipeline), scene.into())
    }

    /// Creates an experiment like [`Experiment::new`], with a pipeline that was chosen at run time.
    pub fn with(config: MachineConfig, pipeline: Arc<dyn Pipeline>, scene: Arc<Scene>) -> Self {
        Self {
            config,
            pipeline,
            scene,
            fields: 120,
            pixels: Pixels::Lazy,
            seed: 1,
            host: Arc::new(BareHost),
            stop: StopFlag::default(),
            shuffle: None,
            traffic: false,
            keep: KeptRecords::Everything,
            least_records: MIN_RECORDS,
            disabled: BTreeSet::new(),
            level: Level::Transaction,
            head: None,
            on_demand: false,
            results_from: None,
            hmd: Hmd::unc(),
            estimates: None,
            observer: None,
            dry_run: None,
        }
    }

    /// Sets the number of fields to simulate. The range is [`FIELDS_RANGE`].
    #[must_use]
    pub const fn fields(mut self, fields: u64) -> Self {
        self.fields = fields;
        self
    }

    /// Sets which pixels are computed.
    #[must_use]
    pub const fn pixels(mut self, pixels: Pixels) -> Self {
        self.pixels = pixels;
        self
    }

    /// Sets the seed of the head motion.
    #[must_use]
    pub const fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// Sets the flag that ends runs with [`ExperimentError::Stopped`](crate::ExperimentError::Stopped).
    #[must_use]
    pub fn stopped_by(self, stop: StopFlag) -> Self {
        Self { stop, ..self }
    }

    /// Sets the host computer, which supplies a clock and the threads for [`Pixels::All`]. The host changes no result.
    #[must_use]
    pub fn host(mut self, host: impl Host + 'static) -> Self {
        self.host = Arc::new(host);
        self
    }

    /// Makes the run handle simultaneous events in a pseudo-random order. Tests use different seeds to prove that the
    /// order changes no result.
    #[must_use]
    pub const fn shuffle_ties(mut self, seed: u64) -> Self {
        self.shuffle = Some(seed);
        self
    }

    /// Makes the run record ring messages and the contents of FIFOs. The recording changes no simulated time.
    #[must_use]
    pub const fn record_traffic(mut self, record: bool) -> Self {
        self.traffic = record;
        self
    }

    /// Sets which observations are kept: [`KeptRecords::Everything`], the default, or [`KeptRecords::Statistics`] for
    /// runs of any length.
    #[must_use]
    pub const fn keep(mut self, keep: KeptRecords) -> Self {
        self.keep = keep;
        self
    }

    /// Sets the number of records below which a run discards nothing. Tests set a small number, so that short runs
    /// discard records several times.
    #[doc(hidden)]
    #[must_use]
    pub const fn least_records(mut self, records: usize) -> Self {
        self.least_records = records;
        self
    }

    /// Disables an optimization of the simulator. No simulated time and no pixel changes, but the run takes longer.
    #[must_use]
    pub fn without(mut self, optimization: Optimization) -> Self {
        self.disabled.insert(optimization);
        self
    }

    /// Sets the level of detail: [`Level::Transaction`], the default, or [`Level::Cycle`].
    #[must_use]
    pub const fn level(mut self, level: Level) -> Self {
        self.level = level;
        self
    }

    /// Sets a head whose pose a tracker reports. Without such a head, the pipeline follows the scene's own motion
    /// without any delay.
    ///
    /// If the head's pose is predicted, the experiment runs twice. The first run, a dry run, finds the time at which
    /// each view is seen.
    #[must_use]
    pub fn head(mut self, head: impl Into<Arc<Head>>) -> Self {
        self.head = Some(head.into());
        self
    }

    /// Makes the host begin a frame only when the tracker reports a pose, so that frames do not queue in the pipeline.
    /// The setting has no effect without a head, or if the pipeline's host does not begin frames.
    ///
    /// A measurement of latency with a pendulum in front of the tracker uses this setting.
    #[must_use]
    pub const fn on_demand(mut self) -> Self {
        self.on_demand = true;
        self
    }

    /// Sets the streaming observer of a run with [`KeptRecords::Statistics`].
    ///
    /// Such a run discards old records. The observer must therefore compute the results for a tracked head during the
    /// run. A run with [`KeptRecords::Everything`] needs no observer.
    #[must_use]
    pub const fn observed_by(mut self, observer: Option<ObserverFactory>) -> Self {
        self.observer = observer;
        self
    }

    pub(crate) fn final_results<'a>(
        &'a self,
        record: &'a Record,
        head: Option<&'a Arc<HeadViews>>,
    ) -> FinalResults<'a> {
        FinalResults {
            pipeline: self.pipeline.as_ref(),
            aim: self.aim(),
            fields: self.fields,
            now: record.tick(self.end()),
            record,
            head,
            hmd: self.hmd,
            arrivals: &record.observation().arrivals,
            pictures: &[],
            next: None,
            until: self.end(),
            samples: usize::MAX,
            window: None,
        }
    }

    /// Begins the evaluation of the run at the period `period` of the first display, or later if the warm-up takes
    /// longer.
    ///
    /// With this setting, results of different pipelines cover the same periods, except for at most one interval
    /// between due pictures.
    #[must_use]
    pub const fn results_from(mut self, period: PeriodNumber) -> Self {
        self.results_from = Some(period);
        self
    }

    /// Returns the same experiment on the machine `config`.
    #[must_use]
    pub fn with_machine(self, config: MachineConfig) -> Self {
        Self { config, ..self }
    }

    /// Replaces the scene.
    #[must_use]
    pub fn with_scene(self, scene: impl Into<Arc<Scene>>) -> Self {
        Self { scene: scene.into(), ..self }
    }

    /// Returns the instant for which pictures are drawn, such as the middle of the time in which a picture lights.
    pub fn aim(&self) -> Aim {
        self.head.as_ref().map(|head| head.aim).unwrap_or_default()
    }

    /// Returns a hash of everything that affects the results: machine, pipeline with its settings, contents of the
    /// scene, number of fields, seed, level and head.
    pub fn config_hash(&self) -> Fingerprint {
        let mut hash = Fingerprint::default();
        // Machine: the code version, the displays, the number of boards, and all parameters that affect the trace.
        hash.setting("code", self.config.code_name());
        self.config.displays.iter().for_each(|display| hash.setting("display", display.name()));
        let [n_gps, n_renderers] = self.config.boards();
        hash.setting("n_gps", n_gps);
        hash.setting("n_renderers", n_renderers);
        self.config
            .identifying_parameters()
            .iter()
            .for_each(|parameter| hash.setting(&parameter.path, parameter.value));
        self.config.i860.unusual_settings().iter().for_each(|(key, value)| hash.setting(key, value));
        // Pipeline, scene and settings of the run.
        hash.setting("pipeline", self.pipeline.name());
        self.pipeline.settings().iter().for_each(|(key, value)| hash.setting(key, value));
        hash.setting("scene", Fingerprint::of_scene(&self.scene));
        hash.setting("fields", self.fields);
        hash.setting("seed", self.seed);
        hash.setting("level", self.level.name());
        if let Some(head) = &self.head {
            hash.setting("head", head.fingerprint());
        }
        if self.on_demand {
            hash.setting("on_demand", true);
        }
        if self.hmd != Hmd::unc() {
            let HmdConfig { eye_separation_m, horizontal_fov_deg, near_m, far_m, convergence_m, .. } =
                *self.hmd.config();
            hash.setting("hmd", format!("{eye_separation_m} {horizontal_fov_deg} {near_m} {far_m}"));
            if let Some(metres) = convergence_m {
                hash.setting("hmd.convergence", metres);
            }
        }
        hash
    }

    /// Returns the parameters of machine, tracker and predictor whose values no source supports ([`out_of_range`]).
    pub fn out_of_range(&self) -> Vec<Parameter> {
        let of_head = self.head.iter().flat_map(|head| &head.unsupported_parameters).cloned();
        out_of_range(&self.config, self.pipeline.as_ref()).into_iter().chain(of_head).collect()
    }

    /// Returns warnings about parameters without a source ([`out_of_range`]), work without code
    /// ([`warning_without_code`]), and problems in the files of the head's motion and of the scene.
    pub fn warnings(&self) -> Vec<String> {
        let supposed = self.out_of_range();
        let of_table = warning_without_code(self.level, self.pipeline.as_ref());
        let of_head = self.head.iter().flat_map(|head| head.motion().warnings());
        let of_scene = self.scene.warnings().iter().map(|warning| format!("{}: {warning}", self.scene.name()));
        supposed.iter().map(Parameter::warning).chain(of_table).chain(of_head).chain(of_scene).collect()
    }

    /// Returns the scene that the pipeline draws.
    pub const fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Returns the machine's configuration before the pipeline changes it ([`Pipeline::adapt`]).
    pub const fn config(&self) -> &MachineConfig {
        &self.config
    }

    /// Returns the pipeline of the experiment.
    pub const fn pipeline(&self) -> &Arc<dyn Pipeline> {
        &self.pipeline
    }

    pub(crate) const fn end(&self) -> PeriodNumber {
        PeriodNumber::FIRST.after(self.fields)
    }
}
