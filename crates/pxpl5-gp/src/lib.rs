//! Graphics processor (GP): an i860 at 40 MHz with 8 MB of memory and a port on the ring.
//!
//! ```text
//!                 +-----------------------------------------------+
//!   ring in  ---->| inbox -> firmware (async fn, two priorities)  |
//!   retrace  ---->|            | spend      | send                |
//!                 |           CPU        clump buffer -> DMA -----|---> ring out
//!                 |            \------- memory, 8 MB -------------|
//!                 +-----------------------------------------------+
//! ```
//!
//! The parts of the board, in the order in which a message passes them:
//!
//! - The inbox holds messages that have arrived, in order of arrival.
//! - *Firmware* is `async fn` code that uses the board through a [`Gp`]. Every `.await` in the code either spends CPU
//!   time ([`Gp::spend`]) or waits for an event ([`Gp::receive`], [`Gp::retrace`], [`Gp::until`]).
//! - There are two priorities with one program each. While the program of [`Priority::Interrupt`] spends CPU time, the
//!   program of [`Priority::Foreground`] is suspended.
//! - [`Gp::send`] costs the CPU a fixed software time. The messages then go to the DMA, which sends them in the
//!   background. There is only one clump buffer (memory for outgoing messages). A batch of messages therefore waits
//!   until the receivers have accepted the previous batch. A group of messages ([`Gp::send_groups`]) reserves the
//!   receiver's port from its first message to its last.
//! - [`Memory`] counts the used bytes of the board's 8 MB. A request that does not fit is a [`Fault`], which names the
//!   board and the region.
//! - The time of [`Work`] comes from the timing table, or from i860 code on the board's [`Processor`]
//!   ([`GpBoard::run_code`]). The firmware is the same in both cases. The message software also exists as i860 code
//!   (kernels/ring.s) and has its own memory ([`RING_MEMORY`]).
//!
//! The host workstation uses the same board model with its own timing table.
//!
//! **Not modelled here:** the bus between CPU and DMA, and the instant of an interrupt within a call of i860 code. A
//! call runs completely at its start. The code of an interrupt during the call therefore finds the caches in their
//! state after the call.
//!
//! Sources: TR94 (memory, clock, background rendering). The timing table states the source of each parameter.

mod bench;
mod board;
mod cpu;
mod firmware;
mod memory;
mod messages;
mod probe;
mod processor;
mod ring;
mod snapshot;
pub mod timing;
mod window;
mod work;

pub use bench::BoardBench;
pub use board::{GpBoard, GpEvent, GpOutput, GpUse, PLACE_BITS};
pub use cpu::Priority;
pub use firmware::{Fault, Firmware, Gp, Received, Ticket};
pub use memory::{Account, Memory, OutOfMemory};
pub use messages::Chain;
pub use probe::{Mark, Stage, StageEdge};
pub use processor::{BreakpointHit, CodeVersion, KEPT_HITS, Processor, ProcessorFault};
pub use snapshot::{GpSnapshot, ProgramSnapshot, WaitingMessageInfo};
pub use timing::{CodeUse, GpTiming, HostTiming};
pub use window::RING_MEMORY;
pub use work::Work;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
