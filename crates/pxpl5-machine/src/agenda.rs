//! Moves the outputs of boards into the event queue.

use crate::event::Event;
use pxpl5_ring::{RingEvent, RingOutput};
use pxpl5_sim::{Context, EventQueue, Phase};

/// Schedules the future events that a board has requested for itself.
pub(crate) fn schedule_own<E, O>(
    queue: &mut EventQueue<Event>,
    context: &mut Context<E, O>,
    event_of: impl Fn(E) -> Event,
) {
    context.each_event(|time, phase, event| queue.schedule(time, phase, event_of(event)));
}

/// Schedules each output of the ring as an event of the receiving board.
pub(crate) fn schedule_outputs(queue: &mut EventQueue<Event>, context: &mut Context<RingEvent, RingOutput>) {
    for (time, output) in context.drain_outputs() {
        queue.schedule(time, Phase::Arrive, Event::FromRing(output));
    }
}
