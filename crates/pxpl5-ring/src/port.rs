//! Events and outputs of the ring.

use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{MAX_MESSAGE_WORDS, Message, NodeId};

/// An event of the ring.
#[derive(Clone, Debug)]
pub enum RingEvent {
    /// A board passes a message to its ring port. The event belongs to phase `Arrive` of the event queue.
    Request(Request),
    /// A receiver with a FIFO answers an announcement. The answer is the time at which the last word will enter the
    /// FIFO. The event belongs to phase `Arrive` of the event queue.
    ///
    /// A time earlier than `first_word_at + words x word` is impossible. Such an answer is counted as a fault, and the
    /// earliest possible time is used instead. If the answer arrives after the time at which the message would free its
    /// sender, the sender becomes free immediately.
    Accept {
        /// Ring port of the board that receives the message.
        destination: NodeId,
        /// Time at which the last word enters the receiver, including the stall.
        last_word_at: Time,
    },
    /// Internal event: the time slot of one word ends. Only a ring that [moves every
    /// word](crate::Ring::move_every_word) has such events. The event belongs to phase `Arrive` of the event queue.
    Slot {
        /// Number of the channel, counted from 0.
        channel: usize,
    },
    /// Internal event: frees the channels of ended messages, then grants channels to waiting messages. The event
    /// belongs to phase `Work` of the event queue.
    Arbitrate,
}

/// A request to send a message, with the options of the transfer.
#[derive(Clone, Debug)]
pub struct Request {
    /// Message to send, with source, destination and length in words.
    pub message: Message,
    /// Number that [`RingOutput::Sent`] or [`RingOutput::Refused`] returns to the sender. With `None`, the sender gets
    /// no answer.
    pub ticket: Option<u64>,
    /// True if the destination stays reserved for this source after the message, because the transfer has more
    /// messages. The first message without `hold` ends the reservation. If no such message follows, the destination
    /// stays blocked. [`Ring::waiting`](crate::Ring::waiting) then lists the blocked messages.
    pub hold: bool,
    /// Rank among the messages that reach the same port at the same instant, the lowest rank first. The rank is needed
    /// because events of one instant have no order. Messages of different instants are sorted by time.
    pub order: u32,
}

/// An output of the ring.
#[derive(Clone, Debug)]
pub enum RingOutput {
    /// Announcement of a message to its receiver `message.destination`, which has a FIFO. The receiver answers with
    /// [`RingEvent::Accept`].
    Announce {
        /// Message that will arrive.
        message: Message,
        /// Time at which the first word begins to arrive. The first word can enter the receiver one word time (`word`)
        /// later.
        first_word_at: Time,
        /// Time that the transfer of one word takes.
        word: Span,
    },
    /// Delivery of a message to its receiver `message.destination`. The receiver accepts every word immediately, and
    /// the last word has arrived.
    Delivered(Message),
    /// Answer to the sender of a message with a ticket: the receiver has accepted the last word.
    Sent {
        /// Ring port of the board that sends the message.
        source: NodeId,
        /// Ticket of the message, as given in [`Request::ticket`].
        ticket: u64,
    },
    /// Answer to the sender of a message with a ticket: the ring has refused the message.
    Refused {
        /// Ring port of the sender, as given in the message.
        source: NodeId,
        /// Ticket of the message, as given in [`Request::ticket`].
        ticket: u64,
        /// Reason why the ring has refused the message.
        error: RingError,
    },
}

/// The reason why a ring cannot be built, or why a message cannot be sent.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RingError {
    /// A parameter of the timing table is out of range.
    #[error("ring timing: {0}")]
    Timing(#[from] SettingError),
    /// The ring has no ports.
    #[error("a ring needs one port at least, found none")]
    NoNodes,
    /// The source or the destination of a message is a port that the ring does not have.
    #[error("there is no ring port {}: the ring has {n_nodes}, from 0", .node.0)]
    NoSuchNode {
        /// Port that does not exist.
        node: NodeId,
        /// Number of ports of the ring. Ports are numbered from 0.
        n_nodes: u16,
    },
    /// The length of a message is 0 or more than 1,024 words.
    #[error("message from ring port {} to {}: expected 1 to {max} words, found {words}", .r#source.0, .destination.0, max = MAX_MESSAGE_WORDS)]
    Length {
        /// Ring port of the board that sends the message.
        r#source: NodeId, // Raw, because `thiserror` takes a plain `source` for another error.
        /// Ring port of the board that receives the message.
        destination: NodeId,
        /// Length of the message in words, without the overhead.
        words: u32,
    },
    /// A receiver answered without an announcement, or answered an announcement for the second time.
    #[error("ring port {} accepted a message that was not announced to it", .destination.0)]
    NothingAnnounced {
        /// Ring port of the board that receives the message.
        destination: NodeId,
    },
    /// A receiver answered with a time that is too early: the last word could not have arrived then.
    #[error("ring port {} accepted the last word at {found}, but it cannot enter before {expected}", .destination.0)]
    AcceptedEarly {
        /// Ring port of the board that receives the message.
        destination: NodeId,
        /// Earliest time at which the last word can have arrived.
        expected: Time,
        /// Time that the receiver stated in its answer.
        found: Time,
    },
    /// A time in the input of the reference model is not a multiple of the model's time step.
    #[error("{what} of {found_ps} ps is no multiple of the tick of {tick}")]
    OffTick {
        /// Name of the time that is not a multiple of the time step.
        what: &'static str,
        /// The time that is not a multiple of the time step, in picoseconds.
        found_ps: u64,
        /// Time step of the reference model.
        tick: Span,
    },
    /// The run of the reference model ended before all messages were delivered.
    #[error("only {delivered} of {of} messages had been delivered at {until}")]
    Unfinished {
        /// Number of delivered messages: messages whose last word was accepted.
        delivered: usize,
        /// Total number of messages, delivered or not.
        of: usize,
        /// Simulated time at which the run of the reference model ended.
        until: Time,
    },
}
