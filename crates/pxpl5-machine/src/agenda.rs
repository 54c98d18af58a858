//! How what boards put out becomes events.

use crate::event::Event;
use pxpl5_ring::{Request, RingEvent, RingOutput};
use pxpl5_sim::{Context, EventQueue, Phase, Time};
use pxpl5_wire::Message;

/// Puts what a board scheduled for itself into the queue.
pub(crate) fn schedule_own<E, O>(
    queue: &mut EventQueue<Event>,
    context: &mut Context<E, O>,
    event_of: impl Fn(E) -> Event,
) {
    context.each_event(|time, phase, event| queue.schedule(time, phase, event_of(event)));
}

/// Puts what the ring brings to boards into the queue; a delivery and the news of it to its sender are one event where they may be.
pub(crate) fn schedule_brought(
    queue: &mut EventQueue<Event>,
    context: &mut Context<RingEvent, RingOutput>,
    joint: bool,
) {
    if context.is_silent() {
        return;
    }
    let mut delivered: Option<(Time, Message)> = None;
    for (time, output) in context.drain_outputs() {
        match (delivered.take(), output) {
            (None, RingOutput::Delivered(message)) if joint => delivered = Some((time, message)),
            (Some((at, message)), RingOutput::Sent { source, ticket }) if at == time && message.source == source => {
                queue.schedule(time, Phase::Arrive, Event::DeliveredAndSent(message, ticket));
            }
            (before, output) => {
                schedule_delivered(queue, before);
                queue.schedule(time, Phase::Arrive, Event::FromRing(output));
            }
        }
    }
    schedule_delivered(queue, delivered);
}

fn schedule_delivered(queue: &mut EventQueue<Event>, delivered: Option<(Time, Message)>) {
    if let Some((time, message)) = delivered {
        queue.schedule(time, Phase::Arrive, Event::FromRing(RingOutput::Delivered(message)));
    }
}

/// Puts messages that a board hands to its port into the queue: one event, where they may be and come at one instant.
pub(crate) fn schedule_requests(
    queue: &mut EventQueue<Event>,
    mut sends: impl Iterator<Item = (Time, Request)>,
    joint: bool,
) {
    let Some((mut at, mut first)) = sends.next() else { return };
    let mut more = Vec::new();
    let mut put = |at, first, more: &mut Vec<Request>| {
        let event = if more.is_empty() {
            Event::Ring(RingEvent::Request(first))
        } else {
            more.insert(0, first);
            Event::Requests(std::mem::take(more))
        };
        queue.schedule(at, Phase::Arrive, event);
    };
    for (time, request) in sends {
        if joint && time == at {
            more.push(request);
        } else {
            put(std::mem::replace(&mut at, time), std::mem::replace(&mut first, request), &mut more);
        }
    }
    put(at, first, &mut more);
}
