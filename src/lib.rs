//! Cycle-accurate emulator of Pixel-Planes 5.

#![doc = ""]
mod config;
mod display_list;
mod experiment;
mod head_to_light;
mod machine;
mod observation;
pub mod pipelines;
mod report;
mod workers;

pub use config::{ConfigError, MachineConfig, PRESETS, Parameter, Preset};
pub use experiment::{Experiment, ExperimentError, FIELDS_RANGE, Outcome, Pixels, WARM_UP_PICTURES};
pub use machine::{Machine, Ports, RunError};
pub use observation::{Arrival, LateRegion, Observation, StageSpan, Swap};
pub use head_to_light::{Budget, FIELDS_WITH_HEAD, Head, HeadError, HeadViews, Rehearsal, Sampled};
pub use pipelines::{Frameless, Jitp, Pipeline, RenderingControl, Slats, Viewpoint};
pub use pxpl5_scene as scene;
pub use tracking;
pub use report::{DefinedStatistics, Report, Statistics};
