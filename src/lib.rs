//! Cycle-accurate emulator of Pixel-Planes 5.

#![doc = ""]
pub mod analytic;
mod config;
mod display_list;
mod experiment;
pub mod figures;
pub mod levels;
pub mod limit;
mod machine;
mod observation;
mod parallel;
pub mod pipelines;
mod report;
mod workers;

pub use config::{ConfigError, MachineConfig, PRESETS, Parameter, Preset};
pub use experiment::{Experiment, ExperimentError, FIELDS_RANGE, Outcome, Pixels, WARM_UP_PICTURES};
pub use machine::{Machine, Ports, RunError};
pub use observation::{Arrival, LateRegion, Observation, StageSpan, Swap};
pub use pipelines::{Code, Pipeline, RenderingControl, Slats};
pub use pphigs::Binning;
pub use pxpl5_scene as scene;
pub use pxpl5_wire::Eye;
pub use report::{DefinedStatistics, Report, Statistics};
pub use slats::Copy;
