//! Cycle-accurate emulator of Pixel-Planes 5.

#![doc = ""]
mod config;
mod display_list;
mod experiment;
mod experiment_file;
mod fingerprint;
mod machine;
mod measure;
mod observation;
pub mod pipelines;
mod report;
pub mod sweep;
mod workers;

pub use config::{ConfigError, MachineConfig, PRESETS, Parameter, Preset};
pub use experiment::{Experiment, ExperimentError, FIELDS_RANGE, Outcome, Pixels, WARM_UP_PICTURES};
pub use experiment_file::{
    ExperimentFile, FileError, KEYS, Key, MotionChoice, Outputs, PIPELINES, Plan, Published, SceneChoice, Settings,
    Variant,
};
pub use fingerprint::Fingerprint;
pub use machine::{Machine, Ports, RunError};
pub use measure::{Measure, QUANTITIES, Quantity};
pub use observation::{Arrival, LateRegion, Observation, StageSpan, Swap};
pub use pipelines::{Pipeline, RenderingControl, Slats};
pub use pxpl5_scene as scene;
pub use pxpl5_wire::Eye;
pub use report::{DefinedStatistics, Report, Statistics};
