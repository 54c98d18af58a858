//! The channels of the ring and the messages on them.

use crate::{WaitReason, WaitingMessage};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Message, NodeId};

const UNKNOWN: Time = Time(u64::MAX);

/// A snapshot of a message that occupies a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelSnapshot {
    pub channel: usize,
    pub source: NodeId,
    pub destination: NodeId,
    pub words: u32,
    pub granted: Time,
    /// Time at which the channel becomes free. `None` if the receiver has a FIFO and has not answered yet.
    pub ends_at: Option<Time>,
}

#[derive(Clone, Debug)]
pub(crate) struct MessageInFlight {
    pub(crate) source: NodeId,
    pub(crate) destination: NodeId,
    pub(crate) words: u32,
    pub(crate) ticket: Option<u64>,
    pub(crate) hold: bool,
    pub(crate) granted: Time,
    pub(crate) latency: Span,
    /// Number of word times until the message ends. Only used after
    /// [`Ring::move_every_word`](crate::Ring::move_every_word).
    pub(crate) slots_left: u64,
    /// The content of the message. `None` after the receiver has got the message. Only used after
    /// [`Ring::move_every_word`](crate::Ring::move_every_word).
    pub(crate) message: Option<Box<Message>>,
}

/// All channels of the ring. A new message takes the free channel with the lowest number.
#[derive(Clone, Debug)]
pub(crate) struct RingChannels {
    flights: Vec<Option<MessageInFlight>>,
    /// Time at which each channel becomes free. `UNKNOWN` for free channels, and for messages without an answer of
    /// their receiver.
    ends_at: Vec<Time>,
    /// Known end times of messages and their channels, the latest end first.
    due: Vec<(Time, usize)>,
    /// Free channels, one bit each.
    free: u64,
}

impl RingChannels {
    /// Makes `n` free channels, 1 to 64.
    pub(crate) fn new(n: usize) -> Self {
        Self {
            flights: vec![None; n],
            ends_at: vec![UNKNOWN; n],
            due: Vec::with_capacity(n),
            free: u64::MAX >> (64 - n),
        }
    }

    pub(crate) const fn has_free(&self) -> bool {
        self.free != 0
    }

    pub(crate) fn busy(&self) -> u32 {
        self.flights.len() as u32 - self.free.count_ones()
    }

    pub(crate) fn is_idle(&self) -> bool {
        self.flights.iter().all(Option::is_none)
    }

    /// Puts a message on the free channel with the lowest number, and returns this number. At least one channel must be
    /// free.
    pub(crate) fn occupy(&mut self, flight: MessageInFlight, ends_at: Option<Time>) -> usize {
        let channel = self.free.trailing_zeros() as usize;
        self.free &= !(1 << channel);
        self.flights[channel] = Some(flight);
        // A free channel has no end time, so an unknown end needs no entry.
        if let Some(end) = ends_at {
            self.end_at(channel, end);
        }
        channel
    }

    /// Sets the time at which the message on a channel ends. Must be called once for each message.
    pub(crate) fn end_at(&mut self, channel: usize, at: Time) {
        let before = std::mem::replace(&mut self.ends_at[channel], at);
        debug_assert_eq!(before, UNKNOWN, "an end that is known stays");
        // Keep the list sorted, with the earliest end last.
        let earlier = self.due.iter().rev().take_while(|end| end.0 < at).count();
        self.due.insert(self.due.len() - earlier, (at, channel));
    }

    pub(crate) fn first_end(&self) -> Option<Time> {
        self.due.last().map(|end| end.0)
    }

    /// Iterates over the messages with a known end, the earliest end first.
    pub(crate) fn ends(&self) -> impl Iterator<Item = (Time, &MessageInFlight)> {
        self.due.iter().rev().filter_map(|(end, channel)| Some((*end, self.flight(*channel)?)))
    }

    pub(crate) fn end(&self, channel: usize) -> Option<Time> {
        Some(self.ends_at[channel]).filter(|end| *end != UNKNOWN)
    }

    /// Frees one channel whose message has ended by `now`. Returns the channel, the end time and the message.
    pub(crate) fn take_ended(&mut self, now: Time) -> Option<(usize, Time, MessageInFlight)> {
        let (ended, channel) = self.due.pop_if(|end| end.0 <= now)?;
        self.ends_at[channel] = UNKNOWN;
        self.free |= 1 << channel;
        Some((channel, ended, self.flights[channel].take()?))
    }

    /// Counts one word time of the message on `channel`, and removes the message from the channel. The caller must then
    /// put it back with [`RingChannels::put_back`].
    pub(crate) fn take_slot(&mut self, channel: usize) -> Option<MessageInFlight> {
        let flight = self.flights.get_mut(channel)?.take()?;
        Some(MessageInFlight { slots_left: flight.slots_left.saturating_sub(1), ..flight })
    }

    pub(crate) fn put_back(&mut self, channel: usize, flight: MessageInFlight) {
        self.flights[channel] = Some(flight);
    }

    pub(crate) fn flight(&self, channel: usize) -> Option<&MessageInFlight> {
        self.flights[channel].as_ref()
    }

    pub(crate) fn flights(&self) -> impl Iterator<Item = &MessageInFlight> {
        self.flights.iter().flatten()
    }

    pub(crate) fn unanswered(&self, channel: usize) -> Option<&MessageInFlight> {
        self.flight(channel).filter(|_| self.ends_at[channel] == UNKNOWN)
    }

    /// Iterates over snapshots of the messages on channels at time `now`, in the order of the channels.
    pub(crate) fn channel_snapshots(&self, now: Time) -> impl Iterator<Item = ChannelSnapshot> + '_ {
        (0..self.flights.len()).filter_map(move |channel| {
            let ends_at = self.end(channel);
            let flight = self.flight(channel).filter(|_| ends_at.is_none_or(|end| end > now))?;
            Some(flight.on_channel(channel, ends_at))
        })
    }

    pub(crate) fn all_unanswered(&self) -> impl Iterator<Item = WaitingMessage> + '_ {
        (0..self.flights.len()).filter_map(|channel| self.unanswered(channel)).map(MessageInFlight::waiting)
    }
}

impl MessageInFlight {
    const fn on_channel(&self, channel: usize, ends_at: Option<Time>) -> ChannelSnapshot {
        ChannelSnapshot {
            channel,
            source: self.source,
            destination: self.destination,
            words: self.words,
            granted: self.granted,
            ends_at,
        }
    }

    const fn waiting(&self) -> WaitingMessage {
        WaitingMessage {
            source: self.source,
            destination: self.destination,
            words: self.words,
            since: self.granted,
            reason: WaitReason::Acceptance,
        }
    }
}
