//! What was observed of a run, and the pictures' histories that follow from it.

use crate::traffic::Traffic;
use pxpl5_gp::{Mark, Stage, StageEdge};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, PeriodNumber, PictureNumber, SurfaceId};
use std::collections::BTreeMap;

/// A region that has arrived at a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// The surface that it is for.
    pub surface: SurfaceId,
    /// Where on it the region belongs.
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

/// A swap at a tick of a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Swap {
    /// The surface that shows its other buffer.
    pub surface: SurfaceId,
    /// The period from whose begin on it does.
    pub tick: PeriodNumber,
}

/// Everything that was observed, in order of time as far as it was handled.
#[derive(Clone, Debug, Default)]
pub struct Observation {
    /// What the programs said.
    pub marks: Vec<Mark>,
    /// Regions that have arrived.
    pub arrivals: Vec<Arrival>,
    /// Swaps of double buffers, in the order in which displays made them.
    pub swaps: Vec<Swap>,
    /// Messages and FIFOs, if they were recorded.
    pub traffic: Option<Box<Traffic>>,
}

/// A stage of one picture and surface, from the first board that began it to the last one that ended it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageSpan {
    /// The picture that the stage worked for, in its pipeline's own count.
    pub picture: PictureNumber,
    /// The surface, for stages that take one eye at a time.
    pub surface: Option<SurfaceId>,
    /// Which part of the work it was.
    pub stage: Stage,
    /// When the first board began.
    pub begin: Time,
    /// When the last board ended; `None` if it has not.
    pub end: Option<Time>,
}

impl Observation {
    /// All stages in order of picture, surface and stage. COPY comes from the displays: from the begin of the first
    /// region's transfer (its first message is `message` long) to its last pixel.
    #[must_use]
    pub fn stages(&self, message: Span) -> Vec<StageSpan> {
        let mut spans: BTreeMap<(PictureNumber, Option<SurfaceId>, Stage), StageSpan> = BTreeMap::new();
        for mark in &self.marks {
            let fresh = StageSpan {
                picture: mark.picture,
                surface: mark.surface,
                stage: mark.stage,
                begin: mark.time,
                end: None,
            };
            let span = spans.entry((mark.picture, mark.surface, mark.stage)).or_insert(fresh);
            match mark.edge {
                StageEdge::Begin => span.begin = span.begin.min(mark.time),
                StageEdge::End => span.end = span.end.max(Some(mark.time)),
            }
        }
        for arrival in &self.arrivals {
            let picture = arrival.target.picture;
            let surface = Some(arrival.surface);
            let begin = arrival.begins_at(message);
            let fresh = StageSpan { picture, surface, stage: Stage::Copy, begin, end: None };
            let span = spans.entry((picture, surface, Stage::Copy)).or_insert(fresh);
            span.begin = span.begin.min(begin);
            span.end = span.end.max(Some(arrival.last_part_at));
        }
        spans.into_values().collect()
    }

    /// The ticks at which frame after frame was swapped in on all of the first `surfaces` surfaces.
    #[must_use]
    pub fn swap_ticks(&self, surfaces: usize) -> Vec<PeriodNumber> {
        let mut ticks: Vec<PeriodNumber> = self.swaps_of(SurfaceId(0)).collect();
        for surface in (1..surfaces as u16).map(SurfaceId) {
            ticks = ticks.into_iter().zip(self.swaps_of(surface)).map(|(a, b)| a.max(b)).collect();
        }
        ticks
    }

    /// The ticks at which a surface was swapped.
    pub fn swaps_of(&self, surface: SurfaceId) -> impl Iterator<Item = PeriodNumber> {
        self.swaps.iter().filter(move |swap| swap.surface == surface).map(|swap| swap.tick)
    }
}

/// A region that came after its deadline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct LateRegion {
    /// The period that it was for: an NTSC display's field.
    pub field: PeriodNumber,
    /// The surface that it was for.
    pub surface: SurfaceId,
    /// Its number in its picture's grid.
    pub region: u16,
    /// How much later than its deadline it was complete, picoseconds.
    pub lateness: Span,
}
