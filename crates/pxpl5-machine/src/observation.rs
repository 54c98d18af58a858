//! Observations of a run, and the stages of pictures that follow from these observations.

use crate::traffic::Traffic;
use pxpl5_gp::{Mark, Stage, StageEdge};
use pxpl5_renderer::DrawnRegion;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, NodeId, PeriodNumber, PictureNumber, SurfaceId};
use std::collections::BTreeMap;

/// The arrival of a region of a picture at a display.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Arrival {
    /// The surface that shows the region.
    pub surface: SurfaceId,
    /// The region: its picture, its index in the picture, and its port of the display.
    pub target: CopyTarget,
    /// Arrival of the region's first message.
    pub first_part_at: Time,
    /// Arrival of the region's last message.
    pub last_part_at: Time,
}

impl Arrival {
    /// Returns the time at which the transfer of the region began on the ring. `message` is the duration of one
    /// message.
    pub const fn begins_at(&self, message: Span) -> Time {
        Time(self.first_part_at.0.saturating_sub(message.0))
    }
}

/// A change of the visible buffer of a display, at the start of a display period.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Swap {
    /// The surface whose visible buffer changes.
    pub surface: SurfaceId,
    /// The ring port whose visible buffer changes. A surface may have several ports.
    pub port: NodeId,
    /// Number of earlier swaps at this port.
    pub number: u64,
    /// The display period at whose start the swap takes effect.
    pub tick: PeriodNumber,
    /// The buffer that is visible from now on. The buffer can be the same as before.
    pub buffer: u8,
}

/// A picture that a port of a display has shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Number of the picture, as counted by its pipeline.
    pub picture: PictureNumber,
    /// Arrival of the last message of the picture's first region.
    pub first_region_at: Time,
    /// Time of the swap that made the picture visible.
    pub at: Time,
}

/// All observations of a run. Each list is in the order in which the machine handled the events.
#[derive(Clone, Debug, Default)]
pub struct Observation {
    /// Time stamps that programs set at the start and end of each stage of a picture.
    pub marks: Vec<Mark>,
    /// Regions that have arrived at displays.
    pub arrivals: Vec<Arrival>,
    /// Swaps of double buffers, in the order in which displays made them.
    pub swaps: Vec<Swap>,
    /// Regions that renderers have copied, each with the index of its renderer, in the order in which the copies
    /// started.
    pub drawn: Vec<(usize, DrawnRegion)>,
    /// Ring messages, and use of channels and FIFOs. `None` unless recording was enabled.
    pub traffic: Option<Box<Traffic>>,
    /// Summary of observations that were discarded to save memory.
    pub discarded: DiscardedSummary,
}

/// Summary of the observations that [`Machine::discard_before`](crate::Machine::discard_before) has discarded in a long
/// run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct DiscardedSummary {
    /// The instant before which observations were discarded. The last earlier swap of each port is kept.
    pub before: Time,
    /// Period of the first swap in the whole run, including discarded swaps.
    pub first_swap: Option<PeriodNumber>,
    /// Largest number of regions that arrived for one picture, up to the last call of `discard_before`.
    pub most_regions: u32,
    /// Number of calls of `discard_before`.
    pub passes: u64,
}

/// One stage of a picture, from the first board that begins to the last board that ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StageSpan {
    /// Number of the picture, as counted by its pipeline.
    pub picture: PictureNumber,
    /// The surface, if the stage handles one surface at a time.
    pub surface: Option<SurfaceId>,
    /// The kind of work, such as TRANSFORM or COPY.
    pub stage: Stage,
    /// Time at which the first board began.
    pub begin: Time,
    /// Time at which the last board ended. `None` if no board has ended.
    pub end: Option<Time>,
}

impl Observation {
    /// Returns all stages in the order of picture, surface and stage.
    ///
    /// Programs record the stages, except COPY. COPY lasts from the first to the last word of the picture's regions at
    /// the displays. `message` is the duration of one message.
    pub fn stages(&self, message: Span) -> Vec<StageSpan> {
        let mut spans: BTreeMap<(PictureNumber, Option<SurfaceId>, Stage), StageSpan> = BTreeMap::new();
        // Stages for which programs have set time stamps.
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
        // COPY, for which no program sets time stamps.
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

    /// Returns the period in which each frame was first visible on all of the first `surfaces` surfaces.
    ///
    /// A key of the map is the number of a swap, which counts from 0 on each surface. Frames with discarded swaps are
    /// missing.
    pub fn frames(&self, surfaces: usize) -> BTreeMap<u64, PeriodNumber> {
        let of = |surface| self.swaps_of(surface).map(|swap| (swap.number, swap.tick));
        let mut frames: BTreeMap<u64, PeriodNumber> = of(SurfaceId(0)).collect();
        for surface in (1..surfaces as u16).map(SurfaceId) {
            let ticks: BTreeMap<u64, PeriodNumber> = of(surface).collect();
            frames = frames.into_iter().filter_map(|(n, tick)| Some((n, tick.max(*ticks.get(&n)?)))).collect();
        }
        frames
    }

    /// Returns the display period of the first swap in the run, or `None` if no display has swapped.
    pub fn first_swap(&self) -> Option<PeriodNumber> {
        self.discarded.first_swap.or_else(|| self.swaps.iter().map(|swap| swap.tick).min())
    }

    /// Returns the number of swaps of a port that were discarded. Returns 0 if no swap of this port is in memory.
    pub fn first_swap_held(&self, port: NodeId) -> u64 {
        self.swaps.iter().filter(|swap| swap.port == port).map(|swap| swap.number).min().unwrap_or_default()
    }

    /// Returns the largest number of regions that arrived for one picture, over the whole run.
    pub fn most_regions_of_a_picture(&self) -> u32 {
        let mut of_pictures: BTreeMap<PictureNumber, u32> = BTreeMap::new();
        self.arrivals.iter().for_each(|arrival| *of_pictures.entry(arrival.target.picture).or_default() += 1);
        of_pictures.into_values().max().unwrap_or_default().max(self.discarded.most_regions)
    }

    /// Returns the number of time stamps, arrivals and swaps in memory.
    pub fn records(&self) -> usize {
        self.marks.len() + self.arrivals.len() + self.swaps.len()
    }

    pub(crate) fn discard_before(&mut self, instant: Time, tick: impl Fn(PeriodNumber) -> Time) {
        let most_regions = self.most_regions_of_a_picture();
        if let Some(traffic) = &mut self.traffic {
            traffic.discard_before(instant);
        }
        self.marks.retain(|mark| mark.time >= instant);
        self.arrivals.retain(|arrival| arrival.last_part_at >= instant);
        self.drawn.retain(|(_, region)| region.copy_at >= instant);
        // Keep the last old swap of each port, because this swap determines the visible buffer.
        let first_swap = self.first_swap();
        let mut last: BTreeMap<NodeId, u64> = BTreeMap::new();
        let is_old = |swap: &Swap| tick(swap.tick) < instant;
        for swap in self.swaps.iter().filter(|swap| is_old(swap)) {
            last.entry(swap.port).and_modify(|last| *last = swap.number.max(*last)).or_insert(swap.number);
        }
        self.swaps.retain(|swap| !is_old(swap) || last[&swap.port] == swap.number);
        // Keep capacity for twice the number of records. A run that discards records regularly soon needs the space
        // again.
        self.marks.shrink_to(2 * self.marks.len());
        self.arrivals.shrink_to(2 * self.arrivals.len());
        self.drawn.shrink_to(2 * self.drawn.len());
        let passes = self.discarded.passes + 1;
        self.discarded = DiscardedSummary { before: instant, first_swap, most_regions, passes };
    }

    /// Returns the swaps of a surface in memory, in the order of time.
    pub fn swaps_of(&self, surface: SurfaceId) -> impl Iterator<Item = &Swap> {
        self.swaps.iter().filter(move |swap| swap.surface == surface)
    }
}

/// A region that arrived after its deadline.
///
/// The deadline is the instant when the display needs the pixels of the region.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct LateRegion {
    /// The display period for which the region was drawn.
    pub field: PeriodNumber,
    /// The surface that should have shown the region.
    pub surface: SurfaceId,
    /// Index of the region in the picture's grid of regions.
    pub region: u16,
    /// Time from the deadline to the arrival of the last pixel, in picoseconds.
    pub lateness: Span,
}

#[cfg(test)]
mod tests {
    use super::*;

    const EYES: [SurfaceId; 2] = [SurfaceId(0), SurfaceId(1)];

    /// Returns the swaps of two eyes. Each eye swaps every second period, and the second eye swaps one period after the
    /// first eye.
    fn stereo() -> Observation {
        let swap = |number: u64| {
            EYES.map(|surface| {
                let tick = PeriodNumber(2 * number + u64::from(surface.0));
                Swap { surface, port: NodeId(10 + surface.0), number, tick, buffer: number as u8 % 2 }
            })
        };
        Observation { swaps: (0..20).flat_map(swap).collect(), ..Observation::default() }
    }

    fn tick(period: PeriodNumber) -> Time {
        Time(100 * period.0)
    }

    #[test]
    fn frames_keep_their_numbers_when_earlier_frames_are_discarded() {
        let mut observation = stereo();
        let all = observation.frames(2);
        assert!(all.iter().all(|(number, tick)| tick.0 == 2 * number + 1) && all.len() == 20);
        // This instant lies between the swaps of both eyes for frame 7. The first eye's swap is the last swap before
        // the instant, so the swap is kept.
        observation.discard_before(Time(1_450), tick);
        let left = observation.frames(2);
        assert_eq!(left, all.into_iter().filter(|(number, _)| *number >= 7).collect());
        assert_eq!(observation.first_swap(), Some(PeriodNumber(0)));
        observation.discard_before(Time(1_900), tick);
        assert_eq!(observation.first_swap(), Some(PeriodNumber(0)), "it stays known");
    }

    #[test]
    fn the_displayed_frame_is_kept_however_old_it_is() {
        let mut observation = stereo();
        observation.discard_before(Time(1_000_000), tick);
        let left: Vec<(SurfaceId, u64)> = observation.swaps.iter().map(|swap| (swap.surface, swap.number)).collect();
        assert_eq!(left, EYES.map(|surface| (surface, 19)));
    }

    fn arrival(surface: u16, picture: u64, first: u64, last: u64) -> Arrival {
        let grid = pxpl5_wire::RegionGrid::FRAME;
        let target = CopyTarget {
            frame_buffer: NodeId(10),
            buffer: 0,
            lines: pxpl5_wire::Lines::Frame,
            grid,
            region: pxpl5_wire::RegionId(0),
            picture: PictureNumber(picture),
        };
        Arrival { surface: SurfaceId(surface), target, first_part_at: Time(first), last_part_at: Time(last) }
    }

    fn mark(time: u64, picture: u64, edge: StageEdge) -> Mark {
        let (node, picture) = (NodeId(1), PictureNumber(picture));
        Mark { time: Time(time), node, picture, surface: None, stage: Stage::Render, edge, view: None }
    }

    #[test]
    fn a_stage_lasts_from_the_begin_on_the_first_board_to_the_end_on_the_last_board() {
        let marks = [(30, 1), (20, 1), (25, 2), (35, 1)].map(|(time, picture)| mark(time, picture, StageEdge::Begin));
        let ends = [(40, 1), (60, 1), (50, 1)].map(|(time, picture)| mark(time, picture, StageEdge::End));
        let arrivals = vec![arrival(1, 1, 70, 90), arrival(0, 1, 65, 80), arrival(1, 1, 68, 85)];
        let observation = Observation { marks: [&marks[..], &ends].concat(), arrivals, ..Observation::default() };
        let span = |picture, surface: Option<u16>, stage, begin, end: Option<u64>| StageSpan {
            picture: PictureNumber(picture),
            surface: surface.map(SurfaceId),
            stage,
            begin: Time(begin),
            end: end.map(Time),
        };
        let expected = [
            span(1, None, Stage::Render, 20, Some(60)),
            span(1, Some(0), Stage::Copy, 65 - 8, Some(80)),
            span(1, Some(1), Stage::Copy, 68 - 8, Some(90)),
            span(2, None, Stage::Render, 25, None),
        ];
        assert_eq!(observation.stages(Span(8)), expected, "messages take 8");
        assert_eq!(observation.records(), 7 + 3);
        assert_eq!(observation.most_regions_of_a_picture(), 3);
    }

    #[test]
    fn discarding_keeps_records_at_and_after_the_instant() {
        let mut observation = stereo();
        observation.marks = (0..1_000).map(|n| mark(n, n, StageEdge::Begin)).collect();
        observation.arrivals = (0..1_000).map(|n| arrival(0, n / 2, n, n)).collect();
        observation.discard_before(Time(900), tick);
        assert!(observation.marks.iter().map(|mark| mark.time.0).eq(900..1_000));
        assert!(observation.arrivals.iter().map(|arrival| arrival.last_part_at.0).eq(900..1_000));
        for capacity in [observation.marks.capacity(), observation.arrivals.capacity()] {
            assert!((200..1_000).contains(&capacity), "{capacity}");
        }
        // The swaps from time 900 on are kept, and the last swap of each eye before time 900.
        let of = |surface| observation.swaps_of(surface).map(|swap| swap.tick.0).collect::<Vec<_>>();
        assert_eq!(of(EYES[0])[..2], [8, 10]);
        assert_eq!(of(EYES[1])[..3], [7, 9, 11]);
        assert_eq!(observation.records(), 100 + 100 + of(EYES[0]).len() + of(EYES[1]).len());
        assert_eq!(observation.discarded.before, Time(900));
        assert_eq!(observation.most_regions_of_a_picture(), 2);
        observation.arrivals.clear();
        assert_eq!(observation.most_regions_of_a_picture(), 2, "it stays known");
    }

    #[test]
    fn the_first_swap_is_the_earliest_of_all_surfaces() {
        let mut observation = stereo();
        assert_eq!(Observation::default().first_swap(), None);
        observation.swaps.retain(|swap| swap.number > 3);
        observation.swaps.reverse();
        assert_eq!(observation.first_swap(), Some(PeriodNumber(8)));
        assert_eq!(observation.frames(1).len(), 16);
        assert_eq!(observation.frames(3).len(), 0, "a third surface never swapped");
    }
}
