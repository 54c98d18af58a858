//! The event queue; its ordering contract stands in the crate's documentation.

use crate::heap::{Keyed, QuadHeap};
use crate::{Time, mix};

/// The three steps of one instant.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Phase {
    /// Inputs latch what has arrived.
    Arrive,
    /// Boards act on what was latched.
    Work,
    /// Probes look; they change nothing.
    Observe,
}

/// When an event is due and where it is kept: 24 bytes, so that the heap moves little.
#[derive(Clone, Copy, Debug)]
struct Due {
    time: Time,
    /// Phase in the upper bits, then the order of scheduling, or a hash of it.
    order: u64,
    slot: u32,
}

impl Keyed for Due {
    fn key(&self) -> u128 {
        u128::from(self.time.0) << 64 | u128::from(self.order)
    }
}

const PHASE_SHIFT: u32 = 62;

/// Events in order of (time, phase), ties in order of scheduling or shuffled.
#[derive(Debug)]
pub struct EventQueue<E> {
    heap: QuadHeap<Due>,
    /// An event that comes before all of the heap: what is scheduled next often is, and need not go through it.
    next: Option<Due>,
    events: Vec<Option<E>>,
    free: Vec<u32>,
    now: Time,
    sequence: u64,
    shuffle: Option<u64>,
    popped: u64,
}

impl<E> Default for EventQueue<E> {
    fn default() -> Self {
        Self {
            heap: QuadHeap::default(),
            next: None,
            events: Vec::new(),
            free: Vec::new(),
            now: Time::ZERO,
            sequence: 0,
            shuffle: None,
            popped: 0,
        }
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
    /// When `time` is in the past: a device has broken the contract. When 2^32 events wait.
    pub fn schedule(&mut self, time: Time, phase: Phase, event: E) {
        assert!(time >= self.now, "an event at {time} was scheduled at {}", self.now);
        let tie = self.shuffle.map_or(self.sequence, |seed| mix(seed ^ mix(self.sequence)));
        let order = (phase as u64) << PHASE_SHIFT | tie & ((1 << PHASE_SHIFT) - 1);
        self.sequence += 1;
        let slot = self.keep(event);
        let due = Due { time, order, slot };
        let for_heap =
            if self.first().is_none_or(|first| due.key() < first.key()) { self.next.replace(due) } else { Some(due) };
        if let Some(due) = for_heap {
            self.heap.push(due);
        }
    }

    fn first(&self) -> Option<Due> {
        self.next.or_else(|| self.heap.peek().copied())
    }

    fn keep(&mut self, event: E) -> u32 {
        if let Some(slot) = self.free.pop() {
            self.events[slot as usize] = Some(event);
            return slot;
        }
        self.events.push(Some(event));
        u32::try_from(self.events.len() - 1).expect("fewer than 2^32 events wait")
    }

    /// Takes the next event and moves the present to it.
    pub fn next_event(&mut self) -> Option<(Time, Phase, E)> {
        let due = self.next.take().or_else(|| self.heap.pop())?;
        self.now = due.time;
        self.popped += 1;
        self.free.push(due.slot);
        let event = self.events[due.slot as usize].take()?;
        let phase = match due.order >> PHASE_SHIFT {
            0 => Phase::Arrive,
            1 => Phase::Work,
            _ => Phase::Observe,
        };
        Some((due.time, phase, event))
    }

    /// All events that wait, in no order.
    pub fn pending(&self) -> impl Iterator<Item = &E> {
        self.events.iter().flatten()
    }

    /// The time of the next event.
    #[must_use]
    pub fn next_time(&self) -> Option<Time> {
        self.first().map(|due| due.time)
    }

    /// The next event and its time, without taking it.
    #[must_use]
    pub fn peek(&self) -> Option<(Time, &E)> {
        let due = self.first()?;
        Some((due.time, self.events[due.slot as usize].as_ref()?))
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

    /// Number of events that wait.
    #[must_use]
    pub fn len(&self) -> usize {
        self.heap.len() + usize::from(self.next.is_some())
    }

    /// Whether no event waits.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn drain(queue: &mut EventQueue<u32>) -> Vec<u32> {
        std::iter::from_fn(|| queue.next_event()).map(|(_, _, event)| event).collect()
    }

    fn order_of_ties(seed: u64) -> Vec<u32> {
        let mut queue = EventQueue::new();
        queue.shuffle_ties(seed);
        (0..100).for_each(|i| queue.schedule(Time(7), Phase::Work, i));
        drain(&mut queue)
    }

    #[test]
    fn ties_come_in_order_of_scheduling() {
        let mut queue = EventQueue::new();
        (0..100).for_each(|i| queue.schedule(Time(7), Phase::Work, i));
        assert_eq!(drain(&mut queue), (0..100).collect::<Vec<_>>());
    }

    #[test]
    fn shuffled_ties_come_in_another_order_that_the_seed_decides() {
        assert_eq!(order_of_ties(1), order_of_ties(1));
        assert_ne!(order_of_ties(1), order_of_ties(2));
        assert_ne!(order_of_ties(1), (0..100).collect::<Vec<_>>());
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
