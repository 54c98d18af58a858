//! SEND of a host that does not wait for the pipeline.

use pxpl5_gp::{Fault, Gp, HostTiming, Stage, Ticket};
use pxpl5_sim::Time;
use pxpl5_wire::{Body, NodeId, ViewNumber, Word};

/// Sends what the tracker delivers to one board, as quickly and as often as tracker, link and ring allow (TR94): a message
/// for each report, as soon as the report is there and the message before it has been accepted. Of several reports that wait
/// meanwhile the newest is sent.
///
/// The first message goes at `first`; `None` if there is none. `next_report` gives the arrival of the first report after an
/// instant; `None` when the tracker has fallen silent for good. `message` makes the words of a message by its number, with
/// all that the host knows at an instant.
///
/// # Errors
///
/// None of its own; the type is that of a program.
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
        gp.spend(at.since(gp.now())).await;
        let known = gp.now();
        // Which pictures will show it is not known here: SEND is marked by the message's own number.
        let marked_as = number.picture_taken_for();
        gp.begin(Stage::Send, marked_as, None);
        let sent = send(&gp, receiver, timing, message(number, known)).await;
        gp.accepted(sent).await;
        gp.end(Stage::Send, marked_as, None);
        due = next_report(known);
        number = number.next();
    }
    Ok(())
}

/// Pays the link, then the message.
async fn send(gp: &Gp, receiver: NodeId, timing: HostTiming, words: Vec<Word>) -> Ticket {
    let length = words.len() as u32;
    gp.spend(timing.link_span(length)).await;
    gp.send(receiver, length, Body::Words(words.into())).await
}
