//! Cycle-accurate emulator of Pixel-Planes 5, UNC's graphics multicomputer of 1989 to 1995, and of its low-latency
//! rendering pipelines.
//!
//! This page is a tour in five steps: build an experiment, run it, read the results, look into the machine, and extend
//! the emulator. [`prelude`] has the names that most programs need.
//!
//! # Build
//!
//! An [`Experiment`] has a machine ([`MachineConfig`]), a pipeline ([`Pipeline`]) and a scene ([`scene::Scene`]). A
//! [`Head`] adds the motion of the viewer's head, a tracker and a predictor.
//!
//! ```
//! use pxpl5::prelude::*;
//!
//! // Twelve triangles that each cover the screen, on 13 graphics processors and 5 renderers (TR94).
//! let scene = scene::builtin("full-screen:12")?;
//! let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Run
//!
//! [`Experiment::run`] returns an [`Outcome`]: all observations, latencies and pictures. Pixels are computed when a
//! picture is read ([`Pixels::Lazy`]).
//!
//! ```
//! # use pxpl5::prelude::*;
//! # let scene = scene::builtin("full-screen:12")?;
//! # let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60);
//! let outcome = experiment.run()?;
//! assert!((outcome.latency_fields().mean - 4.12).abs() < 0.05, "from the start of the first eye's TRANSFORM to the swap");
//! // TR94's 3.4 fields are a mean over both eyes, each from the start of its own TRANSFORM. The model needs 5 % more.
//! let eyes = outcome.summary().eye_swap_latencies_ms;
//! let mean = eyes.iter().sum::<f64>() / eyes.len() as f64 / outcome.field_ms();
//! assert!((mean / 3.4 - 1.0).abs() < 0.06);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Read
//!
//! The trait [`Measured`] reads an outcome: a [`Report`] of all numbers, one quantity by its name, the errors in
//! pixels, and the pictures. A value that was not measured is `None`.
//!
//! ```
//! # use pxpl5::prelude::*;
//! // The same triangles under Slats: one field, always.
//! let scene = scene::builtin("full-screen:12")?;
//! let outcome = Experiment::new(MachineConfig::slats(), Slats::split(), scene).fields(60).run()?;
//! assert_eq!(outcome.quantity("latency_fields.mean")?.map(f64::round), Some(1.0));
//! assert_eq!(outcome.report().missed_retraces, Some(0));
//! let left_eye = outcome.picture(Eye::Left).ok_or("pixels were computed")?;
//! assert_eq!(left_eye.dimensions(), (640, 480));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Look
//!
//! [`Outcome::events`] lists the events on all boards. A [`Stepper`] runs an experiment in steps, and shows the state
//! of the boards between two steps ([`snapshots`]).
//!
//! ```
//! # use pxpl5::prelude::*;
//! # let scene = scene::builtin("full-screen:12")?;
//! # let experiment = Experiment::new(MachineConfig::small_hmd(), RenderingControl::stereo(), scene).fields(60);
//! let mut stepper = experiment.stepper()?;
//! stepper.step_board(Board::Renderer(0));
//! println!("{}: {:?}", stepper.now(), stepper.renderer(0).ok_or("five renderers")?.busy);
//! let outcome = stepper.finish()?;
//! for event in outcome.events().filter(|event| event.board == Board::Renderer(0)).take(3) {
//!     println!("{event}");
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Extend
//!
//! A parameter study calls a closure for each value of a parameter, on all cores:
//!
#![cfg_attr(feature = "lab", doc = "```")]
#![cfg_attr(not(feature = "lab"), doc = "```ignore")]
//! # use pxpl5::prelude::*;
//! use std::sync::Arc;
//!
//! let scene = Arc::new(scene::builtin("full-screen:12")?);
//! let latencies = pxpl5::in_parallel(&[5, 10, 20], |renderers| {
//!     let machine = MachineConfig::small_hmd().with_renderers(*renderers);
//!     let experiment = Experiment::new(machine, RenderingControl::stereo(), scene.clone()).pixels(Pixels::Off);
//!     experiment.fields(60).run().ok().and_then(|outcome| Some(outcome.latency()?.mean))
//! });
//! assert_eq!(latencies.len(), 3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A pipeline of your own implements [`Pipeline`] and [`PictureRules`] with the types of [`firmware`]. A display of
//! your own implements [`device::Display`]. The guide has complete examples of both.
//!
//! # Modules and features
//!
//! Each item has one path. The names at the root are about experiments; the modules have the rest:
//!
//! | module | content | feature |
//! |---|---|---|
//! | [`scene`], [`tracking`] | the scene, and the motion and tracking of the viewer's head | |
//! | [`snapshots`] | snapshots of boards during a run | |
//! | [`firmware`], [`device`] | types for writing a pipeline or a display | |
//! | [`run`], [`measure`] | rarely needed names for an outcome and for its evaluation | |
//! | [`analytic`] | results of experiments from formulas, without simulated events | |
//! | [`oracle`] | ideal pictures: a renderer without parallelism and without time | |
#![cfg_attr(
    feature = "lab",
    doc = "| [`lab`], [`figures`], [`levels`], [`limit`], [`compare`], [`sweep`] | questions over many experiments, experiment files | `lab` |"
)]
#![cfg_attr(
    feature = "views",
    doc = "| [`views`] | output for people: timelines, traces, tables, charts, report pages, films | `views` |"
)]
#![cfg_attr(
    feature = "arp",
    doc = "| [`arp`] | a walk of a viewer through a scene, with a display that follows head rotation: policies, tears, warping, figures | `arp` |"
)]
#![cfg_attr(
    feature = "volume",
    doc = "| [`volume`] | scenes as slices of a spinning volumetric display: settings, reports, variants, figures | `volume` |"
)]
//!
//! All features are on by default. A crate that only runs experiments builds faster with `default-features = false`.
//!
//! Every number of the model has a unit, a provenance (published, derived, assumed) and a source.
//! [`MachineConfig::parameters`] lists all these numbers.
//!
//! **Not modelled:** see the data sheet at the beginning of each board's crate. ACCURACY.md lists the results that
//! differ from the papers.

#![warn(missing_docs)]

mod experiments;
#[cfg(feature = "lab")]
mod laboratory;
mod machines;
mod results;

pub use experiments::*;
#[cfg(feature = "lab")]
pub use laboratory::*;
pub use machines::*;
pub use results::*;

pub use glam;
pub use image;
pub use pphigs::oracle;
#[doc(inline)]
pub use pxpl5_analytic as analytic;
#[cfg(feature = "arp")]
#[doc(inline)]
pub use pxpl5_arp as arp;
#[doc(inline)]
pub use pxpl5_scene as scene;
#[cfg(feature = "views")]
#[doc(inline)]
pub use pxpl5_views as views;
#[cfg(feature = "volume")]
#[doc(inline)]
pub use pxpl5_volume as volume;
pub use pxpl5_wire::display;
#[doc(inline)]
pub use tracking;

/// Less common names for reading an outcome: cube faces around the viewer's head, updates of display memories, and
/// conversions.
pub mod run {
    pub use pxpl5_run::{
        ClosedForm, Estimates, FaceHistory, FacePipeline, FacePolicy, FaceSource, KEPT_SAMPLES, LATE_REGIONS_LISTED,
        OrientationTiming, PixelField, RequestedUpdate, RequestedUpdates, RotationLatency, SceneViews, SegmentedScene,
        ShownUpdate, SurfaceLatency, Tally, ViewSource, bit_of, check_coverage, display_list, in_ms, in_us, region_at,
        retraces, warning_without_code,
    };
}

/// Less common names for evaluating an outcome, such as the parts of a [`Report`] and the use of each kind of board.
pub mod measure {
    pub use pxpl5_measure::{
        FacesReport, GpUtilisation, MemoryReport, PICTURES_FOLLOWED, PortShare, PortUtilisation, RendererUtilisation,
        RingUtilisation, RotationPart, Shares, latency_by_surface, pixel_errors, program, screen,
    };
}

/// Snapshots of boards during a run: see [`Stepper`].
pub mod snapshots {
    pub use pxpl5_gp::{
        Account, BreakpointHit, GpBoard, GpSnapshot, Priority, Processor, ProgramSnapshot, WaitingMessageInfo,
    };
    pub use pxpl5_renderer::{Lanes, PixelArray, Plane, RendererSnapshot};
    pub use pxpl5_ring::{ChannelSnapshot, WaitReason, WaitingMessage};
}

/// Types for writing a pipeline: firmware on graphics processors, display lists, commands for renderers, and messages
/// on the ring.
///
/// Names of other modules that every pipeline needs are included.
pub mod firmware {
    pub use crate::snapshots::{PixelArray, Priority};
    pub use crate::{PeriodNumber, PictureNumber, RegionBinning, ViewNumber};
    pub use pphigs::{DisplayList, EyeView, FrameView, Pass, Picture, RegionEnvelope, Shading, Share, region_messages};
    pub use pxpl5_geometry::{Culling, Viewport};
    pub use pxpl5_gp::{CodeUse, Fault, Firmware, Gp, GpTiming, HostTiming, Mark, Received, Stage, StageEdge, Ticket};
    pub use pxpl5_machine::{FirmwareTable, NamedTable};
    pub use pxpl5_renderer::{CommandKind, Layout};
    pub use pxpl5_wire::{
        Body, CommandList, CopyContent, CopyOrder, CopyPath, CopyTarget, FieldParity, Lines, NodeId, RegionGrid,
        RegionId, Word, swap_request,
    };
}

/// Types for writing a display, or a worker that computes pixels.
pub mod device {
    pub use pxpl5_machine::{DEADLOCK_TICKS, HostLine, PixelWorker, SameThread};
    pub use pxpl5_wire::display::{
        BufferReceipt, Counter, Display, DisplayConfig, DisplayContext, DisplayEvent, DisplayOutput, DoubleBuffer,
        LightTimes, PixelLight, ScanOrder, Surface,
    };
}

/// Names that most programs with this crate need: `use pxpl5::prelude::*`.
pub mod prelude {
    #[cfg(feature = "lab")]
    pub use crate::laboratory::{ExperimentFile, Plan, Study, WhatIf, WhatIfQuery, in_parallel, registry};
    pub use crate::scene::{self, Scene};
    pub use crate::tracking::Pose;
    pub use crate::tracking::motion::{Motion, Recording, from_fn};
    pub use crate::tracking::predict::PredictorKind;
    pub use crate::tracking::tracker::TrackerConfig;
    pub use crate::{
        Board, Experiment, ExperimentError, Eye, Frameless, Head, Jitp, Level, MachineConfig, Measure, Measured,
        ObservedKind, Outcome, PanelConfig, Pause, PictureRules, Pipeline, PipelineSettings, Pixels, Registry,
        RenderingControl, Report, Results, Slats, Stepper, SurfaceId,
    };
    pub use glam::{DQuat, DVec3, Vec3};
}

#[cfg(all(doctest, feature = "lab", feature = "views", feature = "volume", feature = "arp"))]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
