//! An experiment: a machine, a pipeline, a scene and a head motion; and what came of it.

use crate::compare::PixelErrors;
use crate::config::{ConfigError, MachineConfig};
use crate::display::{Display, RasterOffsets};
use crate::display_list::{display_list, views};
use crate::fingerprint::Fingerprint;
use crate::head_to_light::{FIELDS_WITH_HEAD, Head, HeadViews, Rehearsal};
use crate::levels::{Level, literal};
use crate::machine::{Machine, RunError};
use crate::observation::{Observation, StageSpan};
use crate::pictures;
use crate::pipelines::{PictureTimes, Pipeline, ReportTimes, Setup};
use crate::report::{HeadReport, Report, Statistics};
use crate::savings::Saving;
use image::RgbImage;
use pxpl5_scene::Scene;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Eye, MAX_MESSAGE_WORDS};
use std::collections::BTreeSet;
use std::fmt;
use std::sync::Arc;
use std::time::Instant;

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

/// Why an experiment gave no result.
#[derive(Debug)]
#[non_exhaustive]
pub enum ExperimentError {
    /// The machine or its numbers are impossible, or the pipeline cannot run on it.
    Config(ConfigError),
    /// The number of fields is out of range.
    Fields {
        /// Smallest and largest.
        expected: (u64, u64),
        /// What was asked for.
        found: u64,
    },
    /// Nothing was shown in the time given.
    TooShort {
        /// Fields simulated.
        fields: u64,
        /// Pictures that were shown; the first ones are discarded.
        pictures: usize,
    },
    /// The analytic level has no events that an experiment could observe.
    Level,
    /// The scene has nothing to draw, or too many moving structures.
    Scene(String),
    /// Whoever watched the run ended it ([`Experiment::run_stopping`]).
    Stopped(String),
    /// The run ended early; what was observed until then is kept.
    Run {
        /// Why.
        error: RunError,
        /// Everything until then.
        partial: Box<Outcome>,
    },
}

impl fmt::Display for ExperimentError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Config(error) => error.fmt(f),
            Self::Fields { expected: (low, high), found } => write!(f, "fields must be {low} to {high}, found {found}"),
            Self::TooShort { fields, pictures } => write!(
                f,
                "only {pictures} pictures were shown in {fields} fields and the first {WARM_UP_PICTURES} are discarded; simulate more fields"
            ),
            Self::Level => f.write_str(
                "level: expected transaction or cycle, found analytic, which has no events (it is for sweeps and limits)",
            ),
            Self::Scene(text) | Self::Stopped(text) => f.write_str(text),
            Self::Run { error, partial } => {
                write!(f, "{error} ({} pictures had been shown)", partial.pictures().len())
            }
        }
    }
}

impl std::error::Error for ExperimentError {}

impl From<ConfigError> for ExperimentError {
    fn from(error: ConfigError) -> Self {
        Self::Config(error)
    }
}

/// Pictures that are discarded because the pipeline is still filling (TR94 discards the first frames too).
pub const WARM_UP_PICTURES: usize = 4;

/// Smallest and largest number of fields.
pub const FIELDS_RANGE: (u64, u64) = (1, 10_000_000);

/// What is to be run.
#[derive(Clone, Debug)]
pub struct Experiment {
    config: MachineConfig,
    pipeline: Arc<dyn Pipeline>,
    scene: Arc<Scene>,
    fields: u64,
    pixels: Pixels,
    seed: u64,
    threads: usize,
    shuffle: Option<u64>,
    traffic: bool,
    given_up: BTreeSet<Saving>,
    level: Level,
    head: Option<Arc<Head>>,
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
        let threads = std::thread::available_parallelism().map_or(1, usize::from);
        Self {
            config,
            pipeline,
            scene,
            fields: 120,
            pixels: Pixels::Lazy,
            seed: 1,
            threads,
            shuffle: None,
            traffic: false,
            given_up: BTreeSet::new(),
            level: Level::Transaction,
            head: None,
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

    /// Worker threads for [`Pixels::All`], one for each core unless said; 0: the thread that simulates computes the pixels.
    #[must_use]
    pub const fn threads(mut self, threads: usize) -> Self {
        self.threads = threads;
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

    /// The display before the eyes.
    pub(crate) fn display(&self) -> Display {
        self.head.as_ref().map(|head| head.shown_on()).unwrap_or_default()
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
        let (adapted, layout) = (self.pipeline.adapt(self.config.clone()), self.pipeline.layout());
        let config = match self.level {
            Level::Analytic => return Err(ExperimentError::Level),
            Level::Transaction => adapted,
            Level::Cycle => literal(&adapted, &layout),
        };
        let mut machine = Machine::new(&config, self.pipeline.eyes(), layout)?;
        if let (Level::Cycle, Some(version)) = (self.level, config.code) {
            machine.run_code(version);
        }
        let (setup, head) = self.setup(&config, &machine, rehearsal)?;
        self.pipeline.load(&mut machine, &setup)?;
        if let Some(seed) = self.shuffle {
            machine.shuffle_ties(seed);
        }
        self.given_up.iter().for_each(|saving| machine.give_up(*saving));
        if self.pixels == Pixels::All {
            machine.compute_all_pixels(self.threads);
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
        let (eyes, period) = (self.pipeline.eyes(), config.host.view_period_ns * 1_000);
        let list = Arc::new(display_list(&self.scene).map_err(ExperimentError::Scene)?);
        let (views, wanted) = views(&self.scene, self.seed, eyes);
        let reports: ReportTimes = Arc::new(move |after: Time| Some(Time((after.0 / period + 1) * period)));
        let setup = Setup { list, views, wanted, reports, host: config.host, pixels: self.pixels != Pixels::Off };
        let Some(head) = &self.head else { return Ok((setup, None)) };
        let until = machine.video().retrace(self.fields);
        let head = Arc::new(HeadViews::new(Arc::clone(head), &self.scene, eyes, until, rehearsal));
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
    /// [`ExperimentError::TooShort`] when nothing was shown.
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
        let host_time = Instant::now();
        let (mut machine, head) = self.assemble(rehearsal)?;
        let mut result = Ok(());
        for field in self.stops(stops) {
            let until = machine.video().retrace(field);
            result = machine.run_until(until);
            if result.is_err() {
                break;
            }
            at(field, &mut machine)?;
        }
        machine.finish_pixels();
        let host_seconds = host_time.elapsed().as_secs_f64();
        let outcome = Outcome::new(self.clone(), machine, head, host_seconds);
        match result {
            Err(error) => Err(ExperimentError::Run { error, partial: Box::new(outcome) }),
            Ok(()) if outcome.steady_pictures().is_empty() => {
                Err(ExperimentError::TooShort { fields: self.fields, pictures: outcome.pictures().len() })
            }
            Ok(()) => Ok(outcome),
        }
    }
}

impl Experiment {
    /// Fields at which to stop: those asked for, every so many for the progress, the last.
    fn stops(&self, asked: &[u64]) -> BTreeSet<u64> {
        let regular = (PROGRESS_FIELDS..self.fields).step_by(PROGRESS_FIELDS as usize);
        asked.iter().copied().filter(|field| *field < self.fields).chain(regular).chain([self.fields]).collect()
    }

    /// Name of everything on which the trace depends: machine, pipeline and variant, contents of the scene, fields,
    /// seed and level.
    #[must_use]
    pub fn config_hash(&self) -> Fingerprint {
        let Self { config, pipeline, fields, seed, head, level, .. } = self;
        let scene = Fingerprint::of_scene(&self.scene);
        let parameters: Vec<_> = config.parameters().into_iter().map(|p| (p.path, p.value)).collect();
        let boards = (config.n_gps, config.n_renderers);
        let head = head.as_ref().map(|head| format!(" {}", head.fingerprint())).unwrap_or_default();
        // Transaction is left out, so that the names of its experiments stay what they were before there were others.
        let level = if *level == Level::Transaction { String::new() } else { format!(" {level:?}") };
        // So is code, where none runs or it is the preset's.
        let of_preset = MachineConfig::preset(&config.preset).is_ok_and(|preset| preset.code == config.code);
        let plays_no_part = self.level != Level::Cycle || of_preset;
        let code = if plays_no_part { String::new() } else { format!(" {:?}", config.code) };
        Fingerprint::of(
            format!("{boards:?} {parameters:?} {pipeline:?} {scene} {fields} {seed}{head}{level}{code}").as_bytes(),
        )
    }
}

/// Fields between two reports of progress.
const PROGRESS_FIELDS: u64 = 60;

/// What came of an experiment.
#[derive(Debug)]
pub struct Outcome {
    experiment: Experiment,
    machine: Machine,
    head: Option<Arc<HeadViews>>,
    pictures: Vec<PictureTimes>,
    host_seconds: f64,
}

impl Outcome {
    fn new(experiment: Experiment, machine: Machine, head: Option<Arc<HeadViews>>, host_seconds: f64) -> Self {
        let end = machine.video().retrace(experiment.fields);
        let pictures = experiment.pipeline.pictures(&machine, end);
        Self { experiment, machine, head, pictures, host_seconds }
    }

    /// All pictures that were shown.
    #[must_use]
    pub fn pictures(&self) -> &[PictureTimes] {
        &self.pictures
    }

    /// The pictures after the first [`WARM_UP_PICTURES`].
    #[must_use]
    pub fn steady_pictures(&self) -> &[PictureTimes] {
        self.pictures.get(WARM_UP_PICTURES..).unwrap_or_default()
    }

    /// The machine as it stands at the end.
    #[must_use]
    pub const fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The views that the head's tracker gave, if there was one.
    #[must_use]
    pub fn head(&self) -> Option<&HeadViews> {
        self.head.as_deref()
    }

    /// Time that the run took on this host, in seconds.
    #[must_use]
    pub const fn host_seconds(&self) -> f64 {
        self.host_seconds
    }

    /// What was observed.
    #[must_use]
    pub const fn observation(&self) -> &Observation {
        self.machine.observation()
    }

    /// All stages of all pictures, COPY as the frame buffers saw it.
    #[must_use]
    pub fn stages(&self) -> Vec<StageSpan> {
        self.observation().stages(self.machine.ring().timing().occupancy(MAX_MESSAGE_WORDS))
    }

    /// The software time of a message that a GP receives.
    pub(crate) const fn receive_span(&self) -> Span {
        Span::from_ns(self.experiment.config.gp.message_ns)
    }

    /// The pipeline that ran.
    #[must_use]
    pub fn pipeline(&self) -> &dyn Pipeline {
        self.experiment.pipeline.as_ref()
    }

    /// Fields simulated.
    #[must_use]
    pub const fn fields(&self) -> u64 {
        self.experiment.fields
    }

    /// The end of the run.
    #[must_use]
    pub fn end(&self) -> Time {
        self.machine.video().retrace(self.experiment.fields)
    }

    /// Latency in milliseconds over the pictures after the warm-up, as the pipeline defines it.
    #[must_use]
    pub fn latency_ms(&self) -> Statistics {
        Statistics::of(self.steady_pictures().iter().map(|times| (times.shown_at - times.transform_at).as_ms()))
    }

    /// The same in fields.
    #[must_use]
    pub fn latency_fields(&self) -> Statistics {
        let field_ms = self.machine.video().retrace(60_000).since(Time::ZERO).as_ms() / 60_000.0;
        let fields = |times: &PictureTimes| (times.shown_at - times.transform_at).as_ms() / field_ms;
        Statistics::of(self.steady_pictures().iter().map(fields))
    }

    /// What the eye sees at the end; `None` without pixels, or before anything was shown.
    #[must_use]
    pub fn picture(&self, eye: Eye) -> Option<RgbImage> {
        if self.experiment.pixels == Pixels::Off {
            return None;
        }
        match RasterOffsets::of(self) {
            Some(offsets) => {
                let field = self.machine.frame_buffers().get(eye.index())?.last_seen()?.field();
                Some(pictures::screen(&self.machine, eye, field, Some(&offsets)))
            }
            None => self.experiment.pipeline.picture(&self.machine, eye),
        }
    }

    /// Pixel errors on the display before the eyes; `None` of a run without a head.
    #[must_use]
    pub fn pixel_errors(&self) -> Option<PixelErrors> {
        Some(match self.head()?.head().shown_on() {
            Display::Plain => PixelErrors::of(self),
            Display::Vdrt => PixelErrors::with_raster_offset(self),
        })
    }

    /// Everything as numbers.
    #[must_use]
    pub fn report(&self) -> Report {
        let experiment = &self.experiment;
        let pictures = self.steady_pictures();
        let late = experiment.pipeline.late_regions(&self.machine, self.end());
        Report {
            schema: Report::SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            machine: experiment.config.preset.clone(),
            config_hash: experiment.config_hash().to_string(),
            level: experiment.level.name().to_owned(),
            seed: experiment.seed,
            pipeline: experiment.pipeline.name().to_owned(),
            variant: format!("{:?}", experiment.pipeline),
            overrides: experiment.config.overrides(),
            n_gps: experiment.config.n_gps,
            n_renderers: experiment.config.n_renderers,
            scene: experiment.scene.name().to_owned(),
            triangles: experiment.scene.triangles().len(),
            spheres: experiment.scene.spheres().len(),
            fields: experiment.fields,
            pictures: pictures.len(),
            latency_fields: self.latency_fields().defined(experiment.pipeline.latency_definition()),
            latency_ms: self.latency_ms().defined(experiment.pipeline.latency_definition()),
            latency_parts_ms: self.latency_part_statistics(),
            latency_by_eye_ms: self.latency_by_eye(),
            updates_hz: updates_hz(pictures) / experiment.pipeline.updates_per_picture(&self.machine),
            missed_retraces: experiment.pipeline.missed_retraces(pictures),
            missed_retraces_definition: experiment.pipeline.missed_definition().to_owned(),
            late_regions: late.len(),
            first_late_regions: late.into_iter().take(20).collect(),
            head: self.head.as_ref().and_then(|head| HeadReport::of(self, head.head())),
            trace_hash: self.machine.trace_hash().to_string(),
            events: self.machine.events(),
            host_seconds: self.host_seconds,
        }
    }
}

/// Complete pictures per second of simulated time.
fn updates_hz(pictures: &[PictureTimes]) -> f64 {
    let complete: Vec<_> = pictures.iter().filter(|times| times.complete).collect();
    match complete[..] {
        [first, .., last] => (complete.len() - 1) as f64 * 1e3 / (last.shown_at - first.shown_at).as_ms(),
        _ => 0.0,
    }
}
