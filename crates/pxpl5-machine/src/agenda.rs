//! How what boards put out becomes events.

use crate::event::Event;
use pxpl5_ring::{Request, RingEvent, RingOutput};
use pxpl5_sim::{Context, EventQueue, Phase, Time};

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
    let mut outputs = context.drain_outputs();
    while let Some((time, output)) = outputs.next() {
        let event = match (output, outputs.as_slice().first()) {
            (RingOutput::Delivered(message), Some((at, RingOutput::Sent { source, ticket })))
                if joint && *at == time && *source == message.source =>
            {
                let event = Event::DeliveredAndSent(message, *ticket);
                outputs.next();
                event
            }
            (output, _) => Event::FromRing(output),
        };
        queue.schedule(time, Phase::Arrive, event);
    }
}

/// Puts messages that a board hands to its port into the queue: one event, where they may be and come at one instant.
pub(crate) fn schedule_requests(
    queue: &mut EventQueue<Event>,
    sends: impl Iterator<Item = (Time, Request)>,
    joint: bool,
) {
    let mut sends = sends.peekable();
    while let Some((at, first)) = sends.next() {
        let event = match sends.next_if(|(time, _)| joint && *time == at) {
            None => Event::Ring(RingEvent::Request(first)),
            Some((_, second)) => {
                let mut all = Vec::with_capacity(2 + sends.size_hint().1.unwrap_or(0));
                all.extend([first, second]);
                while let Some((_, request)) = sends.next_if(|(time, _)| *time == at) {
                    all.push(request);
                }
                Event::Requests(all)
            }
        };
        queue.schedule(at, Phase::Arrive, event);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_wire::{Body, Message, NodeId};

    fn message(source: u16) -> Message {
        Message { source: NodeId(source), destination: NodeId(9), words: 1, body: Body::Words([1].into()) }
    }

    /// What is in the queue: when, and of which kind and source.
    fn queued(mut queue: EventQueue<Event>) -> Vec<(u64, &'static str, u16)> {
        let mut all = Vec::new();
        while let Some((time, phase, event)) = queue.next_event() {
            assert_eq!(phase, Phase::Arrive);
            let (kind, source) = match event {
                Event::FromRing(RingOutput::Delivered(message)) => ("delivered", message.source),
                Event::FromRing(RingOutput::Sent { source, .. }) => ("sent", source),
                Event::DeliveredAndSent(message, 77) => ("both", message.source),
                Event::Ring(RingEvent::Request(request)) => ("request", request.message.source),
                Event::Requests(requests) if requests.len() == 2 => ("two requests", requests[0].message.source),
                other => panic!("{other:?}"),
            };
            all.push((time.0, kind, source.0));
        }
        all
    }

    fn brought(outputs: &[(u64, bool, u16)], joint: bool) -> Vec<(u64, &'static str, u16)> {
        let mut queue = EventQueue::new();
        let mut context = Context::default();
        for (time, is_delivery, source) in outputs {
            let delivered = RingOutput::Delivered(message(*source));
            let sent = RingOutput::Sent { source: NodeId(*source), ticket: 77 };
            context.output(Time(*time), if *is_delivery { delivered } else { sent });
        }
        schedule_brought(&mut queue, &mut context, joint);
        queued(queue)
    }

    #[test]
    fn a_delivery_and_its_news_are_one_event_where_they_may_be() {
        let both = [(5, true, 1), (5, false, 1)];
        assert_eq!(brought(&both, true), [(5, "both", 1)]);
        assert_eq!(brought(&both, false), [(5, "delivered", 1), (5, "sent", 1)]);
    }

    #[test]
    fn a_delivery_and_news_of_another_message_stay_two() {
        for (outputs, expected) in [
            ([(5, true, 1), (5, false, 2)], [(5, "delivered", 1), (5, "sent", 2)]),
            ([(5, true, 1), (6, false, 1)], [(5, "delivered", 1), (6, "sent", 1)]),
            ([(5, false, 1), (5, true, 1)], [(5, "sent", 1), (5, "delivered", 1)]),
            ([(5, true, 1), (6, true, 2)], [(5, "delivered", 1), (6, "delivered", 2)]),
        ] {
            assert_eq!(brought(&outputs, true), expected);
        }
    }

    fn requested(times: &[u64], joint: bool) -> Vec<(u64, &'static str, u16)> {
        let mut queue = EventQueue::new();
        let request = |source| Request { message: message(source), ticket: None, hold: false, order: 0 };
        let sends = times.iter().zip(1..).map(|(time, source)| (Time(*time), request(source)));
        schedule_requests(&mut queue, sends, joint);
        queued(queue)
    }

    #[test]
    fn messages_of_one_instant_are_one_event_where_they_may_be() {
        assert_eq!(requested(&[], true), []);
        assert_eq!(requested(&[5], true), [(5, "request", 1)]);
        assert_eq!(requested(&[5, 5, 6], true), [(5, "two requests", 1), (6, "request", 3)]);
        assert_eq!(requested(&[5, 6, 6], true), [(5, "request", 1), (6, "two requests", 2)]);
        assert_eq!(requested(&[5, 5], false), [(5, "request", 1), (5, "request", 2)]);
    }
}
