//! The ring network of Pixel-Planes 5: eight channels that carry point-to-point messages between the boards.
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
//! 1. A [`RingEvent::Request`] joins the queue of its source port. A source sends on as many channels at a time as its
//!    port drives, to different receivers; its queue is never overtaken.
//! 2. The message at the head of a queue waits for a free channel and for its destination. All three (channel,
//!    source's port, destination) are granted together, in the order in which messages reached the head of their queues,
//!    at one instant the lowest source first. A message that must wait does not hold up later ones.
//! 3. A message occupies channel and both ports for 16 + `words` word times; at the instant at which that is over
//!    the next one is granted. What a board sends and what it receives do not disturb each other.
//! 4. A message sent with [`Request::hold`] leaves its destination reserved for the same source: the messages of a
//!    region transfer follow each other, and transfers come in order of arrival. (Published for frame buffers, TR94; assumed
//!    for all receivers, because all boards have the same port.)
//! 5. A receiver is *elastic* (takes every word as it comes: graphics processors, frame buffers, the host) or has a
//!    FIFO that may be full (renderers). The elastic one is handed the message when its last word has arrived
//!    ([`RingOutput::Delivered`]). The other one is told that the message is coming ([`RingOutput::Announce`]) and
//!    answers, when it knows, with the time at which the last word enters ([`RingEvent::Accept`]); the difference
//!    to the earliest such time is a stall, during which channel and ports stay occupied.
//! 6. Messages to receivers with a FIFO take [`RingTiming::fifo_channels`] channels at most, so that full FIFOs never keep
//!    back what their boards must send before they can take more.
//! 7. Nothing is dropped. A message that no ring could carry (0 or more than 1,024 words, no such port) is refused,
//!    counted and kept for the report: [`Ring::refusals`].
//!
//! # Timing
//!
//! All numbers stand in [`RingTiming`]. For a message granted at `g`, with `h` hops in the direction of travel:
//!
//! | instant | time |
//! |---|---|
//! | announced | `g + word + h x hop` |
//! | first word at the destination | `g + overhead x word + h x hop` |
//! | last word has arrived; the sender is told ([`RingOutput::Sent`]) | `g + (overhead + words) x word + stall + h x hop` |
//! | channel and ports free | `g + (overhead + words) x word + stall` |
//!
//! A message costs one event of the ring's own, its grant, where nobody waits for its end, and two at most: everything
//! is known at the grant or at the answer. [`Ring::move_every_word`] gives up that shortcut in a running machine; the
//! module [`reference`](mod@reference) holds the same rules word by word and shares no code with the ring. A property test
//! holds all three to the same times.
//!
//! **Not modelled:** routing, check words and the layout of the hardware's queues (their cost is the overhead per
//! message); the way back of a stall or an acknowledgement along the ring; the hop latency between two messages of
//! different sources to one destination (the second may begin to arrive up to the difference of their latencies
//! before the first has ended, on rings of more than 16 boards); multicast; broken hardware.
//!
//! Sources: TR94 (channels, rate, region transfers), F89 (rate). No paper describes the arbiter: its order of
//! arrival is derived (any other order needs 12, not 11, region times for 20 field regions over two ports).

mod channels;
mod port;
pub mod reference;
mod ring;
mod stats;
mod timing;

pub use channels::OnChannel;
pub use port::{Request, RingError, RingEvent, RingOutput};
pub use ring::Ring;
pub use stats::{Refusals, RingStats, WaitReason, WaitingMessage};
pub use timing::RingTiming;
