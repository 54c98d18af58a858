//! A board with one event for the end of its work does everything when a board does that announces every end, whatever interrupts it.

use proptest::prelude::*;
use pxpl5_gp::{Fault, Gp, GpBoard, GpEvent, GpOutput, GpTiming, Priority};
use pxpl5_sim::{Phase, Span, TestBench, Time};
use pxpl5_wire::{Body, Message, NodeId};

const BOARD: NodeId = NodeId(9);

/// Works for each span in turn and sends a message behind each.
async fn foreground(gp: Gp, spans_ns: Vec<u64>) -> Result<(), Fault> {
    for ns in spans_ns {
        gp.spend(Span::from_ns(ns)).await;
        gp.send(NodeId(1), 1, Body::Words([1].into())).await;
    }
    Ok(())
}

/// Works for what each message says.
async fn interrupts(gp: Gp) -> Result<(), Fault> {
    loop {
        let received = gp.receive().await;
        let Body::Words(words) = &received.body else { continue };
        gp.spend(Span::from_ns(u64::from(words[0]))).await;
        gp.send(NodeId(2), 1, received.body).await;
    }
}

/// What a board puts out and when, and the events that it takes; messages of it are accepted 7 ns later.
fn run(every_end: bool, seed: u64, spans_ns: &[u64], messages: &[(u64, u32)]) -> (Vec<(Time, u64)>, u64) {
    let timing = GpTiming { message_ns: 300, ..GpTiming::PAPERS };
    let mut board = GpBoard::new(BOARD, timing, Span(25_000));
    if every_end {
        board.announce_every_end();
    }
    let gp = board.handle_for(Priority::Foreground);
    board.load(Priority::Foreground, Box::pin(foreground(gp, spans_ns.to_vec())));
    let gp = board.handle_for(Priority::Interrupt);
    board.load(Priority::Interrupt, Box::pin(interrupts(gp)));
    let mut bench: TestBench<GpEvent, GpOutput> = TestBench::new();
    bench.queue().shuffle_ties(seed);
    bench.feed(Time::ZERO, Phase::Work, GpEvent::Poll);
    for (at_ns, work_ns) in messages {
        let body = Body::Words([*work_ns].into());
        let message = Message { source: NodeId(3), destination: BOARD, words: 1, body };
        bench.feed(Time(at_ns * 1_000), Phase::Arrive, GpEvent::Delivered(message));
    }
    let mut told = 0;
    let mut sent = Vec::new();
    loop {
        // Up to the next message that leaves, so that its acceptance comes in time.
        while bench.outputs.len() == told {
            let Some(next) = bench.queue().next_time() else {
                return (sent, bench.queue().events_taken());
            };
            bench.run_until(next, |event, context| board.handle(event, context));
        }
        for (time, GpOutput::Send { ticket, .. }) in &bench.outputs[told..] {
            sent.push((*time, *ticket));
        }
        let fresh = sent[told..].to_vec();
        told = bench.outputs.len();
        for (time, ticket) in fresh {
            bench.feed(time + Span(7_000), Phase::Arrive, GpEvent::Accepted(ticket));
        }
    }
}

proptest! {
    #[test]
    fn one_event_for_the_end_of_work_does_what_one_for_every_end_does(
        spans_ns in proptest::collection::vec(0u64..40_000, 1..8),
        messages in proptest::collection::vec((0u64..60_000, 0u32..3_000), 0..30),
        seed in any::<u64>(),
    ) {
        let (sent, events) = run(false, seed, &spans_ns, &messages);
        let (sent_literally, events_literally) = run(true, seed, &spans_ns, &messages);
        prop_assert_eq!(&sent, &sent_literally);
        prop_assert_eq!(sent.len(), spans_ns.len() + messages.len());
        prop_assert!(events <= events_literally, "{} events, {} literally", events, events_literally);
    }
}

#[test]
fn work_that_is_interrupted_ten_times_leaves_one_event_behind_and_not_ten() {
    let messages: Vec<(u64, u32)> = (0..10).map(|i| (1_000 * i + 1_000, 100)).collect();
    let (sent, events) = run(false, 1, &[100_000], &messages);
    let (sent_literally, events_literally) = run(true, 1, &[100_000], &messages);
    assert_eq!(sent, sent_literally);
    // Each of the ten delays of the foreground would announce its end anew; the one that is kept asks once more when it comes.
    assert!(events + 8 <= events_literally, "{events} events, {events_literally} literally");
}
