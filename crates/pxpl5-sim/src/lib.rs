//! Core of a discrete-event simulation: exact time, clocks, and an ordered event queue.
//!
//! Nothing here is specific to Pixel-Planes. A *device* is plain state with a method that handles one event at a time:
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
//! 1. Events are handled in the order of ([`Time`], [`Phase`]). At each instant, all inputs *arrive* first. Then
//!    devices *work* on them, and finally observers *observe* the state.
//! 2. Results must not depend on the order of events with the same instant and phase. A device that must choose between
//!    simultaneous requests stores them in `Arrive` and chooses in `Work` by a rule of its own. It can take the
//!    earliest, for example, and among equal times the lowest port.
//! 3. Such events are handled in the order in which they were scheduled. [`EventQueue::shuffle_ties`] makes this order
//!    pseudo-random, so that tests can check point 2.
//! 4. Scheduling an event in the past is a programming error and panics.
//!
//! # Time
//!
//! [`Time`] and [`Span`] are picoseconds in `u64` (213 days). [`Clock`] computes its n-th edge from zero in 128 bits,
//! so rounding errors do not accumulate. No computation of time uses floating point.
//!
//! Small functions on the path of every event are marked `inline`, because incremental compilation inlines no others
//! into other crates.
//!
//! **Not here:** threads and computing time. A simulation runs in one thread, and pixels are computed by other crates.

mod clock;
mod context;
pub mod figures;
mod heap;
pub mod parameters;
mod queue;
mod random;
mod samples;
mod statistics;
mod study;
mod time;
mod trace;

pub use clock::{Clock, Cycles};
pub use context::{Context, TestBench};
pub use queue::{EventQueue, Phase};
pub use random::SplitMix64;
pub use samples::{KEPT_SAMPLES, Samples};
pub use statistics::{DefinedStatistics, Statistics, number_or_nan};
pub use study::{SharedWatcher, StopFlag, Watcher};
pub use time::{Span, Time};
pub use trace::{TraceHash, mix};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
