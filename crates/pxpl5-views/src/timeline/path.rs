//! From the tracker's sample to light: what one picture had to wait for.

use super::model::{Bar, Timeline};
use crate::experiment::Outcome;
use crate::observation::StageSpan;
use crate::pipelines::PictureTimes;
use pxpl5_framebuffer::Video;
use pxpl5_gp::Stage;
use pxpl5_sim::Time;
use pxpl5_wire::{FieldParity, RegionGrid};

/// A dependency: something could begin because something else had happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrow {
    /// Row and lane where it begins.
    pub from: Place,
    /// When.
    pub begin: Time,
    /// Row and lane where it ends.
    pub to: Place,
    /// When.
    pub end: Time,
}

/// Where in a drawing something happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Place {
    /// The tracker.
    Tracker,
    /// A lane of a row.
    Lane {
        /// The row.
        row: usize,
        /// Its lane.
        lane: usize,
    },
    /// The beam.
    Beam,
}

/// Which of the host's updates a picture shows.
pub(crate) struct Updates {
    /// The host samples for each picture, so both have the same number.
    by_picture: bool,
    /// When each update had reached the GP, and its number, in order.
    received: Vec<(Time, u64)>,
}

impl Updates {
    pub(crate) fn of(outcome: &Outcome, stages: &[StageSpan]) -> Self {
        let host = outcome.machine().ports().host;
        let marks = &outcome.observation().marks;
        let sends = stages.iter().filter(|span| span.stage == Stage::Send);
        let mut received: Vec<(Time, u64)> =
            sends.filter_map(|span| Some((span.end? + outcome.receive_span(), span.picture))).collect();
        received.sort_unstable();
        Self { by_picture: marks.iter().any(|mark| mark.stage == Stage::Sample && mark.node == host), received }
    }

    /// The picture's own update, or the last that had reached the GP when the picture began.
    pub(crate) fn shown_by(&self, times: &PictureTimes) -> Option<u64> {
        if self.by_picture {
            return Some(times.picture);
        }
        let taken = times.sampled_at?;
        let after = self.received.partition_point(|received| received.0 <= taken);
        Some(self.received[after.checked_sub(1)?].1)
    }
}

/// The arrows of the chosen picture.
pub(crate) fn arrows(timeline: &Timeline, video: &Video, chosen: Option<&PictureTimes>) -> Vec<Arrow> {
    let Some(chosen) = chosen else { return Vec::new() };
    let mut arrows = Vec::new();
    let bars = located(timeline);
    if let (Some(send), true) = (bars.iter().find(|bar| bar.1.stage == Stage::Send), timeline.samples.is_some()) {
        arrows.push(Arrow { from: Place::Tracker, begin: send.1.begin, to: send.0, end: send.1.begin });
    }
    for (place, bar) in &bars {
        arrows.extend(cause(&bars, bar).map(|(from, earlier)| follow(from, earlier, *place, bar)));
    }
    for (from, bar) in bars.iter().filter(|(_, bar)| bar.stage == Stage::Copy) {
        let end = light(video, chosen, bar);
        arrows.push(Arrow { from: *from, begin: bar.end.min(end), to: Place::Beam, end });
    }
    let within = |arrow: &Arrow| arrow.begin >= timeline.from && arrow.end <= timeline.to;
    arrows.retain(within);
    arrows
}

type Located<'a> = (Place, &'a Bar);

fn located(timeline: &Timeline) -> Vec<Located<'_>> {
    let rows = timeline.rows.iter().enumerate();
    let bars = rows.flat_map(|(row, it)| it.bars.iter().map(move |bar| (Place::Lane { row, lane: bar.lane }, bar)));
    bars.filter(|(_, bar)| timeline.is_chosen(bar)).collect()
}

/// The bar of the stage before, of the same eye where that stage has eyes; but a second eye's TRANSFORM follows the
/// first eye's, and a bottom half the top half.
fn cause<'a>(bars: &[Located<'a>], bar: &Bar) -> Option<Located<'a>> {
    let sibling = bars.iter().find(|(_, other)| other.stage == bar.stage && is_sequel(other, bar)).copied();
    if sibling.is_some() {
        return sibling;
    }
    let before: &[Stage] = match bar.stage {
        Stage::Edit => &[Stage::Send],
        Stage::Transform => &[Stage::Edit, Stage::Send],
        Stage::Render => &[Stage::Transform],
        Stage::Copy => &[Stage::Render],
        Stage::Sample | Stage::Send | Stage::Swap => &[],
    };
    let same_eye = |other: &Bar| other.eye.is_none() || bar.eye.is_none() || other.eye == bar.eye;
    let of = |stage| bars.iter().find(|(_, other)| other.stage == stage && same_eye(other)).copied();
    before.iter().find_map(|stage| of(*stage))
}

fn is_sequel(first: &Bar, second: &Bar) -> bool {
    match second.stage {
        Stage::Transform => first.eye < second.eye && first.eye.is_some(),
        Stage::Copy => first.eye == second.eye && first.bottom == Some(false) && second.bottom == Some(true),
        _ => false,
    }
}

/// A stage that begins before the other has ended depends on a part of it, and one that began before it depends on it
/// for a part: the arrow is upright.
fn follow(from: Place, earlier: &Bar, to: Place, bar: &Bar) -> Arrow {
    if bar.begin < earlier.begin {
        return Arrow { from, begin: earlier.end, to, end: earlier.end };
    }
    Arrow { from, begin: earlier.end.min(bar.begin), to, end: bar.begin }
}

/// When the first pixel of what was copied lights up; that of the part that stands for it, where it has a beam to meet.
fn light(video: &Video, chosen: &PictureTimes, bar: &Bar) -> Time {
    let field = video.field_at(chosen.shown_at);
    let top = if bar.bottom == Some(true) { 2 * RegionGrid::FIELD.region_height } else { 0 };
    let line = top + FieldParity::of_field(field).first_line();
    video.when(0, line, field).unwrap_or_default().max(chosen.shown_at)
}
