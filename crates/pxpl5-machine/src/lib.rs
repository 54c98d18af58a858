//! Pixel-Planes 5 as a whole: which boards there are, and how they are plugged together.
//!
//! [`Machine`] is the schematic: the only place where boards meet. [`MachineConfig`] holds every number of it, beginning
//! with a preset of the papers ([`PRESETS`]). What was observed, and the boards themselves when a run is over, are a
//! [`Record`].
//!
//! A machine owns any number of displays ([`pxpl5_display::Display`]) and knows nothing of what is peculiar to one.
//!
//! **Not here:** the computer that the simulation runs on. Clocks, threads and files are handed in ([`PixelWorker`]).

#![warn(missing_docs)]

mod agenda;
mod board;
mod config;
mod event;
mod facts;
mod host_line;
mod machine;
mod observation;
mod pixels;
mod ports;
mod preset;
mod record;
mod run_error;
mod savings;
mod traffic;

pub use board::{Board, Happening};
pub use config::{ConfigError, FirmwareTable, MachineConfig, NamedTable, Parameter};
pub use host_line::HostLine;
pub use machine::{DEADLOCK_TICKS, Machine};
pub use observation::{Arrival, LateRegion, Observation, Shown, StageSpan, Swap};
pub use pixels::{PixelWorker, SameThread};
pub use ports::Ports;
pub use preset::{PRESETS, Preset};
pub use record::Record;
pub use run_error::RunError;
pub use savings::Saving;
pub use traffic::{Traffic, Transfer};
