//! The host: SEND whenever the tracker has something new.

use crate::config::SlatsConfig;
use pphigs::FrameView;
use pxpl5_gp::{Fault, Gp, HostTiming, Stage};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Body, ViewNumber};

/// Sends the viewing transforms of both eyes to the leading GP, once every view period.
///
/// `view_of` gives a view whose pose is sampled at a time.
///
/// # Errors
///
/// None of its own; the type is that of a program.
pub async fn host(
    gp: Gp,
    config: SlatsConfig,
    timing: HostTiming,
    mut view_of: impl FnMut(ViewNumber, Time) -> FrameView,
) -> Result<(), Fault> {
    for view in ViewNumber::FIRST.onwards() {
        let started = gp.now();
        // Which pictures will show it is not known here: SEND is marked by the view's own number.
        let marked_as = view.picture_taken_for();
        gp.begin(Stage::Send, marked_as, None);
        let words = view_of(view, started).to_words();
        let length_words = words.len() as u32;
        gp.spend(timing.link_span(length_words)).await;
        let sent = gp.send(config.processors[0], length_words, Body::Words(words.into())).await;
        gp.accepted(sent).await;
        gp.end(Stage::Send, marked_as, None);
        let next = started + Span::from_ns(timing.view_period_ns);
        gp.spend(next.since(gp.now())).await;
    }
    Ok(())
}
