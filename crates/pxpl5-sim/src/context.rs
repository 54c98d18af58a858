//! The interface through which a device acts on the simulation during one event. The module also has a test bench for a
//! single device.

use crate::{EventQueue, Phase, Span, Time};

/// The events that a device schedules for itself, and the outputs of the device.
///
/// `E` is the device's own event type, `O` its output type. The code that owns the devices takes both out after each
/// event.
#[derive(Debug)]
pub struct Context<E, O> {
    now: Time,
    own: Vec<(Time, Phase, E)>,
    outputs: Vec<(Time, O)>,
}

impl<E, O> Default for Context<E, O> {
    fn default() -> Self {
        Self { now: Time::ZERO, own: Vec::new(), outputs: Vec::new() }
    }
}

impl<E, O> Context<E, O> {
    /// Sets the current time for the next event and returns the context. The lists of events and outputs keep their
    /// allocated memory for reuse.
    #[inline]
    pub fn at(&mut self, now: Time) -> &mut Self {
        debug_assert!(self.own.is_empty() && self.outputs.is_empty(), "the wiring left something undone");
        self.now = now;
        self
    }

    /// Returns the time of the event that is being handled.
    #[inline]
    pub const fn now(&self) -> Time {
        self.now
    }

    #[inline]
    pub fn schedule(&mut self, time: Time, phase: Phase, event: E) {
        self.own.push((time, phase, event));
    }

    /// Schedules an event for the same device at `span` after the current time, in the phase [`Phase::Work`].
    #[inline]
    pub fn after(&mut self, span: Span, event: E) {
        self.schedule(self.now + span, Phase::Work, event);
    }

    /// Adds an output of the device. `time` is the time at which the output leaves the device.
    #[inline]
    pub fn output(&mut self, time: Time, output: O) {
        self.outputs.push((time, output));
    }

    /// Removes and returns the events that were scheduled since the last call.
    #[inline]
    pub fn drain_events(&mut self) -> std::vec::Drain<'_, (Time, Phase, E)> {
        self.own.drain(..)
    }

    /// Removes the events that were scheduled since the last call and passes the events to `take`, in the order of
    /// scheduling. Most calls find at most one event.
    #[inline]
    pub fn each_event(&mut self, mut take: impl FnMut(Time, Phase, E)) {
        // The usual case of one event needs no iterator.
        if self.own.len() > 1 {
            return self.own.drain(..).for_each(|(time, phase, event)| take(time, phase, event));
        }
        if let Some((time, phase, event)) = self.own.pop() {
            take(time, phase, event);
        }
    }

    /// Returns true if the device has made no output since the last [`Context::drain_outputs`].
    #[inline]
    pub const fn has_no_outputs(&self) -> bool {
        self.outputs.is_empty()
    }

    /// Removes and returns all outputs of the device.
    #[inline]
    pub fn drain_outputs(&mut self) -> std::vec::Drain<'_, (Time, O)> {
        self.outputs.drain(..)
    }
}

/// A test bench for one device. A test schedules events for the device and reads the device's outputs with their times.
#[derive(Debug)]
pub struct TestBench<E, O> {
    queue: EventQueue<E>,
    context: Context<E, O>,
    /// All outputs of the device with their times, in the order in which the device made the outputs.
    pub outputs: Vec<(Time, O)>,
}

impl<E, O> Default for TestBench<E, O> {
    fn default() -> Self {
        Self { queue: EventQueue::new(), context: Context::default(), outputs: Vec::new() }
    }
}

impl<E, O> TestBench<E, O> {
    /// Makes a test bench without events at time zero.
    pub fn new() -> Self {
        Self::default()
    }

    /// Returns the event queue of the bench, for example to shuffle events or to read the current time.
    pub fn queue(&mut self) -> &mut EventQueue<E> {
        &mut self.queue
    }

    pub fn feed(&mut self, time: Time, phase: Phase, event: E) {
        self.queue.schedule(time, phase, event);
    }

    /// Handles all events up to and including time `until`.
    pub fn run_until(&mut self, until: Time, mut handle: impl FnMut(E, &mut Context<E, O>)) {
        while self.queue.next_time().is_some_and(|time| time <= until) {
            let Some((now, _, event)) = self.queue.next_event() else {
                break;
            };
            handle(event, self.context.at(now));
            // Events that the device scheduled for itself go into the queue.
            for (time, phase, event) in self.context.drain_events() {
                self.queue.schedule(time, phase, event);
            }
            self.outputs.extend(self.context.drain_outputs());
        }
    }

    /// Handles all events until the queue is empty.
    pub fn run(&mut self, handle: impl FnMut(E, &mut Context<E, O>)) {
        self.run_until(Time(u64::MAX), handle);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A device that outputs the number of an event 10 ps after the event. Event 3 also schedules event 2 after 5 ps.
    fn echo(event: u32, context: &mut Context<u32, u32>) {
        context.output(context.now() + Span(10), event);
        if event == 3 {
            context.after(Span(5), 2);
        }
    }

    #[test]
    fn a_device_can_be_run_alone_up_to_a_time() {
        let mut bench = TestBench::new();
        bench.feed(Time(100), Phase::Arrive, 3);
        bench.run_until(Time(99), echo);
        assert!(bench.outputs.is_empty());
        bench.run_until(Time(104), echo);
        assert_eq!(bench.outputs, [(Time(110), 3)]);
        bench.run(echo);
        assert_eq!(bench.outputs, [(Time(110), 3), (Time(115), 2)]);
    }
    #[test]
    fn scheduled_events_are_taken_once_in_order_and_outputs_are_recorded() {
        let mut context = Context::<u32, u32>::default();
        context.at(Time(7));
        for count in [0, 1, 3] {
            (0..count).for_each(|event| context.after(Span(u64::from(event)), event));
            let mut taken = Vec::new();
            context.each_event(|time, phase, event| taken.push((time, phase, event)));
            let expected: Vec<_> = (0..count).map(|n| (Time(7 + u64::from(n)), Phase::Work, n)).collect();
            assert_eq!(taken, expected);
            assert_eq!(context.drain_events().len(), 0);
        }
        assert!(context.has_no_outputs());
        context.output(Time(9), 1);
        assert!(!context.has_no_outputs());
    }

    #[test]
    fn an_input_of_a_test_bench_waits_in_its_queue() {
        let mut bench = TestBench::<u32, u32>::new();
        bench.feed(Time(100), Phase::Arrive, 3);
        assert_eq!(bench.queue().next_time(), Some(Time(100)));
    }
}
