use crate::config::JitpConfig;
use crate::protocol::DrawingOrder;
use pphigs::send_as_tracked;
use pxpl5_gp::{Fault, Gp, HostTiming};
use pxpl5_sim::Time;

/// Sends every report of the tracker to the master. If several reports wait, only the newest report is sent
/// ([`send_as_tracked`]).
///
/// `next_report` returns the arrival time of the first report after a time, or `None` if no more reports follow.
///
/// # Errors
///
/// The function never returns an error. The function returns a `Result` only because all programs have this return
/// type.
pub async fn host(
    gp: Gp,
    config: JitpConfig,
    timing: HostTiming,
    next_report: impl Fn(Time) -> Option<Time>,
) -> Result<(), Fault> {
    let first = next_report(Time::ZERO);
    let words = |_, reports_until| DrawingOrder::Report { reports_until }.words();
    send_as_tracked(gp, config.master, timing, first, next_report, words).await
}
