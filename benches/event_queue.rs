//! The hold model: a queue of constant length in which the handler of each event schedules another event.

#![allow(missing_docs, reason = "criterion's macros make undocumented functions")]

use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use pxpl5_sim::{EventQueue, Phase, Time, mix};

/// An event type with the size of an event that carries a message.
type Event = [u64; 12];

fn hold(queue: &mut EventQueue<Event>, events: u64) -> u64 {
    let mut sum = 0;
    for i in 0..events {
        let Some((time, _, event)) = queue.next_event() else { break };
        sum += event[0];
        queue.schedule(Time(time.0 + mix(i) % 100_000), Phase::Work, event);
    }
    sum
}

fn event_queue(c: &mut Criterion) {
    let mut group = c.benchmark_group("event-queue/hold");
    for pending in [32u64, 256, 2_048] {
        group.throughput(Throughput::Elements(1_000));
        group.bench_with_input(BenchmarkId::from_parameter(pending), &pending, |b, pending| {
            let mut queue = EventQueue::new();
            (0..*pending).for_each(|i| queue.schedule(Time(mix(i) % 100_000), Phase::Work, [i; 12]));
            b.iter(|| hold(&mut queue, 1_000));
        });
    }
    group.finish();
}

criterion_group!(benches, event_queue);
criterion_main!(benches);
