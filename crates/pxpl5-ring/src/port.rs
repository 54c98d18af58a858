//! What comes into the ring and what goes out of it.

use parameters::ParameterError;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{MAX_MESSAGE_WORDS, Message, NodeId};

/// What happens to the ring.
#[derive(Clone, Debug)]
pub enum RingEvent {
    /// A board hands a message to its port. Phase `Arrive`.
    Request(Request),
    /// A receiver that is not elastic says when the last word of the message announced to it enters. Phase `Arrive`.
    ///
    /// Earlier than `first_word_at + words x word` is impossible: it is counted as a fault and the earliest time
    /// is taken. When it is said too late for the sender to be free in time, the sender is free at once.
    Accept {
        /// Port of the receiver.
        destination: NodeId,
        /// When the last word has entered, including the stall.
        last_word_at: Time,
    },
    /// The ring's own, where it [moves every word](crate::Ring::move_every_word): a word slot ends. Phase `Arrive`.
    Slot {
        /// The channel, from 0.
        channel: usize,
    },
    /// The ring's own: release what has ended, then grant what can go. Phase `Work`.
    Arbitrate,
}

/// A message and how it is to be sent.
#[derive(Clone, Debug)]
pub struct Request {
    /// What is sent, with source, destination and length in words.
    pub message: Message,
    /// Given back in [`RingOutput::Sent`] or [`RingOutput::Refused`]; without one the sender is told nothing.
    pub ticket: Option<u64>,
    /// Whether the destination stays reserved for this source afterwards, because more messages of one transfer
    /// follow. The first message without it ends the reservation; without one the destination stays blocked, which
    /// [`Ring::waiting`](crate::Ring::waiting) shows.
    pub hold: bool,
    /// Place among the messages that reach this port at the same instant, lowest first (events of one instant have
    /// no order of their own). Messages of different instants keep the order of time whatever stands here.
    pub order: u32,
}

/// What the ring puts out.
#[derive(Clone, Debug)]
pub enum RingOutput {
    /// To `message.destination`, which is not elastic: a message is coming; answer with [`RingEvent::Accept`].
    Announce {
        /// The message that is coming.
        message: Message,
        /// When the first word begins to arrive; it can have entered one `word` later.
        first_word_at: Time,
        /// Time of one word.
        word: Span,
    },
    /// To `message.destination`, which is elastic: the last word has arrived.
    Delivered(Message),
    /// To the sender of a message with a ticket: the last word has been accepted.
    Sent {
        /// Port of the sender.
        source: NodeId,
        /// [`Request::ticket`] of the message.
        ticket: u64,
    },
    /// To the sender of a message with a ticket: the message could not be carried.
    Refused {
        /// The sender as it named itself.
        source: NodeId,
        /// [`Request::ticket`] of the message.
        ticket: u64,
        /// Why the ring could not carry it.
        error: RingError,
    },
}

/// Why a ring cannot be built or a message not be carried.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RingError {
    /// A number of the timing table is outside of what the model can take.
    #[error("ring timing: {0}")]
    Timing(#[from] ParameterError),
    /// The ring has no port for any board.
    #[error("a ring needs one port at least, found none")]
    NoNodes,
    /// A message names a port that does not exist.
    #[error("there is no ring port {}: the ring has {n_nodes}, from 0", .node.0)]
    NoSuchNode {
        /// The port that was named.
        node: NodeId,
        /// How many ports the ring has, numbered from 0.
        n_nodes: u16,
    },
    /// A message is empty or longer than a message can be.
    #[error("message from ring port {} to {}: expected 1 to {max} words, found {words}", .r#source.0, .destination.0, max = MAX_MESSAGE_WORDS)]
    Length {
        /// Port of the sender.
        r#source: NodeId, // Raw, since `thiserror` takes a plain `source` for another error.
        /// Port of the receiver.
        destination: NodeId,
        /// Length in words, without the overhead.
        words: u32,
    },
    /// A receiver answered though nothing had been announced to it, or answered twice.
    #[error("ring port {} accepted a message that was not announced to it", .destination.0)]
    NothingAnnounced {
        /// Port of the receiver.
        destination: NodeId,
    },
    /// A receiver named a time before the last word can have arrived.
    #[error("ring port {} accepted the last word at {found}, but it cannot enter before {expected}", .destination.0)]
    AcceptedEarly {
        /// Port of the receiver.
        destination: NodeId,
        /// The earliest possible time.
        expected: Time,
        /// The time that it named.
        found: Time,
    },
    /// A reference run was given a time that is no multiple of its tick.
    #[error("{what} of {found_ps} ps is no multiple of the tick of {tick}")]
    OffTick {
        /// What it is the time of.
        what: &'static str,
        /// The time in picoseconds.
        found_ps: u64,
        /// Step of the reference run.
        tick: Span,
    },
    /// A reference run had not delivered everything when its time was over.
    #[error("only {delivered} of {of} messages had been delivered at {until}")]
    Unfinished {
        /// Messages whose last word had been accepted.
        delivered: usize,
        /// Messages that were to be sent.
        of: usize,
        /// When it was over.
        until: Time,
    },
}
