//! The reference model of the ring. It moves each word separately, so it is slow and obvious. Tests compare the fast
//! ring with this model.
//!
//! Time advances in equal time steps. In every time step, the model does three things, in this order:
//!
//! 1. Messages whose time has come join the queue of their source port.
//! 2. Every channel at the end of a word slot moves one word: first the slots of the overhead, then the words of the
//!    message. A word that does not fit into its receiver stays in its slot and is offered again in the next time step.
//!    Channel and ports become free after the last word has moved and the receiver has answered.
//! 3. The first message of each queue may get a free channel. The longest waiting one is served first, and among equals
//!    the one with the lowest source number. It needs a source port with a free send channel, and a free destination
//!    that is not reserved for another source. Messages to receivers with a FIFO use at most `fifo_channels` channels.
//!
//! Because of the hops between two boards, each slot is later at the receiver than at the sender; hops have no other
//! effect. No end of a message is computed in advance, and no event is skipped.

use crate::{RingError, RingTiming};
use pxpl5_sim::parameters::ParameterTable;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::NodeId;
use std::collections::VecDeque;

/// A message that the reference model will send. Messages with the same time and source are sent in the order of the
/// list.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlannedMessage {
    /// Time at which the sending board passes the message to its port.
    pub at: Time,
    pub source: NodeId,
    pub destination: NodeId,
    /// Length of the message in words, 1 to 1,024, without the overhead.
    pub words: u32,
    /// True if the destination stays reserved for the same source after this message.
    pub hold: bool,
}

/// The channel and the times of the transfer of one message.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CarriedMessage {
    pub channel: usize,
    /// Time at which the arbiter granted the channel and the ports.
    pub granted: Time,
    /// Time at which the last word entered the receiver.
    pub last_word_at: Time,
    /// Time at which the channel and the ports became free again.
    pub released: Time,
}

/// The receivers in the reference model. The model calls these functions for every message and word. `at` is the time
/// at the receiver.
pub trait Receivers {
    /// Returns true if the receiver accepts every word immediately.
    fn is_elastic(&self, destination: NodeId) -> bool;

    /// Announces a message to its receiver. Returns the time that the receiver needs to answer.
    fn announced(&mut self, destination: NodeId, at: Time) -> Span;

    /// Offers a word to its receiver at the end of a word slot. Returns true if the receiver accepts the word now.
    fn takes_word(&mut self, destination: NodeId, at: Time) -> bool;
}

/// Receivers that accept every word immediately.
#[derive(Clone, Copy, Debug, Default)]
pub struct Elastic;

impl Receivers for Elastic {
    fn is_elastic(&self, _: NodeId) -> bool {
        true
    }

    fn announced(&mut self, _: NodeId, _: Time) -> Span {
        Span::ZERO
    }

    fn takes_word(&mut self, _: NodeId, _: Time) -> bool {
        true
    }
}

/// The reference model: a ring whose time advances in equal time steps. All messages are known before the first step.
#[derive(Debug)]
pub struct SteppedRing<'a, R> {
    timing: RingTiming,
    n_nodes: u16,
    traffic: &'a [PlannedMessage],
    receivers: R,
    /// For each source, the indices of its waiting messages, and the time at which the first of these messages reached
    /// the head of the queue.
    queues: Vec<(VecDeque<usize>, Time)>,
    sending: Vec<u64>,
    receiving: Vec<bool>,
    reserved_for: Vec<Option<NodeId>>,
    channels: Vec<Option<ChannelSlots>>,
    carried: Vec<Option<CarriedMessage>>,
}

#[derive(Clone, Copy, Debug)]
struct ChannelSlots {
    message: usize,
    overhead_left: u64,
    words_left: u32,
    slot_began: Time,
    latency: Span,
    answered_at: Time,
}

impl<'a, R: Receivers> SteppedRing<'a, R> {
    /// Makes a ring that will send all messages of `traffic`.
    ///
    /// # Errors
    ///
    /// Returns [`RingError::Timing`], [`RingError::NoNodes`] or [`RingError::NoSuchNode`].
    pub fn new(
        timing: RingTiming,
        n_nodes: u16,
        traffic: &'a [PlannedMessage],
        receivers: R,
    ) -> Result<Self, RingError> {
        timing.check()?;
        if n_nodes == 0 {
            return Err(RingError::NoNodes);
        }
        // Check the whole traffic first, so that the steps need no checks.
        let mut nodes = traffic.iter().flat_map(|t| [t.source, t.destination]);
        if let Some(node) = nodes.find(|node| node.0 >= n_nodes) {
            return Err(RingError::NoSuchNode { node, n_nodes });
        }
        let n = usize::from(n_nodes);
        Ok(Self {
            timing,
            n_nodes,
            traffic,
            receivers,
            queues: vec![(VecDeque::new(), Time::ZERO); n],
            sending: vec![0; n],
            receiving: vec![false; n],
            reserved_for: vec![None; n],
            channels: vec![None; timing.channels as usize],
            carried: vec![None; traffic.len()],
        })
    }

    /// Advances by time steps of length `tick` until all messages are delivered. Returns the times of each message, in
    /// the order of `traffic`.
    ///
    /// # Errors
    ///
    /// Returns [`RingError::OffTick`] if a time of the timing table or of the traffic is not a multiple of `tick`.
    /// Returns [`RingError::Unfinished`] if a message is not delivered by `until`.
    pub fn run(mut self, tick: Span, until: Time) -> Result<Vec<CarriedMessage>, RingError> {
        self.check_tick(tick)?;
        let mut now = Time::ZERO;
        while self.carried.iter().any(Option::is_none) || self.channels.iter().any(Option::is_some) {
            if now > until {
                return Err(self.unfinished(until));
            }
            self.join(now);
            self.move_words(now);
            self.grant(now);
            now += tick;
        }
        Ok(self.carried.into_iter().flatten().collect())
    }

    fn check_tick(&self, tick: Span) -> Result<(), RingError> {
        let times = self.traffic.iter().map(|t| ("the time of a message", t.at.0));
        let table = [("word_ns", self.timing.word().0), ("hop_ns", Span::from_ns(self.timing.hop_ns).0)];
        match table.into_iter().chain(times).find(|(_, ps)| tick.0 == 0 || ps % tick.0 != 0) {
            Some((what, found_ps)) => Err(RingError::OffTick { what, found_ps, tick }),
            None => Ok(()),
        }
    }

    fn unfinished(&self, until: Time) -> RingError {
        let delivered = self.carried.iter().flatten().filter(|message| message.released > message.granted).count();
        RingError::Unfinished { delivered, of: self.carried.len(), until }
    }

    fn join(&mut self, now: Time) {
        for (message, traffic) in self.traffic.iter().enumerate().filter(|(_, t)| t.at == now) {
            let source = usize::from(traffic.source.0);
            let (queue, since) = &mut self.queues[source];
            // If the queue was empty, the message becomes its head (first message) now.
            if queue.is_empty() {
                *since = now;
            }
            queue.push_back(message);
        }
    }

    fn move_words(&mut self, now: Time) {
        for channel in 0..self.channels.len() {
            let Some(mut slots) = self.channels[channel].take() else { continue };
            // A word moves only at the end of its slot.
            if now.since(slots.slot_began) >= self.timing.word() {
                self.move_word(&mut slots, now);
            }
            // Channel and ports become free after the last word and the answer.
            if slots.words_left == 0 && slots.answered_at <= now {
                self.release(slots.message, now);
            } else {
                self.channels[channel] = Some(slots);
            }
        }
    }

    fn move_word(&mut self, slots: &mut ChannelSlots, now: Time) {
        let destination = self.traffic[slots.message].destination;
        let seen_at = now + slots.latency;
        // The slots of the overhead are not offered to the receiver.
        if slots.overhead_left > 0 {
            slots.overhead_left -= 1;
            slots.slot_began = now;
        } else if slots.words_left > 0 && self.receivers.takes_word(destination, seen_at) {
            slots.words_left -= 1;
            slots.slot_began = now;
            if let Some(message_carried) = &mut self.carried[slots.message] {
                message_carried.last_word_at = seen_at;
            }
        }
    }

    fn release(&mut self, message: usize, now: Time) {
        // If the source was at its limit, its next message becomes a head only now.
        let PlannedMessage { source, destination, hold, .. } = self.traffic[message];
        if self.sending[usize::from(source.0)] == self.timing.source_channels {
            self.queues[usize::from(source.0)].1 = now;
        }
        self.sending[usize::from(source.0)] -= 1;
        self.receiving[usize::from(destination.0)] = false;
        self.reserved_for[usize::from(destination.0)] = hold.then_some(source);
        if let Some(message_carried) = &mut self.carried[message] {
            message_carried.released = now;
        }
    }

    fn grant(&mut self, now: Time) {
        while let Some((message, channel)) = self.first_grantable() {
            self.start(message, channel, now);
        }
    }

    fn first_grantable(&self) -> Option<(usize, usize)> {
        // Grant the first queue head for which everything is free.
        let channel = self.channels.iter().position(Option::is_none)?;
        let mut heads: Vec<_> = (0..self.queues.len())
            .filter(|source| self.sending[*source] < self.timing.source_channels)
            .filter_map(|source| Some((self.queues[source].1, source, *self.queues[source].0.front()?)))
            .collect();
        heads.sort_unstable();
        let mut messages = heads.into_iter().map(|(_, _, message)| message);
        messages.find(|message| self.can_be_granted(*message)).map(|message| (message, channel))
    }

    fn can_be_granted(&self, message: usize) -> bool {
        let PlannedMessage { source, destination, .. } = self.traffic[message];
        let reserved = self.reserved_for[usize::from(destination.0)].is_some_and(|holder| holder != source);
        !reserved && !self.receiving[usize::from(destination.0)] && self.has_channel_to(destination)
    }

    fn has_channel_to(&self, destination: NodeId) -> bool {
        let taken = self.channels.iter().flatten().map(|slots| self.traffic[slots.message].destination);
        let to_fifos = taken.filter(|destination| !self.receivers.is_elastic(*destination)).count();
        self.receivers.is_elastic(destination) || (to_fifos as u64) < self.timing.fifo_channels
    }

    fn start(&mut self, message: usize, channel: usize, now: Time) {
        let PlannedMessage { source, destination, words, .. } = self.traffic[message];
        self.queues[usize::from(source.0)].0.pop_front();
        self.sending[usize::from(source.0)] += 1;
        self.queues[usize::from(source.0)].1 = now;
        self.receiving[usize::from(destination.0)] = true;
        // The announcement reaches the receiver one word time after the grant, plus the hops.
        let latency = self.timing.latency(source, destination, self.n_nodes);
        let announced_at = now + self.timing.word() + latency;
        self.channels[channel] = Some(ChannelSlots {
            message,
            overhead_left: self.timing.overhead_words,
            words_left: words,
            slot_began: now,
            latency,
            answered_at: announced_at + self.receivers.announced(destination, announced_at),
        });
        self.carried[message] = Some(CarriedMessage { channel, granted: now, last_word_at: now, released: now });
    }
}
