//! Converts events to the numbers that enter the trace hash.

use pxpl5_gp::Mark;
use pxpl5_wire::{Body, Message, RegionPixels, SurfaceId};

/// Returns the numbers that add a ring message to the trace hash: event code (1 announced, 2 delivered), sender,
/// receiver and length.
pub(crate) fn facts(kind: u64, message: &Message) -> [u64; 4] {
    [kind, u64::from(message.source.0), u64::from(message.destination.0), u64::from(message.words)]
}

/// Returns the numbers that add a message on a host line to the trace hash. A host line is a connection from the host
/// to a display that bypasses the ring.
pub(crate) fn host_line_facts(port: usize, body: &Body) -> Vec<u64> {
    match body {
        Body::Words(words) => [8, port as u64].into_iter().chain(words.iter().map(|word| u64::from(*word))).collect(),
        Body::Pixels(RegionPixels { target, part, .. }) => {
            vec![9, port as u64, u64::from(target.region.0), target.picture.0, u64::from(*part)]
        }
        Body::Commands(_) => vec![10, port as u64],
    }
}

/// Returns the numbers that add the start or the end of a stage to the trace hash.
pub(crate) fn mark_facts(mark: &Mark) -> [u64; 6] {
    let surface = surface_fact(mark.surface);
    [4, u64::from(mark.node.0), mark.picture.0, surface, mark.stage as u64, mark.edge as u64]
}

/// Returns the number of a surface in the trace hash: 0 or 1 for the first two surfaces, 2 for no surface. From the
/// third surface on, the number is the index plus 1.
///
/// They come from versions with at most two surfaces, and published hashes depend on them.
fn surface_fact(surface: Option<SurfaceId>) -> u64 {
    match surface {
        None => 2,
        Some(SurfaceId(number)) if number < 2 => u64::from(number),
        Some(SurfaceId(number)) => u64::from(number) + 1,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_gp::{Stage, StageEdge};
    use pxpl5_sim::Time;
    use pxpl5_wire::{CommandList, NodeId, PictureNumber};

    #[test]
    fn a_message_is_described_by_its_ports_and_length() {
        let message = Message { source: NodeId(3), destination: NodeId(70), words: 9, body: Body::Words([7].into()) };
        assert_eq!(facts(2, &message), [2, 3, 70, 9]);
    }

    #[test]
    fn a_message_on_the_host_line_is_described_by_its_port_and_its_words() {
        assert_eq!(host_line_facts(6, &Body::Words([5, 4].into())), [8, 6, 5, 4]);
        let list = CommandList { runs: Vec::new(), context: 0, copies: Vec::new(), content: None };
        assert_eq!(host_line_facts(6, &Body::Commands(list)), [10, 6]);
    }

    /// Tests the number of a surface in the trace hash. Published hashes depend on these numbers: 0 and 1 for the first
    /// two surfaces, 2 for no surface, then 3 and up.
    #[test]
    fn the_surfaces_of_marks_keep_their_numbers_in_the_trace_hash() {
        let surfaces = [Some(0), Some(1), None, Some(2), Some(3)];
        for (number, surface) in (0..).zip(surfaces) {
            let mark = Mark {
                time: Time(8),
                node: NodeId(5),
                picture: PictureNumber(6),
                surface: surface.map(SurfaceId),
                stage: Stage::Render,
                edge: StageEdge::End,
                view: None,
            };
            assert_eq!(mark_facts(&mark), [4, 5, 6, number, 4, 1], "the fifth stage, its end");
        }
    }
}
