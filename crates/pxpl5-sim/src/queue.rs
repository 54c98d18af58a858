//! The event queue; its ordering contract stands in the crate's documentation.

use crate::{Time, mix};
use std::cmp::{Ordering, Reverse};
use std::collections::BinaryHeap;

/// The three steps of one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Phase {
    /// Inputs latch.
    Arrive,
    /// Boards act on what was latched.
    Work,
    /// Probes look; they change nothing.
    Observe,
}

#[derive(Debug)]
struct Entry<E> {
    key: (Time, Phase, u64, u64),
    event: E,
}

impl<E> PartialEq for Entry<E> {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

impl<E> Eq for Entry<E> {}

impl<E> PartialOrd for Entry<E> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<E> Ord for Entry<E> {
    fn cmp(&self, other: &Self) -> Ordering {
        self.key.cmp(&other.key)
    }
}

/// Events in order of (time, phase), ties in order of scheduling or shuffled.
#[derive(Debug)]
pub struct EventQueue<E> {
    heap: BinaryHeap<Reverse<Entry<E>>>,
    now: Time,
    sequence: u64,
    shuffle: Option<u64>,
    popped: u64,
}

impl<E> Default for EventQueue<E> {
    fn default() -> Self {
        Self { heap: BinaryHeap::new(), now: Time::ZERO, sequence: 0, shuffle: None, popped: 0 }
    }
}

impl<E> EventQueue<E> {
    /// An empty queue at time zero.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// From now on, events that are scheduled for the same instant and phase come in an order hashed from `seed`.
    pub fn shuffle_ties(&mut self, seed: u64) {
        self.shuffle = Some(seed);
    }

    /// Schedules an event.
    ///
    /// # Panics
    ///
    /// When `time` is in the past: a device has broken the contract.
    pub fn schedule(&mut self, time: Time, phase: Phase, event: E) {
        assert!(time >= self.now, "an event at {time} was scheduled at {}", self.now);
        let tie = self.shuffle.map_or(0, |seed| mix(seed ^ mix(self.sequence)));
        let key = (time, phase, tie, self.sequence);
        self.sequence += 1;
        self.heap.push(Reverse(Entry { key, event }));
    }

    /// Takes the next event and moves the present to it.
    pub fn next_event(&mut self) -> Option<(Time, Phase, E)> {
        let Reverse(entry) = self.heap.pop()?;
        self.now = entry.key.0;
        self.popped += 1;
        Some((entry.key.0, entry.key.1, entry.event))
    }

    /// The time of the next event.
    #[must_use]
    pub fn next_time(&self) -> Option<Time> {
        self.heap.peek().map(|Reverse(entry)| entry.key.0)
    }

    /// The present: the time of the event taken last.
    #[must_use]
    pub const fn now(&self) -> Time {
        self.now
    }

    /// Events taken so far.
    #[must_use]
    pub const fn events_taken(&self) -> u64 {
        self.popped
    }

    /// Events waiting.
    #[must_use]
    pub fn len(&self) -> usize {
        self.heap.len()
    }

    /// Whether nothing waits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.heap.is_empty()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn drain(queue: &mut EventQueue<u32>) -> Vec<u32> {
        std::iter::from_fn(|| queue.next_event()).map(|(_, _, event)| event).collect()
    }

    #[test]
    fn ties_come_in_order_of_scheduling() {
        let mut queue = EventQueue::new();
        (0..100).for_each(|i| queue.schedule(Time(7), Phase::Work, i));
        assert_eq!(drain(&mut queue), (0..100).collect::<Vec<_>>());
    }

    #[test]
    fn shuffled_ties_come_in_another_order_that_the_seed_decides() {
        let order = |seed| {
            let mut queue = EventQueue::new();
            queue.shuffle_ties(seed);
            (0..100).for_each(|i| queue.schedule(Time(7), Phase::Work, i));
            drain(&mut queue)
        };
        assert_eq!(order(1), order(1));
        assert_ne!(order(1), order(2));
        assert_ne!(order(1), (0..100).collect::<Vec<_>>());
    }

    #[test]
    #[should_panic(expected = "was scheduled at")]
    fn nothing_is_scheduled_in_the_past() {
        let mut queue = EventQueue::new();
        queue.schedule(Time(5), Phase::Work, ());
        queue.next_event();
        queue.schedule(Time(4), Phase::Work, ());
    }

    proptest! {
        #[test]
        fn events_come_by_time_then_phase(times in proptest::collection::vec((0u64..20, 0u8..3), 0..200)) {
            let mut queue = EventQueue::new();
            queue.shuffle_ties(3);
            let phases = [Phase::Arrive, Phase::Work, Phase::Observe];
            for (time, phase) in &times {
                queue.schedule(Time(*time), phases[usize::from(*phase)], (*time, *phase));
            }
            let taken: Vec<_> = std::iter::from_fn(|| queue.next_event()).map(|e| e.2).collect();
            let mut sorted = times;
            sorted.sort_unstable();
            prop_assert_eq!(taken, sorted);
        }
    }
}
