//! The ring network of Pixel-Planes 5: eight channels that carry messages between pairs of boards.
//!
//! ```text
//!   Request --> source port: queue, several in flight    --+
//!                                                           |  arbiter: 1 of 8 channels, source and
//!   Announce <-- destination port: one message at a time <--+  destination free, granted together
//!   Delivered <--/      ^
//!                       Accept (only of a receiver with a FIFO)
//! ```
//!
//! # Behaviour
//!
//! 1. A [`RingEvent::Request`] puts a message into the queue of its source port, which messages leave in order. A
//!    source can send to different receivers at the same time, on a limited number of channels.
//! 2. The *head*, the first message of a queue, waits until a channel, the source's port and the destination are free.
//!    The arbiter grants all three together. It serves heads in the order in which they became heads, and at equal
//!    times in the order of their sources. A head that must wait does not delay later ones.
//! 3. A message occupies its channel and both ports for 16 + `words` word times. At the end of this time, the arbiter
//!    grants the next message. A board can send and receive at the same time.
//! 4. A message sent with [`Request::hold`] leaves its destination reserved for the same source, so the messages of a
//!    region are not interrupted by other sources. This is published for frame buffers (TR94), and assumed for all
//!    other receivers, because all boards have the same port.
//! 5. An *elastic* receiver (a graphics processor, a frame buffer or the host) accepts every word immediately. It gets
//!    the message when the last word has arrived ([`RingOutput::Delivered`]).
//! 6. A receiver with a FIFO that can be full (a renderer) gets an announcement ([`RingOutput::Announce`]) and answers
//!    with the time at which the last word enters its FIFO ([`RingEvent::Accept`]). A full FIFO makes this later than
//!    the earliest possible time. The difference is a *stall*, during which channel and ports stay occupied.
//! 7. Such messages use at most [`RingTiming::fifo_channels`] channels. A board with a full FIFO may have to send
//!    messages before it can accept more words, and the remaining channels are for these, so full FIFOs cannot block
//!    them.
//! 8. No message is dropped. An impossible message (0 words, more than 1,024 words, or a port that does not exist) is
//!    refused, counted and kept for the report: [`Ring::refusals`].
//!
//! # Timing
//!
//! [`RingTiming`] lists all timing parameters. For a message granted at `g`, with `h` hops in the direction of travel:
//!
//! | instant | time |
//! |---|---|
//! | announced | `g + word + h x hop` |
//! | first word at the destination | `g + overhead x word + h x hop` |
//! | last word arrived; sender notified ([`RingOutput::Sent`]) | `g + (overhead + words) x word + stall + h x hop` |
//! | channel and ports free | `g + (overhead + words) x word + stall` |
//!
//! All times of a message are known at its grant or at the receiver's answer. It therefore needs only one event, its
//! grant, and a second one if another message waits for its end. [`Ring::move_every_word`] disables this optimization.
//! The reference model ([`reference`](mod@reference)) applies the same rules word by word and shares no code with the
//! ring; a property test compares the two, with and without the optimization.
//!
//! **Not modelled:**
//!
//! - routing, check words and the layout of the hardware's queues (the overhead of each message stands for their cost)
//! - the travel time of a stall or an acknowledgement back along the ring
//! - the hop latency between two messages from different sources to one destination. On rings of more than 16 boards,
//!   the second message can therefore begin to arrive before the first message has ended.
//! - multicast and broken hardware
//!
//! Sources: TR94 (channels, rate, region transfers), F89 (rate). No paper describes the arbiter. Its order (first come,
//! first served) is derived from the published transfer of 20 regions of a field over two ports, which takes the time
//! of 11 regions. With any other order, the transfer would take the time of 12 regions.

mod channels;
mod port;
pub mod reference;
mod ring;
mod stats;
mod timing;

pub use channels::ChannelSnapshot;
pub use port::{Request, RingError, RingEvent, RingOutput};
pub use ring::Ring;
pub use stats::{Refusals, RingStats, WaitReason, WaitingMessage};
pub use timing::RingTiming;

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct ReadmeExamples;
