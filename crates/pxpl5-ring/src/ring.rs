//! The ring's ports, and the arbiter that grants channels to messages.

use crate::channels::{ChannelSnapshot, MessageInFlight, RingChannels};
use crate::{Refusals, Request, RingError, RingEvent, RingOutput, RingStats, RingTiming, WaitReason, WaitingMessage};
use pxpl5_sim::parameters::ParameterTable;
use pxpl5_sim::{Context, Phase, Span, Time};
use pxpl5_wire::{MAX_MESSAGE_WORDS, Message, NodeId};
use std::collections::VecDeque;

type RingContext = Context<RingEvent, RingOutput>;

#[derive(Clone, Debug)]
pub struct Ring {
    timing: RingTiming,
    word: Span,
    sources: Vec<SourcePort>,
    destinations: Vec<DestinationPort>,
    channels: RingChannels,
    /// Number of messages on channels to receivers with a FIFO, at most `fifo_channels`.
    to_fifos: u64,
    /// First message of each queue whose source has a free send channel, in the order of grants.
    heads: Vec<QueueHead>,
    /// Number of messages in `heads` whose receiver has a FIFO.
    heads_to_fifos: u32,
    /// Number of sources that send on the greatest permitted number of channels, `source_channels`.
    at_limit: usize,
    /// True if a channel or destination has become free since the last grants, so that a waiting message may be
    /// granted.
    unblocked: bool,
    /// Times at which an arbitration (a pass that grants channels to waiting messages) is scheduled.
    arbitrations: Vec<Time>,
    /// True if every end of a message causes an event, even if no other message waits for this end.
    watched: bool,
    word_by_word: bool,
    stats: RingStats,
    /// Time for which each port has received messages, including overhead and stalls.
    receiving: Vec<Span>,
    refusals: Refusals,
}

#[derive(Clone, Debug, Default)]
struct SourcePort {
    queue: VecDeque<QueuedRequest>,
    /// Number of channels on which the source sends, at most `source_channels`.
    in_flight: u64,
}

#[derive(Clone, Debug)]
struct QueuedRequest {
    at: Time,
    request: Request,
}

#[derive(Clone, Debug)]
struct DestinationPort {
    elastic: bool,
    channel: Option<usize>,
    reserved_for: Option<NodeId>,
    /// Number of messages for this destination that are first in their queue and wait for a grant.
    heads: u32,
}

/// The first message of a source's queue, which waits for its grant. The arbiter serves messages in the order of
/// `since`, and at equal times in the order of `source`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct QueueHead {
    since: Time,
    source: NodeId,
    destination: NodeId,
}

impl Ring {
    /// Makes an empty ring of `n_nodes` ports. `elastic` returns true for receivers that accept every word immediately.
    ///
    /// # Errors
    ///
    /// Returns [`RingError::Timing`] or [`RingError::NoNodes`].
    pub fn new(timing: RingTiming, n_nodes: u16, elastic: impl Fn(NodeId) -> bool) -> Result<Self, RingError> {
        timing.check()?;
        if n_nodes == 0 {
            return Err(RingError::NoNodes);
        }
        let n_channels = timing.channels as usize;
        Ok(Self {
            timing,
            word: timing.word(),
            sources: vec![SourcePort::default(); usize::from(n_nodes)],
            destinations: (0..n_nodes).map(|node| DestinationPort::new(elastic(NodeId(node)))).collect(),
            channels: RingChannels::new(n_channels),
            to_fifos: 0,
            heads: Vec::new(),
            heads_to_fifos: 0,
            at_limit: 0,
            unblocked: false,
            arbitrations: Vec::new(),
            watched: false,
            word_by_word: false,
            stats: RingStats { channel_busy: vec![Span::ZERO; n_channels], ..RingStats::default() },
            receiving: vec![Span::ZERO; usize::from(n_nodes)],
            refusals: Refusals::default(),
        })
    }

    /// Schedules an event for the end of every message. [`Ring::busy_channels`] is then correct after every event.
    pub const fn watch(&mut self) {
        self.watched = true;
    }

    /// Schedules an event for every word. Without this call, the ring computes the end of a message at its grant. The
    /// call does not change the times of messages. Receivers with a FIFO still answer for whole messages.
    pub const fn move_every_word(&mut self) {
        self.word_by_word = true;
    }

    /// Handles one event at the time of `context`. The resulting events and outputs go to `context`.
    pub fn handle(&mut self, event: RingEvent, context: &mut RingContext) {
        match event {
            RingEvent::Request(request) => self.request(request, context),
            RingEvent::Accept { destination, last_word_at } => self.accept(destination, last_word_at, context),
            RingEvent::Slot { channel } => self.move_word(channel, context),
            RingEvent::Arbitrate => self.arbitrate(context),
        }
    }

    fn arbitrate(&mut self, context: &mut RingContext) {
        let now = context.now();
        // Arbitrations up to this instant are done.
        self.arbitrations.retain(|at| *at > now);
        self.settle(now);
        self.grant_all(now, context);
        // A wrong count stays wrong, so a check of some arbitrations of a long run finds it. Short runs, as in tests, are
        // checked at every arbitration.
        let is_checked = self.stats.messages < 1_000 || self.stats.messages.is_multiple_of(64);
        debug_assert!(!is_checked || self.check_counters(), "a count differs from what it counts: {self:?}");
        self.arbitrate_at_next_end(context);
    }

    /// Recomputes all counters of the ring. Returns true if the counters were correct.
    fn check_counters(&self) -> bool {
        let to_fifo = |node: NodeId| !self.is_elastic(node);
        // Count in one pass over the heads, because a scan for each port would take most of the time of a test run.
        let mut heads_of_ports = vec![0; self.destinations.len()];
        self.heads.iter().for_each(|head| heads_of_ports[usize::from(head.destination.0)] += 1);
        let source_limit = self.timing.source_channels;
        let at_limit = |port: &&SourcePort| port.in_flight >= source_limit;
        let in_flight: u64 = self.sources.iter().map(|port| port.in_flight).sum();
        let heads_to_fifos = self.heads.iter().filter(|head| to_fifo(head.destination)).count();
        let to_fifos = self.channels.flights().filter(|flight| to_fifo(flight.destination)).count();
        self.heads.is_sorted()
            && self.heads_to_fifos as usize == heads_to_fifos
            && self.to_fifos as usize == to_fifos
            && self.at_limit == self.sources.iter().filter(at_limit).count()
            && in_flight == u64::from(self.channels.busy())
            && self.destinations.iter().zip(heads_of_ports).all(|(port, heads)| port.heads == heads)
    }

    pub const fn timing(&self) -> &RingTiming {
        &self.timing
    }

    pub fn n_nodes(&self) -> u16 {
        self.sources.len() as u16
    }

    /// Returns the statistics of all messages that had ended at the last grant or [`Ring::settle`].
    pub const fn stats(&self) -> &RingStats {
        &self.stats
    }

    /// Returns the time for which a port has received messages, including overhead and stalls. Only ended messages
    /// count. The result is zero for a port that does not exist.
    pub fn receiving(&self, port: NodeId) -> Span {
        self.receiving.get(usize::from(port.0)).copied().unwrap_or(Span::ZERO)
    }

    /// Returns the number of refused messages and answers, and the reason for the first refusal.
    pub const fn refusals(&self) -> &Refusals {
        &self.refusals
    }

    /// Returns the number of occupied channels. Unless [`Ring::watch`] was called, the channel of an ended message can
    /// still count as occupied.
    pub fn busy_channels(&self) -> u32 {
        self.channels.busy()
    }

    /// Returns snapshots of the messages on channels at time `now`, in the order of the channels. `now` must not be
    /// earlier than the last event.
    pub fn channel_snapshots(&self, now: Time) -> impl Iterator<Item = ChannelSnapshot> + '_ {
        self.channels.channel_snapshots(now)
    }

    /// Returns true if, at the last grant or [`Ring::settle`], no message was on a channel or waited for a channel.
    pub fn is_idle(&self) -> bool {
        self.heads.is_empty() && self.channels.is_idle()
    }

    /// Checks that the ring can carry a message.
    ///
    /// # Errors
    ///
    /// Returns [`RingError::NoSuchNode`] or [`RingError::Length`].
    pub fn check(&self, message: &Message) -> Result<(), RingError> {
        for node in [message.source, message.destination] {
            self.check_node(node)?;
        }
        if (1..=MAX_MESSAGE_WORDS).contains(&message.words) {
            return Ok(());
        }
        Err(RingError::Length { source: message.source, destination: message.destination, words: message.words })
    }

    /// Returns the messages that wait for a grant as first of their queue, and the messages that wait for their
    /// receiver's answer. The messages are sorted by source.
    pub fn waiting(&self) -> Vec<WaitingMessage> {
        let heads = self.heads.iter().filter_map(|head| self.waiting_head(*head));
        let mut all: Vec<_> = self.channels.all_unanswered().chain(heads).collect();
        all.sort_by_key(|message| message.source);
        all
    }

    fn check_node(&self, node: NodeId) -> Result<(), RingError> {
        if usize::from(node.0) < self.sources.len() {
            return Ok(());
        }
        Err(RingError::NoSuchNode { node, n_nodes: self.n_nodes() })
    }

    fn request(&mut self, request: Request, context: &mut RingContext) {
        if let Err(error) = self.check(&request.message) {
            return self.refuse(&request, error, context);
        }
        let now = context.now();
        let id = request.message.source;
        let most = self.timing.source_channels;
        let source = &mut self.sources[usize::from(id.0)];
        let new_first = source.insert(QueuedRequest { at: now, request }) == 0;
        // Only a new head needs an arbitration, and only if its source can send.
        if !new_first || source.in_flight >= most {
            return;
        }
        // The new message can precede the old head if both reached the port at this instant.
        if source.queue.len() > 1
            && let Some(place) = self.heads.iter().position(|head| head.source == id)
        {
            self.take_head(place);
        }
        self.add_head(now, id);
        self.arbitrate_at(now, context);
    }

    /// Schedules an arbitration (a pass that grants channels to waiting messages) at time `at`. Does nothing if an
    /// earlier arbitration is already scheduled, because each arbitration schedules the next.
    fn arbitrate_at(&mut self, at: Time, context: &mut RingContext) {
        if self.arbitrations.iter().all(|earlier| *earlier > at) {
            self.arbitrations.push(at);
            context.schedule(at, Phase::Work, RingEvent::Arbitrate);
        }
    }

    /// Schedules an arbitration at the next end of a message for which another message waits. After [`Ring::watch`],
    /// schedules it at the next end of any message.
    fn arbitrate_at_next_end(&mut self, context: &mut RingContext) {
        // If a source is at its limit or no channel is free, the end of every message is relevant.
        let any_end = self.watched || self.at_limit > 0;
        let next = if any_end || self.is_channel_missing() {
            self.channels.first_end()
        } else if self.heads.is_empty() {
            None
        } else {
            self.first_end_waited_for()
        };
        if let Some(end) = next {
            self.arbitrate_at(end.max(context.now()), context);
        }
    }

    /// Returns the earliest known time when a destination of a waiting message becomes free. Only messages at the head
    /// of their queue count.
    fn first_end_waited_for(&self) -> Option<Time> {
        let waited_for = |flight: &MessageInFlight| self.destinations[usize::from(flight.destination.0)].heads > 0;
        self.channels.ends().find(|(_, flight)| waited_for(flight)).map(|(end, _)| end)
    }

    fn is_channel_missing(&self) -> bool {
        (!self.heads.is_empty() && !self.channels.has_free())
            || (self.heads_to_fifos > 0 && self.to_fifos >= self.timing.fifo_channels)
    }

    fn refuse(&mut self, request: &Request, error: RingError, context: &mut RingContext) {
        if let Some(ticket) = request.ticket {
            let refused = RingOutput::Refused { source: request.message.source, ticket, error: error.clone() };
            context.output(context.now() + self.word, refused);
        }
        self.refusals.record(context.now(), error);
    }

    fn add_head(&mut self, since: Time, source: NodeId) {
        let Some(first) = self.sources[usize::from(source.0)].queue.front() else { return };
        let head = QueueHead { since, source, destination: first.request.message.destination };
        // Sort the heads by the time at which they became heads, then by source.
        let later = self.heads.iter().rev().take_while(|&&h| h > head).count();
        self.heads.insert(self.heads.len() - later, head);
        // Count the head at its destination, so that the end of a message there causes a new round of grants.
        let destination = &mut self.destinations[usize::from(head.destination.0)];
        destination.heads += 1;
        self.heads_to_fifos += u32::from(!destination.elastic);
    }

    fn take_head(&mut self, place: usize) {
        let head = self.heads.remove(place);
        let destination = &mut self.destinations[usize::from(head.destination.0)];
        destination.heads -= 1;
        self.heads_to_fifos -= u32::from(!destination.elastic);
    }

    /// Frees the channels and ports of all messages that have ended by `now`, and adds these messages to the
    /// statistics. The ring also does this before every grant.
    pub fn settle(&mut self, now: Time) {
        let lacked_channel = self.is_channel_missing();
        while let Some((channel, ended, flight)) = self.channels.take_ended(now) {
            let destination = &mut self.destinations[usize::from(flight.destination.0)];
            // Free the destination, and keep it reserved if the message was held.
            destination.release(&flight);
            self.unblocked |= lacked_channel || destination.heads > 0;
            self.to_fifos -= u64::from(!destination.elastic);
            let source = &mut self.sources[usize::from(flight.source.0)];
            source.in_flight -= 1;
            // The next message of a source below its limit is already a head.
            if source.in_flight + 1 == self.timing.source_channels {
                self.at_limit -= 1;
                self.add_head(ended, flight.source);
            }
            let busy = ended.since(flight.granted);
            self.stats.channel_busy[channel] += busy;
            self.receiving[usize::from(flight.destination.0)] += busy;
            self.stats.stalled += busy - self.timing.occupancy(flight.words);
            self.stats.messages += 1;
            self.stats.words += u64::from(flight.words);
        }
    }

    /// Grants channels to all waiting messages that can be sent. One pass is enough, because a grant frees nothing, and
    /// the next message of the same source comes later in the order. If nothing has become free since the last pass,
    /// only messages that became first in their queue at this instant are checked.
    fn grant_all(&mut self, now: Time, context: &mut RingContext) {
        let is_for_all = std::mem::take(&mut self.unblocked);
        let mut place =
            if is_for_all { 0 } else { self.heads.iter().rposition(|h| h.since < now).map_or(0, |p| p + 1) };
        while self.channels.has_free() && place < self.heads.len() {
            if self.can_go(place) {
                let source = self.heads[place].source;
                self.take_head(place);
                self.grant(source, now, context);
            } else {
                place += 1;
            }
        }
    }

    fn can_go(&self, place: usize) -> bool {
        let QueueHead { source, destination, .. } = self.heads[place];
        self.destinations[usize::from(destination.0)].takes_from(source) && self.has_channel_to(destination)
    }

    fn has_channel_to(&self, destination: NodeId) -> bool {
        self.channels.has_free() && (self.is_elastic(destination) || self.to_fifos < self.timing.fifo_channels)
    }

    fn grant(&mut self, source: NodeId, now: Time, context: &mut RingContext) {
        let port = &mut self.sources[usize::from(source.0)];
        let Some(QueuedRequest { at, request }) = port.queue.pop_front() else { return };
        port.in_flight += 1;
        let waited = now.since(at);
        self.stats.waiting += waited;
        self.stats.longest_wait = self.stats.longest_wait.max(waited);
        self.carry(self.flight(&request, now), request.message, context);
        // The source's next message becomes a head if the port may drive one more channel.
        if self.sources[usize::from(source.0)].in_flight < self.timing.source_channels {
            self.add_head(now, source);
        } else {
            self.at_limit += 1;
        }
    }

    fn flight(&self, request: &Request, now: Time) -> MessageInFlight {
        let Message { source, destination, words, .. } = request.message;
        MessageInFlight {
            source,
            destination,
            words,
            ticket: request.ticket,
            hold: request.hold,
            granted: now,
            latency: self.timing.latency(source, destination, self.n_nodes()),
            slots_left: self.timing.overhead_words + u64::from(words),
            message: None,
        }
    }

    /// Puts a message on a channel, and outputs its delivery or its announcement. Its end is known now if the receiver
    /// accepts every word immediately, otherwise at the receiver's answer. If every word causes an event, it is known
    /// at the last of these.
    fn carry(&mut self, flight: MessageInFlight, message: Message, context: &mut RingContext) {
        if self.word_by_word {
            let begins = flight.granted;
            let channel = self.occupy(MessageInFlight { message: Some(Box::new(message)), ..flight }, None);
            context.schedule(begins + self.word, Phase::Arrive, RingEvent::Slot { channel });
        } else if !self.is_elastic(flight.destination) {
            self.announce(&flight, message, context);
            self.occupy(flight, None);
        } else {
            let end = flight.granted + self.timing.occupancy(flight.words);
            deliver(message, end + flight.latency, (flight.source, flight.ticket), context);
            self.occupy(flight, Some(end));
        }
    }

    fn occupy(&mut self, flight: MessageInFlight, end: Option<Time>) -> usize {
        let destination = &mut self.destinations[usize::from(flight.destination.0)];
        self.to_fifos += u64::from(!destination.elastic);
        let channel = self.channels.occupy(flight, end);
        destination.channel = Some(channel);
        channel
    }

    /// Ends the time slot of one word, or of one word of overhead. A receiver with a FIFO gets the announcement after
    /// the first slot. An elastic receiver (which accepts every word immediately) gets the message after the last slot.
    fn move_word(&mut self, channel: usize, context: &mut RingContext) {
        let Some(mut flight) = self.channels.take_slot(channel) else { return };
        // The next word slot follows at once.
        if flight.slots_left > 0 {
            context.schedule(context.now() + self.word, Phase::Arrive, RingEvent::Slot { channel });
        }
        let elastic = self.is_elastic(flight.destination);
        // An elastic receiver gets the message after the last word. Another receiver gets the announcement after the
        // first slot.
        let message = if flight.slots_left == 0 || !elastic { flight.message.take() } else { None };
        match message {
            Some(message) if elastic => {
                let now = context.now();
                deliver(*message, now + flight.latency, (flight.source, flight.ticket), context);
                self.channels.put_back(channel, flight);
                self.channels.end_at(channel, now);
                self.arbitrate_at_next_end(context);
                return;
            }
            Some(message) => self.announce(&flight, *message, context),
            None => {}
        }
        self.channels.put_back(channel, flight);
    }

    fn is_elastic(&self, node: NodeId) -> bool {
        self.destinations[usize::from(node.0)].elastic
    }

    fn announce(&self, flight: &MessageInFlight, message: Message, context: &mut RingContext) {
        let first_word_at = flight.granted + self.timing.occupancy(0) + flight.latency;
        let announce = RingOutput::Announce { message, first_word_at, word: self.word };
        context.output(flight.granted + self.word + flight.latency, announce);
    }

    fn accept(&mut self, destination: NodeId, last_word_at: Time, context: &mut RingContext) {
        let now = context.now();
        let Some((channel, flight)) = self.unanswered(destination) else {
            let error = RingError::NothingAnnounced { destination };
            return self.refusals.record(now, error);
        };
        // The earliest possible time for the last word, without a stall. A stall keeps the channel occupied, so the
        // channel cannot become free before the present.
        let earliest = flight.granted + self.timing.occupancy(flight.words) + flight.latency;
        let accepted = last_word_at.max(earliest);
        let end = now.max(Time(accepted.0 - flight.latency.0));
        notify_sender((flight.source, flight.ticket), accepted.max(now + self.word), context);
        self.channels.end_at(channel, end);
        self.arbitrate_at_next_end(context);
        if last_word_at < earliest {
            let error = RingError::AcceptedEarly { destination, expected: earliest, found: last_word_at };
            self.refusals.record(now, error);
        }
    }

    /// Returns the message that was announced to `destination` but not answered yet, and its channel.
    fn unanswered(&self, destination: NodeId) -> Option<(usize, &MessageInFlight)> {
        let channel = self.destinations.get(usize::from(destination.0))?.channel?;
        Some((channel, self.channels.unanswered(channel)?))
    }

    fn waiting_head(&self, QueueHead { since, source, destination }: QueueHead) -> Option<WaitingMessage> {
        let words = self.sources[usize::from(source.0)].queue.front()?.request.message.words;
        let reason = self.wait_reason(source, destination);
        Some(WaitingMessage { source, destination, words, since, reason })
    }

    fn wait_reason(&self, source: NodeId, destination: NodeId) -> WaitReason {
        let port = &self.destinations[usize::from(destination.0)];
        if let Some(flight) = port.channel.and_then(|channel| self.channels.flight(channel)) {
            return WaitReason::DestinationBusy(flight.source);
        }
        match port.reserved_for {
            Some(holder) if holder != source => WaitReason::DestinationReserved(holder),
            _ if !self.has_channel_to(destination) => WaitReason::Channel,
            _ => WaitReason::Arbitration,
        }
    }
}

/// Outputs the delivery of a message to a receiver that accepts every word immediately, and the report to the sender.
fn deliver(message: Message, at: Time, sender: (NodeId, Option<u64>), context: &mut RingContext) {
    context.output(at, RingOutput::Delivered(message));
    notify_sender(sender, at, context);
}

fn notify_sender((source, ticket): (NodeId, Option<u64>), at: Time, context: &mut RingContext) {
    if let Some(ticket) = ticket {
        context.output(at, RingOutput::Sent { source, ticket });
    }
}

impl QueuedRequest {
    const fn order(&self) -> (Time, u32) {
        (self.at, self.request.order)
    }
}

impl SourcePort {
    fn insert(&mut self, queued: QueuedRequest) -> usize {
        let later = self.queue.iter().rev().take_while(|other| other.order() > queued.order()).count();
        let place = self.queue.len() - later;
        if later == 0 {
            self.queue.push_back(queued);
        } else {
            self.queue.insert(place, queued);
        }
        place
    }
}

impl DestinationPort {
    const fn new(elastic: bool) -> Self {
        Self { elastic, channel: None, reserved_for: None, heads: 0 }
    }

    fn takes_from(&self, source: NodeId) -> bool {
        self.channel.is_none() && self.reserved_for.is_none_or(|holder| holder == source)
    }

    fn release(&mut self, flight: &MessageInFlight) {
        self.channel = None;
        self.reserved_for = flight.hold.then_some(flight.source);
    }
}
