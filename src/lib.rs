//! Cycle-accurate emulator of Pixel-Planes 5, UNC's graphics multicomputer of 1989 to 1995, and of its low-latency
//! rendering pipelines.
//!
//! An [`Experiment`] runs a [`Pipeline`] with a [`scene`] on a machine described by a [`MachineConfig`], and gives an
//! [`Outcome`]: latencies, pictures, and everything that was observed.
//!
//! ```
//! use pxpl5::{Experiment, MachineConfig, Pixels, RenderingControl, Slats, scene};
//!
//! // Twelve triangles that each cover the screen, on 13 graphics processors and 5 renderers (TR94).
//! let trivial = scene::builtin("full-screen:12")?;
//! let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), trivial);
//! let outcome = experiment.fields(60).pixels(Pixels::Off).run()?;
//! assert!((outcome.latency_fields().mean - 3.4).abs() < 0.3, "published: 3.4 fields");
//!
//! // The same triangles under Slats: one field, always.
//! let trivial = scene::builtin("full-screen:12")?;
//! let outcome = Experiment::new(MachineConfig::slats(), Slats::split(), trivial).fields(60).run()?;
//! assert!((outcome.latency_fields().mean - 1.0).abs() < 1e-9);
//! assert_eq!(outcome.report().missed_retraces, 0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! | module or crate | what |
//! |---|---|
//! | [`Machine`] | boards plugged together: the only place where they meet |
//! | [`pipelines`] | what can run on it; a new pipeline implements [`Pipeline`] |
//! | [`compare`], [`display`] | every way to fight latency in pixels; what a display does on the way to the eye |
//! | [`figures`], [`levels`], [`limit`] | published figures, levels of modelling, most triangles per field |
//! | [`ExperimentFile`], [`sweep`], [`Snapshot`] | experiments as text, at many points, and continued |
//! | `pxpl5-*` crates | one for each board, and the event kernel |
//!
//! Every number of the model has a unit, a standing (published, derived, assumed) and a source:
//! [`MachineConfig::parameters`] lists them.
//!
//! **Not modelled:** see the data sheet at the head of each board's crate, and ACCURACY.md for what comes out wrong.

pub mod analytic;
pub mod compare;
mod config;
pub mod display;
mod display_list;
mod experiment;
mod experiment_file;
pub mod figures;
mod fingerprint;
pub mod growth;
mod head_to_light;
pub mod intervals;
mod latency;
pub mod levels;
pub mod limit;
mod machine;
mod measure;
mod observation;
mod parallel;
pub mod pictures;
pub mod pipelines;
mod report;
pub mod results;
mod savings;
mod snapshot;
pub mod sweep;
pub mod timeline;
pub mod trace_export;
mod traffic;
mod workers;

pub use config::{ConfigError, MachineConfig, PRESETS, Parameter, Preset};
pub use experiment::{Experiment, ExperimentError, FIELDS_RANGE, Outcome, Pixels, WARM_UP_PICTURES};
pub use experiment_file::{
    ExperimentFile, FileError, HeadChoice, KEYS, Key, MotionChoice, Outputs, PIPELINES, Plan, Published, SceneChoice,
    Settings,
};
pub use fingerprint::Fingerprint;
pub use head_to_light::{Budget, FIELDS_WITH_HEAD, Head, HeadError, HeadViews, Rehearsal, Sampled};
pub use latency::{EyeStatistics, LATENCY_PARTS, LatencyParts, NamedStatistics, PartDefinition};
pub use machine::{Machine, Ports, RunError};
pub use measure::{Measure, QUANTITIES, Quantity, Results};
pub use observation::{Arrival, LateRegion, Observation, StageSpan, Swap};
pub use pipelines::{Code, Frameless, Interpolation, Jitp, Pipeline, RenderingControl, Slats, Viewpoint};
pub use pphigs::Binning;
pub use pxpl5_scene as scene;
pub use pxpl5_wire::Eye;
pub use report::{DefinedStatistics, HeadReport, Report, Statistics};
pub use savings::Saving;
pub use slats::CopySchedule;
pub use snapshot::{Snapshot, SnapshotError};
pub use tracking;
pub use traffic::{Traffic, Transfer};

/// The examples of the README, compiled and run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
