//! The channels and what is on them.

use crate::{WaitReason, WaitingMessage};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Message, NodeId};

const UNKNOWN: Time = Time(u64::MAX);

/// What somebody who looks sees on a channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OnChannel {
    /// The channel, from 0.
    pub channel: usize,
    /// The port of the sender.
    pub source: NodeId,
    /// The port of the receiver.
    pub destination: NodeId,
    /// Length of the message in words.
    pub words: u32,
    /// When the channel was given to it.
    pub granted: Time,
    /// When the channel is free again; `None` until a receiver with a FIFO has said when it has room.
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
    /// Word slots that have not ended, and the message until the receiver is told of it; only where every word is moved.
    pub(crate) slots_left: u64,
    pub(crate) message: Option<Box<Message>>,
}

/// All channels; free ones are taken from the lowest number.
#[derive(Clone, Debug)]
pub(crate) struct RingChannels {
    flights: Vec<Option<MessageInFlight>>,
    /// When each channel is free again; unknown on a free one and until the receiver has answered.
    ends_at: Vec<Time>,
    /// Those that are known, with their channels, the earliest last.
    due: Vec<(Time, usize)>,
    /// One bit a channel.
    free: u64,
}

impl RingChannels {
    /// 1 to 64 free channels.
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

    /// Puts a message on the lowest free channel, which must exist; its end may be known already.
    pub(crate) fn occupy(&mut self, flight: MessageInFlight, ends_at: Option<Time>) -> usize {
        let channel = self.free.trailing_zeros() as usize;
        self.free &= !(1 << channel);
        self.flights[channel] = Some(flight);
        // A free channel has no end.
        if let Some(end) = ends_at {
            self.end_at(channel, end);
        }
        channel
    }

    /// Says when the message on a channel ends, once.
    pub(crate) fn end_at(&mut self, channel: usize, at: Time) {
        let before = std::mem::replace(&mut self.ends_at[channel], at);
        debug_assert_eq!(before, UNKNOWN, "an end that is known stays");
        let earlier = self.due.iter().rev().take_while(|end| end.0 < at).count();
        self.due.insert(self.due.len() - earlier, (at, channel));
    }

    /// The earliest end that is known.
    pub(crate) fn first_end(&self) -> Option<Time> {
        self.due.last().map(|end| end.0)
    }

    /// The ends that are known, the earliest first, and what ends.
    pub(crate) fn ends(&self) -> impl Iterator<Item = (Time, &MessageInFlight)> {
        self.due.iter().rev().filter_map(|(end, channel)| Some((*end, self.flight(*channel)?)))
    }

    /// The end of the message on a channel, if it is known.
    pub(crate) fn end(&self, channel: usize) -> Option<Time> {
        Some(self.ends_at[channel]).filter(|end| *end != UNKNOWN)
    }

    /// Takes a message whose time is over, with its channel and the end of that time.
    pub(crate) fn take_ended(&mut self, now: Time) -> Option<(usize, Time, MessageInFlight)> {
        let (ended, channel) = self.due.pop_if(|end| end.0 <= now)?;
        self.ends_at[channel] = UNKNOWN;
        self.free |= 1 << channel;
        Some((channel, ended, self.flights[channel].take()?))
    }

    /// A word slot of a channel has ended: takes the message off for a moment.
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

    /// The messages that occupy channels, by channel.
    pub(crate) fn flights(&self) -> impl Iterator<Item = &MessageInFlight> {
        self.flights.iter().flatten()
    }

    /// The message on a channel if nobody has said when it ends.
    pub(crate) fn unanswered(&self, channel: usize) -> Option<&MessageInFlight> {
        self.flight(channel).filter(|_| self.ends_at[channel] == UNKNOWN)
    }

    /// What is on each channel after `now`, by channel.
    pub(crate) fn on_channels(&self, now: Time) -> impl Iterator<Item = OnChannel> + '_ {
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
    const fn on_channel(&self, channel: usize, ends_at: Option<Time>) -> OnChannel {
        OnChannel {
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
