//! Program of the host, which sends the next update.

use crate::cube::config::CubeControlConfig;
use crate::cube::protocol::UpdateOrder;
use crate::cube::update::FaceUpdate;
use pxpl5_gp::{Fault, Gp, HostTiming, Stage};
use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;

/// An action of the host, when the host is ready for an update.
#[derive(Clone, Debug, PartialEq)]
pub enum HostAction {
    /// Send this update now.
    Send(FaceUpdate),
    /// Wait until this time, and call `plan` again.
    Wait(Time),
    /// Send no more updates.
    Nothing,
}

/// Runs the host program, which sends updates over the host's link and the ring to all graphics processors.
///
/// SEND of an update begins after EDIT of the previous update has finished (TR94). Whenever the host is ready for an
/// update, the program calls `plan` with the number of the next update and the current time.
///
/// # Errors
///
/// Returns [`Fault::Protocol`] if a message other than the master's answer arrives.
pub async fn host(
    gp: Gp,
    config: CubeControlConfig,
    timing: HostTiming,
    mut plan: impl FnMut(PictureNumber, Time) -> HostAction,
) -> Result<(), Fault> {
    let mut next = PictureNumber::FIRST;
    loop {
        // Choose the next update.
        let update = match plan(next, gp.now()) {
            HostAction::Send(update) => update,
            HostAction::Wait(until) => {
                gp.spend(until.since(gp.now())).await;
                continue;
            }
            HostAction::Nothing => return Ok(()),
        };
        // Send the update, and wait until all slaves have applied its edits.
        send(&gp, &config, timing, update).await;
        let received = gp.receive().await;
        if UpdateOrder::read(&received, gp.node())? != UpdateOrder::EditsDone(next) {
            return Err(Fault::Protocol { node: gp.node(), found: format!("while update {next} is being edited") });
        }
        next = next.next();
    }
}

async fn send(gp: &Gp, config: &CubeControlConfig, timing: HostTiming, update: FaceUpdate) {
    let number = update.number;
    gp.begin(Stage::Sample, number, None);
    gp.begin(Stage::Send, number, None);
    let (words, body) = UpdateOrder::Send(update).message();
    gp.spend(timing.link_span(words)).await;
    let receivers = config.slaves.iter().chain([&config.master]);
    let sent = gp.send_batch(receivers.map(|node| (*node, words, body.clone())).collect()).await;
    gp.accepted(sent).await;
    gp.end(Stage::Send, number, None);
}
