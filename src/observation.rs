//! What was observed of a run, and the pictures' histories that follow from it.

use crate::traffic::Traffic;
use pxpl5_framebuffer::Video;
use pxpl5_gp::{Edge, Mark, Stage};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, Eye};
use std::collections::BTreeMap;

/// A region that has arrived in a frame buffer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// Frame buffer, 0 left, 1 right.
    pub board: usize,
    /// Where it went.
    pub target: CopyTarget,
    /// When its first message had arrived.
    pub first_part_at: Time,
    /// When its last message had arrived.
    pub last_part_at: Time,
}

impl Arrival {
    /// When its first word was on the channel; its messages are `message` long.
    #[must_use]
    pub const fn begins_at(&self, message: Span) -> Time {
        Time(self.first_part_at.0.saturating_sub(message.0))
    }
}

/// A swap at the retrace that begins a field.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Swap {
    /// Frame buffer, 0 left, 1 right.
    pub board: usize,
    /// The first field scanned from the new buffer.
    pub field: u64,
}

/// Everything that was observed, in order of time as far as it was handled.
#[derive(Clone, Debug, Default)]
pub struct Observation {
    /// What the programs said.
    pub marks: Vec<Mark>,
    /// Regions that have arrived.
    pub arrivals: Vec<Arrival>,
    /// Swaps.
    pub swaps: Vec<Swap>,
    /// Messages and FIFOs, if they were recorded.
    pub traffic: Option<Box<Traffic>>,
}

/// A stage of one picture and eye, from the first board that began it to the last one that ended it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageSpan {
    /// Frame or field.
    pub picture: u64,
    /// The eye, for stages that take one eye at a time.
    pub eye: Option<Eye>,
    /// The stage.
    pub stage: Stage,
    /// When the first board began.
    pub begin: Time,
    /// When the last board ended; `None` if it has not.
    pub end: Option<Time>,
}

impl Observation {
    /// All stages in order of picture, eye and stage. COPY comes from the frame buffers: from the begin of the first
    /// region's transfer (its first message is `message` long) to its last pixel.
    #[must_use]
    pub fn stages(&self, message: Span) -> Vec<StageSpan> {
        let mut spans: BTreeMap<(u64, Option<Eye>, Stage), StageSpan> = BTreeMap::new();
        for mark in &self.marks {
            let fresh =
                StageSpan { picture: mark.picture, eye: mark.eye, stage: mark.stage, begin: mark.time, end: None };
            let span = spans.entry((mark.picture, mark.eye, mark.stage)).or_insert(fresh);
            match mark.edge {
                Edge::Begin => span.begin = span.begin.min(mark.time),
                Edge::End => span.end = span.end.max(Some(mark.time)),
            }
        }
        for arrival in &self.arrivals {
            let (eye, picture) = (Eye::BOTH[arrival.board.min(1)], arrival.target.picture);
            let begin = arrival.begins_at(message);
            let fresh = StageSpan { picture, eye: Some(eye), stage: Stage::Copy, begin, end: None };
            let span = spans.entry((picture, Some(eye), Stage::Copy)).or_insert(fresh);
            span.begin = span.begin.min(begin);
            span.end = span.end.max(Some(arrival.last_part_at));
        }
        spans.into_values().collect()
    }

    /// The fields at which frame after frame was swapped in on all boards.
    #[must_use]
    pub fn swap_fields(&self, boards: usize) -> Vec<u64> {
        let of = |board: usize| self.swaps.iter().filter(move |swap| swap.board == board).map(|swap| swap.field);
        let mut fields: Vec<u64> = of(0).collect();
        for board in 1..boards {
            fields = fields.into_iter().zip(of(board)).map(|(a, b)| a.max(b)).collect();
        }
        fields
    }
}

/// A region that came after its deadline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct LateRegion {
    /// The field it was for.
    pub field: u64,
    /// The eye.
    pub eye: Eye,
    /// The region.
    pub region: u16,
    /// By how much.
    pub lateness: Span,
}

/// When a region of a field must be complete.
pub(crate) fn deadline(video: &Video, target: &CopyTarget, before_retrace: bool) -> Time {
    let retrace = video.retrace(target.picture);
    if before_retrace { retrace } else { video.reaches(target, target.picture).unwrap_or(retrace) }
}
