use crate::config::SlatsConfig;
use pphigs::{FrameView, send_as_tracked};
use pxpl5_gp::{Fault, Gp, HostTiming};
use pxpl5_sim::Time;
use pxpl5_wire::ViewNumber;

/// Sends the viewing transforms of both eyes to the first graphics processor.
///
/// The host sends the first message at the start of the run, and then a message for every report of the tracker
/// ([`send_as_tracked`]). The graphics processor uses the newest view when it begins a field.
///
/// `next_report` returns the arrival time of the first report after a time. `view_of` returns the view for a number and
/// for the time at which the pose is sampled.
///
/// # Errors
///
/// The function never returns an error. The function returns a `Result` only because all programs have this return
/// type.
pub async fn host(
    gp: Gp,
    config: SlatsConfig,
    timing: HostTiming,
    next_report: impl Fn(Time) -> Option<Time>,
    mut view_of: impl FnMut(ViewNumber, Time) -> FrameView,
) -> Result<(), Fault> {
    let words = |view, reports_until| view_of(view, reports_until).to_words();
    send_as_tracked(gp, config.processors[0], timing, Some(Time::ZERO), next_report, words).await
}
