//! SEND for a host that sends every tracker report at once.

use pxpl5_gp::{Fault, Gp, HostTiming, Stage, Ticket};
use pxpl5_sim::Time;
use pxpl5_wire::{Body, NodeId, ViewNumber, Word};

/// Sends the tracker's reports to one board, as often as tracker, link and ring permit (TR94).
///
/// A message is sent for each report, when the previous message has been accepted. If several reports have arrived in
/// the meantime, only the newest report is sent.
///
/// The first message is sent at `first`, if there is such a time. `next_report` returns the arrival time of the first
/// report after a time, or `None` if no more reports follow. `message` makes the words of a message from its number and
/// a time. The words use only reports that the host has received by that time.
///
/// # Errors
///
/// The function never returns an error. The return type is the same for all programs.
pub async fn send_as_tracked(
    gp: Gp,
    receiver: NodeId,
    timing: HostTiming,
    first: Option<Time>,
    next_report: impl Fn(Time) -> Option<Time>,
    mut message: impl FnMut(ViewNumber, Time) -> Vec<Word>,
) -> Result<(), Fault> {
    let mut due = first;
    let mut number = ViewNumber::FIRST;
    while let Some(at) = due {
        gp.sleep_until(at).await;
        let reports_until = gp.now();
        // The pictures that will show this view are not determined yet, so the record of SEND has the number of the
        // message.
        let marked_as = number.picture_taken_for();
        gp.begin(Stage::Send, marked_as, None);
        let sent = send(&gp, receiver, timing, message(number, reports_until)).await;
        gp.accepted(sent).await;
        gp.end(Stage::Send, marked_as, None);
        due = next_report(reports_until);
        number = number.next();
    }
    Ok(())
}

/// Waits for the transfer of a message over the host's link, and then sends the message on the ring.
async fn send(gp: &Gp, receiver: NodeId, timing: HostTiming, words: Vec<Word>) -> Ticket {
    let length = words.len() as u32;
    gp.spend(timing.link_span(length)).await;
    gp.send(receiver, length, Body::Words(words.into())).await
}
