//! Program of the host, which sends a view and edits for each frame.

use crate::config::RenderingControlConfig;
use crate::protocol::StageOrder;
use pphigs::FrameView;
use pxpl5_gp::{Fault, Gp, HostTiming, Stage};
use pxpl5_sim::Time;
use pxpl5_wire::{PictureNumber, ViewNumber};

/// Sends one frame after the other. For each frame, the program samples the head's pose, and sends the view and the
/// edits over the host's link to all graphics processors. The program then waits for the end of EDIT.
///
/// SEND of a frame must not begin before EDIT of the previous frame has finished (TR94).
///
/// `start_of` returns the time at which a frame begins, or `None` if no more frames begin. The argument is the time at
/// which the host is ready. `view_of` returns the view for a number and for the time at which the pose is sampled.
///
/// # Errors
///
/// Returns [`Fault::Protocol`] if a message arrives that is not the master's answer.
pub async fn host(
    gp: Gp,
    config: RenderingControlConfig,
    timing: HostTiming,
    start_of: impl Fn(Time) -> Option<Time>,
    mut view_of: impl FnMut(ViewNumber, Time) -> FrameView,
) -> Result<(), Fault> {
    for frame in PictureNumber::FIRST.onwards() {
        let Some(start) = start_of(gp.now()) else { break };
        // The sample is taken when SEND begins.
        gp.spend(start.since(gp.now())).await;
        gp.begin(Stage::Sample, frame, None);
        gp.begin(Stage::Send, frame, None);
        let (words, body) = StageOrder::Send(view_of(ViewNumber::taken_for(frame), gp.now())).message();
        // The words pass the slow link to the machine before they enter the ring.
        gp.spend(timing.link_span(words)).await;
        let receivers = config.slaves.iter().chain([&config.master]);
        let batch = receivers.map(|node| (*node, words, body.clone())).collect();
        let sent = gp.send_batch(batch).await;
        gp.accepted(sent).await;
        gp.end(Stage::Send, frame, None);
        // The next SEND must not begin before these edits are applied.
        let received = gp.receive().await;
        if StageOrder::read(&received, gp.node())? != StageOrder::EditsDone(frame) {
            return Err(Fault::Protocol { node: gp.node(), found: format!("while frame {frame} is being edited") });
        }
    }
    Ok(())
}
