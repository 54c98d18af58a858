//! The fast ring and the reference model give the same times for all traffic.

use crate::support::{Receiver, Stepped, Times, run_fast, run_prepared};
use proptest::prelude::*;
use pxpl5_ring::reference::{CarriedMessage, Elastic, PlannedMessage, SteppedRing};
use pxpl5_ring::{Ring, RingError, RingTiming};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::NodeId;

#[derive(Clone, Debug)]
struct RingCase {
    timing: RingTiming,
    tick: Span,
    receivers: Vec<Receiver>,
    traffic: Vec<PlannedMessage>,
}

/// Returns random transfers. Each transfer has up to four messages to one destination. All messages except the last
/// have the flag `hold`.
fn transfers(n_nodes: u16, tick: Span) -> impl Strategy<Value = Vec<PlannedMessage>> {
    let words = prop_oneof![8 => 1u32..40, 2 => 40u32..200, 1 => Just(1_024u32)];
    let transfer = (0u64..600, 0..n_nodes, 0..n_nodes, words, 1usize..5);
    prop::collection::vec(transfer, 1..30).prop_map(move |transfers| {
        let mut traffic: Vec<_> = transfers.iter().flat_map(|t| parts(t, tick)).collect();
        traffic.sort_by_key(|t| t.at);
        traffic
    })
}

fn parts(transfer: &(u64, u16, u16, u32, usize), tick: Span) -> Vec<PlannedMessage> {
    let (at, source, destination, words, n) = *transfer;
    let source = NodeId(source);
    let destination = NodeId(destination);
    (0..n).map(|i| PlannedMessage { at: Time::ZERO + tick * at, source, destination, words, hold: i + 1 < n }).collect()
}

fn receiver(tick: Span) -> impl Strategy<Value = Receiver> {
    let fifo = (1usize..60, 0u64..30, 0u64..400, 1u64..900).prop_map(move |(words, drain, opens, answers)| {
        Receiver::Fifo { words, drain: tick * drain, opens_after: tick * opens, answers_after: tick * answers }
    });
    prop_oneof![Just(Receiver::Elastic), fifo]
}

/// Returns random cases. Hops are short compared with the overhead, so that the words of two messages never overlap at
/// a receiver.
fn cases() -> impl Strategy<Value = RingCase> {
    (2u16..20, (1u64..=8, 1u64..=8, 1u64..=8), 16u64..20, 0u64..3, prop_oneof![Just(1u64), Just(2), Just(5)])
        .prop_flat_map(
            |(n_nodes, (channels, source_channels, fifo_channels), overhead_words, hop_ticks, word_ticks)| {
                let tick = Span::from_ns(10);
                let timing = RingTiming {
                    word_ns: 10 * word_ticks,
                    signal_ns: 10,
                    overhead_words,
                    hop_ns: 10 * hop_ticks * u64::from(hop_ticks * u64::from(n_nodes) <= 16 * word_ticks),
                    channels,
                    source_channels,
                    fifo_channels,
                };
                let receivers = prop::collection::vec(receiver(tick), usize::from(n_nodes));
                (receivers, transfers(n_nodes, tick)).prop_map(move |(receivers, traffic)| RingCase {
                    timing,
                    tick,
                    receivers,
                    traffic,
                })
            },
        )
}

fn step(case: &RingCase) -> Vec<CarriedMessage> {
    let receivers = Stepped::new(&case.receivers);
    let n_nodes = case.receivers.len() as u16;
    let ring = SteppedRing::new(case.timing, n_nodes, &case.traffic, receivers).expect("valid");
    ring.run(case.tick, Time(1_000_000_000_000)).expect("everything is delivered")
}

/// Returns the time of the answer to the sender. The answer comes with the last word, but at least one word time after
/// the receiver's answer.
fn notified_at(case: &RingCase, message: usize, message_carried: &CarriedMessage) -> Time {
    let t = case.traffic[message];
    match case.receivers[usize::from(t.destination.0)] {
        Receiver::Elastic => message_carried.last_word_at,
        Receiver::Fifo { answers_after, .. } => {
            let latency = case.timing.latency(t.source, t.destination, case.receivers.len() as u16);
            let answered = message_carried.granted + case.timing.word() + latency + answers_after;
            message_carried.last_word_at.max(answered + case.timing.word())
        }
    }
}

fn compare(case: &RingCase, carried: &[CarriedMessage], ring: &Ring, times: &Times) -> Result<(), TestCaseError> {
    prop_assert_eq!(ring.refusals().count, 0);
    prop_assert!(ring.is_idle());
    prop_assert_eq!(times.accepted.len(), case.traffic.len());
    for (message, message_carried) in carried.iter().enumerate() {
        let number = message as u64;
        prop_assert_eq!(times.accepted[&number], message_carried.last_word_at, "message {}", message);
        prop_assert_eq!(times.sent[&number], notified_at(case, message, message_carried), "message {}", message);
    }
    compare_sums(case, carried, ring)
}

fn compare_sums(case: &RingCase, carried: &[CarriedMessage], ring: &Ring) -> Result<(), TestCaseError> {
    for (channel, busy) in ring.stats().channel_busy.iter().enumerate() {
        let on_channel = carried.iter().filter(|message_carried| message_carried.channel == channel);
        let slots: Span = on_channel.map(|message_carried| message_carried.released - message_carried.granted).sum();
        prop_assert_eq!(*busy, slots, "channel {}", channel);
    }
    let waited: Span =
        carried.iter().zip(&case.traffic).map(|(message_carried, planned)| message_carried.granted - planned.at).sum();
    prop_assert_eq!(ring.stats().waiting, waited);
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn the_closed_form_agrees_with_word_by_word_transfer_to_the_picosecond(case in cases(), seed in any::<u64>()) {
        let carried = step(&case);
        let ways: [fn(&mut Ring); 3] = [|_| {}, Ring::watch, Ring::move_every_word];
        for prepare in ways {
            let (ring, times) = run_prepared(case.timing, &case.receivers, &case.traffic, Some(seed), prepare);
            compare(&case, &carried, &ring, &times)?;
        }
    }

    #[test]
    fn the_order_of_simultaneous_events_changes_no_time(case in cases(), seeds in any::<[u64; 4]>()) {
        let (_, times) = run_fast(case.timing, &case.receivers, &case.traffic, None);
        for seed in seeds {
            let (_, shuffled) = run_fast(case.timing, &case.receivers, &case.traffic, Some(seed));
            prop_assert_eq!(&shuffled, &times);
        }
    }
}

fn planned(at_ns: u64, source: u16, destination: u16, words: u32) -> PlannedMessage {
    let (source, destination) = (NodeId(source), NodeId(destination));
    PlannedMessage { at: Time::ZERO + Span::from_ns(at_ns), source, destination, words, hold: false }
}

/// Runs messages between elastic receivers on the reference model.
fn elastic(traffic: &[PlannedMessage], tick: Span, until_ns: u64) -> Result<Vec<CarriedMessage>, RingError> {
    let ring = SteppedRing::new(RingTiming::PAPERS, 20, traffic, Elastic).expect("valid");
    ring.run(tick, Time::ZERO + Span::from_ns(until_ns))
}

/// Sends seven messages to elastic receivers at once. The ring also has receivers with a FIFO, whose messages may use
/// only six channels.
#[test]
fn in_the_reference_model_elastic_receivers_accept_each_word_on_arrival() {
    let traffic: Vec<_> = (0..7).map(|i| planned(3_000, 2 * i, 2 * i + 1, 100)).collect();
    let carried = elastic(&traffic, Span::from_ns(50), 100_000).expect("delivered");
    let end = Time::ZERO + Span::from_ns(3_000 + (16 + 100) * 50);
    for (channel, message) in carried.iter().enumerate() {
        let granted = Time::ZERO + Span::from_ns(3_000);
        let last_word_at = end + Span::from_ns(50);
        assert_eq!(*message, CarriedMessage { channel, granted, last_word_at, released: end });
    }
}

#[test]
fn the_reference_model_delivers_only_messages_that_end_by_the_end_time() {
    let traffic = [planned(0, 0, 1, 10), planned(3_000, 2, 3, 10)];
    let tick = Span::from_ns(50);
    let end_ns = 3_000 + (16 + 10) * 50;
    assert!(elastic(&traffic, tick, end_ns).is_ok());
    let until = Time::ZERO + Span::from_ns(end_ns - 50);
    assert_eq!(elastic(&traffic, tick, end_ns - 50), Err(RingError::Unfinished { delivered: 1, of: 2, until }));
}

#[test]
fn the_reference_model_refuses_times_that_are_no_multiple_of_the_tick() {
    let traffic = [planned(3_010, 0, 1, 10)];
    let off = |what, found_ps, tick| Err(RingError::OffTick { what, found_ps, tick });
    let long = Span::from_ns(20);
    assert_eq!(elastic(&traffic, long, 100_000), off("word_ns", 50_000, long));
    assert_eq!(elastic(&traffic, Span::ZERO, 100_000), off("word_ns", 50_000, Span::ZERO));
    let word = Span::from_ns(50);
    assert_eq!(elastic(&traffic, word, 100_000), off("the time of a message", 3_010_000, word));
    assert!(elastic(&traffic, Span::from_ns(10), 100_000).is_ok());
}

/// 20 boards send to their neighbours at once and occupy all eight channels. Random traffic seldom does this for long.
#[test]
fn both_models_agree_if_twenty_messages_request_eight_channels_at_once() {
    let tick = Span::from_ns(50);
    let traffic: Vec<_> = (0..20).flat_map(|node| parts(&(3, node, (node + 1) % 20, 1_024, 3), tick)).collect();
    let timing = RingTiming { hop_ns: 0, ..RingTiming::PAPERS };
    let case = RingCase { timing, tick, receivers: vec![Receiver::Elastic; 20], traffic };
    let (ring, times) = run_fast(case.timing, &case.receivers, &case.traffic, None);
    let carried = step(&case);
    assert!(carried.iter().zip(0u64..).all(|(message_carried, i)| times.accepted[&i] == message_carried.last_word_at));
    // 60 messages of 52 us on 8 channels take seven full rounds, and an eighth round with four messages.
    let last = times.accepted.values().max().expect("some");
    assert_eq!(*last, Time::ZERO + tick * 3 + Span::from_us(8 * 52));
    assert_eq!(ring.stats().channel_busy[7], Span::from_us(7 * 52));
}
