//! The event queue of the simulation. The documentation of the crate states the order of events.

use crate::heap::{Keyed, QuadHeap};
use crate::{Time, mix};
use std::collections::VecDeque;

/// The three phases of one instant. All events of a phase are handled before the next phase begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Phase {
    /// Devices store the inputs that have arrived at this instant.
    Arrive,
    /// Devices act on the stored inputs.
    Work,
    /// Observers read the state and change nothing.
    Observe,
}

/// The time, order and storage index of a waiting event. The size of only 24 bytes makes moves within the heap fast.
#[derive(Clone, Copy, Debug)]
struct Due {
    time: Time,
    /// The upper two bits have the phase of the event. The lower bits have the number of the call that scheduled the
    /// event or, if events are shuffled, a hash of this number.
    order: u64,
    slot: u32,
}

impl Keyed for Due {
    #[inline]
    fn key(&self) -> u128 {
        u128::from(self.time.0) << 64 | u128::from(self.order)
    }
}

const PHASE_SHIFT: u32 = 62;

/// Greatest length of the sorted list of the earliest events. For a longer list, insertion would be slower than
/// insertion into the heap.
const NEAR: usize = 16;

/// Returns the sort key that separates the phases `Work` and `Observe` at `now`. The key is greater than the keys of
/// all events in `Work`, and at most equal to the keys of events in `Observe`.
#[inline]
const fn work_key(now: Time) -> u128 {
    (now.0 as u128) << 64 | ((Phase::Observe as u64) << PHASE_SHIFT) as u128
}

/// A queue of events in the order of time, then phase. Events with equal time and phase keep the order of scheduling,
/// unless the queue shuffles them.
#[derive(Debug)]
pub struct EventQueue<E> {
    heap: QuadHeap<Due>,
    /// The earliest waiting events, at most [`NEAR`], with the next event at the end of the list. If at most [`NEAR`]
    /// events wait, the heap is empty.
    near: Vec<Due>,
    /// Events in phase `Work` of the current instant that were also scheduled at the current instant. These events need
    /// no sorting. The list is unused if events are shuffled.
    soon: VecDeque<E>,
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
            near: Vec::with_capacity(NEAR + 1),
            soon: VecDeque::new(),
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
    /// Makes an empty queue. The current time is zero.
    pub fn new() -> Self {
        Self::default()
    }

    /// Shuffles events of the same instant and phase: a hash with `seed` determines their order. The call has no effect
    /// on events that were scheduled before.
    pub fn shuffle_ties(&mut self, seed: u64) {
        self.shuffle = Some(seed);
    }

    /// Schedules an event.
    ///
    /// # Panics
    ///
    /// Panics if `time` is earlier than the current time, because such a call violates the ordering contract. Also
    /// panics if 2^32 events are waiting.
    pub fn schedule(&mut self, time: Time, phase: Phase, event: E) {
        assert!(time >= self.now, "an event at {time} was scheduled at {}", self.now);
        // Work for the current instant comes after all other work of the instant, so it needs no sorting.
        if time == self.now && phase == Phase::Work && self.shuffle.is_none() {
            return self.soon.push_back(event);
        }
        // The key resolves ties by the sequence number, or by a hash of this number.
        let tie = self.shuffle.map_or(self.sequence, |seed| mix(seed ^ mix(self.sequence)));
        let order = (phase as u64) << PHASE_SHIFT | tie & ((1 << PHASE_SHIFT) - 1);
        self.sequence += 1;
        let slot = self.keep(event);
        self.enter(Due { time, order, slot });
    }

    fn enter(&mut self, due: Due) {
        // Events later than the first event of the heap go into the heap.
        if self.heap.peek().is_some_and(|first| first.key() < due.key()) {
            return self.heap.push(due);
        }
        // Earlier events go into the sorted list. If the list is full, its latest event moves to the heap.
        let sooner = self.near.iter().rev().take_while(|near| near.key() < due.key()).count();
        self.near.insert(self.near.len() - sooner, due);
        if self.near.len() > NEAR {
            let latest = self.near.remove(0);
            self.heap.push(latest);
        }
    }

    fn first(&self) -> Option<Due> {
        self.near.last().or_else(|| self.heap.peek()).copied()
    }

    fn take_first(&mut self) -> Option<Due> {
        self.near.pop().or_else(|| self.heap.pop())
    }

    /// Returns true if the next event is in `soon`. Events of `soon` come after two kinds of events of the current
    /// instant: events in phase `Arrive`, and events in phase `Work` that were scheduled at an earlier instant.
    fn is_current_work_next(&self, first: Option<Due>) -> bool {
        !self.soon.is_empty() && first.is_none_or(|first| first.key() >= work_key(self.now))
    }

    fn keep(&mut self, event: E) -> u32 {
        // Reuse the slot of a taken event.
        if let Some(slot) = self.free.pop() {
            self.events[slot as usize] = Some(event);
            return slot;
        }
        self.events.push(Some(event));
        u32::try_from(self.events.len() - 1).expect("fewer than 2^32 events wait")
    }

    /// Removes and returns the next event. The current time becomes the time of this event.
    pub fn next_event(&mut self) -> Option<(Time, Phase, E)> {
        if self.is_current_work_next(self.first()) {
            return self.take_current_work().map(|event| (self.now, Phase::Work, event));
        }
        let due = self.take_first()?;
        let event = self.take(due)?;
        let phase = match due.order >> PHASE_SHIFT {
            0 => Phase::Arrive,
            1 => Phase::Work,
            _ => Phase::Observe,
        };
        Some((due.time, phase, event))
    }

    /// Removes and returns the next event if the event's time is before `end`. The current time becomes the time of
    /// this event.
    pub fn next_event_before(&mut self, end: Time) -> Option<(Time, E)> {
        let first = self.first();
        if self.is_current_work_next(first) {
            let event = if self.now < end { self.take_current_work() } else { None }?;
            return Some((self.now, event));
        }
        if first?.time >= end {
            return None;
        }
        let due = self.take_first()?;
        Some((due.time, self.take(due)?))
    }

    fn take_current_work(&mut self) -> Option<E> {
        self.popped += 1;
        self.soon.pop_front()
    }

    /// Removes an event from the storage of waiting events. The current time becomes the time of this event.
    fn take(&mut self, due: Due) -> Option<E> {
        self.now = due.time;
        self.popped += 1;
        self.free.push(due.slot);
        self.events[due.slot as usize].take()
    }

    /// Iterates over all waiting events, in unspecified order.
    pub fn pending(&self) -> impl Iterator<Item = &E> {
        self.events.iter().flatten().chain(&self.soon)
    }

    pub fn next_time(&self) -> Option<Time> {
        if !self.soon.is_empty() {
            return Some(self.now);
        }
        self.first().map(|due| due.time)
    }

    /// Returns the next event and its time, without removing it.
    pub fn peek(&self) -> Option<(Time, &E)> {
        let first = self.first();
        if self.is_current_work_next(first) {
            return Some((self.now, self.soon.front()?));
        }
        let due = first?;
        Some((due.time, self.events[due.slot as usize].as_ref()?))
    }

    /// Returns the current time: the time of the last removed event.
    pub const fn now(&self) -> Time {
        self.now
    }

    /// Returns the number of events that were removed so far.
    pub const fn events_taken(&self) -> u64 {
        self.popped
    }

    pub fn len(&self) -> usize {
        self.heap.len() + self.near.len() + self.soon.len()
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

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
    fn simultaneous_events_run_in_order_of_scheduling() {
        let mut queue = EventQueue::new();
        (0..100).for_each(|i| queue.schedule(Time(7), Phase::Work, i));
        assert_eq!(drain(&mut queue), (0..100).collect::<Vec<_>>());
    }

    #[test]
    fn the_seed_determines_the_order_of_shuffled_simultaneous_events() {
        assert_eq!(order_of_ties(1), order_of_ties(1));
        assert_ne!(order_of_ties(1), order_of_ties(2));
        assert_ne!(order_of_ties(1), (0..100).collect::<Vec<_>>());
    }

    /// Tests the shuffle with seeds that differ in one bit. Each of 64 seeds shuffles 100 events. A fair shuffle has
    /// 100 (1 - 0.99^64) = 47 different first events on average, with a standard deviation of 3.
    #[test]
    fn similar_seeds_shuffle_as_fairly_as_different_seeds() {
        for bits in [0, u64::MAX] {
            let firsts: BTreeSet<u32> = (0..64).map(|bit| order_of_ties(bits ^ 1 << bit)[0]).collect();
            assert!((35..60).contains(&firsts.len()), "{} come first", firsts.len());
        }
    }

    #[test]
    #[should_panic(expected = "was scheduled at")]
    fn nothing_is_scheduled_in_the_past() {
        let mut queue = EventQueue::new();
        queue.schedule(Time(5), Phase::Work, ());
        queue.next_event();
        queue.schedule(Time(4), Phase::Work, ());
    }

    /// Delay and phase of an event that an earlier event schedules.
    type Follow = (u64, u8);

    /// Reference model: an event queue that searches a list for the first event.
    #[derive(Default)]
    struct Plain {
        waiting: Vec<(u64, u8, usize)>,
        now: u64,
        scheduled: usize,
    }

    impl Plain {
        fn schedule(&mut self, time: u64, phase: u8) {
            self.waiting.push((time, phase, self.scheduled));
            self.scheduled += 1;
        }

        fn take(&mut self) -> Option<(u64, u8, usize)> {
            let first = self.waiting.iter().copied().min()?;
            self.waiting.retain(|event| *event != first);
            self.now = first.0;
            Some(first)
        }
    }

    proptest! {
        /// Tests the queue against the reference model. The delays include 0, because the queue stores events of the
        /// current instant separately.
        #[test]
        fn events_scheduled_by_events_are_sorted_correctly(
            begun in proptest::collection::vec((0u64..4, 0u8..3), 1..60),
            follows in proptest::collection::vec(proptest::collection::vec((0u64..3, 0u8..3), 0..3), 60)
        ) {
            let phases = [Phase::Arrive, Phase::Work, Phase::Observe];
            let mut queue = EventQueue::new();
            let mut plain = Plain::default();
            let follow = |queue: &mut EventQueue<usize>, plain: &mut Plain, now: u64, some: &[Follow]| {
                for (later, phase) in some {
                    queue.schedule(Time(now + later), phases[usize::from(*phase)], plain.scheduled);
                    plain.schedule(now + later, *phase);
                }
            };
            follow(&mut queue, &mut plain, 0, &begun);
            for some in follows {
                prop_assert_eq!(queue.len(), plain.waiting.len());
                prop_assert_eq!(queue.is_empty(), plain.waiting.is_empty());
                prop_assert_eq!(queue.events_taken(), (plain.scheduled - plain.waiting.len()) as u64);
                prop_assert_eq!(queue.pending().count(), plain.waiting.len());
                let peeked = queue.peek().map(|(time, event)| (time, *event));
                prop_assert_eq!(queue.next_time(), peeked.map(|next| next.0));
                let expected = plain.take();
                prop_assert_eq!(peeked.map(|(time, event)| (time.0, event)), expected.map(|t| (t.0, t.2)));
                if let Some((time, _, event)) = expected.filter(|(.., event)| event % 2 == 0) {
                    prop_assert_eq!(queue.next_event_before(Time(time)), None);
                    prop_assert_eq!(queue.next_event_before(Time(time + 1)), Some((Time(time), event)));
                } else {
                    let taken = queue.next_event().map(|(time, phase, event)| (time.0, phase as u8, event));
                    prop_assert_eq!(taken, expected);
                }
                let now = plain.now;
                follow(&mut queue, &mut plain, now, &some);
            }
        }

        #[test]
        fn events_are_ordered_by_time_then_phase(times in proptest::collection::vec((0u64..20, 0u8..3), 0..200)) {
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
