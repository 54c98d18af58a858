//! What the ring has done and what waits on it, for reports.

use crate::RingError;
use pxpl5_sim::{Blocked, Span, Time};
use pxpl5_wire::NodeId;

/// Sums over all messages that have ended.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct RingStats {
    /// Time for which each channel was occupied, overhead and stalls included.
    pub channel_busy: Vec<Span>,
    /// Messages whose channel has become free.
    pub messages: u64,
    /// Words of these messages, without the overhead.
    pub words: u64,
    /// Time from the request to the grant, summed.
    pub waiting: Span,
    /// The longest such time.
    pub longest_wait: Span,
    /// Time for which full receivers held messages up, summed.
    pub stalled: Span,
}

/// Messages and answers that were refused.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Refusals {
    /// Messages and answers that were refused since the ring was made.
    pub count: u64,
    /// The first, with its time.
    pub first: Option<(Time, RingError)>,
}

impl Refusals {
    pub(crate) fn record(&mut self, now: Time, error: RingError) {
        self.count += 1;
        self.first.get_or_insert((now, error));
    }
}

/// A message that has not been sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaitingMessage {
    /// Port of the sender.
    pub source: NodeId,
    /// Port of the receiver.
    pub destination: NodeId,
    /// Length in words, without the overhead.
    pub words: u32,
    /// Since when it has been at the head of its queue, or in flight.
    pub since: Time,
    /// What has to happen before the message goes on.
    pub reason: WaitReason,
}

/// What a message waits for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WaitReason {
    /// The receiver has not said that it will take the message.
    Acceptance,
    /// The receiver takes another message, from this port.
    DestinationBusy(NodeId),
    /// The receiver is reserved for a transfer of this port that has not ended.
    DestinationReserved(NodeId),
    /// All channels that the message may take are occupied.
    Channel,
    /// Nothing: it will be granted at this instant.
    Arbitration,
}

impl WaitingMessage {
    /// A line for a deadlock report; `name` gives the boards' names.
    #[must_use]
    pub fn blocked(&self, name: impl Fn(NodeId) -> String) -> Blocked {
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
        Blocked { board: name(self.source), waits_for: format!("{what} since {}", self.since) }
    }
}
