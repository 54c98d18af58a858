//! Messages of which displays are told late.

use pxpl5_sim::Time;
use pxpl5_wire::{Message, NodeId};
use std::collections::{BTreeMap, VecDeque};

/// What has been on its way to displays since they were told last, by port.
#[derive(Debug, Default)]
pub(crate) struct Parts {
    ports: BTreeMap<NodeId, VecDeque<(Time, Message)>>,
}

impl Parts {
    /// A message whose last word arrives then, or did: behind all others of its port.
    pub(crate) fn add(&mut self, arrives: Time, message: Message) {
        self.ports.entry(message.destination).or_default().push_back((arrives, message));
    }

    /// Takes the next message to a port that has arrived before an instant.
    pub(crate) fn take(&mut self, port: NodeId, before: Time) -> Option<(Time, Message)> {
        let waiting = self.ports.get_mut(&port)?;
        let has_arrived = waiting.front().is_some_and(|(arrives, _)| *arrives < before);
        if has_arrived { waiting.pop_front() } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_wire::Body;

    #[test]
    fn what_has_arrived_is_taken_once_in_order_and_from_its_port() {
        let mut parts = Parts::default();
        let message = |destination, word| {
            let body = Body::Words([word].into());
            Message { source: NodeId(1), destination: NodeId(destination), words: 1, body }
        };
        for (arrives, port, word) in [(5, 8, 1), (3, 9, 2), (7, 8, 3)] {
            parts.add(Time(arrives), message(port, word));
        }
        let mut taken = |port, before| {
            let next = parts.take(NodeId(port), Time(before));
            next.map(|(arrived, message)| (arrived.0, message.destination.0))
        };
        assert_eq!(taken(8, 5), None, "not before it has arrived");
        assert_eq!([taken(8, 8), taken(8, 8), taken(8, 8)], [Some((5, 8)), Some((7, 8)), None]);
        assert_eq!([taken(9, 4), taken(9, 4), taken(7, 99)], [Some((3, 9)), None, None]);
    }
}
