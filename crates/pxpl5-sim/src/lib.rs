//! Core of a discrete-event simulation: exact time, clocks, and an ordered event queue.
//!
//! The core contains nothing specific to Pixel-Planes. A *device* is plain state with a method that handles one event
//! at a time:
//!
//! ```text
//!            event                     own events (later)
//!   queue ----------> device.handle ---------------------> queue
//!                        |  outputs (these leave the board at least one cycle later)
//!                        v
//!                     wiring  (turns an output of one device into an event of another)
//! ```
//!
//! # Ordering contract
//!
//! 1. Events are handled in the order of ([`Time`], [`Phase`]). At each instant, first all inputs *arrive*. Then the
//!    devices *work* on the inputs. Finally, observers *observe* the state.
//! 2. Results must not depend on the order of events with the same instant and phase. A device that must choose between
//!    simultaneous requests stores them in `Arrive`. In `Work`, the device chooses one of the stored requests by its
//!    own rule. For example, a device can choose the earliest request, and the lowest port among requests of the same
//!    instant.
//! 3. Events with the same instant and phase are handled in the order of scheduling. [`EventQueue::shuffle_ties`]
//!    replaces this order by a pseudo-random order. Tests use the pseudo-random order to check point 2.
//! 4. No event can be scheduled in the past. An attempt is a programming error and causes a panic.
//!
//! # Time
//!
//! [`Time`] and [`Span`] are picoseconds in `u64` (213 days). [`Clock`] computes its n-th edge from zero in 128 bits,
//! so rounding errors do not accumulate. No computation of time uses floating point.
//!
//! Small functions on the path of every event have the attribute `inline`. With incremental compilation, the compiler
//! inlines no other function of this crate into other crates.
//!
//! **Not here:** threads and the computing time of the simulation. A simulation runs in one thread, and other crates
//! compute pixels.

mod clock;
mod context;
pub mod figures;
mod heap;
pub mod parameters;
mod queue;
mod random;
mod samples;
mod statistics;
mod time;
mod trace;

pub use clock::{Clock, Cycles};
pub use context::{Context, TestBench};
pub use queue::{EventQueue, Phase};
pub use random::SplitMix64;
pub use samples::{KEPT_SAMPLES, Samples};
pub use statistics::{DefinedStatistics, Statistics, number_or_nan};
pub use time::{Span, Time};
pub use trace::{TraceHash, mix};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
