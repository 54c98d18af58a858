//! Messages per second of host time: the machine of TR94 with every port busy.

#![allow(missing_docs, reason = "the macros of criterion make public functions without any")]

use criterion::{BatchSize, Criterion, Throughput, criterion_group, criterion_main};
use pxpl5_ring::{Request, Ring, RingEvent, RingOutput, RingTiming};
use pxpl5_sim::{Context, EventQueue, Phase, Time};
use pxpl5_wire::{Body, Message, NodeId};
use std::hint::black_box;
use std::sync::Arc;

const MESSAGES: u64 = 20_000;

fn request(number: u64, n_nodes: u16, words: &Arc<[u32]>) -> Request {
    let n_nodes = u64::from(n_nodes);
    let message = Message {
        source: NodeId((number % n_nodes) as u16),
        destination: NodeId(((number * 7 + 3) % n_nodes) as u16),
        words: 1 + (number * 37 % 1_024) as u32,
        body: Body::Words(Arc::clone(words)),
    };
    Request { message, ticket: Some(number), hold: false, order: 0 }
}

/// Makes a ring of 21 ports with one request at each port.
fn busy_ring(elastic: bool, words: &Arc<[u32]>) -> (Ring, EventQueue<RingEvent>) {
    let ring = Ring::new(RingTiming::PAPERS, 21, |_| elastic).expect("valid");
    let mut queue = EventQueue::new();
    for number in 0..21 {
        queue.schedule(Time(0), Phase::Arrive, RingEvent::Request(request(number, 21, words)));
    }
    (ring, queue)
}

/// Sends the next message of a port at every `Sent`, so that the lengths of the queues stay constant.
fn run(mut ring: Ring, mut queue: EventQueue<RingEvent>, words: &Arc<[u32]>) -> Ring {
    let n_nodes = ring.n_nodes();
    let mut context = Context::default();
    let mut number = u64::from(n_nodes);
    while let Some((now, _, event)) = queue.next_event() {
        ring.handle(event, context.at(now));
        for (time, phase, event) in context.drain_events() {
            queue.schedule(time, phase, event);
        }
        for (time, output) in context.drain_outputs() {
            match output {
                RingOutput::Sent { source, .. } if number < MESSAGES => {
                    let mut next = request(number, n_nodes, words);
                    next.message.source = source;
                    number += 1;
                    queue.schedule(time, Phase::Arrive, RingEvent::Request(next));
                }
                RingOutput::Announce { message, first_word_at, word } => {
                    let last_word_at = first_word_at + word * u64::from(message.words);
                    let destination = message.destination;
                    let accept = RingEvent::Accept { destination, last_word_at };
                    queue.schedule(time + word, Phase::Arrive, accept);
                }
                output => drop(black_box(output)),
            }
        }
    }
    ring
}

fn messages(criterion: &mut Criterion) {
    let words: Arc<[u32]> = Arc::from([0]);
    let mut group = criterion.benchmark_group("messages");
    group.throughput(Throughput::Elements(MESSAGES));
    for (name, elastic) in [("elastic", true), ("answered", false)] {
        group.bench_function(name, |bencher| {
            bencher.iter_batched(
                || busy_ring(elastic, &words),
                |(ring, queue)| run(ring, queue, &words),
                BatchSize::LargeInput,
            );
        });
    }
    group.finish();
}

criterion_group!(benches, messages);
criterion_main!(benches);
