//! Experiments, pipelines, heads, and runs in steps.

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

/// ```
/// use pxpl5::prelude::*;
///
/// // A run of one field shows no picture. The error contains the observations of the run.
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene);
/// match experiment.fields(1).run() {
///     Err(ExperimentError::TooShort { partial, .. }) => assert!(partial.latency().is_none()),
///     other => panic!("{other:?}"),
/// }
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::ExperimentError;

/// ```
/// use pxpl5::{ObservedEvent, prelude::*};
///
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60);
/// let outcome: Outcome = experiment.run()?;
/// // Slats shows a new picture in each field, with a latency of one field.
/// assert!((outcome.latency_fields().mean - 1.0).abs() < 1e-9);
/// // Each event of the run has the board on which it happened.
/// let first: Option<ObservedEvent> = outcome.events().find(|event| matches!(event.kind, ObservedKind::Arrived { .. }));
/// println!("{}", first.expect("pictures were shown"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Outcome;

/// ```
/// use pxpl5::prelude::*;
/// use std::sync::Arc;
///
/// // A head that turns by 100 degrees a second, a magnetic tracker, and a Kalman filter.
/// let turn = from_fn(|seconds| Pose { orientation: DQuat::from_rotation_y(1.745 * seconds), ..Pose::IDENTITY });
/// let head = Head::new(Arc::new(turn), TrackerConfig::fastrak(), PredictorKind::Kalman, 1)?;
/// let scene = scene::builtin("full-screen:4")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(90).pixels(Pixels::Off);
/// let report = experiment.head(head).run()?.report();
/// assert!(report.head.is_some_and(|head| head.error.pixels.mean > 0.0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::Head;

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

/// ```
/// use pxpl5::{PipelineEntry, prelude::*};
///
/// // A pipeline that is chosen by its name at run time.
/// let registry = Registry::of_papers();
/// let entry: &PipelineEntry = registry.pipeline("jitp-scanline-racing")?;
/// let pipeline = (entry.build)(&PipelineSettings::default());
/// assert_eq!(pipeline.name(), "jitp-scanline-racing");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::{PipelineEntry, PipelineSettings, Registry};

/// ```
/// use pxpl5::firmware::{CopyTarget, Layout, PictureNumber, Shading, ViewNumber};
/// use pxpl5::{Aim, Machine, PictureTimes, Record, SettingError, Setup, Source, Time, prelude::*};
/// use std::collections::BTreeMap;
///
/// // A new pipeline that loads the firmware of an existing pipeline.
/// #[derive(Debug)]
/// struct Mine(RenderingControl);
///
/// impl Pipeline for Mine {
///     fn name(&self) -> &'static str {
///         "mine"
///     }
///     fn eyes(&self) -> usize {
///         self.0.eyes()
///     }
///     fn layout(&self) -> Layout {
///         self.0.layout()
///     }
///     fn shading(&self) -> Shading {
///         self.0.shading()
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
///     fn latency_definition(&self) -> &'static str {
///         "from TRANSFORM to the swap"
///     }
///     fn due_definition(&self) -> &'static str {
///         "no picture is due"
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
pub use pxpl5_run::{PictureRules, Pipeline, Setup, Source};

/// ```
/// use pxpl5::{Viewpoint, prelude::*};
///
/// // The same triangles with four pipelines of the papers.
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
pub use pxpl5_run::{Frameless, Jitp, RenderingControl, Slats};

/// ```
/// use pxpl5::{Code, CopySchedule, FinishedRegions, Interpolation, RegionBinning, Slats, SlatsLighting};
///
/// // A pipeline is a struct of settings. Experiment files use the same names for the values.
/// let slats = Slats { copy: CopySchedule::Whole, binning: RegionBinning::Touched, ..Slats::split() };
/// assert_eq!(slats.copy.to_string(), "whole");
/// assert_eq!("touched".parse(), Ok(slats.binning));
/// assert_eq!("gp".parse(), Ok(SlatsLighting::OnGp));
/// assert_eq!("1995".parse(), Ok(Code::Of1995));
/// assert_eq!(FinishedRegions::default().name(), "wait");
/// # let _ = Interpolation::View;
/// ```
pub use pxpl5_run::{Code, FinishedRegions, Interpolation, SlatsLighting, Viewpoint};

pub use pphigs::RegionBinning;
pub use slats::CopySchedule;

/// ```
/// use pxpl5::{Keep, Level, Pixels};
///
/// // Each value has a name, which can be printed and parsed.
/// assert_eq!("cycle".parse(), Ok(Level::Cycle));
/// assert_eq!(Pixels::Lazy.to_string(), "lazy");
/// assert_eq!("statistics".parse(), Ok(Keep::Statistics));
/// let error = "cycles".parse::<Level>().expect_err("no level");
/// assert_eq!(error.to_string(), "expected cycle, analytic or transaction, found `cycles`");
/// ```
pub use pxpl5_run::{Keep, Level, Pixels};

/// ```
/// use pxpl5::{Aim, Every, Raster, Reprojection, Warp};
///
/// // A device after the frame buffer that rotates each line to the newest pose.
/// let device = Reprojection::new(Warp::Rotation, Every::Line);
/// assert_eq!(device.to_string(), "rotation every line, 100 us");
/// assert_eq!("rotation every line, 100 us".parse(), Ok(Raster::Reprojected(device)));
/// // By default, the view is predicted for the middle of the time in which the picture lights.
/// assert_eq!(Aim::default().to_string(), "middle");
/// ```
pub use pxpl5_run::{Aim, Every, Raster, Reprojection, Warp};

/// ```
/// use pxpl5::{BareHost, Host};
///
/// // A host without a clock measures no computing time. The results are the same.
/// assert_eq!(BareHost.seconds(), None);
/// ```
pub use pxpl5_run::{BareHost, Host};

/// ```
/// use pxpl5::{DisplayEntry, Goal, Key, KeyValue, KeyValues, LimitCriterion, Registry, TestScene};
///
/// let registry = Registry::of_papers();
/// let slats = registry.pipeline("slats")?;
/// let ntsc: &DisplayEntry = registry.display("ntsc")?;
/// assert_eq!((ntsc.config)().name(), "ntsc");
/// // The setting `copy` has three values.
/// let copy: &Key = slats.keys.iter().find(|key| key.name == "copy").ok_or("a key")?;
/// assert_eq!(copy.values.to_string(), "whole, split or backup");
/// // A scene is small enough if no retrace is missed.
/// let LimitCriterion { goal, .. } = (slats.limit)(&Default::default());
/// assert_eq!(goal, Goal::NoMissedRetrace);
/// # let _ = TestScene::Typical;
/// # let _ = (KeyValue::Flag(true), KeyValues::Flag);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::{DisplayEntry, Goal, Key, KeyValue, KeyValues, LimitCriterion, TestScene};

/// ```
/// use pxpl5::{Cause, Fingerprint};
///
/// assert_eq!(Cause::ALL.map(Cause::name), ["latency", "scan-out", "noise", "prediction", "sampling"]);
/// // A fingerprint identifies settings or the contents of a scene.
/// let fingerprint = Fingerprint::of(b"a");
/// assert_eq!(fingerprint.to_string().parse(), Ok(fingerprint));
/// ```
pub use pxpl5_run::{Cause, Fingerprint};

/// ```
/// use pxpl5::firmware::{RegionId, Shading};
/// use pxpl5::{PolicyFrame, PolicyPipeline, RegionAssignment, RegionPolicy, SettingError, prelude::*};
///
/// /// Draws region after region, with one renderer after the other.
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
pub use pxpl5_run::{PolicyFrame, PolicyPipeline, RegionAssignment, RegionPolicy};

/// ```
/// use pxpl5::{HeadPlace, prelude::*};
///
/// // The motion is given in the world's coordinates, not relative to the start of the scene's own motion.
/// let motion = std::sync::Arc::new(from_fn(|_| Pose::IDENTITY));
/// let head = Head::new(motion, TrackerConfig::ideal(), PredictorKind::None, 1)?.with_place(HeadPlace::World);
/// # drop(head);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::HeadPlace;

/// ```
/// use pxpl5::{Estimator, HeadViews, SampledPose, prelude::*};
/// use std::sync::Arc;
///
/// let turn = from_fn(|seconds| Pose { orientation: DQuat::from_rotation_y(seconds), ..Pose::IDENTITY });
/// let head = Head::new(Arc::new(turn), TrackerConfig::ideal(), PredictorKind::None, 1)?;
/// let scene = scene::builtin("full-screen:4")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60).pixels(Pixels::Off);
/// let outcome = experiment.head(head).run()?;
/// // The poses for which the pictures were drawn, and a new estimate for the same instants.
/// let views: &Arc<HeadViews> = outcome.head().ok_or("a tracked head")?;
/// let sampled: Vec<SampledPose> = views.sampled();
/// let last = sampled.last().ok_or("views were requested")?;
/// let estimate = Estimator::new(views, None).pose(last.known, last.objects_at);
/// println!("{estimate:?}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::{Estimator, HeadViews, SampledPose};

pub use pxpl5_run::{FIELDS_RANGE, Pause, out_of_range};
