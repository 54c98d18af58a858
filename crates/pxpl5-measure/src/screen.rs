//! The region whose pixels are on the screen at any instant, derived from the records of arrived regions.

use pxpl5_machine::Arrival;
use pxpl5_run::{FinalResults, region_at};
use pxpl5_sim::Time;
use pxpl5_wire::{CopyTarget, Lines, PeriodNumber, PictureNumber, RegionGrid, RegionId, SurfaceId};

/// Arrivals of regions on a run's first surface. The region that a pixel shows at any time follows from these arrivals.
#[derive(Debug, Default)]
pub(crate) struct Screen {
    cuts: Vec<Cut>,
    /// The swaps of the two buffers: the period from which a buffer is shown, and the buffer. A program may ask for the
    /// same buffer twice, so the buffers need not alternate.
    swaps: Vec<(PeriodNumber, u8)>,
}

/// Arrivals of regions in one buffer, for one division of the screen into regions, sorted by region and time.
#[derive(Debug)]
struct Cut {
    /// Copy target of the first arrival. All arrivals have the same buffer and the same division of the screen. The
    /// region and the picture in this target are ignored.
    of: CopyTarget,
    regions: Vec<Vec<(Time, PictureNumber)>>,
}

impl Cut {
    const fn key(target: &CopyTarget) -> (u8, Lines, RegionGrid) {
        (target.buffer, target.lines, target.grid)
    }

    /// Returns the newest arrival, up to the instant `at`, of the region that contains a pixel.
    fn newest(&self, x: u32, y: u32, at: Time) -> Option<(Time, CopyTarget)> {
        let row = match self.of.lines {
            Lines::Frame => y,
            Lines::Field(parity) if y % 2 == parity.first_line() => y / 2,
            Lines::Field(_) => return None,
        };
        let region = region_at(&self.of.grid, x, row);
        let arrived = self.regions.get(usize::from(region.0))?;
        let (time, picture) = *arrived[..arrived.partition_point(|a| a.0 <= at)].last()?;
        Some((time, CopyTarget { region, picture, ..self.of }))
    }
}

impl Screen {
    /// Adds the arrivals of regions since the last call. Replaces the list of swaps by the swaps that the run still has
    /// in memory.
    pub(crate) fn take(&mut self, run: &FinalResults<'_>) {
        let arrived = run.arrivals.iter().filter(|arrival| arrival.surface == SurfaceId(0));
        arrived.for_each(|arrival| self.arrive(arrival));
        let swaps = run.record.observation().swaps_of(SurfaceId(0));
        self.swaps = swaps.map(|swap| (swap.tick, swap.buffer)).collect();
    }

    fn arrive(&mut self, arrival: &Arrival) {
        let target = arrival.target;
        // Find the division of the picture into regions to which this region belongs, or add a new division.
        let place = self.cuts.iter().position(|cut| Cut::key(&cut.of) == Cut::key(&target)).unwrap_or_else(|| {
            self.cuts.push(Cut { of: target, regions: vec![Vec::new(); target.grid.regions() as usize] });
            self.cuts.len() - 1
        });
        if let Some(region) = self.cuts[place].regions.get_mut(usize::from(target.region.0)) {
            region.push((arrival.last_part_at, target.picture));
        }
    }

    /// Discards the arrivals of regions that later arrivals had replaced on the screen by `instant`.
    pub(crate) fn discard_before(&mut self, instant: Time) {
        for region in self.cuts.iter_mut().flat_map(|cut| &mut cut.regions) {
            let there = region.partition_point(|arrived| arrived.0 <= instant);
            region.drain(..there.saturating_sub(1));
        }
    }

    pub(crate) fn targets(&self) -> impl Iterator<Item = CopyTarget> {
        self.cuts.iter().flat_map(|cut| {
            let regions = (0..).map(RegionId).zip(&cut.regions);
            let of_region = move |(region, arrived)| {
                let arrived: &Vec<(Time, PictureNumber)> = arrived;
                arrived.iter().map(move |(_, picture)| CopyTarget { region, picture: *picture, ..cut.of })
            };
            regions.flat_map(of_region)
        })
    }

    pub(crate) fn shown(&self, x: u32, y: u32, field: PeriodNumber, at: Time) -> Option<CopyTarget> {
        // Buffer 0 is shown first.
        let before = self.swaps.partition_point(|swap| swap.0 <= field);
        let buffer = self.swaps[..before].last().map_or(0, |swap| swap.1);
        let newest = self.cuts.iter().filter(|cut| cut.of.buffer == buffer).filter_map(|cut| cut.newest(x, y, at));
        newest.max_by_key(|newest| newest.0).map(|newest| newest.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_wire::{FieldParity, NodeId};

    const GRID: RegionGrid = RegionGrid { width: 256, height: 256, region_width: 128, region_height: 128 };

    /// Returns the destination of region 3, the lower right region, in buffer 0.
    fn target(lines: Lines, picture: u64) -> CopyTarget {
        let (frame_buffer, picture) = (NodeId(1), PictureNumber(picture));
        CopyTarget { frame_buffer, buffer: 0, lines, grid: GRID, region: RegionId(3), picture }
    }

    fn screen(targets: impl IntoIterator<Item = (u64, CopyTarget)>) -> Screen {
        let mut screen = Screen::default();
        for (at, target) in targets {
            let last_part_at = Time(at);
            screen.arrive(&Arrival { surface: SurfaceId(0), target, first_part_at: Time(at - 1), last_part_at });
        }
        screen
    }

    #[test]
    fn a_pixel_shows_the_newest_arrived_picture_of_its_region() {
        let targets = [7, 8, 9].map(|picture| target(Lines::Frame, picture));
        let screen = screen([10, 20, 30].into_iter().zip(targets));
        let shown = |x, y, at| screen.shown(x, y, PeriodNumber(0), Time(at));
        for (at, expected) in [(9, None), (10, Some(targets[0])), (29, Some(targets[1])), (30, Some(targets[2]))] {
            assert_eq!(shown(128, 255, at), expected, "{at}");
        }
        assert_eq!(shown(127, 255, 99), None, "another region");
    }

    #[test]
    fn a_line_shows_its_own_field() {
        let odd = target(Lines::Field(FieldParity::Odd), 7);
        let screen = screen([(10, odd)]);
        // Row 128 of an odd field of 256 rows is line 257 of the frame.
        assert_eq!(screen.shown(128, 257, PeriodNumber(0), Time(10)), Some(odd));
        assert_eq!(screen.shown(128, 256, PeriodNumber(0), Time(10)), None);
    }

    #[test]
    fn a_swap_shows_the_buffer_that_the_program_asked_for() {
        let [first, second] = [0, 1].map(|buffer| CopyTarget { buffer, ..target(Lines::Frame, buffer.into()) });
        let mut screen = screen([(10, first), (10, second)]);
        screen.swaps = vec![(PeriodNumber(3), 1), (PeriodNumber(5), 1), (PeriodNumber(6), 0)];
        for (field, expected) in [(2, first), (3, second), (4, second), (5, second), (6, first), (9, first)] {
            assert_eq!(screen.shown(200, 200, PeriodNumber(field), Time(10)), Some(expected), "{field}");
        }
    }

    #[test]
    fn only_regions_covered_before_the_instant_are_discarded() {
        let targets = [7, 8, 9, 10].map(|picture| target(Lines::Frame, picture));
        let mut screen = screen([10, 20, 30, 40].into_iter().zip(targets));
        for (instant, left) in [(9, 0), (19, 0), (20, 1), (35, 2), (99, 3)] {
            screen.discard_before(Time(instant));
            assert_eq!(screen.targets().collect::<Vec<_>>(), targets[left..], "{instant}");
        }
    }
}
