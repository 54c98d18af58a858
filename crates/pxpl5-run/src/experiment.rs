//! An experiment: a machine, a pipeline, a scene and a head motion.

use crate::face_notes::FaceNotes;
use crate::fingerprint::Fingerprint;
use crate::head::Head;
use crate::head_views::HeadViews;
use crate::host::{BareHost, Host};
use crate::keep::Keep;
use crate::level::Level;
use crate::pipeline::Pipeline;
use crate::raster::Raster;
use crate::rehearsal::Rehearsed;
use crate::sums::{Settled, Sums};
use pxpl5_display::Aim;
use pxpl5_machine::{MachineConfig, Parameter, Record, Saving};
use pxpl5_scene::Scene;
use pxpl5_wire::PeriodNumber;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Which pixels are computed. It changes no time and no trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pixels {
    /// No pixel is computed; firmware keeps counts where it would keep bins.
    Off,
    /// Those that somebody looks at, when he does.
    Lazy,
    /// All, on worker threads, while the simulation goes on.
    All,
}

/// Smallest and largest number of fields.
pub const FIELDS_RANGE: (u64, u64) = (1, 10_000_000);

/// Parameters that no source allows for a pipeline: outside their stated range, and neither what the preset says nor what the
/// pipeline's own code makes of it.
#[must_use]
pub fn out_of_range(config: &MachineConfig, pipeline: &dyn Pipeline) -> Vec<Parameter> {
    let usual = MachineConfig::preset(&config.preset).map(|preset| pipeline.adapt(preset).parameters());
    let usual = usual.unwrap_or_default();
    config.out_of_range().into_iter().filter(|parameter| !usual.contains(parameter)).collect()
}

/// What has no i860 code although clocks of code are asked for: a sentence, or `None` where all is code or none is asked for.
#[must_use]
pub fn times_of_table(level: Level, config: &MachineConfig, pipeline: &dyn Pipeline) -> Option<String> {
    let what = (level == Level::Cycle).then(|| pipeline.without_code(config)).flatten()?;
    let name = pipeline.name();
    Some(format!(
        "{name} at the cycle level: there is no i860 code for {what}: that takes the times of the table (gp.*)"
    ))
}

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Experiment {
    pub(crate) config: MachineConfig,
    pub(crate) pipeline: Arc<dyn Pipeline>,
    pub(crate) scene: Arc<Scene>,
    pub(crate) fields: u64,
    pub(crate) pixels: Pixels,
    pub(crate) seed: u64,
    pub(crate) host: Arc<dyn Host>,
    pub(crate) shuffle: Option<u64>,
    pub(crate) traffic: bool,
    pub(crate) keep: Keep,
    pub(crate) given_up: BTreeSet<Saving>,
    pub(crate) level: Level,
    pub(crate) head: Option<Arc<Head>>,
    pub(crate) on_demand: bool,
    pub(crate) estimates: Option<Estimates>,
    pub(crate) sums: Option<Sums>,
    pub(crate) rehearsed: Option<Arc<Rehearsed>>,
}

/// What a closed form can say of an experiment before or after it is run.
#[derive(Clone, Copy, Debug)]
pub struct Estimates {
    /// Fields after which the first picture behind the warm-up has been shown; `None` if none ever will be, or if it cannot be
    /// said.
    pub fields_needed: fn(&Experiment) -> Option<u64>,
    /// The most primitives of the scene, its first ones, that would all be shown in time; `None` if it cannot be said.
    pub triangles_in_time: fn(&Experiment) -> Option<u64>,
}

impl Experiment {
    /// A pipeline on a machine with a scene; 120 fields, pixels when looked at, seed 1.
    #[must_use]
    pub fn new(config: MachineConfig, pipeline: impl Pipeline + 'static, scene: impl Into<Arc<Scene>>) -> Self {
        Self::with(config, Arc::new(pipeline), scene.into())
    }

    /// The same with a pipeline that was chosen at run time.
    #[must_use]
    pub fn with(config: MachineConfig, pipeline: Arc<dyn Pipeline>, scene: Arc<Scene>) -> Self {
        Self {
            config,
            pipeline,
            scene,
            fields: 120,
            pixels: Pixels::Lazy,
            seed: 1,
            host: Arc::new(BareHost),
            shuffle: None,
            traffic: false,
            keep: Keep::Everything,
            given_up: BTreeSet::new(),
            level: Level::Transaction,
            head: None,
            on_demand: false,
            estimates: None,
            sums: None,
            rehearsed: None,
        }
    }

    /// Number of fields to simulate.
    #[must_use]
    pub const fn fields(mut self, fields: u64) -> Self {
        self.fields = fields;
        self
    }

    /// Which pixels are computed.
    #[must_use]
    pub const fn pixels(mut self, pixels: Pixels) -> Self {
        self.pixels = pixels;
        self
    }

    /// Seed of the head motion.
    #[must_use]
    pub const fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// The computer that it runs on: its clock, and who computes the pixels of [`Pixels::All`]. No result changes.
    #[must_use]
    pub fn host(mut self, host: impl Host + 'static) -> Self {
        self.host = Arc::new(host);
        self
    }

    /// Takes simultaneous events in an order hashed from a seed; no result may change.
    #[must_use]
    pub const fn shuffle_ties(mut self, seed: u64) -> Self {
        self.shuffle = Some(seed);
        self
    }

    /// Records messages, busy channels and FIFOs; no time changes.
    #[must_use]
    pub const fn record_traffic(mut self, record: bool) -> Self {
        self.traffic = record;
        self
    }

    /// What of the observations is kept: [`Keep::Everything`], the default, or [`Keep::Statistics`] for runs of any length.
    #[must_use]
    pub const fn keep(mut self, keep: Keep) -> Self {
        self.keep = keep;
        self
    }

    /// Does without a saving; no time and no pixel changes, but the run is slower.
    #[must_use]
    pub fn without(mut self, saving: Saving) -> Self {
        self.given_up.insert(saving);
        self
    }

    /// How literally the machine is modelled: [`Level::Transaction`], the default, or [`Level::Cycle`].
    #[must_use]
    pub const fn level(mut self, level: Level) -> Self {
        self.level = level;
        self
    }

    /// A head with its tracker instead of the scene's own motion, which the pipeline follows without any delay.
    ///
    /// With prediction the experiment is run twice: the first run tells when each view will be seen.
    #[must_use]
    pub fn head(mut self, head: impl Into<Arc<Head>>) -> Self {
        self.head = Some(head.into());
        self
    }

    /// Lets the host begin a frame only when its tracker reports something, so that pipelines are not full: as a measurement
    /// from outside does. Without a head, or where the host does not begin frames, nothing changes.
    #[must_use]
    pub const fn on_demand(mut self) -> Self {
        self.on_demand = true;
        self
    }

    /// By what a run that is too short says how many fields it would take, and one that is too heavy how many triangles would
    /// do: a pipeline's closed form knows.
    #[must_use]
    pub const fn estimated_by(mut self, estimates: Option<Estimates>) -> Self {
        self.estimates = estimates;
        self
    }

    /// Who sums up a run that keeps statistics only ([`Keep::Statistics`]) what its tally does not know: what a report says of a head rests on
    /// records that such a run gives up. Of a run that keeps everything it is summed up when somebody asks.
    #[must_use]
    pub const fn summed_by(mut self, sums: Option<Sums>) -> Self {
        self.sums = sums;
        self
    }

    /// All that is kept of a run of it, but for its pictures.
    pub(crate) fn settled<'a>(
        &'a self,
        record: &'a Record,
        head: Option<&'a Arc<HeadViews>>,
        notes: &'a FaceNotes,
    ) -> Settled<'a> {
        Settled {
            pipeline: self.pipeline.as_ref(),
            aim: self.aim(),
            fields: self.fields,
            record,
            head,
            notes,
            arrivals: &record.observation().arrivals,
            pictures: &[],
            next: None,
            until: self.end(),
            samples: usize::MAX,
            window: None,
        }
    }

    /// The most primitives of its scene that would all be shown in time, by the closed form; `None` where there is none.
    #[must_use]
    pub fn triangles_in_time(&self) -> Option<u64> {
        (self.estimates?.triangles_in_time)(self)
    }

    /// The same experiment with another scene.
    #[must_use]
    pub fn with_scene(self, scene: impl Into<Arc<Scene>>) -> Self {
        Self { scene: scene.into(), ..self }
    }

    /// The same experiment without a head: the pipeline follows the scene's own motion without any delay.
    #[must_use]
    pub fn without_head(self) -> Self {
        Self { head: None, ..self }
    }

    /// How the raster before the head's eyes shows the picture.
    #[must_use]
    pub fn raster(&self) -> Raster {
        self.head.as_ref().map(|head| head.raster()).unwrap_or_default()
    }

    /// For which instant of what is shown from them views are drawn.
    #[must_use]
    pub fn aim(&self) -> Aim {
        self.head.as_ref().map(|head| head.aim()).unwrap_or_default()
    }

    /// Name of everything on which the trace depends: machine, pipeline with its settings, contents of the scene, fields,
    /// seed, level and head.
    #[must_use]
    pub fn config_hash(&self) -> Fingerprint {
        let mut hash = Fingerprint::default();
        hash.setting("code", self.config.code_name());
        self.config.displays.iter().for_each(|display| hash.setting("display", display.name()));
        let [n_gps, n_renderers] = self.config.boards();
        hash.setting("n_gps", n_gps);
        hash.setting("n_renderers", n_renderers);
        self.config.telling_parameters().iter().for_each(|parameter| hash.setting(&parameter.path, parameter.value));
        self.config.i860.unusual_settings().iter().for_each(|(key, value)| hash.setting(key, value));
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
        hash
    }

    /// Parameters of the machine and of what tracks the head that no source allows: see [`out_of_range`].
    #[must_use]
    pub fn out_of_range(&self) -> Vec<Parameter> {
        let of_head = self.head.iter().flat_map(|head| head.suppositions()).cloned();
        out_of_range(&self.config, self.pipeline.as_ref()).into_iter().chain(of_head).collect()
    }

    /// What cannot be taken for the machine: see [`out_of_range`] and [`times_of_table`]. And what is to be said of the files of the
    /// head's motion and of the scene.
    #[must_use]
    pub fn warnings(&self) -> Vec<String> {
        let supposed = self.out_of_range();
        let of_table = times_of_table(self.level, &self.config, self.pipeline.as_ref());
        let of_head = self.head.iter().flat_map(|head| head.motion().warnings());
        let of_scene = self.scene.warnings().iter().map(|warning| format!("{}: {warning}", self.scene.name()));
        supposed.iter().map(Parameter::warning).chain(of_table).chain(of_head).chain(of_scene).collect()
    }

    /// The scene that is drawn.
    #[must_use]
    pub const fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The machine as it was configured, before the pipeline adapted it.
    #[must_use]
    pub const fn config(&self) -> &MachineConfig {
        &self.config
    }

    /// The pipeline that runs.
    #[must_use]
    pub const fn pipeline(&self) -> &Arc<dyn Pipeline> {
        &self.pipeline
    }

    /// Fields that are simulated.
    #[must_use]
    pub const fn length(&self) -> u64 {
        self.fields
    }

    /// The period of the first display at whose begin the run ends: the first that is not simulated.
    pub(crate) const fn end(&self) -> PeriodNumber {
        PeriodNumber::FIRST.after(self.fields)
    }

    /// Seed of the head motion's sway.
    #[must_use]
    pub const fn seed_of_motion(&self) -> u64 {
        self.seed
    }

    /// The level of modelling.
    #[must_use]
    pub const fn level_of_modelling(&self) -> Level {
        self.level
    }

    /// Whether somebody may want pixels.
    #[must_use]
    pub const fn pixels_wanted(&self) -> Pixels {
        self.pixels
    }

    /// The head with its tracker, if there is one.
    #[must_use]
    pub const fn tracked_head(&self) -> Option<&Arc<Head>> {
        self.head.as_ref()
    }
}
