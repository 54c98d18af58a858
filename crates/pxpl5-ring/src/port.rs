//! Events and outputs of the ring.

use parameters::ParameterError;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{MAX_MESSAGE_WORDS, Message, NodeId};

/// An event of the ring.
#[derive(Clone, Debug)]
pub enum RingEvent {
    /// A board passes a message to its port. Phase `Arrive`.
    Request(Request),
    /// A receiver with a FIFO answers an announcement with the time at which the last word enters. Phase `Arrive`.
    ///
    /// A time earlier than `first_word_at + words x word` is impossible. Such an answer is counted as a fault, and the
    /// earliest time is used instead. If the answer comes after the sender could have been free, the sender becomes
    /// free at once.
    Accept {
        /// Port of the receiver.
        destination: NodeId,
        /// Time at which the last word has entered, including the stall.
        last_word_at: Time,
    },
    /// Internal event of a ring that [moves every word](crate::Ring::move_every_word): a word slot ends. Phase
    /// `Arrive`.
    Slot {
        /// Number of the channel, from 0.
        channel: usize,
    },
    /// Internal event: release ended messages, then grant waiting ones. Phase `Work`.
    Arbitrate,
}

/// A message with the options of its transfer.
#[derive(Clone, Debug)]
pub struct Request {
    /// Message with source, destination and length in words.
    pub message: Message,
    /// Number returned in [`RingOutput::Sent`] or [`RingOutput::Refused`]; with `None` the sender gets no answer.
    pub ticket: Option<u64>,
    /// True if the destination stays reserved for this source afterwards, because more messages of the transfer follow.
    /// The first message without `hold` ends the reservation. If none follows, the destination stays blocked, which
    /// [`Ring::waiting`](crate::Ring::waiting) shows.
    pub hold: bool,
    /// Place among the messages that reach this port at the same instant, lowest first, because events of one instant
    /// have no order. Messages of different instants keep their order in time.
    pub order: u32,
}

/// An output of the ring.
#[derive(Clone, Debug)]
pub enum RingOutput {
    /// Announcement to `message.destination`, which has a FIFO and answers with [`RingEvent::Accept`].
    Announce {
        /// Message that is coming.
        message: Message,
        /// Time at which the first word begins to arrive. The word can enter one `word` later.
        first_word_at: Time,
        /// Time of one word.
        word: Span,
    },
    /// Delivery to `message.destination`, which is elastic: the last word has arrived.
    Delivered(Message),
    /// Answer to the sender of a message with a ticket: the last word was accepted.
    Sent {
        /// Port of the sender.
        source: NodeId,
        /// [`Request::ticket`] of the message.
        ticket: u64,
    },
    /// Answer to the sender of a message with a ticket: the ring could not carry the message.
    Refused {
        /// Sender as given in the message.
        source: NodeId,
        /// [`Request::ticket`] of the message.
        ticket: u64,
        /// Reason of the refusal.
        error: RingError,
    },
}

/// The reason why a ring cannot be built or a message cannot be carried.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RingError {
    /// A number of the timing table is out of range.
    #[error("ring timing: {0}")]
    Timing(#[from] ParameterError),
    /// The ring would have no port.
    #[error("a ring needs one port at least, found none")]
    NoNodes,
    /// A message names a port that does not exist.
    #[error("there is no ring port {}: the ring has {n_nodes}, from 0", .node.0)]
    NoSuchNode {
        /// Port in the message.
        node: NodeId,
        /// Number of ports of the ring, numbered from 0.
        n_nodes: u16,
    },
    /// A message has no words, or more than 1,024.
    #[error("message from ring port {} to {}: expected 1 to {max} words, found {words}", .r#source.0, .destination.0, max = MAX_MESSAGE_WORDS)]
    Length {
        /// Port of the sender.
        r#source: NodeId, // Raw, since `thiserror` takes a plain `source` for another error.
        /// Port of the receiver.
        destination: NodeId,
        /// Length in words, without the overhead.
        words: u32,
    },
    /// A receiver answered without an announcement, or answered twice.
    #[error("ring port {} accepted a message that was not announced to it", .destination.0)]
    NothingAnnounced {
        /// Port of the receiver.
        destination: NodeId,
    },
    /// A receiver answered with a time before the last word can have arrived.
    #[error("ring port {} accepted the last word at {found}, but it cannot enter before {expected}", .destination.0)]
    AcceptedEarly {
        /// Port of the receiver.
        destination: NodeId,
        /// Earliest possible time.
        expected: Time,
        /// Time in the answer.
        found: Time,
    },
    /// A time given to the reference model is not a multiple of its tick.
    #[error("{what} of {found_ps} ps is no multiple of the tick of {tick}")]
    OffTick {
        /// Description of the time.
        what: &'static str,
        /// Value of the time in picoseconds.
        found_ps: u64,
        /// Tick of the reference model.
        tick: Span,
    },
    /// The reference model had not delivered all messages at the end of its time.
    #[error("only {delivered} of {of} messages had been delivered at {until}")]
    Unfinished {
        /// Number of messages whose last word was accepted.
        delivered: usize,
        /// Number of messages of the traffic.
        of: usize,
        /// End of the run.
        until: Time,
    },
}
