//! Timing of the head orientations that a display with cube faces latches.

use crate::head_views::HeadViews;
use crate::pipelines::faces::load_schedule::LoadSchedule;
use address_recalculation::{AddressRecalculationPipeline, FaceScan, Latch};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::{Aim, Display, LightTimes};
use pxpl5_wire::{FieldParity, PeriodNumber};

pub(crate) fn lights_of(scan: &FaceScan, field: PeriodNumber) -> LightTimes {
    let tick = scan.retrace(field);
    let top = FieldParity::of_field(field).first_line();
    let light = |x: u32, y: u32| scan.when(x, y, field).unwrap_or(tick);
    LightTimes { tick, first: light(0, top), last: light(scan.width() - 1, scan.height() - 2 + top) }
}

pub(crate) const ORIENTATION_WORDS: u32 = 9;

/// Timing of the orientation register of a display with cube faces.
///
/// The timing states which tracker report each orientation uses, and for which instant the orientation is predicted. A
/// display that latches by field gets one orientation for each report. A display that latches by line or by pixel gets
/// more orientations than reports. The host then predicts from the newest report, for each line or part of a line. The
/// host's connection to the display limits the number of parts.
#[derive(Clone, Copy, Debug)]
pub struct OrientationTiming {
    scan: FaceScan,
    schedule: Option<LoadSchedule>,
    latch: Latch,
    depth: Span,
    link: Span,
    aim: Aim,
}

impl OrientationTiming {
    /// Creates the timing for a display. Returns `None` if the display does not accept cube faces. `link` is the
    /// transfer time of an orientation from the host to the register.
    pub(crate) fn before(display: &dyn Display, link: Span, aim: Aim) -> Option<Self> {
        let display: &AddressRecalculationPipeline = (display as &dyn std::any::Any).downcast_ref()?;
        let config = display.config();
        let scan = config.scan().ok()?;
        let depth = config.timing.depth();
        let schedule = LoadSchedule::new(scan, depth, config.latch, link, aim);
        Some(Self { scan, schedule, latch: config.latch, depth, link, aim })
    }

    /// Returns the time at which the orientation from a report is in the register.
    pub fn loaded(&self, report: Time) -> Time {
        report + self.link
    }

    /// Returns the time at which a pixel's orientation is latched. Returns `None` for a pixel that the field does not
    /// scan.
    pub fn latches(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        self.scan.latches(self.latch, x, y, field)
    }

    /// Returns the first time later than `after` when a new orientation is in the register.
    ///
    /// The first orientation arrives when the machine starts. Each later orientation comes from a report, or from the
    /// schedule for latching by line or pixel. `reports(t)` returns the arrival time of the first report after `t`.
    pub(crate) fn next(&self, after: Time, reports: impl Fn(Time) -> Option<Time>) -> Option<Time> {
        let first = self.loaded(Time::ZERO);
        if after < first {
            return Some(first);
        }
        match self.schedule {
            Some(schedule) => Some(schedule.loaded(schedule.next(after))),
            None => reports(self.sent(after)).map(|report| self.loaded(report)),
        }
    }

    /// Returns the instant at which the host sent an orientation, and the instant for which the orientation was
    /// predicted. `loaded` is the time at which this orientation is in the register.
    pub(crate) fn predicted(&self, loaded: Time) -> (Time, Time) {
        let aimed = match self.schedule {
            Some(schedule) => schedule.aimed(schedule.at(loaded)),
            None => self.aimed_at_field(loaded),
        };
        (self.sent(loaded), aimed)
    }

    fn sent(&self, loaded: Time) -> Time {
        Time(loaded.0.saturating_sub(self.link.0))
    }

    /// Returns the instant for which an orientation is predicted, in the first field that latches the orientation.
    /// `loaded` is the time at which the orientation is in the register.
    fn aimed_at_field(&self, loaded: Time) -> Time {
        let mut field = self.scan.field_at(loaded);
        let y = |field: PeriodNumber| FieldParity::of_field(field).first_line();
        while self.latches(0, y(field), field).is_none_or(|at| at < loaded) {
            field = field.next();
        }
        self.aim.instant(&lights_of(&self.scan, field))
    }

    /// Returns the time up to which the host used reports for a pixel's orientation, and the instant for which this
    /// orientation was predicted.
    ///
    /// Before the first report, the host has the head's initial pose. Returns `None` before an orientation is loaded.
    pub fn orientation_of_pixel(&self, head: &HeadViews, x: u32, y: u32, field: PeriodNumber) -> Option<(Time, Time)> {
        let latched = self.latches(x, y, field)?;
        if let Some(schedule) = self.schedule {
            let load = schedule.load_of(x, y, field)?;
            return Some((self.sent(schedule.loaded(load)), schedule.aimed(load)));
        }
        let before_any = (latched >= self.loaded(Time::ZERO)).then_some(Time::ZERO);
        let report = head.report_by(self.sent(latched)).or(before_any)?;
        Some((report, self.aimed_at_field(self.loaded(report))))
    }

    /// Returns the parts of the time from the measurement of an orientation until a pixel is lit. Returns `None` before
    /// the first report.
    pub fn latency(&self, head: &HeadViews, x: u32, y: u32, field: PeriodNumber) -> Option<RotationLatency> {
        let latched = self.latches(x, y, field)?;
        let (reports_until, _) = self.orientation_of_pixel(head, x, y, field)?;
        // The orientation comes from the newest report that the host knew.
        let report = head.report_by(reports_until)?;
        let measured = head.measured_at(report)?;
        let scanned = self.scan.when(x, y, field)?;
        let loaded = self.loaded(report);
        // Each part begins at the end of the part before.
        Some(RotationLatency {
            tracker: report.since(measured),
            host: self.link,
            wait_for_latch: latched.since(loaded),
            pipeline: self.depth,
            scan: scanned.since(latched + self.depth),
        })
    }
}

/// Parts of the rotation latency.
///
/// The sum of the parts is the latency.
///
/// Rotation latency is the time from the measurement of an orientation until a pixel that uses the orientation is lit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct RotationLatency {
    /// Time from the tracker's measurement to the arrival of its report at the host.
    pub tracker: Span,
    /// Time from the report's arrival at the host until the orientation is in the display's register.
    pub host: Span,
    /// Time from the arrival in the register until the orientation is latched.
    ///
    /// For latching by line or pixel, the host waits for this time before it predicts from the report.
    pub wait_for_latch: Span,
    /// Time that a pixel takes through the hardware of the display.
    pub pipeline: Span,
    /// Time from the lighting of the first pixel with the latched orientation to the lighting of this pixel.
    pub scan: Span,
}

impl RotationLatency {
    /// Returns the parts with their names, in order of time.
    pub const fn parts(&self) -> [(&'static str, Span); 5] {
        [
            ("tracker", self.tracker),
            ("host", self.host),
            ("wait_for_latch", self.wait_for_latch),
            ("pipeline", self.pipeline),
            ("scan", self.scan),
        ]
    }

    /// Returns the sum of all parts.
    pub fn total(&self) -> Span {
        self.parts().iter().map(|(_, span)| *span).sum()
    }
}
