//! An experiment: a machine, a pipeline, a scene and a head motion.

use crate::display_list::{display_list, hmd_before, views};
use crate::head::Head;
use crate::head_views::{FIELDS_WITH_HEAD, HeadViews, Rehearsal};
use crate::host::{BareHost, Host};
use crate::level::{Level, with_clocks_of_instructions};
use crate::pipeline::{Pipeline, ReportTimes, Setup};
use crate::raster::Raster;
use crate::registry::{ClosedForm, Registry};
use crate::{ExperimentError, Fingerprint, Outcome};
use pxpl5_machine::{Machine, MachineConfig, Saving};
use pxpl5_scene::Scene;
use pxpl5_sim::Time;
use std::collections::BTreeSet;
use std::sync::Arc;

/// Which pixels are computed. It changes no time and no trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pixels {
    /// None.
    Off,
    /// Those that somebody looks at, when he does.
    Lazy,
    /// All, on worker threads, while the simulation goes on.
    All,
}

/// Pictures that are discarded because the pipeline is still filling (TR94 discards the first frames too).
pub const WARM_UP_PICTURES: usize = 4;

/// Smallest and largest number of fields.
pub const FIELDS_RANGE: (u64, u64) = (1, 10_000_000);

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Experiment {
    pub(crate) config: MachineConfig,
    pub(crate) pipeline: Arc<dyn Pipeline>,
    pub(crate) scene: Arc<Scene>,
    pub(crate) fields: u64,
    pub(crate) pixels: Pixels,
    pub(crate) seed: u64,
    host: Arc<dyn Host>,
    shuffle: Option<u64>,
    traffic: bool,
    given_up: BTreeSet<Saving>,
    pub(crate) level: Level,
    pub(crate) head: Option<Arc<Head>>,
    closed_form: Option<ClosedForm>,
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
            given_up: BTreeSet::new(),
            level: Level::Transaction,
            head: None,
            closed_form: None,
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

    /// The closed form by which a run that is too short to show anything says how many fields it would take.
    #[must_use]
    pub const fn estimated_by(mut self, closed_form: Option<ClosedForm>) -> Self {
        self.closed_form = closed_form;
        self
    }

    /// How the raster before the head's eyes shows the picture.
    #[must_use]
    pub fn raster(&self) -> Raster {
        self.head.as_ref().map(|head| head.raster()).unwrap_or_default()
    }

    /// Builds the machine, switched on, with the pipeline's programs loaded; with prediction, after a rehearsal.
    ///
    /// # Errors
    ///
    /// [`ExperimentError`] for a machine, scene or number of fields that cannot be simulated.
    pub fn build(&self) -> Result<Machine, ExperimentError> {
        Ok(self.assemble(self.rehearse()?)?.0)
    }

    fn assemble(&self, rehearsal: Option<Rehearsal>) -> Result<(Machine, Option<Arc<HeadViews>>), ExperimentError> {
        let expected = if self.head.is_some() { (FIELDS_RANGE.0, FIELDS_WITH_HEAD) } else { FIELDS_RANGE };
        if !(expected.0..=expected.1).contains(&self.fields) {
            return Err(ExperimentError::Fields { expected, found: self.fields });
        }
        let adapted = self.pipeline.adapt(self.config.clone());
        let layout = self.pipeline.layout();
        let config = match self.level {
            Level::Analytic => return Err(ExperimentError::Level),
            Level::Transaction => adapted,
            Level::Cycle => with_clocks_of_instructions(&adapted, &layout),
        };
        let mut machine = Machine::new(&config, self.pipeline.eyes(), layout)?;
        if self.level == Level::Cycle {
            machine.run_code();
        }
        let (setup, head) = self.setup(&config, &machine, rehearsal)?;
        self.pipeline.load(&mut machine, &setup)?;
        if let Some(seed) = self.shuffle {
            machine.shuffle_ties(seed);
        }
        self.given_up.iter().for_each(|saving| machine.give_up(*saving));
        if self.pixels == Pixels::All {
            machine.compute_all_pixels(self.host.pixel_worker());
        }
        if self.traffic {
            machine.record_traffic();
        }
        machine.switch_on();
        Ok((machine, head))
    }

    fn setup(
        &self,
        config: &MachineConfig,
        machine: &Machine,
        rehearsal: Option<Rehearsal>,
    ) -> Result<(Setup, Option<Arc<HeadViews>>), ExperimentError> {
        let surface = machine.record().display().surfaces().first().cloned();
        let hmd = hmd_before(surface.as_ref());
        let eyes = self.pipeline.eyes();
        let period = config.host.view_period_ns * 1_000;
        let list = Arc::new(display_list(&self.scene).map_err(ExperimentError::Scene)?);
        let (views, wanted) = views(&self.scene, self.seed, hmd, eyes);
        let reports: ReportTimes = Arc::new(move |after: Time| Some(Time((after.0 / period + 1) * period)));
        let setup = Setup { list, views, wanted, reports, host: config.host, pixels: self.pixels != Pixels::Off };
        let Some(head) = &self.head else { return Ok((setup, None)) };
        let until = machine.record().tick(self.fields);
        let head = Arc::new(HeadViews::new(Arc::clone(head), &self.scene, (hmd, eyes), until, rehearsal));
        let (views, wanted, reports) = HeadViews::functions(&head);
        Ok((Setup { views, wanted, reports, ..setup }, Some(head)))
    }

    /// When each view is seen, from a run without prediction; `None` where nobody predicts, or the firmware knows.
    fn rehearse(&self) -> Result<Option<Rehearsal>, ExperimentError> {
        if self.pipeline.knows_when_seen() {
            return Ok(None);
        }
        let Some(head) = self.head.as_ref().filter(|head| head.predicts()) else { return Ok(None) };
        let plain = Self { head: Some(Arc::new(head.without_prediction())), pixels: Pixels::Off, ..self.clone() };
        let outcome = plain.perform(None, &[], |_, _| Ok(()))?;
        Ok(Some(Rehearsal::of(&outcome)))
    }

    /// Runs it.
    ///
    /// # Errors
    ///
    /// As [`Experiment::build`]; [`ExperimentError::Run`] with everything observed so far when the run ends early;
    /// [`ExperimentError::TooShort`], with the same, when nothing but pictures of the warm-up was shown.
    pub fn run(&self) -> Result<Outcome, ExperimentError> {
        self.run_with(|_, _| {})
    }

    /// Runs it and reports progress: fields simulated, of all.
    ///
    /// # Errors
    ///
    /// As [`Experiment::run`].
    pub fn run_with(&self, mut progress: impl FnMut(u64, u64)) -> Result<Outcome, ExperimentError> {
        self.run_stopping(&[], |field, _| {
            progress(field, self.fields);
            Ok(())
        })
    }

    /// Runs it and stops at the retrace that begins each of some fields, and now and then between: `at` sees the field
    /// and the machine, before anything of that field has happened, and may end the run.
    ///
    /// # Errors
    ///
    /// As [`Experiment::run`], and what `at` says.
    pub fn run_stopping(
        &self,
        stops: &[u64],
        at: impl FnMut(u64, &mut Machine) -> Result<(), ExperimentError>,
    ) -> Result<Outcome, ExperimentError> {
        self.perform(self.rehearse()?, stops, at)
    }

    fn perform(
        &self,
        rehearsal: Option<Rehearsal>,
        stops: &[u64],
        mut at: impl FnMut(u64, &mut Machine) -> Result<(), ExperimentError>,
    ) -> Result<Outcome, ExperimentError> {
        let begun_s = self.host.seconds();
        let (mut machine, head) = self.assemble(rehearsal)?;
        let mut result = Ok(());
        for field in self.stops(stops) {
            let until = machine.record().tick(field);
            result = machine.run_until(until);
            if result.is_err() {
                break;
            }
            at(field, &mut machine)?;
        }
        machine.finish_pixels();
        let host_seconds = begun_s.zip(self.host.seconds()).map(|(begin, end)| end - begin);
        let record = machine.into_record();
        let reached = result.as_ref().err().map_or(self.fields, |error| record.display().period_at(error.time()));
        let outcome = Outcome::new(self.clone(), record, head, reached, host_seconds);
        match result {
            Err(error) => Err(ExperimentError::Run { error, partial: Box::new(outcome) }),
            Ok(()) if outcome.steady_pictures().is_empty() => Err(self.too_short(outcome)),
            Ok(()) => Ok(outcome),
        }
    }

    fn too_short(&self, partial: Outcome) -> ExperimentError {
        let needed = self.closed_form.and_then(|form| (form.fields_needed)(self).ok().flatten());
        let pictures = partial.pictures().len();
        ExperimentError::TooShort { fields: self.fields, pictures, needed, partial: Box::new(partial) }
    }
}

impl Experiment {
    /// Fields at which to stop: those asked for, every so many for the progress, the last.
    fn stops(&self, asked: &[u64]) -> BTreeSet<u64> {
        let regular = (PROGRESS_FIELDS..self.fields).step_by(PROGRESS_FIELDS as usize);
        asked.iter().copied().filter(|field| *field < self.fields).chain(regular).chain([self.fields]).collect()
    }

    /// Name of everything on which the trace depends: machine, pipeline with its settings, contents of the scene, fields,
    /// seed, level and head.
    #[must_use]
    pub fn config_hash(&self) -> Fingerprint {
        let mut hash = Fingerprint::default();
        // Firmware without a table of its own runs with the papers' numbers: with them or without, it is the same machine.
        let config = Registry::of_papers().machine_of(self.config.clone());
        hash.setting("code", config.code.name());
        config.displays.iter().for_each(|display| hash.setting("display", display.name()));
        config.settings().iter().for_each(|(path, value)| hash.setting(path, value));
        hash.setting("pipeline", self.pipeline.name());
        self.pipeline.settings().iter().for_each(|(key, value)| hash.setting(key, value));
        hash.setting("scene", Fingerprint::of_scene(&self.scene));
        hash.setting("fields", self.fields);
        hash.setting("seed", self.seed);
        hash.setting("level", self.level.name());
        if let Some(head) = &self.head {
            hash.setting("head", head.fingerprint());
        }
        hash
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

/// Fields between two reports of progress.
const PROGRESS_FIELDS: u64 = 60;
