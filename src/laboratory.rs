//! Experiments in files, saved runs, and studies of many experiments.

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
pub use pxpl5_lab::{ExperimentFile, Plan, Settings};

/// ```
/// use pxpl5::prelude::*;
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60);
/// let mut stepper = experiment.stepper()?;
/// stepper.step_period();
/// // The text of a saved run. The same experiment can later continue from the saved field.
/// let text = Snapshot::of_stepper(&stepper)?.to_text();
/// let saved = Snapshot::read(&text, "saved")?;
/// let other = saved.resume(&experiment.clone().seed(2), "saved");
/// assert!(other.is_err_and(|error| error.to_string().contains("differs from the saved run")));
/// let resumed = saved.resume(&experiment, "saved")?;
/// assert_eq!(resumed.finish()?.record().trace_hash(), stepper.finish()?.record().trace_hash());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_lab::Snapshot;

/// ```
/// use pxpl5::prelude::*;
///
/// // The latency with 10 % more of each resource, computed by the analytic model.
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60);
/// for WhatIf { resource, latency_ms: [before, after], .. } in what_if(&registry(), &experiment)? {
///     println!("10 % more {resource}: {before:?} ms, then {after:?} ms");
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_lab::{WhatIf, what_if};

/// ```
/// use pxpl5::StudyError;
/// use pxpl5::pipeline_figures::PIPELINE_FIGURES;
///
/// // A drawing of a pipeline in a paper, repeated as a run. One error type covers invalid settings and failed runs.
/// let run = || -> Result<_, StudyError> { PIPELINE_FIGURES[0].run() };
/// assert!(run().is_ok());
/// ```
pub use pxpl5_lab::StudyError;

/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::Workstation;
///
/// // Two threads compute the pixels of all regions during the simulation.
/// let scene = scene::builtin("full-screen:1")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(12);
/// let outcome = experiment.pixels(Pixels::All).host(Workstation::with_threads(2)).run()?;
/// assert!(outcome.host_seconds().is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_lab::Workstation;

/// ```
/// use pxpl5::limit::LimitQuery;
/// use pxpl5::{ExperimentError, MachineConfig, Slats, StopFlag};
///
/// // A flag that ends a search. Another thread usually holds a clone of the flag, and stops the search later.
/// let stop = StopFlag::default();
/// let query = LimitQuery { stop: stop.clone(), ..LimitQuery::of_papers(MachineConfig::slats(), Slats::split())? };
/// stop.stop();
/// assert!(matches!(query.search(), Err(ExperimentError::Stopped(_))));
/// # Ok::<(), ExperimentError>(())
/// ```
pub use pxpl5_lab::StopFlag;

/// ```
/// use pxpl5::{MachineConfig, Suitability, registry, suitability};
///
/// // For each pipeline, the reason why the machine cannot run it, or `None`.
/// let of_slats: Vec<Suitability> = suitability(&registry(), &MachineConfig::slats());
/// assert!(!of_slats.is_empty());
/// ```
pub use pxpl5_lab::{Suitability, registry, suitability};

/// ```
/// use pxpl5::{ExperimentFile, HeadChoice, MotionChoice, Outputs, Published, SceneChoice};
///
/// let text = "pipeline = \"slats\"\nscene = \"mig\"\ntriangles = 100\nhead.motion = \"pan:90\"\n";
/// let plan = ExperimentFile::parse(text, "an experiment")?.resolve()?;
/// // The choices of a plan are public fields.
/// let (scene, outputs): (&SceneChoice, &Outputs) = (&plan.scene, &plan.output);
/// assert_eq!(scene.triangles, Some(100));
/// println!("{outputs:?}");
/// let (motion, head): (&MotionChoice, Option<&HeadChoice>) = (&scene.motion, plan.head.as_ref());
/// println!("{motion:?}");
/// assert!(head.is_some());
/// let published: Option<&Published> = plan.published.as_ref();
/// assert!(published.is_none());
/// # Ok::<(), pxpl5::SettingError>(())
/// ```
pub use pxpl5_lab::{HeadChoice, MotionChoice, Outputs, Published, SceneChoice};

pub use pxpl5_lab::{
    compare, figures, growth, in_parallel, intervals, levels, limit, pipeline_figures, readings, rig, sweep,
    tracking_parameters,
};

/// Less common names of the laboratory: trackers, predictors, and estimates of the cost of a run.
pub mod lab {
    /// ```
    /// use pxpl5::lab::{FileKey, PathChoice};
    /// use pxpl5::{ExperimentFile, registry};
    ///
    /// // All keys of an experiment file.
    /// let keys: Vec<FileKey> = ExperimentFile::keys_of(&registry());
    /// assert!(!keys.is_empty());
    /// // The key `head.path` selects the path of the head.
    /// let text = "pipeline = \"slats\"\nscene = \"mig\"\nhead.path = \"still\"\n";
    /// let path: PathChoice = ExperimentFile::parse(text, "an experiment")?.resolve()?.scene.motion.path;
    /// assert_eq!(path, PathChoice::Still);
    /// # Ok::<(), pxpl5::SettingError>(())
    /// ```
    pub use pxpl5_lab::{FileKey, PathChoice};

    /// ```
    /// use pxpl5::SettingError;
    /// use pxpl5::lab::motion;
    ///
    /// let error: SettingError = motion("pann:200").expect_err("no motion");
    /// assert!(error.to_string().starts_with("there is no motion `pann:200`"));
    /// ```
    pub use pxpl5_lab::motion;

    pub use pxpl5_lab::{
        PREDICTORS, TRACKERS, application_time, code_times, diff, estimate, manifest, predictor, tracker,
    };
}
