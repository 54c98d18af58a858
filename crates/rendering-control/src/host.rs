//! The host's program, which decides when each picture is sent, and sends the picture (SEND).

use crate::drawn::{Drawn, RenderingControlConfig, Sent};
use crate::protocol::StageOrder;
use pxpl5_gp::{Fault, Gp, HostTiming, Stage};
use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;

/// The next action of the host.
#[derive(Clone, Debug, PartialEq)]
pub enum HostAction<S> {
    /// Sends this picture now.
    Send(S),
    /// Waits until this time, and then calls `plan` again.
    Wait(Time),
    /// Ends the program.
    Nothing,
}

/// Runs the host's program, which sends one picture after the other to all graphics processors.
///
/// SEND of a picture may begin when EDIT of the previous picture has finished (TR94). Each time the host may send a
/// picture, the host's program calls `plan` with the number of the picture and the current time.
///
/// # Errors
///
/// Returns [`Fault::Protocol`] if the host gets any message except the master's report that EDIT has finished.
pub async fn host<D: Drawn>(
    gp: Gp,
    config: RenderingControlConfig<D>,
    timing: HostTiming,
    mut plan: impl FnMut(PictureNumber, Time) -> HostAction<D::Sent>,
) -> Result<(), Fault> {
    let mut next = PictureNumber::FIRST;
    loop {
        let sent = match plan(next, gp.now()) {
            HostAction::Send(sent) => sent,
            HostAction::Wait(until) => {
                gp.sleep_until(until).await;
                continue;
            }
            HostAction::Nothing => return Ok(()),
        };
        send(&gp, &config, timing, sent).await;
        // The next SEND must not begin before these edits are applied.
        let received = gp.receive().await;
        if StageOrder::<D::Sent>::read(&received, gp.node())? != StageOrder::EditsDone(next) {
            return Err(Fault::Protocol { node: gp.node(), found: format!("while picture {next} is being edited") });
        }
        next = next.next();
    }
}

async fn send<D: Drawn>(gp: &Gp, config: &RenderingControlConfig<D>, timing: HostTiming, sent: D::Sent) {
    let number = sent.number();
    gp.begin(Stage::Sample, number, None);
    gp.begin(Stage::Send, number, None);
    let (words, body) = StageOrder::Send(sent).message();
    // The words pass the slow link to the machine before they enter the ring.
    gp.spend(timing.link_span(words)).await;
    let receivers = config.slaves.iter().chain([&config.master]);
    let ticket = gp.send_batch(receivers.map(|node| (*node, words, body.clone())).collect()).await;
    gp.accepted(ticket).await;
    gp.end(Stage::Send, number, None);
}

/// Returns a function for the argument `plan` of `host`, which sends one picture after the other.
///
/// `start_of` receives the time at which the host may send a picture, and returns the time at which the picture begins.
/// The result is `None` after the last picture. `sent` returns what is sent for the pose of the head at a time.
pub fn frames<T>(
    start_of: impl Fn(Time) -> Option<Time>,
    mut sent: impl FnMut(PictureNumber, Time) -> T,
) -> impl FnMut(PictureNumber, Time) -> HostAction<T> {
    let mut start = None;
    move |picture, now| match start.take().or_else(|| start_of(now)) {
        None => HostAction::Nothing,
        Some(at) if at > now => {
            start = Some(at);
            HostAction::Wait(at)
        }
        // The sample is taken when SEND begins.
        Some(_) => HostAction::Send(sent(picture, now)),
    }
}
