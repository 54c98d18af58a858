//! Transfers of which nobody is told in time: messages that follow each other without an event for each.
//!
//! A message that keeps its receiver's port is followed there, at its end, by the next one of its transfer: nobody else may have the port, and its own
//! channel has just become free. Only where a head lacks a channel could that one be first, and then every end is an event. So the ring goes
//! through such ends when something else happens to it, in their order and at their instants, and takes the channels that it would have taken.

use super::Ring;
use crate::channels::MessageInFlight;
use pxpl5_sim::Time;
use pxpl5_wire::{Message, NodeId};

impl Ring {
    /// Has an elastic receiver told late of messages without a ticket that keep its port for the next one: whoever looks asks for them
    /// ([`Ring::take_part`]). Those of one transfer, a *train*, then follow each other without an event for each. Receivers that are not
    /// elastic stay as they are.
    pub fn tell_late(&mut self, destination: NodeId) {
        if let Some(port) = self.destinations.get_mut(usize::from(destination.0)) {
            port.patient = port.elastic;
        }
    }

    /// Tells every receiver of every message when it arrives, as if [`Ring::tell_late`] had not been called; only before anything was sent.
    pub fn tell_in_time(&mut self) {
        self.destinations.iter_mut().for_each(|port| port.patient = false);
    }

    /// Takes the next message of which a receiver is [told late](Ring::tell_late), if it has arrived before an instant; with its arrival.
    /// There is no event of the ring before that instant any more.
    pub fn take_part(&mut self, destination: NodeId, before: Time) -> Option<(Time, Message)> {
        self.catch_up(before);
        let parts = &mut self.destinations.get_mut(usize::from(destination.0))?.parts;
        let has_arrived = parts.front().is_some_and(|(arrival, _)| *arrival < before);
        if has_arrived { parts.pop_front() } else { None }
    }

    /// Brings trains up to an instant, and not including it, before which there is no event any more: channels are left and taken, and
    /// parts are on their way, as of then.
    pub(super) fn catch_up(&mut self, before: Time) {
        while self.train_goes_on_at < before {
            let end = self.train_goes_on_at;
            self.settle(end);
            self.go_on(end);
        }
    }

    /// The next messages of trains of which one has ended take channels. No other head can go at that instant: none waits for a
    /// channel, and none for a receiver that was left, or there would be an event.
    fn go_on(&mut self, now: Time) {
        self.unblocked = false;
        let mut place = 0;
        while place < self.heads.len() {
            let source = self.heads[place].source;
            if !self.can_go(place) {
                place += 1;
                continue;
            }
            self.take_head(place);
            if let Some((flight, message)) = self.take_first(source, now) {
                let to_tell = self.carry_to_end(flight, message);
                debug_assert!(to_tell.is_none(), "nobody is told of what a train brings");
            }
            self.add_head_behind(source, now);
        }
    }

    /// Puts a message to an elastic receiver on a channel, and gives it back with its arrival if somebody is told of that in time.
    pub(super) fn carry_to_end(&mut self, flight: MessageInFlight, message: Message) -> Option<(Time, Message)> {
        let end = flight.granted + self.timing.occupancy(flight.words);
        let goes_on = flight.hold && self.is_in_train(&flight, end);
        if goes_on {
            self.train_goes_on_at = self.train_goes_on_at.min(end);
        }
        let to_tell = self.keep_part(&flight, message, end + flight.latency);
        self.occupy(MessageInFlight { goes_on, ..flight }, Some(end));
        to_tell
    }

    /// Keeps a message for a receiver that is told of it late; gives back any other.
    pub(super) fn keep_part(
        &mut self,
        flight: &MessageInFlight,
        message: Message,
        at: Time,
    ) -> Option<(Time, Message)> {
        let port = &mut self.destinations[usize::from(flight.destination.0)];
        if !port.patient || !flight.is_part {
            return Some((at, message));
        }
        port.parts.push_back((at, message));
        None
    }

    /// Whether a message that keeps its port, and ends then, is followed there by one of which nobody is told in time; and until when such
    /// follow, if they are not held up.
    fn is_in_train(&mut self, flight: &MessageInFlight, end: Time) -> bool {
        if !self.destinations[usize::from(flight.destination.0)].patient {
            return false;
        }
        let source = &mut self.sources[usize::from(flight.source.0)];
        let waiting = source.queue.iter().map(|queued| &queued.request);
        let parts = waiting.take_while(|next| next.message.destination == flight.destination && next.is_part());
        let mut spans = parts.map(|next| self.timing.occupancy(next.message.words));
        let Some(first) = spans.next() else { return false };
        // What was reckoned at the first message holds, but where a want of channels has held the train up.
        if source.train_until <= end {
            source.train_until = end + first + spans.sum();
        }
        true
    }
}
