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
//! - The inbox holds arrived messages in order.
//! - *Firmware* is `async fn` code that uses the board through a [`Gp`]. Every `.await` either spends CPU time
//!   ([`Gp::spend`]) or waits for an event ([`Gp::receive`], [`Gp::retrace`], [`Gp::until`]).
//! - There are two priorities with one program each. While that of [`Priority::Interrupt`] spends CPU time, that of
//!   [`Priority::Foreground`] is suspended.
//! - [`Gp::send`] costs the CPU a fixed software time. The DMA then sends the messages in the background. There is only
//!   one clump buffer (memory for outgoing messages), so a batch waits until the receivers have accepted the previous
//!   one. A group of messages ([`Gp::send_groups`]) reserves the receiver's port from its first message to its last.
//! - [`Memory`] counts the used bytes of the 8 MB. A request that does not fit is a [`Fault`] with the board and the
//!   region.
//! - [`Work`] gets its time from the timing table, or from i860 code on the board's [`Processor`]
//!   ([`GpBoard::run_code`]); the firmware is the same. The message software also exists as i860 code (kernels/ring.s)
//!   with memory of its own ([`RING_MEMORY`]).
//!
//! The host workstation is the same model with a timing table of its own.
//!
//! **Not modelled here:** the bus between CPU and DMA, and the instant of an interrupt within a call of i860 code. A
//! call runs completely at its start, so an interrupt during it finds the caches as they are afterwards.
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
