//! The channels of the ring and the messages on them.

use crate::{WaitReason, WaitingMessage};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Message, NodeId};

const UNKNOWN: Time = Time(u64::MAX);

/// A snapshot of a message that occupies a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ChannelSnapshot {
    /// Number of the channel, counted from 0.
    pub channel: usize,
    /// Ring port of the board that sends the message.
    pub source: NodeId,
    /// Ring port of the board that receives the message.
    pub destination: NodeId,
    /// Length of the message in words.
    pub words: u32,
    /// Time at which the arbiter granted the channel to the message.
    pub granted: Time,
    /// Time at which the channel becomes free. `None` means that the receiver has a FIFO and has not answered yet.
    pub ends_at: Option<Time>,
}

/// A message that occupies a channel.
#[derive(Clone, Debug)]
pub(crate) struct MessageInFlight {
    pub(crate) source: NodeId,
    pub(crate) destination: NodeId,
    pub(crate) words: u32,
    pub(crate) ticket: Option<u64>,
    pub(crate) hold: bool,
    pub(crate) granted: Time,
    pub(crate) latency: Span,
    /// Number of word times until the message ends. Only a ring that moves every word
    /// ([`Ring::move_every_word`](crate::Ring::move_every_word)) uses this number.
    pub(crate) slots_left: u64,
    /// The message, kept until it is passed to the receiver. Only a ring that moves every word
    /// ([`Ring::move_every_word`](crate::Ring::move_every_word)) keeps the message.
    pub(crate) message: Option<Box<Message>>,
}

/// All channels of the ring. A new message takes the free channel with the lowest number.
#[derive(Clone, Debug)]
pub(crate) struct RingChannels {
    flights: Vec<Option<MessageInFlight>>,
    /// Time at which each channel becomes free. The time is `UNKNOWN` for free channels, and for messages whose
    /// receiver has not answered yet.
    ends_at: Vec<Time>,
    /// Known end times of messages with their channels, sorted by falling time.
    due: Vec<(Time, usize)>,
    /// Bit set of the free channels.
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

    /// Puts a message on the free channel with the lowest number, and returns the number of the channel. At least one
    /// channel must be free.
    pub(crate) fn occupy(&mut self, flight: MessageInFlight, ends_at: Option<Time>) -> usize {
        let channel = self.free.trailing_zeros() as usize;
        self.free &= !(1 << channel);
        self.flights[channel] = Some(flight);
        // A free channel has no end time, so an unknown end needs no record.
        if let Some(end) = ends_at {
            self.end_at(channel, end);
        }
        channel
    }

    /// Sets the time at which the message on a channel ends. This function must be called once for each message.
    pub(crate) fn end_at(&mut self, channel: usize, at: Time) {
        let before = std::mem::replace(&mut self.ends_at[channel], at);
        debug_assert_eq!(before, UNKNOWN, "an end that is known stays");
        // Keep the list sorted, with the earliest end last.
        let earlier = self.due.iter().rev().take_while(|end| end.0 < at).count();
        self.due.insert(self.due.len() - earlier, (at, channel));
    }

    /// Returns the earliest known end of a message.
    pub(crate) fn first_end(&self) -> Option<Time> {
        self.due.last().map(|end| end.0)
    }

    /// Iterates over the known ends of messages, each with its message. The earliest end comes first.
    pub(crate) fn ends(&self) -> impl Iterator<Item = (Time, &MessageInFlight)> {
        self.due.iter().rev().filter_map(|(end, channel)| Some((*end, self.flight(*channel)?)))
    }

    /// Returns the time at which the message on a channel ends, if this time is known.
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

    /// Counts one word time of the message on a channel and returns the message. After the word time is processed, the
    /// message must be returned to the channel by [`RingChannels::put_back`].
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

    /// Iterates over the messages that occupy channels, sorted by channel.
    pub(crate) fn flights(&self) -> impl Iterator<Item = &MessageInFlight> {
        self.flights.iter().flatten()
    }

    /// Returns the message on a channel if the end of this message is not known yet.
    pub(crate) fn unanswered(&self, channel: usize) -> Option<&MessageInFlight> {
        self.flight(channel).filter(|_| self.ends_at[channel] == UNKNOWN)
    }

    /// Iterates over snapshots of the messages that occupy channels after time `now`, sorted by channel.
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
