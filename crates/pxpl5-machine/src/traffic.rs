//! Records of ring messages and of the words in renderers' FIFOs. Recording is optional and changes no simulated time.

use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Message, NodeId};
use std::collections::BTreeMap;

/// A message that crossed the ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Transfer {
    /// Port of the sender.
    pub source: NodeId,
    /// Port of the receiver.
    pub destination: NodeId,
    /// Length of the message in words of 32 bits, without the overhead of the ring.
    pub words: u32,
    /// Arrival of the first word at the receiver.
    pub begin: Time,
    /// Time at which the receiver finished taking the last word.
    pub end: Time,
}

/// Messages, and changes in the use of channels and FIFOs, recorded during a run.
#[derive(Clone, Debug, Default)]
pub struct Traffic {
    /// Messages, in the order of their ends.
    pub transfers: Vec<Transfer>,
    /// Number of occupied channels after each change. A channel is occupied during overhead and stalls too.
    pub busy_channels: Vec<(Time, u32)>,
    /// Changes of the renderers' FIFOs: index of the renderer, time, and change in words.
    ///
    /// A command adds its words when its last word arrives, and removes its words when its execution starts.
    pub fifo_changes: Vec<(usize, Time, i64)>,
    /// Messages whose first word has arrived at a renderer and whose last word has not, by the renderer's port.
    announced: BTreeMap<NodeId, Transfer>,
}

impl Traffic {
    /// Returns the number of words in a renderer's FIFO after each change. Only complete commands count.
    pub fn fifo_words(&self, renderer: usize) -> Vec<(Time, i64)> {
        let of = self.fifo_changes.iter().filter(|change| change.0 == renderer);
        let mut changes: BTreeMap<Time, i64> = BTreeMap::new();
        of.for_each(|(_, time, words)| *changes.entry(*time).or_default() += words);
        let mut held = 0;
        let sums = changes.into_iter().filter(|(_, words)| *words != 0).map(|(time, words)| {
            held += words;
            (time, held)
        });
        sums.collect()
    }

    /// Returns the number of messages and changes in memory.
    pub fn records(&self) -> usize {
        self.transfers.len() + self.busy_channels.len() + self.fifo_changes.len()
    }

    /// Discards the records before `instant`. The number of occupied channels and the words in FIFOs at this instant
    /// are kept.
    pub(crate) fn discard_before(&mut self, instant: Time) {
        self.transfers.retain(|transfer| transfer.end >= instant);
        let last = self.busy_channels.partition_point(|(time, _)| *time < instant).saturating_sub(1);
        self.busy_channels.drain(..last);
        let mut held: BTreeMap<usize, i64> = BTreeMap::new();
        let old = self.fifo_changes.iter().filter(|change| change.1 < instant);
        old.for_each(|(renderer, _, words)| *held.entry(*renderer).or_default() += words);
        self.fifo_changes.retain(|change| change.1 >= instant);
        let before = Time(instant.0.saturating_sub(1));
        let held = held.into_iter().filter(|(_, words)| *words != 0);
        self.fifo_changes.splice(..0, held.map(|(renderer, words)| (renderer, before, words)));
    }

    pub(crate) fn channels(&mut self, time: Time, busy: u32) {
        match self.busy_channels.last_mut() {
            Some(last) if last.1 == busy => {}
            Some(last) if last.0 == time => last.1 = busy,
            _ => self.busy_channels.push((time, busy)),
        }
    }

    pub(crate) fn announce(&mut self, message: &Message, begin: Time) {
        self.announced.insert(message.destination, transfer(message, begin, begin));
    }

    pub(crate) fn accept(&mut self, destination: NodeId, end: Time) {
        let announced = self.announced.remove(&destination);
        self.transfers.extend(announced.map(|transfer| Transfer { end, ..transfer }));
    }

    /// Records a message whose words arrive without a gap. `end` is the arrival of the last word, and `word` is the
    /// time of one word.
    pub(crate) fn deliver(&mut self, message: &Message, end: Time, word: Span) {
        let begin = Time(end.0.saturating_sub((word * u64::from(message.words)).0));
        self.transfers.push(transfer(message, begin, end));
    }
}

fn transfer(message: &Message, begin: Time, end: Time) -> Transfer {
    Transfer { source: message.source, destination: message.destination, words: message.words, begin, end }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(words: u32) -> Message {
        let body = pxpl5_wire::Body::Words([0].into());
        Message { source: NodeId(1), destination: NodeId(2), words, body }
    }

    #[test]
    fn words_of_a_message_arrive_in_sequence_until_its_end() {
        let mut traffic = Traffic::default();
        traffic.deliver(&message(4), Time(1_000), Span(50));
        assert_eq!((traffic.transfers[0].begin, traffic.transfers[0].end), (Time(800), Time(1_000)));
    }

    #[test]
    fn a_message_to_a_fifo_is_a_transfer_when_it_was_accepted() {
        let mut traffic = Traffic::default();
        traffic.announce(&message(4), Time(800));
        assert_eq!(traffic.records(), 0, "it is on its way");
        traffic.accept(NodeId(3), Time(900));
        traffic.accept(NodeId(2), Time(1_100));
        traffic.accept(NodeId(2), Time(1_200));
        let expected = transfer(&message(4), Time(800), Time(1_100));
        assert_eq!(traffic.transfers, [expected], "of its receiver, and once");
        assert_eq!((expected.source, expected.destination, expected.words), (NodeId(1), NodeId(2), 4));
    }

    /// Returns the value at `instant` from a list of changes, or `None` before the first change.
    fn at<T: Copy>(history: &[(Time, T)], instant: u64) -> Option<T> {
        history.iter().rev().find(|(time, _)| time.0 <= instant).map(|(_, state)| *state)
    }

    proptest::proptest! {
        #[test]
        fn busy_channels_are_recorded_when_their_number_changes(
            periods in proptest::collection::vec((0u64..3, 0u32..3), 1..20),
        ) {
            let mut traffic = Traffic::default();
            let mut now = 0;
            let mut all = Vec::new();
            for (wait, busy) in periods {
                now += wait;
                all.push((Time(now), busy));
                traffic.channels(Time(now), busy);
            }
            (0..=now).for_each(|instant| assert_eq!(at(&traffic.busy_channels, instant), at(&all, instant)));
            assert!(traffic.busy_channels.is_sorted_by(|a, b| a.0 < b.0), "{:?}", traffic.busy_channels);
            let changes = all.windows(2).filter(|pair| pair[0].1 != pair[1].1).count();
            assert!(traffic.busy_channels.len() <= 1 + changes, "{all:?}: {:?}", traffic.busy_channels);
        }

        #[test]
        fn discarding_keeps_the_records_from_an_instant_on(
            busy in proptest::collection::btree_map(0u64..40, 0u32..9, 1..20),
            changes in proptest::collection::vec((0usize..2, 0u64..40, -9i64..9), 0..20),
            ends in proptest::collection::vec(0u64..40, 0..9),
            instant in 1u64..40,
        ) {
            let mut traffic = Traffic {
                transfers: ends.iter().map(|end| transfer(&message(1), Time::ZERO, Time(*end))).collect(),
                busy_channels: busy.into_iter().map(|(time, busy)| (Time(time), busy)).collect(),
                fifo_changes: changes.into_iter().map(|(renderer, time, words)| (renderer, Time(time), words)).collect(),
                announced: BTreeMap::new(),
            };
            let before = traffic.clone();
            traffic.discard_before(Time(instant));
            assert_eq!(traffic.transfers.len(), ends.iter().filter(|end| **end >= instant).count());
            assert_eq!(
                traffic.records(),
                traffic.transfers.len() + traffic.busy_channels.len() + traffic.fifo_changes.len()
            );
            for later in instant..40 {
                assert_eq!(at(&traffic.busy_channels, later), at(&before.busy_channels, later));
                for renderer in 0..2 {
                    let held = |traffic: &Traffic| -> i64 {
                        let of = traffic.fifo_changes.iter().filter(|(of, time, _)| *of == renderer && time.0 <= later);
                        of.map(|(_, _, words)| words).sum()
                    };
                    assert_eq!(held(&traffic), held(&before));
                    assert_eq!(at(&traffic.fifo_words(renderer), later).unwrap_or(0), held(&before));
                }
            }
            let old = traffic.fifo_changes.iter().filter(|(_, time, _)| time.0 < instant).count();
            assert!(old <= 2, "a renderer's words in one number");
            assert!(traffic.fifo_changes.iter().all(|(_, time, words)| time.0 >= instant || *words != 0));
            assert!(traffic.busy_channels.iter().filter(|(time, _)| time.0 < instant).count() <= 1);
        }
    }
}
