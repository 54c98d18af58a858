//! Which of the host's updates a picture shows.

use pxpl5_gp::Stage;
use pxpl5_machine::StageSpan;
use pxpl5_run::{PictureTimes, SoFar};
use pxpl5_sim::Time;
use pxpl5_wire::PictureNumber;

/// The host's updates of a run.
pub(crate) struct Updates {
    /// The host samples for each picture, so both have the same number.
    by_picture: bool,
    /// In order of time.
    received: Vec<Received>,
}

/// An update that had reached the GP.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Received {
    at: Time,
    /// The number that its SEND bears.
    update: PictureNumber,
}

impl Updates {
    pub(crate) fn of(run: &SoFar<'_>, stages: &[StageSpan]) -> Self {
        let sends = stages.iter().filter(|span| span.stage == Stage::Send);
        let receive_span = run.receive_span();
        let mut received: Vec<Received> =
            sends.filter_map(|send| Some(Received { at: send.end? + receive_span, update: send.picture })).collect();
        received.sort_unstable();
        Self { by_picture: host_samples(run), received }
    }

    /// The picture's own update, or the last that had reached the GP when the picture began.
    pub(crate) fn shown_by(&self, times: &PictureTimes) -> Option<PictureNumber> {
        if self.by_picture {
            return Some(times.picture);
        }
        let taken = times.sampled_at?;
        let after = self.received.partition_point(|received| received.at <= taken);
        Some(self.received[after.checked_sub(1)?].update)
    }
}

/// Whether it is the host that samples the poses of pictures.
fn host_samples(run: &SoFar<'_>) -> bool {
    let host = run.record().ports().host;
    run.observation().marks.iter().any(|mark| mark.stage == Stage::Sample && mark.node == host)
}
