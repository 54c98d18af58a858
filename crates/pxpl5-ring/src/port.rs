//! Events and outputs of the ring.

use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{MAX_MESSAGE_WORDS, Message, NodeId};

#[derive(Clone, Debug)]
pub enum RingEvent {
    /// A board passes a message to its ring port. The event belongs to phase `Arrive`.
    Request(Request),
    /// A receiver with a FIFO answers an announcement with the time at which the last word will enter the FIFO. The
    /// event belongs to phase `Arrive`.
    ///
    /// A time earlier than `first_word_at + words x word` is impossible: it is counted as a fault, and the earliest
    /// possible time replaces it. If the answer comes after the message would have freed its sender, the sender becomes
    /// free at once.
    Accept {
        destination: NodeId,
        /// Time at which the last word enters the receiver, including the stall.
        last_word_at: Time,
    },
    /// Internal event: the time slot of one word ends. Only a ring that [moves every
    /// word](crate::Ring::move_every_word) has such events. The event belongs to phase `Arrive`.
    Slot { channel: usize },
    /// Internal event: frees the channels of ended messages, then grants channels to waiting messages. The event
    /// belongs to phase `Work`.
    Arbitrate,
}

/// A request to send a message, with the options of the transfer.
#[derive(Clone, Debug)]
pub struct Request {
    pub message: Message,
    /// Number that the sender gets back in [`RingOutput::Sent`] or [`RingOutput::Refused`]. With `None`, it gets no
    /// answer.
    pub ticket: Option<u64>,
    /// True if the destination stays reserved for this source after the message. The source's next message without
    /// `hold` ends this. If none comes, the destination stays blocked, and [`Ring::waiting`](crate::Ring::waiting)
    /// lists the messages that wait for it.
    pub hold: bool,
    /// Rank among the messages that reach the same port at the same instant, the lowest first. It is necessary because
    /// events of one instant have no order.
    pub order: u32,
}

#[derive(Clone, Debug)]
pub enum RingOutput {
    /// Announcement of a message to a receiver with a FIFO. The receiver answers with [`RingEvent::Accept`].
    Announce {
        message: Message,
        /// Time at which the first word begins to arrive. It can enter the receiver one word time (`word`) later.
        first_word_at: Time,
        /// Time for which the transfer of one word occupies a channel.
        word: Span,
    },
    /// Delivery of a message to its receiver, which accepts every word immediately. The last word has just arrived.
    Delivered(Message),
    /// Answer to the sender: the receiver has accepted the last word.
    Sent { source: NodeId, ticket: u64 },
    /// Answer to the sender: the ring has refused the message.
    Refused {
        /// Ring port of the sender, according to the message.
        source: NodeId,
        ticket: u64,
        error: RingError,
    },
}

/// The reason why a ring cannot be built, or why a message cannot be sent.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RingError {
    #[error("ring timing: {0}")]
    Timing(#[from] SettingError),
    #[error("a ring needs one port at least, found none")]
    NoNodes,
    /// The ring does not have the port of the source or of the destination.
    #[error("there is no ring port {}: the ring has {n_nodes}, from 0", .node.0)]
    NoSuchNode {
        node: NodeId,
        /// Number of ports of the ring. The first port has the number 0.
        n_nodes: u16,
    },
    /// The length of a message is 0 or more than 1,024 words.
    #[error("message from ring port {} to {}: expected 1 to {max} words, found {words}", .r#source.0, .destination.0, max = MAX_MESSAGE_WORDS)]
    Length {
        r#source: NodeId, // Raw, because `thiserror` takes a plain `source` for another error.
        destination: NodeId,
        words: u32,
    },
    /// A receiver answered without an announcement, or answered an announcement twice.
    #[error("ring port {} accepted a message that was not announced to it", .destination.0)]
    NothingAnnounced { destination: NodeId },
    /// A receiver answered with a time at which the last word cannot have arrived yet.
    #[error("ring port {} accepted the last word at {found}, but it cannot enter before {expected}", .destination.0)]
    AcceptedEarly {
        destination: NodeId,
        /// Earliest time at which the last word can have arrived.
        expected: Time,
        /// Time of the last word in the answer of the receiver.
        found: Time,
    },
    /// A time in the input of the reference model is not a multiple of its time step.
    #[error("{what} of {found_ps} ps is no multiple of the tick of {tick}")]
    OffTick {
        /// Name of the time that is not a multiple of the time step.
        what: &'static str,
        /// The time, in picoseconds, that is not a multiple of the time step.
        found_ps: u64,
        tick: Span,
    },
    /// The run of the reference model ended before all messages were delivered.
    #[error("only {delivered} of {of} messages had been delivered at {until}")]
    Unfinished {
        /// Number of messages whose last word was accepted.
        delivered: usize,
        of: usize,
        /// Simulated time at which the run ended.
        until: Time,
    },
}
