//! A test machine that consists of a ring and receivers.

use pxpl5_ring::reference::{PlannedMessage, Receivers};
use pxpl5_ring::{Request, Ring, RingEvent, RingOutput, RingTiming};
use pxpl5_sim::{Context, EventQueue, Phase, Span, Time};
use pxpl5_wire::{Body, Message, NodeId};
use std::collections::{BTreeMap, VecDeque};

/// A receiver: elastic, or a FIFO that is emptied at a constant rate.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Receiver {
    Elastic,
    Fifo {
        words: usize,
        /// Time that each word takes to leave the FIFO.
        drain: Span,
        /// Time from the announcement to the first possible entry of a word.
        opens_after: Span,
        /// Time from the announcement to the answer, at least one tick.
        answers_after: Span,
    },
}

impl Receiver {
    const fn is_elastic(&self) -> bool {
        matches!(self, Self::Elastic)
    }
}

pub(crate) const ELASTIC: [Receiver; 64] = [Receiver::Elastic; 64];

/// Times of each message, by its number in the traffic: the entry of its last word, and the answer to its sender.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Times {
    pub(crate) accepted: BTreeMap<u64, Time>,
    pub(crate) sent: BTreeMap<u64, Time>,
}

/// Makes a message that is identified by its number.
pub(crate) fn message(number: u64, source: u16, destination: u16, words: u32) -> Message {
    let body = Body::Words(vec![number as u32].into());
    Message { source: NodeId(source), destination: NodeId(destination), words, body }
}

pub(crate) fn request(number: u64, source: u16, destination: u16, words: u32) -> Request {
    let message = message(number, source, destination, words);
    Request { message, ticket: Some(number), hold: false, order: number as u32 }
}

fn number(message: &Message) -> u64 {
    match &message.body {
        Body::Words(words) => u64::from(words[0]),
        _ => unreachable!("the tests send words"),
    }
}

/// Sends the traffic over the fast ring.
pub(crate) fn run_fast(
    timing: RingTiming,
    receivers: &[Receiver],
    traffic: &[PlannedMessage],
    shuffle: Option<u64>,
) -> (Ring, Times) {
    run_prepared(timing, receivers, traffic, shuffle, |_| {})
}

/// Sends the traffic over the fast ring after `prepare` has disabled optimizations.
pub(crate) fn run_prepared(
    timing: RingTiming,
    receivers: &[Receiver],
    traffic: &[PlannedMessage],
    shuffle: Option<u64>,
    prepare: impl FnOnce(&mut Ring),
) -> (Ring, Times) {
    let mut ring =
        Ring::new(timing, receivers.len() as u16, |node| receivers[usize::from(node.0)].is_elastic()).expect("valid");
    prepare(&mut ring);
    let mut queue = EventQueue::new();
    if let Some(seed) = shuffle {
        queue.shuffle_ties(seed);
    }
    let requests = (0..)
        .zip(traffic)
        .map(|(i, t)| (t.at, Request { hold: t.hold, ..request(i, t.source.0, t.destination.0, t.words) }));
    requests.for_each(|(at, request)| queue.schedule(at, Phase::Arrive, RingEvent::Request(request)));
    run_queue(ring, queue, receivers)
}

fn run_queue(mut ring: Ring, mut queue: EventQueue<RingEvent>, receivers: &[Receiver]) -> (Ring, Times) {
    let mut fifos = vec![VecDeque::new(); receivers.len()];
    let mut context = Context::default();
    let mut times = Times::default();
    while let Some((now, _, event)) = queue.next_event() {
        ring.handle(event, context.at(now));
        for (time, phase, event) in context.drain_events() {
            queue.schedule(time, phase, event);
        }
        for (time, output) in context.drain_outputs() {
            match output {
                RingOutput::Delivered(message) => {
                    times.accepted.insert(number(&message), time);
                }
                RingOutput::Sent { ticket, .. } => drop(times.sent.insert(ticket, time)),
                RingOutput::Refused { error, .. } => panic!("{error}"),
                RingOutput::Announce { message, first_word_at, word } => {
                    let node = usize::from(message.destination.0);
                    let Receiver::Fifo { opens_after, answers_after, .. } = receivers[node] else { unreachable!() };
                    let slots = WordSlots { begins: first_word_at, opens: time + opens_after, word, n: message.words };
                    let last_word_at = last_word(receivers[node], &mut fifos[node], slots);
                    times.accepted.insert(number(&message), last_word_at);
                    let accept = RingEvent::Accept { destination: message.destination, last_word_at };
                    queue.schedule(time + answers_after, Phase::Arrive, accept);
                }
            }
        }
    }
    ring.settle(Time(u64::MAX));
    (ring, times)
}

struct WordSlots {
    begins: Time,
    opens: Time,
    word: Span,
    n: u32,
}

/// Returns the time at which the last word enters, computed by a recurrence. A word enters one slot after the previous
/// word, or later, when the FIFO has room and the receiver is open. `departures` has the times at which the last words
/// leave the FIFO.
fn last_word(receiver: Receiver, departures: &mut VecDeque<Time>, slots: WordSlots) -> Time {
    let Receiver::Fifo { words, drain, .. } = receiver else { unreachable!() };
    let mut entered = slots.begins;
    for _ in 0..slots.n {
        let room = if departures.len() == words { departures.pop_front() } else { None };
        entered = (entered + slots.word).max(slots.opens).max(room.unwrap_or(Time::ZERO));
        let leaves = departures.back().map_or(entered, |last| entered.max(*last)) + drain;
        departures.push_back(leaves);
    }
    entered
}

/// The same receivers for the reference model, with counters instead of a recurrence.
#[derive(Debug)]
pub(crate) struct Stepped {
    fifos: Vec<(Receiver, Counters)>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Counters {
    level: usize,
    opens_at: Time,
    next_leaves_at: Option<Time>,
}

impl Stepped {
    pub(crate) fn new(receivers: &[Receiver]) -> Self {
        let fifos = receivers.iter().map(|receiver| (*receiver, Counters::default()));
        Self { fifos: fifos.collect() }
    }
}

impl Receivers for Stepped {
    fn is_elastic(&self, destination: NodeId) -> bool {
        self.fifos[usize::from(destination.0)].0.is_elastic()
    }

    fn announced(&mut self, destination: NodeId, at: Time) -> Span {
        let (receiver, counters) = &mut self.fifos[usize::from(destination.0)];
        let Receiver::Fifo { opens_after, answers_after, .. } = *receiver else { return Span::ZERO };
        counters.opens_at = at + opens_after;
        answers_after
    }

    fn takes_word(&mut self, destination: NodeId, at: Time) -> bool {
        let (receiver, counters) = &mut self.fifos[usize::from(destination.0)];
        let Receiver::Fifo { words, drain, .. } = *receiver else { return true };
        while let Some(leaves) = counters.next_leaves_at.filter(|leaves| *leaves <= at) {
            counters.level -= 1;
            counters.next_leaves_at = (counters.level > 0).then_some(leaves + drain);
        }
        if at < counters.opens_at || counters.level == words {
            return false;
        }
        counters.level += 1;
        counters.next_leaves_at.get_or_insert(at + drain);
        true
    }
}
