//! Schedule of the orientations that a host sends to a display that latches orientations by line or by pixel.

use address_recalculation::{FaceScan, Latch};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::{Aim, LightTimes};
use pxpl5_wire::{FieldParity, PeriodNumber};

/// A schedule of the orientations that a host predicts for parts of a field.
///
/// Each orientation is in the display's register when the display latches the orientation for the first pixel that uses
/// this orientation. With latching by line, a line has one orientation. With latching by pixel, a line has as many
/// orientations as the host's connection can carry. After the last orientation of a line, the connection is idle until
/// the next line. If the transfer of an orientation takes longer than a line, the orientation serves several lines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LoadSchedule {
    scan: FaceScan,
    /// Delay of a pixel in the hardware of the display.
    depth: Span,
    /// Time between two successive loads of the display's orientation register within a line.
    link: Span,
    /// Number of lines of a field that use the same load of the display's orientation register.
    lines: u32,
    loads: u32,
    aim: Aim,
}

/// Identifier of a load of the display's orientation register: the field, the first line within the field, and the
/// index within this line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Load {
    field: PeriodNumber,
    line: u32,
    number: u32,
}

impl LoadSchedule {
    /// Creates a schedule. Returns `None` for a display that latches one orientation per field.
    ///
    /// The host of such a display sends each orientation as soon as the orientation is known.
    pub(crate) fn new(scan: FaceScan, depth: Span, latch: Latch, link: Span, aim: Aim) -> Option<Self> {
        let line = scan.when(0, 2, PeriodNumber::FIRST)?.since(scan.when(0, 0, PeriodNumber::FIRST)?);
        let lines = link.0.div_ceil(line.0.max(1)).max(1) as u32;
        let loads = match latch {
            Latch::Field => return None,
            Latch::Line => 1,
            Latch::Pixel => (line.0 / link.0.max(1)).clamp(1, u64::from(scan.width())) as u32,
        };
        Some(Self { scan, depth, link, lines, loads, aim })
    }

    fn height(&self) -> u32 {
        self.scan.height() / 2
    }

    fn light(&self, x: u32, line: u32, field: PeriodNumber) -> Time {
        let y = 2 * line + FieldParity::of_field(field).first_line();
        self.scan.when(x, y, field).unwrap_or_else(|| self.scan.retrace(field))
    }

    /// Returns the load of the display's orientation register that a pixel uses. Returns `None` for a pixel that the
    /// field does not scan.
    pub(crate) fn load_of(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Load> {
        let into_line = self.scan.when(x, y, field)?.since(self.light(0, y / 2, field));
        let number = (into_line.0 / self.link.0.max(1)).min(u64::from(self.loads) - 1) as u32;
        Some(Load { field, line: y / 2 / self.lines * self.lines, number })
    }

    /// Returns the instant at which the display's register receives an orientation. The display latches (copies) the
    /// orientation from the register when the first pixel that uses the orientation begins. The display latches at most
    /// one pixel's time after the returned instant.
    pub(crate) fn loaded(&self, load: Load) -> Time {
        let first = self.light(0, load.line, load.field) + self.link * u64::from(load.number);
        Time(first.0.saturating_sub(self.depth.0))
    }

    /// Returns the instant for which an orientation is predicted. This instant depends on the aim, and lies in the time
    /// span in which the pixels with this orientation are lit.
    pub(crate) fn aimed(&self, load: Load) -> Time {
        let Load { field, line, number } = load;
        let last_line = (line + self.lines).min(self.height()) - 1;
        let after =
            if number + 1 == self.loads { self.scan.width() } else { self.first_pixel(line, number + 1, field) };
        let light = LightTimes {
            tick: self.scan.retrace(field),
            first: self.light(self.first_pixel(line, number, field), line, field),
            last: self.light(after.saturating_sub(1), last_line, field),
        };
        self.aim.instant(&light)
    }

    fn first_pixel(&self, line: u32, number: u32, field: PeriodNumber) -> u32 {
        let from = self.light(0, line, field) + self.link * u64::from(number);
        partition(self.scan.width() - 1, |x| self.light(x, line, field) < from)
    }

    pub(crate) fn next(&self, after: Time) -> Load {
        let mut field = self.scan.field_at(after);
        loop {
            let groups = self.height().div_ceil(self.lines);
            let begun = |group: u32| self.loaded(Load { field, line: group * self.lines, number: 0 }) <= after;
            // Find the last group of lines whose first load lies at or before the instant.
            let groups_begun = partition(groups, begun);
            if let Some(group) = groups_begun.checked_sub(1) {
                let line = group * self.lines;
                // A later load of the same group comes next, if the group has one.
                let loads_begun = partition(self.loads, |number| self.loaded(Load { field, line, number }) <= after);
                if loads_begun < self.loads {
                    return Load { field, line, number: loads_begun };
                }
            }
            // Otherwise the first load of the next group comes next, or the first load of the next field.
            if groups_begun < groups {
                return Load { field, line: groups_begun * self.lines, number: 0 };
            }
            field = field.next();
        }
    }

    /// Returns the load of the display's orientation register that is complete at exactly the instant `loaded`. If
    /// there is no such load, returns the first later load.
    pub(crate) fn at(&self, loaded: Time) -> Load {
        self.next(Time(loaded.0.saturating_sub(1)))
    }
}

/// Returns the number of values below `end` for which `is_first` returns true. `is_first` must return true for the
/// first values and false for all others.
fn partition(end: u32, is_first: impl Fn(u32) -> bool) -> u32 {
    let mut from = 0;
    let mut to = end;
    while from < to {
        let middle = u32::midpoint(from, to);
        if is_first(middle) {
            from = middle + 1;
        } else {
            to = middle;
        }
    }
    from
}

#[cfg(test)]
mod tests {
    use super::*;
    use address_recalculation::ArpConfig;

    fn schedule(latch: Latch, link_ns: u64) -> LoadSchedule {
        let config = ArpConfig::MACHINE;
        let scan = config.scan().expect("in range");
        let link = Span::from_ns(link_ns);
        LoadSchedule::new(scan, config.timing.depth(), latch, link, Aim::Middle).expect("no field")
    }

    /// Returns all loads of the orientation register in two fields, in order.
    fn all(schedule: &LoadSchedule) -> Vec<Load> {
        let mut at = Time::ZERO;
        let mut found = Vec::new();
        loop {
            let load = schedule.next(at);
            if load.field > PeriodNumber(1) {
                return found;
            }
            at = schedule.loaded(load);
            found.push(load);
        }
    }

    /// Tests the number of register loads. A message of nine words takes 7.2 us, so the 63.56 us of a line have room
    /// for 8 loads.
    #[test]
    fn a_line_has_one_orientation_or_the_number_of_orientations_that_the_host_line_can_carry() {
        for (latch, link_ns, expected) in [
            (Latch::Line, 7_200, 2 * 240),
            (Latch::Pixel, 7_200, 2 * 240 * 8),
            (Latch::Line, 100_000, 2 * 120),
            (Latch::Pixel, 100_000, 2 * 120),
            (Latch::Pixel, 40_000, 2 * 240),
        ] {
            let schedule = schedule(latch, link_ns);
            let loads = all(&schedule);
            assert_eq!(loads.len(), expected, "{latch:?} {link_ns}");
            for pair in loads.windows(2) {
                let apart = schedule.loaded(pair[1]).since(schedule.loaded(pair[0]));
                assert!(apart >= Span::from_ns(link_ns), "{pair:?}: {apart:?}");
            }
            for load in loads {
                assert_eq!(schedule.at(schedule.loaded(load)), load);
            }
        }
    }

    #[test]
    fn for_each_pixel_the_display_latches_the_newest_orientation_in_its_register() {
        for latch in [Latch::Line, Latch::Pixel] {
            let schedule = schedule(latch, 7_200);
            for (x, y, field) in
                [(0, 0, 0), (1, 0, 0), (88, 0, 0), (89, 0, 0), (639, 479, 1), (320, 240, 2), (620, 2, 0)]
            {
                let field = PeriodNumber(field);
                let load = schedule.load_of(x, y, field).expect("scanned");
                let latched = schedule.scan.latches(latch, x, y, field).expect("scanned");
                assert!(schedule.loaded(load) <= latched, "{x} {y}");
                let next = schedule.next(schedule.loaded(load));
                assert!(schedule.loaded(next) > latched, "{x} {y}");
            }
        }
    }

    #[test]
    fn a_load_is_predicted_for_the_middle_of_its_pixels() {
        let pixel_ps = 81_481.5;
        let line = schedule(Latch::Line, 7_200);
        let load = line.load_of(17, 2, PeriodNumber::FIRST).expect("scanned");
        let first = line.light(0, 1, PeriodNumber::FIRST).0 as f64;
        assert!((line.aimed(load).0 as f64 - first - 319.5 * pixel_ps).abs() < 100.0);
        // 7.2 us are 88.4 pixels, so the third load of a line covers the pixels from 177 to 265.
        let pixels = schedule(Latch::Pixel, 7_200);
        let load = pixels.load_of(200, 2, PeriodNumber::FIRST).expect("scanned");
        assert_eq!(load.number, 2);
        assert!((pixels.aimed(load).0 as f64 - first - 221.0 * pixel_ps).abs() < 100.0);
    }
}
