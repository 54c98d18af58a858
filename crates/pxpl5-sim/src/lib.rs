//! Discrete-event kernel: exact time, clocks, and an ordered event queue.
//!
//! The kernel contains nothing specific to Pixel-Planes. A *device* is plain state with a method that handles one event
//! at a time:
//!
//! ```text
//!            event                     own events (later)
//!   queue ----------> device.handle ---------------------> queue
//!                        |  outputs (what leaves the board, at least one cycle later)
//!                        v
//!                     wiring  (turns an output of one device into an event of another)
//! ```
//!
//! # Ordering contract
//!
//! 1. Events happen in the order of ([`Time`], [`Phase`]). At one instant all inputs *arrive*, then boards *work* on
//!    them, then probes *observe*.
//! 2. Events of one instant and phase commute: no result may depend on their order. A device that must choose between
//!    simultaneous requests stores them in `Arrive` and chooses in `Work` by a rule of its own (first come, then lowest
//!    port).
//! 3. Without shuffling, ties are resolved in the order of scheduling. [`EventQueue::shuffle_ties`] resolves them in a
//!    hashed order instead. Tests use it to prove point 2.
//! 4. No event may be scheduled in the past. This is an error of the program and panics.
//!
//! # Time
//!
//! [`Time`] and [`Span`] are picoseconds in `u64` (213 days). [`Clock`] computes its n-th edge from zero in 128 bits,
//! so no clock drifts. No computation of time uses floating point.
//!
//! **Not here:** threads (a simulation runs in one thread; pixels are computed elsewhere), host time.

mod clock;
mod context;
mod heap;
mod queue;
mod random;
mod time;
mod trace;

pub use clock::{Clock, Cycles};
pub use context::{Blocked, Context, TestBench};
pub use queue::{EventQueue, Phase};
pub use random::SplitMix64;
pub use time::{Span, Time};
pub use trace::{TraceHash, mix};
