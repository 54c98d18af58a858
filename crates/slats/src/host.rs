//! The host: SEND whenever the tracker has something new.

use crate::config::SlatsConfig;
use pphigs::FrameView;
use pxpl5_gp::{Fault, Gp, HostTiming, Stage};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::Body;

/// Sends the viewing transforms of both eyes to the leading GP, once every view period.
///
/// `view_of` gives the view of an update whose pose is sampled at a time.
///
/// # Errors
///
/// None of its own; the type is that of a program.
pub async fn host(
    gp: Gp,
    config: SlatsConfig,
    timing: HostTiming,
    mut view_of: impl FnMut(u64, Time) -> FrameView,
) -> Result<(), Fault> {
    for update in 0.. {
        let started = gp.now();
        gp.begin(Stage::Send, update, None);
        let words = view_of(update, started).to_words();
        let length_words = words.len() as u32;
        gp.spend(timing.link_span(length_words)).await;
        let sent = gp.send(config.processors[0], length_words, Body::Words(words.into())).await;
        gp.accepted(sent).await;
        gp.end(Stage::Send, update, None);
        let next = started + Span::from_ns(timing.view_period_ns);
        gp.spend(next.since(gp.now())).await;
    }
    Ok(())
}
