//! Finds the update that each picture shows. An update is a head pose with edits of the scene, which the host sends.

use pxpl5_gp::Stage;
use pxpl5_machine::StageSpan;
use pxpl5_run::{FinalResults, PictureTimes};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::PictureNumber;

/// The updates (head poses with edits) that the host sent in a run.
pub(crate) struct Updates {
    /// True if the host samples a pose for each picture. In this case, an update and the picture that shows the update
    /// have the same number.
    by_picture: bool,
    /// Updates that a graphics processor has received, in order of time.
    received: Vec<Received>,
}

#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Received {
    at: Time,
    /// Number of the SEND in which the host sent the update.
    update: PictureNumber,
}

impl Updates {
    pub(crate) fn of(run: &FinalResults<'_>, stages: &[StageSpan]) -> Self {
        let sends = stages.iter().filter(|span| span.stage == Stage::Send);
        let receive_span = Span::from_ns(run.record.config().gp.message_ns);
        let mut received: Vec<Received> =
            sends.filter_map(|send| Some(Received { at: send.end? + receive_span, update: send.picture })).collect();
        received.sort_unstable();
        Self { by_picture: host_samples(run), received }
    }

    /// Returns the update that a picture shows.
    ///
    /// A graphics processor may sample the poses instead of the host. The result is then the newest update that had
    /// arrived at this processor when the picture's pose was sampled.
    pub(crate) fn shown_by(&self, times: &PictureTimes) -> Option<PictureNumber> {
        if self.by_picture {
            return Some(times.picture);
        }
        let taken = times.sampled_at?;
        let after = self.received.partition_point(|received| received.at <= taken);
        Some(self.received[after.checked_sub(1)?].update)
    }
}

/// Returns true if the host samples the poses of pictures. Otherwise a graphics processor samples them.
fn host_samples(run: &FinalResults<'_>) -> bool {
    let host = run.record.ports().host;
    run.record.observation().marks.iter().any(|mark| mark.stage == Stage::Sample && mark.node == host)
}
