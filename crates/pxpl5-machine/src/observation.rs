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
    /// How many swaps of that port came before it.
    pub number: u64,
    /// The period from whose begin on it does.
    pub tick: PeriodNumber,
    /// The buffer that is shown from then on; it may be the same as before.
    pub buffer: u8,
}

/// A picture, or a part of it, that a double-buffered port has shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shown {
    /// Which.
    pub picture: PictureNumber,
    /// When the last message of its first region had arrived.
    pub first_region_at: Time,
    /// The swap from which on it is shown.
    pub at: Time,
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
    /// Marks, arrivals and swaps before this instant are gone, but the last swap of each port, which says what is shown.
    pub before: Time,
    /// The first swap of all.
    pub first_swap: Option<PeriodNumber>,
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

    /// The frames that were swapped in on all of the first `surfaces` surfaces, by how many came before, and the ticks at which they
    /// were; those that were not given up.
    #[must_use]
    pub fn frames(&self, surfaces: usize) -> BTreeMap<u64, PeriodNumber> {
        let of = |surface| self.swaps_of(surface).map(|swap| (swap.number, swap.tick));
        let mut frames: BTreeMap<u64, PeriodNumber> = of(SurfaceId(0)).collect();
        for surface in (1..surfaces as u16).map(SurfaceId) {
            let ticks: BTreeMap<u64, PeriodNumber> = of(surface).collect();
            frames = frames.into_iter().filter_map(|(n, tick)| Some((n, tick.max(*ticks.get(&n)?)))).collect();
        }
        frames
    }

    /// The period from which on anything at all was shown.
    #[must_use]
    pub fn first_swap(&self) -> Option<PeriodNumber> {
        self.forgotten.first_swap.or_else(|| self.swaps.iter().map(|swap| swap.tick).min())
    }

    /// How many swaps of a port came before the first one that is held; 0 where none is.
    #[must_use]
    pub fn first_swap_held(&self, port: NodeId) -> u64 {
        self.swaps.iter().filter(|swap| swap.port == port).map(|swap| swap.number).min().unwrap_or_default()
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
        let first_swap = self.first_swap();
        let mut last: BTreeMap<NodeId, u64> = BTreeMap::new();
        let is_old = |swap: &Swap| tick(swap.tick) < instant;
        for swap in self.swaps.iter().filter(|swap| is_old(swap)) {
            last.entry(swap.port).and_modify(|last| *last = swap.number.max(*last)).or_insert(swap.number);
        }
        self.swaps.retain(|swap| !is_old(swap) || last[&swap.port] == swap.number);
        // Room for as much again stays: a run that gives up now and then takes it soon.
        self.marks.shrink_to(2 * self.marks.len());
        self.arrivals.shrink_to(2 * self.arrivals.len());
        self.forgotten = Forgotten { before: instant, first_swap, most_regions };
    }

    /// The swaps of a surface that are held, in order.
    pub fn swaps_of(&self, surface: SurfaceId) -> impl Iterator<Item = &Swap> {
        self.swaps.iter().filter(move |swap| swap.surface == surface)
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

#[cfg(test)]
mod tests {
    use super::*;

    const EYES: [SurfaceId; 2] = [SurfaceId(0), SurfaceId(1)];

    /// Two eyes that swap every second period, the second one period later.
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
    fn frames_keep_their_numbers_when_those_before_are_given_up() {
        let mut observation = stereo();
        let all = observation.frames(2);
        assert!(all.iter().all(|(number, tick)| tick.0 == 2 * number + 1) && all.len() == 20);
        // Between the swaps of frame 7's eyes: the first eye's swap is the last before the instant, and kept.
        observation.forget_before(Time(1_450), tick);
        let left = observation.frames(2);
        assert_eq!(left, all.into_iter().filter(|(number, _)| *number >= 7).collect());
        assert_eq!(observation.first_swap(), Some(PeriodNumber(0)));
        observation.forget_before(Time(1_900), tick);
        assert_eq!(observation.first_swap(), Some(PeriodNumber(0)), "it stays known");
    }

    #[test]
    fn what_is_shown_stays_known_however_long_ago_it_was_swapped_in() {
        let mut observation = stereo();
        observation.forget_before(Time(1_000_000), tick);
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
    fn a_stage_lasts_from_the_first_board_that_begins_to_the_last_that_ends() {
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
    fn what_lies_at_the_instant_stays_and_room_for_as_much_again() {
        let mut observation = stereo();
        observation.marks = (0..1_000).map(|n| mark(n, n, StageEdge::Begin)).collect();
        observation.arrivals = (0..1_000).map(|n| arrival(0, n / 2, n, n)).collect();
        observation.forget_before(Time(900), tick);
        assert!(observation.marks.iter().map(|mark| mark.time.0).eq(900..1_000));
        assert!(observation.arrivals.iter().map(|arrival| arrival.last_part_at.0).eq(900..1_000));
        for capacity in [observation.marks.capacity(), observation.arrivals.capacity()] {
            assert!((200..1_000).contains(&capacity), "{capacity}");
        }
        // Swaps at 900 (the second eye's, whose period 9 begins then) and later, and the last one of each eye before.
        let of = |surface| observation.swaps_of(surface).map(|swap| swap.tick.0).collect::<Vec<_>>();
        assert_eq!(of(EYES[0])[..2], [8, 10]);
        assert_eq!(of(EYES[1])[..3], [7, 9, 11]);
        assert_eq!(observation.records(), 100 + 100 + of(EYES[0]).len() + of(EYES[1]).len());
        assert_eq!(observation.forgotten.before, Time(900));
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
