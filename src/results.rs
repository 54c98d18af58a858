//! Results of runs: latencies, errors in pixels, the use of boards, and pictures.

/// The methods that read an outcome as numbers and pictures.
///
/// The example reads one quantity by its name, a report of all results, and a picture.
///
/// ```
/// // The prelude contains the trait `Measured`.
/// use pxpl5::prelude::*;
///
/// let scene = scene::builtin("full-screen:12")?;
/// let outcome = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60).run()?;
/// assert_eq!(outcome.quantity("missed_retraces")?, Some(0.0));
/// assert_eq!(outcome.report().missed_retraces, Some(0));
/// assert_eq!(outcome.picture(Eye::Left).map(|picture| picture.dimensions()), Some((640, 480)));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_measure::Measured;

/// The results of a run as a struct with public fields.
///
/// The example prints the parts of the latency, and reads the latencies of both eyes.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{LatencyPartStatistics, SurfaceStatistics, TooHeavy};
///
/// let scene = scene::builtin("full-screen:12")?;
/// let outcome = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60).run()?;
/// let report: Report = outcome.report();
/// let parts: &[LatencyPartStatistics] = &report.latency_parts_ms;
/// for part in parts {
///     println!("{}: {:.2} ms", part.name, part.statistics.statistics.mean);
/// }
/// // Latencies of the left eye, the right eye and both, each to the end of COPY, to the swap and to the light.
/// let eyes: &[SurfaceStatistics] = &report.latency_by_eye_ms;
/// assert_eq!(eyes.len(), 3 * 3);
/// // The scene is small enough for the pipeline, so there is no warning.
/// let heavy: Option<&TooHeavy> = report.too_heavy.as_ref();
/// assert!(heavy.is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_measure::Report;

/// The part of a report about a tracked head.
///
/// In the example, a device moves each picture to the newest pose of the head.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{Budget, Every, EyeReport, HeadReport, Raster, RasterOffsets, Reprojection, ReprojectionReport, Warp};
/// use std::sync::Arc;
///
/// let turn = from_fn(|seconds| Pose { orientation: DQuat::from_rotation_y(seconds), ..Pose::IDENTITY });
/// let head = Head::new(Arc::new(turn), TrackerConfig::ideal(), PredictorKind::None, 1)?;
/// let head = head.with_raster(Raster::Reprojected(Reprojection::new(Warp::Rotation, Every::Line)));
/// let scene = scene::builtin("full-screen:4")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(90).pixels(Pixels::Off);
/// let outcome = experiment.head(head).run()?;
/// assert!(RasterOffsets::of(&outcome).is_some());
/// let report = outcome.report();
/// let head: HeadReport = report.head.ok_or("a tracked head")?;
/// let budget: Budget = head.end_to_end;
/// assert!(budget.total_ms > 0.0);
/// let eye: Option<EyeReport> = report.eye;
/// let device: Option<ReprojectionReport> = eye.and_then(|eye| eye.reprojection);
/// assert!(device.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_measure::HeadReport;

/// The name of one number of a run, such as `latency_ms.mean`.
///
/// The example prints the first quantity of the list, and measures the mean latency of Slats.
///
/// ```
/// use pxpl5::{QUANTITIES, Quantity, prelude::*};
///
/// let first: &Quantity = &QUANTITIES[0];
/// println!("{}: {}", first.name, first.definition);
/// let measure: Measure = "latency_ms.mean".parse()?;
/// println!("{measure}: {}", measure.definition());
/// let scene = scene::builtin("full-screen:12")?;
/// let results = Results::of_run(Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60).run()?);
/// // One NTSC field is 1001/60000 s.
/// assert!((measure.of(&results).ok_or("pictures were shown")? - 16.683).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_measure::Measure;

/// A list of the resources for which pictures wait.
///
/// The example prints the resource with the largest share of the latency.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{CriticalPath, LatencyPercentiles, PathPart, Resource, Utilisation};
///
/// let scene = scene::builtin("full-screen:12")?;
/// let report = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60).run()?.report();
/// // The resources for which the picture waits, sorted by their share of the latency.
/// let path: CriticalPath = report.critical_path.ok_or("pictures were shown")?;
/// println!("limited by {}", path.limited_by);
/// assert!(path.share(Resource::Ports) > 0.0);
/// let largest: &PathPart = &path.parts[0];
/// assert!(path.parts.iter().all(|part| part.share <= largest.share));
/// // Percentiles of the latency: a still scene has the same latency in each picture.
/// let LatencyPercentiles { latency, .. } = report.percentiles_ms;
/// assert!(latency.p95 - latency.p50 < 1.0);
/// let busy: Utilisation = report.utilisation.ok_or("the machine ran")?;
/// assert!(busy.renderers.executing.max <= 1.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_measure::CriticalPath;

/// An estimate of the pixel error from a motion and a latency, without a run.
///
/// In the example, a latency of 50 ms at 200 degrees a second is an error of 10 degrees.
///
/// ```
/// use pxpl5::LatencyCurve;
/// use pxpl5::tracking::motion::Pan;
///
/// let curve = LatencyCurve::of(&Pan::at(200.0), 50, 2, 1.0);
/// // 320 px are 30 degrees from the middle, and the middle moves by f tan(10 deg).
/// let middle = 320.0 / 30f64.to_radians().tan() * 10f64.to_radians().tan();
/// assert!((curve.mean_px() / middle - 1.0).abs() < 0.3, "{}", curve.mean_px());
/// ```
pub use pxpl5_measure::LatencyCurve;

/// A table that divides the pixel error of a run among its causes.
///
/// The example prints the error that the latency causes.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{Cause, ErrorCauses, ErrorPart, FieldMisregistration, PixelErrors, Registration, Showing};
/// use std::sync::Arc;
///
/// let turn = from_fn(|seconds| Pose { orientation: DQuat::from_rotation_y(seconds), ..Pose::IDENTITY });
/// let head = Head::new(Arc::new(turn), TrackerConfig::ideal(), PredictorKind::None, 1)?;
/// let scene = scene::builtin("full-screen:4")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(90).pixels(Pixels::Off);
/// let outcome = experiment.head(head).run()?;
/// let errors: PixelErrors = outcome.pixel_errors().ok_or("a tracked head")?;
/// assert!(errors.pixels.mean > 0.0);
/// let fields: &[FieldMisregistration] = &errors.by_field;
/// assert!(!fields.is_empty() && Registration::of(&outcome).is_some());
/// let causes = ErrorCauses::of(&outcome, Showing::Plain, &errors).ok_or("a tracked head")?;
/// let latency: Option<&ErrorPart> = causes.parts_px.iter().find(|part| part.cause == Cause::Latency);
/// println!("{:.2} px of {:.2} px", latency.ok_or("all causes are listed")?.px, causes.whole_px);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_measure::ErrorCauses;

/// A description of a list of numbers by mean and deviation.
///
/// The example computes the statistics of three latencies, and the percentiles of the numbers from 1 to 100.
///
/// ```
/// use pxpl5::{DefinedStatistics, Percentiles, Samples, Statistics};
///
/// let latencies = Statistics::of([49.0, 50.0, 51.0].into_iter());
/// assert_eq!((latencies.n, latencies.mean, latencies.sd), (3, 50.0, 1.0));
/// let defined: DefinedStatistics = latencies.defined("from TRANSFORM to the swap, ms");
/// assert_eq!(defined.statistics.min, 49.0);
/// let hundred = Percentiles::of((1..=100).map(f64::from));
/// assert_eq!((hundred.mean, hundred.max), (50.5, 100.0));
/// # let _ = Samples::keeping(1);
/// ```
pub use pxpl5_run::Statistics;

/// The instants at which a picture was begun, drawn and shown.
///
/// The example reads the pictures of a run, their latencies, and the periods that the results cover.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{DuePictures, LATENCY_PARTS, LatencyParts, PartDefinition, PictureResult, PictureTimes, ResultWindow, Summary};
///
/// let scene = scene::builtin("full-screen:12")?;
/// let outcome = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60).run()?;
/// // Results cover the display periods after the warm-up. In these periods, all due pictures were shown.
/// let (window, due): (ResultWindow, DuePictures) = outcome.window().zip(outcome.due()).ok_or("a window")?;
/// assert!(window.periods() > 0 && due.not_shown() == 0);
/// let picture: &PictureTimes = outcome.complete_pictures().next().ok_or("a picture")?;
/// assert!(picture.shown_at > picture.transform_at && picture.end == PictureResult::Shown);
/// // Each part of a latency has a definition in words.
/// let part: &PartDefinition = &LATENCY_PARTS[0];
/// println!("{part:?}");
/// let parts: Vec<LatencyParts> = outcome.latency_parts();
/// let summary: Summary = outcome.summary();
/// assert_eq!(parts.len() as u64, summary.latency_ms().n);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::PictureTimes;

/// An observer that computes the results of a tracked head during the run.
///
/// The memory of the run in the example does not grow with the length of the run.
///
/// ```
/// use pxpl5::{HeadSum, KeptRecords, prelude::*};
/// use std::sync::Arc;
///
/// let head = Head::new(Arc::new(from_fn(|_| Pose::IDENTITY)), TrackerConfig::ideal(), PredictorKind::None, 1)?;
/// let scene = scene::builtin("full-screen:4")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(90).pixels(Pixels::Off);
/// let long = experiment.head(head).keep(KeptRecords::Statistics).observed_by(Some(HeadSum::begin));
/// assert!(long.run()?.report().head.is_some());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_measure::HeadSum;

/// The trait of an observer that computes a result of its own during the run.
///
/// The observer of the example counts pictures.
///
/// ```
/// use pxpl5::prelude::*;
/// use pxpl5::{FinalResults, KeptRecords, ObserverFactory, StreamingObserver};
/// use std::any::Any;
///
/// #[derive(Debug, Default)]
/// struct Count(usize);
///
/// impl StreamingObserver for Count {
///     fn take(&mut self, results: &FinalResults<'_>) {
///         self.0 += results.pictures.len();
///     }
///     fn result(self: Box<Self>) -> Box<dyn Any + Send + Sync> {
///         Box::new(self.0)
///     }
/// }
///
/// let begin: ObserverFactory = || Box::<Count>::default();
/// let scene = scene::builtin("full-screen:12")?;
/// let experiment = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60).pixels(Pixels::Off);
/// let outcome = experiment.keep(KeptRecords::Statistics).observed_by(Some(begin)).run()?;
/// assert!(outcome.observed::<usize>().is_some_and(|pictures| *pictures > 0));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_run::StreamingObserver;

/// Computes how a picture looks after the head has moved.
///
/// In the example, a wall is two metres ahead, and the head moves five centimetres to the right.
///
/// ```
/// use pxpl5::image::RgbImage;
/// use pxpl5::tracking::view::Hmd;
/// use pxpl5::{DepthPicture, prelude::*, reproject_with_depth};
///
/// let depths = DepthPicture::from_fn(640, 480, |_, _| 2.0);
/// let now = Pose { position: DVec3::new(0.05, 0.0, 0.0), ..Pose::IDENTITY };
/// let moved = reproject_with_depth(&RgbImage::new(640, 480), &depths, &Hmd::unc(), &Pose::IDENTITY, &now);
/// // The picture moves to the left, so its right edge has no content.
/// let (_, black) = moved.ok_or("three pictures of one size")?;
/// assert!(black > 0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub use pxpl5_measure::reproject_with_depth;

pub use pxpl5_measure::{
    Budget, DepthPicture, ErrorPart, EyeReport, FieldMisregistration, LatencyPartStatistics, LatencyPercentiles,
    PathPart, Percentiles, PixelErrors, QUANTITIES, Quantity, RasterOffsets, Registration, ReprojectionReport,
    Resource, Results, Showing, SurfaceStatistics, TooHeavy, Utilisation, head_times, picture, reproject, side_by_side,
};
pub use pxpl5_run::{
    DefinedStatistics, DuePictures, FinalResults, LATENCY_PARTS, LatencyParts, ObserverFactory, PartDefinition,
    PictureResult, ResultWindow, Samples, Summary, WARM_UP_PERIODS, WARM_UP_PICTURES, WINDOW_DEFINITION,
};
