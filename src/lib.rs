//! Cycle-accurate emulator of Pixel-Planes 5, UNC's graphics multicomputer of 1989 to 1995, and of its low-latency
//! rendering pipelines.
//!
//! An [`Experiment`] runs a [`Pipeline`] with a [`scene`] on a machine that a [`MachineConfig`] describes. The result
//! is an [`Outcome`] with latencies, pictures and all observations.
//!
//! ```
//! use pxpl5::{Experiment, MachineConfig, Measured, Pixels, RenderingControl, Slats, scene};
//!
//! // Twelve triangles that each cover the screen, on 13 graphics processors and 5 renderers (TR94).
//! let trivial = scene::builtin("full-screen:12")?;
//! let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), trivial);
//! let outcome = experiment.fields(60).pixels(Pixels::Off).run()?;
//! assert!((outcome.latency_fields().mean - 3.9).abs() < 0.1, "from the start of the first eye's TRANSFORM to the swap");
//!
//! // The published 3.4 fields are a mean over both eyes, each from the start of its own TRANSFORM (`figures::Reading`).
//! let eyes = pxpl5::measure::summary(&outcome).eye_swap_latencies_ms;
//! let mean = eyes.iter().sum::<f64>() / eyes.len() as f64 / outcome.field_ms();
//! assert!((mean - 3.4).abs() < 0.1);
//!
//! // The same triangles under Slats: one field, always.
//! let trivial = scene::builtin("full-screen:12")?;
//! let outcome = Experiment::new(MachineConfig::slats(), Slats::split(), trivial).fields(60).run()?;
//! assert!((outcome.latency_fields().mean - 1.0).abs() < 1e-9);
//! assert_eq!(outcome.report().missed_retraces, Some(0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! This crate re-exports the other crates. A user's crate needs only `use pxpl5::...`.
//!
//! | crate | content |
//! |---|---|
//! | [`machine`], [`display`] | the boards and their connections; the interface of displays |
//! | [`run`] | one experiment: [`Experiment`], [`Pipeline`], [`Head`], [`Registry`]; the outcome is data |
//! | [`measure`] | evaluation of an outcome: [`Report`], latencies, errors in pixels, pictures |
//! | [`analytic`] | results of experiments from formulas, without simulated events |
//! | [`lab`] | questions over many experiments: [`figures`], [`levels`], [`limit`], [`compare`], [`sweep`], experiment files |
//! | [`oracle`] | ideal pictures: a renderer without parallelism and without time |
//! | [`views`] | output for people: timelines, traces, tables, charts, report pages, films |
//! | [`arp`] | a walk of a viewer through a scene, with a display that follows head rotation: policies, tears, warping, figures, pictures |
//! | [`volume`] | scenes as slices of a spinning volumetric display: settings, reports, variants, figures |
//! | [`scene`], [`tracking`] | the scene, and the motion and tracking of the viewer's head |
//! | [`firmware`] | types for writing a new pipeline |
//!
//! Every number of the model has a unit, a provenance (published, derived, assumed) and a source.
//! [`MachineConfig::parameters`] lists all of them.
//!
//! **Not modelled:** see the data sheet at the beginning of each board's crate. ACCURACY.md lists the results that
//! differ from the papers.

#![warn(missing_docs)]

pub use pphigs::oracle;
pub use pxpl5_analytic as analytic;
pub use pxpl5_arp as arp;
pub use pxpl5_lab as lab;
pub use pxpl5_machine as machine;
pub use pxpl5_measure as measure;
pub use pxpl5_run as run;
pub use pxpl5_scene as scene;
pub use pxpl5_views as views;
pub use pxpl5_volume as volume;
pub use pxpl5_wire::display;
pub use tracking;

pub use pphigs::RegionBinning;
pub use pxpl5_framebuffer::{
    FrameBufferConfig, HiResConfig, LcdConfig, NtscDisplay, OledConfig, Panel, PanelConfig, PanelNumbers,
};
pub use pxpl5_gp::CodeVersion;
pub use pxpl5_lab::{
    ExperimentFile, FileError, HeadChoice, MotionChoice, Outputs, Plan, Published, SceneChoice, Settings, Snapshot,
    SnapshotError, Suitability, WhatIf, Workstation, compare, figures, growth, intervals, levels, limit,
    pipeline_figures, readings, registry, rig, suitability, sweep, tracking_parameters, what_if,
};
pub use pxpl5_machine::{
    Arrival, Board, ConfigError, EventDescription, LateRegion, Machine, MachineConfig, Observation, Optimization,
    PRESETS, Parameter, Ports, Preset, Record, RunError, StageSpan, Swap, Traffic, Transfer,
};
pub use pxpl5_measure::{
    Budget, CriticalPath, DepthPicture, ErrorCauses, ErrorPart, EyeReport, FieldMisregistration, HeadReport, HeadSum,
    LATENCY_PARTS, LatencyCurve, LatencyPartStatistics, LatencyParts, Measure, Measured, PartDefinition, PathPart,
    Percentiles, PixelErrors, QUANTITIES, Quantity, RasterOffsets, Registration, Report, ReprojectionReport, Resource,
    Results, Showing, SurfaceStatistics, TooHeavy, Utilisation, picture, reproject, reproject_with_depth, side_by_side,
};
pub use pxpl5_run::{
    Aim, BareHost, Cause, Code, DefinedStatistics, DuePictures, Estimates, Estimator, Every, Experiment,
    ExperimentError, FIELDS_RANGE, FinalResults, Fingerprint, FinishedRegions, Frameless, Goal, Head, HeadError,
    HeadViews, Host, Interpolation, Jitp, Keep, Key, KeyValue, KeyValues, Level, LimitCriterion, ObserverFactory,
    Outcome, Pause, PictureResult, PictureTimes, Pipeline, PipelineEntry, PipelineSettings, Pixels, Raster, Registry,
    RenderingControl, Reprojection, ResultWindow, SampledPose, Samples, Setup, Slats, SlatsLighting, Source,
    Statistics, Stepper, StreamingObserver, Summary, TestScene, Viewpoint, WARM_UP_PERIODS, WARM_UP_PICTURES,
    WINDOW_DEFINITION, Warp, out_of_range,
};
pub use pxpl5_sim::parameters::{ParameterInfo, ParameterTable, Standing, Value};
pub use pxpl5_sim::{Span, Time, TraceHash};
pub use pxpl5_views::{FILM_PERIODS, Film, FilmError, FilmSurfaces, results, timeline, trace_export};
pub use pxpl5_wire::{Eye, PeriodNumber, PictureNumber, SurfaceId, ViewNumber};
pub use slats::CopySchedule;

/// Snapshots of boards during a run: see [`Stepper`].
pub mod looks {
    pub use pxpl5_gp::{
        Account, BreakpointHit, GpBoard, GpSnapshot, Priority, Processor, ProgramSnapshot, WaitingMessageInfo,
    };
    pub use pxpl5_renderer::{Lanes, PixelArray, Plane, RendererSnapshot};
    pub use pxpl5_ring::{ChannelSnapshot, WaitReason, WaitingMessage};
}

/// Types for writing a pipeline: firmware on graphics processors, display lists, commands for renderers, and messages
/// on the ring.
pub mod firmware {
    pub use pphigs::{
        DisplayList, EyeView, FrameView, Pass, Picture, RegionBinning, RegionEnvelope, Shading, Share, region_messages,
    };
    pub use pxpl5_geometry::Viewport;
    pub use pxpl5_gp::{
        CodeUse, Fault, Firmware, Gp, GpTiming, HostTiming, Mark, Priority, Received, Stage, StageEdge, Ticket,
    };
    pub use pxpl5_renderer::{CommandKind, Layout, PixelArray};
    pub use pxpl5_wire::{
        Body, CommandList, CopyContent, CopyOrder, CopyPath, CopyTarget, FieldParity, Lines, NodeId, PeriodNumber,
        PictureNumber, RegionGrid, RegionId, ViewNumber, Word, swap_request,
    };
}

/// Names that most programs with this crate need: `use pxpl5::prelude::*`.
pub mod prelude {
    pub use crate::scene::{self, Scene};
    pub use crate::tracking::Pose;
    pub use crate::tracking::motion::{Motion, Recording, from_fn};
    pub use crate::tracking::predict::PredictorKind;
    pub use crate::tracking::tracker::TrackerConfig;
    pub use crate::{
        Experiment, ExperimentError, ExperimentFile, Frameless, Head, Jitp, Level, MachineConfig, Measure, Measured,
        Outcome, Pipeline, Pixels, RenderingControl, Report, Results, Slats, SurfaceId, WhatIf, registry, what_if,
    };
}

/// Compiles and runs the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
