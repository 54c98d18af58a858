//! The host: passes on what the tracker delivers.

use crate::config::JitpConfig;
use crate::protocol::DrawingOrder;
use pxpl5_gp::{Fault, Gp, HostTiming, Stage};
use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;

/// Sends every report of the tracker to the master as it arrives; of several that wait, the newest.
///
/// `next_report` gives the arrival of the first report after an instant; `None` when the tracker has fallen silent for
/// good.
///
/// # Errors
///
/// None of its own; the type is that of a program.
pub async fn host(
    gp: Gp,
    config: JitpConfig,
    timing: HostTiming,
    mut next_report: impl FnMut(Time) -> Option<Time>,
) -> Result<(), Fault> {
    let mut known = Time::ZERO;
    // Which pictures will use a report is not known here: SEND is marked by the report's own number.
    for report in PictureNumber::FIRST.onwards() {
        let Some(arrives_at) = next_report(known) else { break };
        gp.spend(arrives_at.since(gp.now())).await;
        known = gp.now().max(arrives_at);
        gp.begin(Stage::Send, report, None);
        let (words, body) = DrawingOrder::Report { known }.message();
        gp.spend(timing.link_span(words)).await;
        let sent = gp.send(config.master, words, body).await;
        gp.accepted(sent).await;
        gp.end(Stage::Send, report, None);
    }
    Ok(())
}
