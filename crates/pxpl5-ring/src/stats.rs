//! Statistics of the ring and lists of waiting messages, for reports.

use crate::RingError;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::NodeId;
use std::fmt;

/// Statistics of all messages that have ended.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct RingStats {
    /// Time for which each channel was occupied, including overhead and stalls.
    pub channel_busy: Vec<Span>,
    /// Number of messages that have ended and have freed their channels.
    pub messages: u64,
    /// Number of words of all ended messages, without the overhead.
    pub words: u64,
    /// Sum of the waiting times of all messages, from request to grant.
    pub waiting: Span,
    /// Longest waiting time of a message, from request to grant.
    pub longest_wait: Span,
    /// Sum of the times for which receivers with a full FIFO have stalled messages.
    pub stalled: Span,
}

/// Number of refused messages and answers, and the reason for the first refusal.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Refusals {
    /// Number of refused messages and answers since the ring was made.
    pub count: u64,
    /// Time and reason of the first refusal.
    pub first: Option<(Time, RingError)>,
}

impl Refusals {
    pub(crate) fn record(&mut self, now: Time, error: RingError) {
        self.count += 1;
        self.first.get_or_insert((now, error));
    }
}

/// A message that waits for its grant or for the answer of its receiver.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaitingMessage {
    pub source: NodeId,
    pub destination: NodeId,
    /// Length of the message in words, without the overhead.
    pub words: u32,
    /// Time at which the message was granted. Without a grant, time at which the message became the first of its queue.
    pub since: Time,
    pub reason: WaitReason,
}

/// The condition for which a message waits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitReason {
    /// The receiver must still answer the announcement of the message.
    Acceptance,
    /// The receiver is busy with a message from this port.
    DestinationBusy(NodeId),
    /// The receiver is reserved for messages from this port.
    DestinationReserved(NodeId),
    /// All channels that the message can use are occupied.
    Channel,
    /// Nothing is missing: the arbiter will grant the message at this instant.
    Arbitration,
}

impl WaitingMessage {
    /// Returns the port of the board that must act before the message can continue: the receiver, or the board that
    /// occupies or reserves the receiver. Returns `None` if the message waits for the ring.
    pub const fn waits_on(&self) -> Option<NodeId> {
        match self.reason {
            WaitReason::Acceptance => Some(self.destination),
            WaitReason::DestinationBusy(by) | WaitReason::DestinationReserved(by) => Some(by),
            WaitReason::Channel | WaitReason::Arbitration => None,
        }
    }

    /// Returns the condition for which the message waits, for reports of deadlocks. `name` returns the name of a board.
    pub fn waits_for<N: fmt::Display>(&self, name: impl Fn(NodeId) -> N) -> String {
        let to = name(self.destination);
        let words = self.words;
        let what = match self.reason {
            WaitReason::Acceptance => format!("{to} to accept {words} words sent"),
            WaitReason::DestinationBusy(by) => format!("{to}, busy with {}, to take {words} words", name(by)),
            WaitReason::DestinationReserved(by) => {
                format!("{to}, reserved for an unfinished transfer of {}, to take {words} words", name(by))
            }
            WaitReason::Channel => format!("a free channel to {to} for {words} words"),
            WaitReason::Arbitration => format!("arbitration to {to} for {words} words"),
        };
        format!("{what} since {}", self.since)
    }
}
