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

mod board_text;
mod build;
mod built_in;
mod display_list;
mod dry_run;
mod dry_run_observer;
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
mod level;
mod observe;
mod pipeline;
mod pipelines;
mod raster;
mod registry;
mod report_schedule;
mod reprojection;
mod result;
mod running;
mod scene_views;
mod stepper;
mod tunings;
mod views;

pub use board_text::{PixelField, bit_of, in_ms, in_us};
pub use build::assembly::check_coverage;
pub use display_list::display_list;
pub use dry_run::{DryRun, SeenTimes};
pub use error::ExperimentError;
pub use estimator::{Cause, Estimator};
pub use experiment::{Estimates, Experiment, FIELDS_RANGE, Pixels, out_of_range, warning_without_code};
pub use fingerprint::Fingerprint;
pub use head::{Head, HeadPlace};
pub use head_views::{HeadViews, SampledPose};
pub use host::{BareHost, Host};
pub use kept_records::KeptRecords;
pub use keys::PipelineSettings;
pub use level::Level;
pub use observe::observers::{FinalResults, ObserverFactory, StreamingObserver};
pub use pipeline::{PictureRules, PictureTimes, Pipeline, PipelineProperties, Setup, Source};
pub use pipelines::faces::{
    FaceHistory, FacePipeline, FacePolicy, FaceSource, OrientationTiming, RequestedUpdate, RequestedUpdates,
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
pub use result::due::DuePictures;
pub use result::latency::{LATENCY_PARTS, LatencyParts, PartDefinition};
pub use result::outcome::Outcome;
pub use result::picture_ends::{PictureResult, WARM_UP_PICTURES};
pub use result::result_window::{ResultWindow, WARM_UP_PERIODS, WINDOW_DEFINITION};
pub use result::summary::{Summary, retraces};
pub use result::tally::{LATE_REGIONS_LISTED, SurfaceLatency, Tally};
pub use scene_views::{SceneViews, hmd_on};
pub use stepper::{Pause, Stepper};
pub use tunings::Tunings;
pub use views::ViewSource;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
