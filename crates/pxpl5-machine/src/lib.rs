//! The complete machine: its boards and the connections between them.
//!
//! - [`Machine`] builds all boards, and is alone in connecting them.
//! - [`MachineConfig`] holds every number. It starts from a preset of the papers ([`PRESETS`]).
//! - [`Record`] holds the boards after a run, and all observations of it.
//!
//! It owns any number of displays, which it reaches only through [`pxpl5_wire::display::Display`]. So it has no code
//! for a particular kind.
//!
//! **Not here:** clocks, threads and files of the computer that runs the simulation. If you want pixels to be computed
//! on another thread, pass in a [`PixelWorker`].

#![warn(missing_docs)]

mod board;
mod config;
mod event;
mod facts;
mod host_line;
mod machine;
mod observation;
mod observed_event;
mod optimization;
mod pixels;
mod ports;
mod preset;
mod record;
mod run_error;
mod traffic;

pub use board::{Board, EventDescription};
pub use config::{FirmwareTable, MachineConfig, NamedTable};
pub use host_line::HostLine;
pub use machine::{DEADLOCK_TICKS, Machine};
pub use observation::{Arrival, LateRegion, Observation, Shown, StageSpan, Swap};
pub use observed_event::{ObservedEvent, ObservedKind};
pub use optimization::Optimization;
pub use pixels::{PixelWorker, SameThread};
pub use ports::Ports;
pub use preset::{PRESETS, Preset};
pub use record::{Attachment, Record};
pub use run_error::{Blocked, RunError};
pub use traffic::{Traffic, Transfer};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
