//! What was observed of a run, and the pictures' histories that follow from it.

use crate::traffic::Traffic;
use pxpl5_gp::{Mark, Stage, StageEdge};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, NodeId, PeriodNumber, PictureNumber, SurfaceId};
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
    /// The port of the ring that fills it, or that part of it which swapped.
    pub port: NodeId,
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
    /// What is still known of records that were given up.
    pub forgotten: Forgotten,
}

/// What is known of records that were given up so that a long run has room: see [`Machine::forget_before`](crate::Machine::forget_before).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Forgotten {
    /// Marks and arrivals before this instant are gone.
    pub before: Time,
    /// As many swaps of every surface that swaps are gone: frames, where all of a frame's surfaces are swapped.
    pub frames: u64,
    /// Most regions that were there of one picture when records were given up.
    pub most_regions: u32,
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

    /// The ticks at which frame after frame was swapped in on all of the first `surfaces` surfaces, from the first that was not
    /// given up.
    #[must_use]
    pub fn swap_ticks(&self, surfaces: usize) -> Vec<PeriodNumber> {
        let mut ticks: Vec<PeriodNumber> = self.swaps_of(SurfaceId(0)).collect();
        for surface in (1..surfaces as u16).map(SurfaceId) {
            ticks = ticks.into_iter().zip(self.swaps_of(surface)).map(|(a, b)| a.max(b)).collect();
        }
        ticks
    }

    /// Most regions that have arrived of one picture, in the whole run.
    #[must_use]
    pub fn most_regions_of_a_picture(&self) -> u32 {
        let mut of_pictures: BTreeMap<PictureNumber, u32> = BTreeMap::new();
        self.arrivals.iter().for_each(|arrival| *of_pictures.entry(arrival.target.picture).or_default() += 1);
        of_pictures.into_values().max().unwrap_or_default().max(self.forgotten.most_regions)
    }

    /// Marks, arrivals and swaps that are held.
    #[must_use]
    pub fn records(&self) -> usize {
        self.marks.len() + self.arrivals.len() + self.swaps.len()
    }

    /// Gives up what was before an instant; `tick` tells when a period begins.
    pub(crate) fn forget_before(&mut self, instant: Time, tick: impl Fn(PeriodNumber) -> Time) {
        let most_regions = self.most_regions_of_a_picture();
        if let Some(traffic) = &mut self.traffic {
            traffic.forget_before(instant);
        }
        self.marks.retain(|mark| mark.time >= instant);
        self.arrivals.retain(|arrival| arrival.last_part_at >= instant);
        let mut swapped: BTreeMap<SurfaceId, u64> = BTreeMap::new();
        self.swaps
            .iter()
            .for_each(|swap| *swapped.entry(swap.surface).or_default() += u64::from(tick(swap.tick) < instant));
        let gone = swapped.values().copied().min().unwrap_or_default();
        swapped.values_mut().for_each(|left| *left = gone);
        self.swaps.retain(|swap| {
            let left = swapped.get_mut(&swap.surface).filter(|left| **left > 0);
            left.map(|left| *left -= 1).is_none()
        });
        self.marks.shrink_to(2 * self.marks.len());
        self.arrivals.shrink_to(2 * self.arrivals.len());
        self.forgotten = Forgotten { before: instant, frames: self.forgotten.frames + gone, most_regions };
    }

    /// The ticks at which a surface was swapped, of swaps that are held.
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
