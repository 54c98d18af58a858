//! Experiments in files, and studies of many experiments.

/// An experiment that was read from the text of a file.
///
/// The example reads an experiment, prints all its settings, and runs it.
///
/// ```
/// use pxpl5::{Settings, prelude::*};
///
/// let text = "pipeline = \"slats\"\nscene = \"full-screen:12\"\nfields = 60\n";
/// let plan: Plan = ExperimentFile::parse(text, "an experiment")?.resolve()?;
/// // All settings of the plan as the text of a file.
/// let settings: Settings = plan.settings();
/// assert!(settings.to_string().contains("slats"));
/// let outcome = plan.experiment(plan.load_scene()?).run()?;
/// assert!((outcome.latency_fields().mean - 1.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_lab::ExperimentFile;

/// Finds the resources of a machine that limit the latency.
///
/// The example prints the latency before and after each change. Each latency comes from a run.
///
/// ```
/// use pxpl5::prelude::*;
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60);
/// let query = WhatIfQuery { registry: registry(), experiment };
/// for WhatIf { resource, latency_ms: [before, after], .. } in query.run(&mut ())? {
///     println!("10 % more {resource}: {before:?} ms, then {after:?} ms");
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_lab::WhatIfQuery;

/// The error type of all studies, for invalid settings and failed runs.
///
/// The example asks for more than a display can show.
///
/// ```
/// use pxpl5::{ExperimentFile, StudyError};
///
/// let read = || -> Result<_, StudyError> { Ok(ExperimentFile::parse("fields = 0", "an experiment")?.resolve()?) };
/// assert!(matches!(read(), Err(StudyError::Setting(_))));
/// ```
pub use pxpl5_lab::StudyError;

/// A host with a clock and threads for [`Experiment::host`](crate::Experiment::host).
///
/// In the example, two threads compute the pixels of all regions during the simulation.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::Workstation;
///
/// let scene = scene::builtin("full-screen:1")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(12);
/// let outcome = experiment.pixels(Pixels::All).host(Workstation::with_threads(2)).run()?;
/// assert!(outcome.host_seconds().is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_lab::Workstation;

/// A signal that ends a long search or a long run.
///
/// The example sets the flag before the search. Another thread usually sets a clone of the flag later.
///
/// ```
/// use pxpl5::limit::LimitQuery;
/// use pxpl5::{MachineConfig, Slats, StopFlag, Study};
///
/// let mut stop = StopFlag::default();
/// let query = LimitQuery::of_papers(MachineConfig::slats(), Slats::split())?;
/// stop.stop();
/// assert!(query.run(&mut stop).is_err_and(|error| error.to_string().contains("stopped")));
/// # Ok::<(), pxpl5::ExperimentError>(())
/// ```
pub use pxpl5_lab::StopFlag;

/// The shape of all questions over many experiments, and the follower of their progress.
///
/// The example counts the scenes that a search simulates.
///
/// ```
/// use pxpl5::limit::LimitQuery;
/// use pxpl5::{MachineConfig, Slats, Study, StudyError, Watcher};
///
/// struct Counter(u64);
/// impl Watcher for Counter {
///     fn progress(&mut self, done: u64, _of: u64) {
///         self.0 = done;
///     }
/// }
/// let mut scenes = Counter(0);
/// let limit = LimitQuery::of_papers(MachineConfig::slats(), Slats::split())?.run(&mut scenes)?;
/// assert_eq!(scenes.0, limit.tried as u64);
/// # Ok::<(), StudyError>(())
/// ```
pub use pxpl5_lab::Study;
pub use pxpl5_lab::Watcher;

/// Returns the reason why a machine cannot run a pipeline, for each pipeline.
///
/// The example tests the machine of Slats.
///
/// ```
/// use pxpl5::{MachineConfig, Suitability, registry, suitability};
///
/// let of_slats: Vec<Suitability> = suitability(&registry(), &MachineConfig::slats());
/// assert!(!of_slats.is_empty());
/// ```
pub use pxpl5_lab::suitability;

/// The settings of an experiment file, complete and checked.
///
/// The example reads the choices of a plan from its public fields.
///
/// ```
/// use pxpl5::{ExperimentFile, HeadChoice, ModelPlace, MotionChoice, Origin, Outputs, Published, SceneChoice};
///
/// let text = "pipeline = \"slats\"\nscene = \"mig\"\ntriangles = 100\nhead.motion = \"pan:90\"\n";
/// let plan = ExperimentFile::parse(text, "an experiment")?.resolve()?;
/// let (scene, outputs): (&SceneChoice, &Outputs) = (&plan.scene, &plan.output);
/// assert_eq!(scene.triangles, Some(100));
/// println!("{outputs:?}");
/// let (motion, head): (&MotionChoice, Option<&HeadChoice>) = (&scene.motion, plan.head.as_ref());
/// println!("{motion:?}");
/// assert!(head.is_some());
/// let published: Option<&Published> = plan.published.as_ref();
/// assert!(published.is_none());
/// // No key `model.*` moves the scene, and no key `origin.*` names the results that the settings come from.
/// assert_eq!((scene.model, &plan.origin), (ModelPlace::default(), &Origin::default()));
/// # Ok::<(), pxpl5::SettingError>(())
/// ```
pub use pxpl5_lab::Plan;

pub use pxpl5_lab::{
    HeadChoice, ModelPlace, MotionChoice, Origin, Outputs, Published, SceneChoice, Settings, Suitability, WhatIf,
    compare, figures, in_parallel, interpretations, intervals, levels, limit, registry, rig, sweep,
    tracking_parameters,
};

/// Less common names of the laboratory: trackers, predictors, and estimates of the cost of a run.
pub mod lab {
    /// A key that an experiment file can have.
    ///
    /// The example lists all keys, and reads the key `head.path`.
    ///
    /// ```
    /// use pxpl5::lab::{FileKey, PathChoice};
    /// use pxpl5::{ExperimentFile, registry};
    ///
    /// let keys: Vec<FileKey> = ExperimentFile::keys_of(&registry());
    /// assert!(!keys.is_empty());
    /// let text = "pipeline = \"slats\"\nscene = \"mig\"\nhead.path = \"still\"\n";
    /// let path: PathChoice = ExperimentFile::parse(text, "an experiment")?.resolve()?.scene.motion.path;
    /// assert_eq!(path, PathChoice::Still);
    /// # Ok::<(), pxpl5::SettingError>(())
    /// ```
    pub use pxpl5_lab::FileKey;

    pub use pxpl5_lab::{
        NEAR_FIELDS, PREDICTORS, PathChoice, TRACKERS, diff, estimate, manifest, motion, near_edges, predictor,
        tracker, volumes, walks,
    };
}
