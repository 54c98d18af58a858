//! Tests of each rule of the ring. Expected values are published figures or sums of the timing table.

use crate::support::{ELASTIC, Receiver, message, request, run_fast};
use pxpl5_ring::reference::PlannedMessage;
use pxpl5_ring::{ChannelSnapshot, Request, Ring, RingError, RingEvent, RingOutput, RingTiming, WaitReason};
use pxpl5_sim::{Context, Phase, Span, TestBench, Time};
use pxpl5_wire::{MAX_MESSAGE_WORDS, NodeId};
use std::collections::BTreeMap;

const TIMING: RingTiming = RingTiming::PAPERS;
/// A timing table in which each port sends one message at a time. Some rules are easier to test with this table.
const ONE_AT_A_TIME: RingTiming = RingTiming { source_channels: 1, ..TIMING };
/// Occupancy of a message of maximum size: (16 + 1,024) x 50 ns.
const FULL: Span = Span::from_us(52);
const HOP: Span = Span::from_ns(50);

fn us(us: u64) -> Time {
    Time::ZERO + Span::from_us(us)
}

fn traffic(at: Time, source: u16, destination: u16, words: u32) -> PlannedMessage {
    PlannedMessage { at, source: NodeId(source), destination: NodeId(destination), words, hold: false }
}

/// Returns the fifteen held messages of a region of 15,360 pixels.
fn region(at: Time, source: u16, destination: u16) -> impl Iterator<Item = PlannedMessage> {
    let part = traffic(at, source, destination, MAX_MESSAGE_WORDS);
    (0..15).map(move |i| PlannedMessage { hold: i < 14, ..part })
}

fn accepted(traffic: &[PlannedMessage]) -> Vec<Time> {
    let (_, times) = run_fast(TIMING, &ELASTIC[..20], traffic, Some(7));
    times.accepted.into_values().collect()
}

fn bench() -> TestBench<RingEvent, RingOutput> {
    TestBench::new()
}

/// Makes a ring of ten ports. Only port 9 is not elastic.
fn ring_with_a_fifo() -> Ring {
    Ring::new(ONE_AT_A_TIME, 10, |node| node != NodeId(9)).expect("valid")
}

#[test]
fn a_message_has_arrived_after_its_overhead_its_words_and_its_hops() {
    let times = accepted(&[traffic(us(3), 2, 5, 100)]);
    assert_eq!(times, [us(3) + Span::from_ns((16 + 100) * 50) + HOP * 3]);
}

#[test]
fn a_region_of_fifteen_messages_takes_the_published_780_us() {
    let messages: Vec<_> = region(us(0), 0, 1).collect();
    let times = accepted(&messages);
    assert_eq!(*times.last().expect("15"), us(780) + HOP);
    let gaps: Vec<_> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    assert_eq!(gaps, [FULL; 14]);
}

/// TR94: five renderers copy 20 field regions to two frame buffers. Each renderer alternates between left and right. At
/// the start and at the end, one frame buffer idles for one region time.
#[test]
fn twenty_regions_to_two_frame_buffers_take_eleven_region_times() {
    let mut messages = Vec::new();
    for renderer in 0..5 {
        for turn in 0..4 {
            messages.extend(region(us(0), renderer, 5 + turn % 2));
        }
    }
    // A renderer copies one region at a time, so its port sends one message at a time.
    let (ring, times) = run_fast(ONE_AT_A_TIME, &ELASTIC[..7], &messages, Some(1));
    let last = times.accepted.into_values().max().expect("some");
    let longest_way = HOP * 6;
    assert!(last >= us(11 * 780) && last <= us(11 * 780) + longest_way, "{last}");
    assert_eq!(ring.stats().messages, 300);
    assert_eq!(ring.stats().words, 20 * 15_360);
}

#[test]
fn the_ninth_message_waits_until_a_channel_is_free_and_not_a_picosecond_longer() {
    let messages: Vec<_> = (0..9).map(|i| traffic(us(0), 2 * i, 2 * i + 1, MAX_MESSAGE_WORDS)).collect();
    let times = accepted(&messages);
    assert_eq!(times[..8], [us(52) + HOP; 8]);
    assert_eq!(times[8], us(104) + HOP);
}

#[test]
fn full_fifos_leave_channels_for_messages_of_their_boards() {
    // Ports 0 to 7 accept no word before 400 us. A message from port 10 to port 11 comes a microsecond later.
    let shut = Receiver::Fifo {
        words: 1,
        drain: Span::ZERO,
        opens_after: Span::from_us(400),
        answers_after: Span::from_us(1),
    };
    let receivers: Vec<_> = (0..24).map(|port| if port < 8 { shut } else { Receiver::Elastic }).collect();
    let mut messages: Vec<_> = (0..8).map(|port| traffic(us(0), 12 + port, port, 10)).collect();
    messages.push(traffic(us(1), 10, 11, 1_024));
    let (_, times) = run_fast(TIMING, &receivers, &messages, Some(3));
    assert_eq!(times.accepted[&8], us(1 + 52) + HOP);
    // Six messages wait for their receivers, and the other two for a channel.
    let late = times.accepted.values().filter(|time| **time > us(800)).count();
    assert_eq!(late, 2);
}

#[test]
fn sending_does_not_disturb_receiving() {
    let times = accepted(&[traffic(us(0), 0, 1, 1_000), traffic(us(0), 1, 0, 1_000)]);
    let occupied = Span::from_ns(1_016 * 50);
    assert_eq!(times, [us(0) + occupied + HOP, us(0) + occupied + HOP * 19]);
}

#[test]
fn a_source_can_send_to_several_destinations_and_a_destination_receives_from_one_source_at_a_time() {
    let from_one = accepted(&[traffic(us(0), 0, 1, 1_024), traffic(us(0), 0, 2, 1_024)]);
    assert_eq!(from_one, [us(52) + HOP, us(52) + HOP * 2]);
    let to_one = accepted(&[traffic(us(0), 0, 2, 1_024), traffic(us(0), 1, 2, 1_024)]);
    assert_eq!(to_one, [us(52) + HOP * 2, us(104) + HOP]);
}

#[test]
fn waiting_messages_go_in_order_of_arrival_then_of_source_number() {
    let busy = traffic(us(0), 9, 3, 1_024);
    let first_come = accepted(&[busy, traffic(us(2), 1, 3, 1_024), traffic(us(1), 2, 3, 1_024)]);
    assert_eq!(first_come[1..], [us(156) + HOP * 2, us(104) + HOP]);
    let together = accepted(&[busy, traffic(us(1), 2, 3, 1_024), traffic(us(1), 1, 3, 1_024)]);
    assert_eq!(together[1..], [us(156) + HOP, us(104) + HOP * 2]);
}

/// Port 0 requests port 3 earlier than port 1 does. However, port 0 must first send another message, and this message
/// has to wait.
#[test]
fn a_message_queues_for_its_destination_once_it_is_first_at_its_source() {
    let times = accepted(&[
        traffic(us(0), 9, 3, 1_024),
        traffic(us(0), 8, 5, 1_000),
        traffic(us(1), 0, 5, 100),
        traffic(us(1), 0, 3, 1_024),
        traffic(us(2), 1, 3, 1_024),
    ]);
    assert_eq!(times[4], us(104) + HOP * 2);
    assert_eq!(times[3], us(156) + HOP * 3);
}

#[test]
fn a_waiting_message_does_not_delay_a_later_message_to_another_destination() {
    let times = accepted(&[traffic(us(0), 0, 3, 1_024), traffic(us(1), 1, 3, 1_024), traffic(us(2), 2, 4, 1_024)]);
    assert_eq!(times[2], us(54) + HOP * 2);
}

#[test]
fn messages_of_one_source_at_one_instant_keep_their_order() {
    let mut bench = bench();
    let mut ring = ring_with_a_fifo();
    for number in [2, 0, 1] {
        bench.feed(us(0), Phase::Arrive, RingEvent::Request(request(number, 0, 1, 1_024)));
    }
    bench.run(|event, context| ring.handle(event, context));
    let mut sent: Vec<_> = bench
        .outputs
        .iter()
        .filter_map(|(time, output)| match output {
            RingOutput::Sent { ticket, .. } => Some((*time, *ticket)),
            _ => None,
        })
        .collect();
    sent.sort_unstable();
    assert_eq!(sent, [(us(52) + HOP, 0), (us(104) + HOP, 1), (us(156) + HOP, 2)]);
}

#[test]
fn a_reserved_destination_serves_its_source_and_after_release_the_first_waiting_request() {
    let hold = PlannedMessage { hold: true, ..traffic(us(0), 0, 2, 1_024) };
    let end_of_transfer = traffic(us(100), 0, 2, 1_024);
    let other = traffic(us(1), 1, 2, 1_024);
    let times = accepted(&[hold, end_of_transfer, other]);
    assert_eq!(times, [us(52) + HOP * 2, us(152) + HOP * 2, us(204) + HOP]);
}

/// Returns the time of an output that answers a sender, or `None` for other outputs.
fn sent_at(output: &(Time, RingOutput)) -> Option<Time> {
    match output {
        (time, RingOutput::Sent { .. }) => Some(*time),
        _ => None,
    }
}

#[test]
fn a_receiver_with_a_fifo_is_notified_before_the_first_word_and_its_answer_ends_the_message() {
    let mut bench = bench();
    let mut ring = ring_with_a_fifo();
    bench.feed(us(0), Phase::Arrive, RingEvent::Request(request(1, 0, 9, 100)));
    bench.feed(us(0), Phase::Arrive, RingEvent::Request(request(2, 0, 1, 100)));
    bench.run(|event, context| ring.handle(event, context));
    let [(announced, RingOutput::Announce { first_word_at, word, .. })] = bench.outputs[..] else {
        panic!("{:?}", bench.outputs)
    };
    let latency = HOP * 9;
    assert_eq!(announced, us(0) + word + latency);
    assert_eq!(first_word_at, us(0) + word * 16 + latency);
    assert_eq!(ring.waiting()[0].reason, WaitReason::Acceptance);

    let stall = Span::from_ns(12_345);
    let last_word_at = first_word_at + word * 100 + stall;
    let accept = RingEvent::Accept { destination: NodeId(9), last_word_at };
    bench.feed(us(2), Phase::Arrive, accept);
    bench.run(|event, context| ring.handle(event, context));
    assert_eq!(sent_at(&bench.outputs[1]), Some(last_word_at));
    let released = us(0) + word * 116 + stall;
    assert_eq!(sent_at(&bench.outputs[3]), Some(released + word * 116 + HOP));
    assert_eq!(ring.stats().stalled, stall);
}

/// A snapshot shows a message on its channel from the grant to the end of its last word's slot. Before the receiver's
/// answer, the snapshot has no end.
#[test]
fn a_snapshot_shows_a_message_on_its_channel_until_the_message_ends() {
    let mut bench = bench();
    let mut ring = ring_with_a_fifo();
    bench.feed(us(1), Phase::Arrive, RingEvent::Request(request(1, 4, 9, 100)));
    bench.run(|event, context| ring.handle(event, context));
    let (source, destination) = (NodeId(4), NodeId(9));
    let begun = ChannelSnapshot { channel: 0, source, destination, words: 100, granted: us(1), ends_at: None };
    assert_eq!(ring.channel_snapshots(us(1)).collect::<Vec<_>>(), [begun]);
    assert_eq!(
        ring.channel_snapshots(us(900)).collect::<Vec<_>>(),
        [begun],
        "the time at which the receiver has room is not known"
    );

    let end = us(1) + Span::from_ns((16 + 100) * 50);
    let accept = RingEvent::Accept { destination, last_word_at: end + HOP * 5 };
    bench.feed(us(2), Phase::Arrive, accept);
    let mut seen = Vec::new();
    bench.run(|event, context| {
        ring.handle(event, context);
        // This is the first event after the answer.
        if seen.is_empty() {
            seen = [us(2), Time(end.0 - 1), end, us(900)]
                .map(|at| ring.channel_snapshots(at).collect::<Vec<_>>())
                .to_vec();
        }
    });
    let answered = vec![ChannelSnapshot { ends_at: Some(end), ..begun }];
    assert_eq!(seen, [answered.clone(), answered, Vec::new(), Vec::new()]);
}

/// Returns the number of events of a ring that carries a message of a hundred words.
fn events_of_a_message(prepare: fn(&mut Ring)) -> usize {
    let mut bench = bench();
    let mut ring = ring_with_a_fifo();
    prepare(&mut ring);
    bench.feed(us(0), Phase::Arrive, RingEvent::Request(request(1, 0, 1, 100)));
    let mut events = 0;
    bench.run(|event, context| {
        events += 1;
        ring.handle(event, context);
    });
    events
}

#[test]
fn a_message_needs_a_few_events_and_word_by_word_transfer_adds_one_event_for_each_slot() {
    let slots = 16 + 100;
    let [few, all] = [events_of_a_message(|_| {}), events_of_a_message(Ring::move_every_word)];
    assert!(few < 4, "{few} events of a message as a whole");
    assert_eq!(all, few + slots);
}

#[test]
fn an_answer_that_comes_after_the_last_word_frees_the_sender_at_once() {
    let mut bench = bench();
    let mut ring = ring_with_a_fifo();
    bench.feed(us(0), Phase::Arrive, RingEvent::Request(request(1, 8, 9, 10)));
    let earliest = us(0) + Span::from_ns(26 * 50) + HOP;
    bench.feed(us(30), Phase::Arrive, RingEvent::Accept { destination: NodeId(9), last_word_at: earliest });
    bench.run(|event, context| ring.handle(event, context));
    assert!(matches!(bench.outputs[1], (time, RingOutput::Sent { .. }) if time == us(30) + Span::from_ns(50)));
    assert_eq!(ring.stats().channel_busy[0], Span::from_us(30));
    assert_eq!(ring.refusals().count, 0);
}

#[test]
fn a_message_too_long_for_the_ring_is_refused_and_its_sender_notified() {
    let mut bench = bench();
    let mut ring = ring_with_a_fifo();
    for (number, (source, destination, words)) in (0..).zip([(0, 1, 0), (0, 1, 1_025), (10, 1, 5), (0, 10, 5)]) {
        bench.feed(us(number), Phase::Arrive, RingEvent::Request(request(number, source, destination, words)));
    }
    bench.run(|event, context| ring.handle(event, context));
    let refused = bench.outputs.iter().filter(|(_, output)| matches!(output, RingOutput::Refused { .. })).count();
    assert_eq!((refused, bench.outputs.len()), (4, 4));
    assert_eq!(ring.refusals().count, 4);
    let (time, error) = ring.refusals().first.clone().expect("refused");
    assert_eq!(time, us(0));
    assert_eq!(error.to_string(), "message from ring port 0 to 1: expected 1 to 1024 words, found 0");
    assert_eq!(ring.check(&message(0, 0, 10, 5)), Err(RingError::NoSuchNode { node: NodeId(10), n_nodes: 10 }));
    assert!(ring.is_idle());
}

#[test]
fn an_answer_to_nothing_and_an_impossible_answer_are_faults_without_a_panic() {
    let mut bench = bench();
    let mut ring = ring_with_a_fifo();
    for destination in [9, 1, 500] {
        let accept = RingEvent::Accept { destination: NodeId(destination), last_word_at: us(1) };
        bench.feed(us(0), Phase::Arrive, accept);
    }
    bench.run(|event, context| ring.handle(event, context));
    assert_eq!(ring.refusals().count, 3);

    bench.feed(us(1), Phase::Arrive, RingEvent::Request(request(1, 8, 9, 10)));
    bench.feed(us(2), Phase::Arrive, RingEvent::Accept { destination: NodeId(9), last_word_at: us(2) });
    bench.run(|event, context| ring.handle(event, context));
    assert_eq!(ring.refusals().count, 4);
    let earliest = us(1) + Span::from_ns(26 * 50) + HOP;
    assert!(matches!(bench.outputs[1], (time, RingOutput::Sent { .. }) if time == earliest));
}

#[test]
fn a_deadlock_report_names_each_waiting_board_and_the_cause() {
    let mut bench = bench();
    let mut ring = ring_with_a_fifo();
    let mut held = request(1, 0, 1, 10);
    held.hold = true;
    bench.feed(us(0), Phase::Arrive, RingEvent::Request(held));
    bench.feed(us(5), Phase::Arrive, RingEvent::Request(request(2, 2, 1, 20)));
    bench.feed(us(6), Phase::Arrive, RingEvent::Request(request(3, 3, 9, 30)));
    bench.feed(us(7), Phase::Arrive, RingEvent::Request(request(4, 4, 9, 40)));
    bench.run(|event, context| ring.handle(event, context));
    let name = |node: NodeId| format!("port {}", node.0);
    let waiting = ring.waiting();
    let lines: Vec<_> =
        waiting.iter().map(|wait| format!("{} waits for {}", name(wait.source), wait.waits_for(name))).collect();
    let on: Vec<_> = waiting.iter().map(pxpl5_ring::WaitingMessage::waits_on).collect();
    assert_eq!(on, [Some(NodeId(0)), Some(NodeId(9)), Some(NodeId(3))], "the port that must act");
    assert_eq!(
        lines,
        [
            "port 2 waits for port 1, reserved for an unfinished transfer of port 0, to take 20 words since 5.000000 us",
            "port 3 waits for port 9 to accept 30 words sent since 6.000000 us",
            "port 4 waits for port 9, busy with port 3, to take 40 words since 7.000000 us",
        ]
    );
}

#[test]
fn a_ring_that_cannot_be_built_is_refused_with_the_reason() {
    let none = Ring::new(TIMING, 0, |_| true).expect_err("no ports");
    assert_eq!(none.to_string(), "a ring needs one port at least, found none");
    let no_channels = RingTiming { channels: 0, ..TIMING };
    let error = Ring::new(no_channels, 3, |_| true).expect_err("no channels");
    assert_eq!(error.to_string(), "ring timing: channels must be 1 to 64, found 0");
}

/// Makes a ring of ten ports. Ports 8 and 9 are not elastic and share one channel.
fn ring_with_two_fifos() -> Ring {
    let timing = RingTiming { fifo_channels: 1, ..TIMING };
    Ring::new(timing, 10, |node| node.0 < 8).expect("valid")
}

fn reasons(ring: &Ring) -> Vec<(u16, WaitReason)> {
    ring.waiting().iter().map(|message| (message.source.0, message.reason)).collect()
}

fn announced_to(outputs: &[(Time, RingOutput)], port: u16) -> Vec<Time> {
    let to_port = outputs.iter().filter(
        |(_, output)| matches!(output, RingOutput::Announce { message, .. } if message.destination == NodeId(port)),
    );
    to_port.map(|(time, _)| *time).collect()
}

#[test]
fn a_message_to_a_fifo_waits_for_a_channel_until_another_to_a_fifo_has_ended() {
    let mut bench = bench();
    let mut ring = ring_with_two_fifos();
    for (number, source, destination) in [(1, 0, 9), (2, 1, 8), (3, 2, 3)] {
        bench.feed(us(0), Phase::Arrive, RingEvent::Request(request(number, source, destination, 100)));
    }
    bench.run(|event, context| ring.handle(event, context));
    // The third message has an elastic receiver. Its end therefore frees no channel for the second message.
    assert_eq!(ring.stats().messages, 1);
    assert_eq!(reasons(&ring), [(0, WaitReason::Acceptance), (1, WaitReason::Channel)]);

    let accept = RingEvent::Accept { destination: NodeId(9), last_word_at: us(100) };
    bench.feed(us(100), Phase::Arrive, accept);
    bench.run(|event, context| ring.handle(event, context));
    assert_eq!(announced_to(&bench.outputs, 8), [us(100) + TIMING.word() + HOP * 7]);
}

#[test]
fn a_source_that_reserves_its_destination_waits_only_for_a_channel() {
    let mut bench = bench();
    let mut ring = ring_with_two_fifos();
    let held = Request { hold: true, ..request(1, 0, 9, 10) };
    bench.feed(us(0), Phase::Arrive, RingEvent::Request(held));
    bench.feed(us(1), Phase::Arrive, RingEvent::Request(request(2, 1, 8, 10)));
    bench.feed(us(2), Phase::Arrive, RingEvent::Request(request(3, 0, 9, 10)));
    let accept = RingEvent::Accept { destination: NodeId(9), last_word_at: us(5) };
    bench.feed(us(5), Phase::Arrive, accept);
    bench.run(|event, context| ring.handle(event, context));
    assert_eq!(reasons(&ring), [(0, WaitReason::Channel), (1, WaitReason::Acceptance)]);
}

#[test]
fn an_unobstructed_message_waits_only_for_arbitration() {
    let mut ring = ring_with_two_fifos();
    let mut context = Context::default();
    ring.handle(RingEvent::Request(request(1, 0, 1, 10)), context.at(us(3)));
    assert_eq!(reasons(&ring), [(0, WaitReason::Arbitration)]);
}

#[test]
fn an_observed_ring_counts_busy_channels_after_every_event() {
    let mut bench = bench();
    let mut ring = Ring::new(TIMING, 10, |_| true).expect("valid");
    ring.watch();
    bench.feed(us(0), Phase::Arrive, RingEvent::Request(request(1, 0, 1, 1_024)));
    bench.feed(us(10), Phase::Arrive, RingEvent::Request(request(2, 2, 3, 1_024)));
    let mut busy = BTreeMap::new();
    bench.run(|event, context| {
        ring.handle(event, context);
        busy.insert(context.now(), ring.busy_channels());
    });
    let expected = [(us(0), 1), (us(10), 2), (us(52), 1), (us(62), 0)];
    assert_eq!(busy.into_iter().collect::<Vec<_>>(), expected);
}

#[test]
fn a_ring_is_idle_if_no_message_waits_or_is_on_a_channel() {
    let mut ring = Ring::new(ONE_AT_A_TIME, 10, |_| true).expect("valid");
    let mut bench = bench();
    assert!(ring.is_idle());
    bench.feed(us(1), Phase::Arrive, RingEvent::Request(request(1, 0, 1, 100)));
    let mut was_idle = Vec::new();
    bench.run(|event, context| {
        ring.handle(event, context);
        was_idle.push((context.now(), ring.is_idle()));
    });
    // The message waits for its arbitration, and then occupies its channel for (16 + 100) x 50 ns.
    assert_eq!(was_idle[..2], [(us(1), false), (us(1), false)]);
    ring.settle(us(1) + Span::from_ns(5_800));
    assert!(ring.is_idle());
}
