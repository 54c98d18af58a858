//! What of a happening enters the trace.

use pxpl5_gp::Mark;
use pxpl5_wire::{Body, Message, RegionPixels, SurfaceId};

/// What of a message enters the trace, under a number for what happened to it.
pub(crate) fn facts(kind: u64, message: &Message) -> [u64; 4] {
    [kind, u64::from(message.source.0), u64::from(message.destination.0), u64::from(message.words)]
}

/// What of a message that came to a port by a line of the host enters the trace.
pub(crate) fn facts_of_line(port: usize, body: &Body) -> Vec<u64> {
    match body {
        Body::Words(words) => [8, port as u64].into_iter().chain(words.iter().map(|word| u64::from(*word))).collect(),
        Body::Pixels(RegionPixels { target, part, .. }) => {
            vec![9, port as u64, u64::from(target.region.0), target.picture.0, u64::from(*part)]
        }
        Body::Commands(_) => vec![10, port as u64],
    }
}

/// What of a mark enters the trace.
pub(crate) fn facts_of(mark: &Mark) -> [u64; 6] {
    let surface = surface_fact(mark.surface);
    [4, u64::from(mark.node.0), mark.picture.0, surface, mark.stage as u64, mark.edge as u64]
}

/// The surface as traces have it since there were two at most, which 2 stands for: none.
fn surface_fact(surface: Option<SurfaceId>) -> u64 {
    match surface {
        None => 2,
        Some(SurfaceId(number)) if number < 2 => u64::from(number),
        Some(SurfaceId(number)) => u64::from(number) + 1,
    }
}
