//! Experiments, pipelines, heads, and runs in steps.

/// A machine, a pipeline and a scene, ready to run.
///
/// The example runs 60 fields without pixels and reads the latency.
///
/// ```
/// use pxpl5::prelude::*;
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene);
/// let outcome = experiment.fields(60).pixels(Pixels::Off).run()?;
/// assert!(outcome.latency().is_some_and(|latency| latency.mean > 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Experiment;

/// The error of [`Experiment::run`] and of a [`Stepper`].
///
/// The run of the example has one field and shows no picture. Its error contains the observations of the run.
///
/// ```
/// use pxpl5::prelude::*;
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene);
/// match experiment.fields(1).run() {
///     Err(ExperimentError::TooShort { partial, .. }) => assert!(partial.latency().is_none()),
///     other => panic!("{other:?}"),
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::ExperimentError;

/// The return value of [`Experiment::run`], with everything that was observed.
///
/// The example reads the latency of Slats, and the event of the first region that arrived.
///
/// ```
/// use pxpl5::{ObservedEvent, prelude::*};
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60);
/// let outcome: Outcome = experiment.run()?;
/// assert!((outcome.latency_fields().mean - 1.0).abs() < 1e-9);
/// let first: Option<ObservedEvent> = outcome.events().find(|event| matches!(event.kind, ObservedKind::Arrived { .. }));
/// println!("{}", first.expect("pictures were shown"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Outcome;

/// The viewer of an experiment, whose head moves and is tracked.
///
/// In the example, a head turns by 100 degrees a second, with a magnetic tracker and a Kalman filter. The motion has
/// the coordinates of the world.
///
/// ```
/// use pxpl5::{HeadPlace, prelude::*};
/// use std::sync::Arc;
///
/// let turn = from_fn(|seconds| Pose { orientation: DQuat::from_rotation_y(1.745 * seconds), ..Pose::IDENTITY });
/// let head = Head::new(Arc::new(turn), TrackerConfig::fastrak(), PredictorKind::Kalman, 1)?.with_place(HeadPlace::World);
/// let scene = scene::builtin("full-screen:4")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(90).pixels(Pixels::Off);
/// let report = experiment.head(head).run()?.report();
/// assert!(report.head.is_some_and(|head| head.error.pixels.mean > 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Head;

/// A run in steps, as in a debugger.
///
/// The example stops at the first event of renderer 0, and then runs to the end.
///
/// ```
/// use pxpl5::prelude::*;
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60);
/// let mut stepper = experiment.stepper()?;
/// assert_eq!(stepper.step_board(Board::Renderer(0)), Pause::Reached);
/// assert_eq!(stepper.last().map(|event| event.board), Some(Board::Renderer(0)));
/// // A run in steps has the same results as a run without steps.
/// let outcome = stepper.finish()?;
/// assert_eq!(outcome.record().trace_hash(), experiment.run()?.record().trace_hash());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Stepper;

/// A list of pipelines and displays, from which a program selects by name.
///
/// The example finds a display and a pipeline, and reads the settings of the pipeline.
///
/// ```
/// use pxpl5::{DisplayEntry, Goal, Key, KeyValue, KeyValues, LimitCriterion, PipelineEntry, TestScene, prelude::*};
///
/// let registry = Registry::of_papers();
/// let ntsc: &DisplayEntry = registry.display("ntsc")?;
/// assert_eq!((ntsc.config)().name(), "ntsc");
/// let entry: &PipelineEntry = registry.pipeline("slats")?;
/// let pipeline = (entry.build)(&PipelineSettings::default());
/// assert_eq!(pipeline.name(), "slats");
/// // The setting `copy` has three values.
/// let copy: &Key = entry.keys.iter().find(|key| key.name == "copy").ok_or("a key")?;
/// assert_eq!(copy.values.to_string(), "whole, split or backup");
/// // A scene is small enough if no retrace is missed.
/// let LimitCriterion { goal, .. } = (entry.limit)(&Default::default());
/// assert_eq!(goal, Goal::NoMissedRetrace);
/// # let _ = TestScene::Typical;
/// # let _ = (KeyValue::Flag(true), KeyValues::Flag);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Registry;

/// The trait that a pipeline of your own implements, together with [`PictureRules`].
///
/// The pipeline of the example loads the firmware of an existing pipeline, and has the same results.
///
/// ```
/// use pxpl5::firmware::{CopyTarget, PictureNumber, ViewNumber};
/// use pxpl5::{Aim, Machine, PictureTimes, PipelineProperties, Record, SettingError, Setup, Source, Time, prelude::*};
/// use std::collections::BTreeMap;
///
/// #[derive(Debug)]
/// struct Mine(RenderingControl);
///
/// impl Pipeline for Mine {
///     fn name(&self) -> &'static str {
///         "mine"
///     }
///     fn properties(&self) -> PipelineProperties {
///         let latency_definition = "from TRANSFORM to the swap";
///         PipelineProperties { latency_definition, due_definition: "no picture is due", ..self.0.properties() }
///     }
///     fn load(&self, machine: &mut Machine, setup: &Setup) -> Result<(), SettingError> {
///         self.0.load(machine, setup)
///     }
/// }
///
/// // The rules define the pictures of the pipeline, and the view for which each part of a picture was drawn.
/// impl PictureRules for Mine {
///     fn pictures(&self, record: &Record, end: Time) -> Vec<PictureTimes> {
///         self.0.pictures(record, end)
///     }
///     fn source(
///         &self,
///         record: &Record,
///         target: &CopyTarget,
///         views: &BTreeMap<PictureNumber, ViewNumber>,
///         aim: Aim,
///     ) -> Option<Source> {
///         self.0.source(record, target, views, aim)
///     }
/// }
///
/// let scene = std::sync::Arc::new(scene::builtin("full-screen:12")?);
/// let run = |pipeline: std::sync::Arc<dyn Pipeline>| {
///     Experiment::with(MachineConfig::small_hmd(), pipeline, scene.clone()).fields(60).run()
/// };
/// let (mine, theirs) = (RenderingControl::stereo(), RenderingControl::stereo());
/// let [mine, theirs] = [run(std::sync::Arc::new(Mine(mine)))?, run(std::sync::Arc::new(theirs))?];
/// assert_eq!(mine.record().trace_hash(), theirs.record().trace_hash());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Pipeline;

/// A pipeline that draws a whole frame before it shows the frame.
///
/// The example builds experiments with the same triangles and four pipelines of the papers.
///
/// ```
/// use pxpl5::{Viewpoint, prelude::*};
///
/// let scene = std::sync::Arc::new(scene::builtin("full-screen:4")?);
/// let slats = Experiment::new(MachineConfig::slats(), Slats::split(), scene.clone());
/// let machine = MachineConfig::small_hmd();
/// let jitp = Experiment::new(machine.clone(), Jitp::new(Viewpoint::Field, false), scene.clone());
/// let frameless = Experiment::new(machine.clone(), Frameless::new(), scene.clone());
/// let control = Experiment::new(machine, RenderingControl::mono(), scene);
/// let names = [slats, jitp, frameless, control].map(|experiment| experiment.pipeline().name());
/// assert_eq!(names[0], "slats");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::RenderingControl;

/// A pipeline with a latency of one field.
///
/// The example changes two settings. Experiment files use the same names for the values.
///
/// ```
/// use pxpl5::{Code, CopySchedule, FinishedRegions, Interpolation, RegionBinning, Slats, SlatsLighting};
///
/// let slats = Slats { copy: CopySchedule::Whole, binning: RegionBinning::Touched, ..Slats::split() };
/// assert_eq!(slats.copy.to_string(), "whole");
/// assert_eq!("touched".parse(), Ok(slats.binning));
/// assert_eq!("gp".parse(), Ok(SlatsLighting::OnGp));
/// assert_eq!("1995".parse(), Ok(Code::Of1995));
/// assert_eq!(FinishedRegions::default().name(), "store");
/// # let _ = Interpolation::View;
/// ```
pub use pxpl5_run::Slats;

/// A choice between formulas and models that execute events or instructions.
///
/// The example parses and prints the names of the choices of an experiment.
///
/// ```
/// use pxpl5::{KeptRecords, Level, Pixels};
///
/// assert_eq!("cycle".parse(), Ok(Level::Cycle));
/// assert_eq!(Pixels::Lazy.to_string(), "lazy");
/// assert_eq!("statistics".parse(), Ok(KeptRecords::Statistics));
/// let error = "cycles".parse::<Level>().expect_err("no level");
/// assert_eq!(error.to_string(), "expected cycle, analytic or transaction, found `cycles`");
/// ```
pub use pxpl5_run::Level;

/// A device after the frame buffer that moves pictures to the newest pose of the head.
///
/// The device of the example rotates each line. Experiment files use the printed text.
///
/// ```
/// use pxpl5::{Aim, Every, Raster, Reprojection, Warp};
///
/// let device = Reprojection::new(Warp::Rotation, Every::Line);
/// assert_eq!(device.to_string(), "rotation every line, 100 us");
/// assert_eq!("rotation every line, 100 us".parse(), Ok(Raster::Reprojected(device)));
/// // By default, the view is predicted for the middle of the time in which the picture lights.
/// assert_eq!(Aim::default().to_string(), "middle");
/// ```
pub use pxpl5_run::Reprojection;

/// A host that gives no services to a run.
///
/// The example shows that this host measures no computing time.
///
/// ```
/// use pxpl5::{BareHost, Host};
///
/// assert_eq!(BareHost.seconds(), None);
/// ```
pub use pxpl5_run::BareHost;

/// An identification of settings or of a scene by their content.
///
/// The example computes a fingerprint, prints it and parses it.
///
/// ```
/// use pxpl5::Fingerprint;
///
/// let fingerprint = Fingerprint::of(b"a");
/// assert_eq!(fingerprint.to_string().parse(), Ok(fingerprint));
/// ```
pub use pxpl5_run::Fingerprint;

/// A pipeline for testing how regions are assigned to renderers.
///
/// The policy of the example draws region after region, with one renderer after the other.
///
/// ```
/// use pxpl5::firmware::{RegionId, Shading};
/// use pxpl5::{PolicyFrame, PolicyPipeline, RegionAssignment, RegionPolicy, SettingError, prelude::*};
///
/// #[derive(Debug)]
/// struct InTurn;
///
/// impl RegionPolicy for InTurn {
///     fn name(&self) -> &str {
///         "in-turn"
///     }
///
///     fn assign(&self, frame: &PolicyFrame) -> Option<Vec<RegionAssignment>> {
///         let regions = 0..frame.primitives.len() as u16;
///         Some(regions.map(|region| (RegionId(region), usize::from(region) % frame.renderers)).collect())
///     }
/// }
///
/// let pipeline = PolicyPipeline::new(std::sync::Arc::new(InTurn), Shading::Gouraud);
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::small_hmd(), pipeline, scene).fields(60).pixels(Pixels::Off);
/// assert!(experiment.run()?.latency().is_some());
///
/// // The method `check` refuses an assignment to a renderer that does not exist.
/// let frame = PolicyFrame { frame: Default::default(), time: Default::default(), columns: 1, primitives: vec![9], renderers: 5 };
/// let error: SettingError = frame.check(&[(RegionId(0), 5)]).expect_err("renderers 0 to 4");
/// println!("{error}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::PolicyPipeline;

/// The prediction of a head's pose, repeated after a run.
///
/// The example lists the poses that Slats requested, and estimates the last pose again.
///
/// ```
/// use pxpl5::{Estimator, HeadViews, SampledPose, prelude::*};
/// use std::sync::Arc;
///
/// let turn = from_fn(|seconds| Pose { orientation: DQuat::from_rotation_y(seconds), ..Pose::IDENTITY });
/// let head = Head::new(Arc::new(turn), TrackerConfig::ideal(), PredictorKind::None, 1)?;
/// let scene = scene::builtin("full-screen:4")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60).pixels(Pixels::Off);
/// let outcome = experiment.head(head).run()?;
/// let views: &Arc<HeadViews> = outcome.head().ok_or("a tracked head")?;
/// let sampled: Vec<SampledPose> = views.sampled();
/// let last = sampled.last().ok_or("views were requested")?;
/// let estimate = Estimator::new(views, None).pose(last.reports_until, last.objects_at);
/// println!("{estimate:?}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Estimator;

pub use pphigs::RegionBinning;
pub use pxpl5_run::{
    Aim, Cause, Code, DisplayEntry, Every, FIELDS_RANGE, FinishedRegions, Frameless, Goal, HeadPlace, HeadViews, Host,
    Interpolation, Jitp, KeptRecords, Key, KeyValue, KeyValues, LimitCriterion, Pause, PictureRules, PipelineEntry,
    PipelineProperties, PipelineSettings, Pixels, PolicyFrame, Raster, RegionAssignment, RegionPolicy, SampledPose,
    Setup, SlatsLighting, Source, TestScene, Viewpoint, Warp, out_of_range,
};
pub use slats::CopySchedule;
