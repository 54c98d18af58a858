//! Cycle-accurate emulator of Pixel-Planes 5.

#![doc = ""]
mod config;
mod display_list;
mod experiment;
mod machine;
mod observation;
pub mod pipelines;
mod report;
pub mod timeline;
mod workers;

pub use config::{ConfigError, MachineConfig, PRESETS, Parameter, Preset};
pub use experiment::{Experiment, ExperimentError, FIELDS_RANGE, Outcome, Pixels, WARM_UP_PICTURES};
pub use machine::{Machine, Ports, RunError};
pub use observation::{Arrival, LateRegion, Observation, StageSpan, Swap};
pub use pipelines::{Pipeline, RenderingControl, Slats};
pub use pxpl5_scene as scene;
pub use report::{DefinedStatistics, Report, Statistics};
