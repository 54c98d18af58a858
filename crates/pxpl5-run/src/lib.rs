//! Runs one experiment on the emulated Pixel-Planes 5: a machine, a pipeline, a scene and a head.
//!
//! The result is an [`Outcome`].
//!
//! ```text
//!   MachineConfig --+
//!   Pipeline -------+--> Experiment --run--> Outcome: Record of the machine, times of every picture, poses that were used
//!   Scene ----------+                           |
//!   Head (tracker) -+                           +--> pxpl5-measure: latencies, errors in pixels, pictures
//! ```
//!
//! A [`Registry`] lists all pipelines. Commands and experiment files find pipelines in the registry by name.
//!
//! **Not here:** access to the host computer. A [`Host`] supplies the clock and the threads. Scenes are passed as
//! values.

#![warn(missing_docs)]

mod assembled;
mod assembly;
mod board_text;
mod display_list;
mod dry_run;
mod dry_run_observer;
mod due;
mod error;
mod estimator;
mod experiment;
mod facing;
mod fingerprint;
mod head;
mod head_views;
mod host;
mod ideal;
mod kept_records;
mod keys;
mod latency;
mod level;
mod observed_run;
mod observers;
mod outcome;
mod papers;
mod picture_ends;
mod pipeline;
mod pipelines;
mod preparation;
mod raster;
mod registry;
mod report_schedule;
mod reprojection;
mod result_window;
mod running;
mod scene_views;
mod stepper;
mod summary;
mod tally;
mod tunings;
mod views;
mod window;

pub use assembly::check_coverage;
pub use board_text::{PixelField, bit_of, in_ms, in_us};
pub use display_list::display_list;
pub use dry_run::{DryRun, SeenTimes};
pub use due::DuePictures;
pub use error::ExperimentError;
pub use estimator::{Cause, Estimator};
pub use experiment::{Estimates, Experiment, FIELDS_RANGE, Pixels, out_of_range, warning_without_code};
pub use fingerprint::Fingerprint;
pub use head::{Head, HeadPlace};
pub use head_views::{HeadViews, SampledPose};
pub use host::{BareHost, Host};
pub use kept_records::KeptRecords;
pub use keys::PipelineSettings;
pub use latency::{LATENCY_PARTS, LatencyParts, PartDefinition};
pub use level::Level;
pub use observed_run::ObservedRun;
pub use observers::{FinalResults, ObserverFactory, StreamingObserver};
pub use outcome::Outcome;
pub use picture_ends::{PictureResult, WARM_UP_PICTURES};
pub use pipeline::{PictureRules, PictureTimes, Pipeline, Setup, Source};
pub use pipelines::faces::{
    FaceHistory, FaceLens, FacePipeline, FacePolicy, FaceSource, OrientationTiming, RequestedUpdate, RequestedUpdates,
    RotationLatency, SegmentedScene, ShownUpdate,
};
pub use pipelines::{
    Code, FinishedRegions, Frameless, Interpolation, Jitp, PolicyFrame, PolicyPipeline, RegionAssignment, RegionPolicy,
    RenderingControl, Slats, SlatsLighting, Viewpoint, region_at,
};
pub use pxpl5_sim::parameters::{Key, KeyValue, KeyValues};
pub use pxpl5_sim::{DefinedStatistics, KEPT_SAMPLES, Samples, Statistics, number_or_nan};
pub use pxpl5_wire::display::{Aim, Coverage, LightTimes};
pub use raster::Raster;
pub use registry::{ClosedForm, DisplayEntry, Goal, LimitCriterion, PipelineEntry, Registry, TestScene};
pub use reprojection::{Every, Reprojection, Warp};
pub use result_window::{ResultWindow, WARM_UP_PERIODS, WINDOW_DEFINITION};
pub use scene_views::{hmd_on, views};
pub use stepper::{Pause, Stepper};
pub use summary::{Summary, retraces};
pub use tally::{LATE_REGIONS_LISTED, SurfaceLatency, Tally};
pub use tunings::Tunings;
pub use views::{FrameStarts, Poses, ReportTimes, Views, ViewsWanted};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
