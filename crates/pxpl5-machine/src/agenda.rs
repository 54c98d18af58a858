//! Moves events and outputs of boards into the machine's event queue.

use crate::event::Event;
use pxpl5_ring::{RingEvent, RingOutput};
use pxpl5_sim::{Context, EventQueue, Phase};

pub(crate) fn schedule_own<E, O>(
    queue: &mut EventQueue<Event>,
    context: &mut Context<E, O>,
    event_of: impl Fn(E) -> Event,
) {
    context.each_event(|time, phase, event| queue.schedule(time, phase, event_of(event)));
}

pub(crate) fn schedule_outputs(queue: &mut EventQueue<Event>, context: &mut Context<RingEvent, RingOutput>) {
    for (time, output) in context.drain_outputs() {
        queue.schedule(time, Phase::Arrive, Event::FromRing(output));
    }
}
