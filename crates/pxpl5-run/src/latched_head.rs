//! Which orientation a display with faces latched when.

use crate::head_views::HeadViews;
use crate::load_schedule::LoadSchedule;
use address_recalculation::{AddressRecalculationPipeline, Latch, Scan};
use pxpl5_display::{Aim, Display, LightSpan};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{FieldParity, PeriodNumber};

/// When a field of a scan lights.
pub(crate) fn lights_of(scan: &Scan, field: PeriodNumber) -> LightSpan {
    let tick = scan.retrace(field);
    let top = FieldParity::of_field(field).first_line();
    let light = |x: u32, y: u32| scan.lights(x, y, field).unwrap_or(tick);
    LightSpan { tick, first: light(0, top), last: light(scan.width() - 1, scan.height() - 2 + top) }
}

/// Words that an orientation takes on the host's own line.
pub(crate) const ORIENTATION_WORDS: u32 = 9;

/// Which of a tracker's reports is in a display's orientation register when, and for which instant it is predicted.
///
/// A display that latches fields gets an orientation for each report. One that latches lines or pixels gets more than there are reports:
/// the host predicts from the newest report for every line, or for as many parts of a line as its own line to the display carries.
#[derive(Clone, Copy, Debug)]
pub struct LatchedHead {
    scan: Scan,
    schedule: Option<LoadSchedule>,
    latch: Latch,
    depth: Span,
    link: Span,
    aim: Aim,
}

impl LatchedHead {
    /// In front of a display; `None` where it takes no faces. `link` is what an orientation takes from the host to the register.
    pub(crate) fn before(display: &dyn Display, link: Span, aim: Aim) -> Option<Self> {
        let display: &AddressRecalculationPipeline = (display as &dyn std::any::Any).downcast_ref()?;
        let config = display.config();
        let scan = config.scan().ok()?;
        let depth = config.timing.depth();
        let schedule = LoadSchedule::new(scan, depth, config.latch, link, aim);
        Some(Self { scan, schedule, latch: config.latch, depth, link, aim })
    }

    /// When a report's orientation is in the register.
    #[must_use]
    pub fn loaded(&self, report: Time) -> Time {
        report + self.link
    }

    /// When a pixel's orientation is latched; `None` for one that the field does not scan.
    #[must_use]
    pub fn latches(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        self.scan.latches(self.latch, x, y, field)
    }

    /// When an orientation is in the register for the first time after an instant: the first one as soon as the machine runs, then one
    /// for each report, or for each line or as many pixels as the host's line carries. `reports` gives the first report after an instant.
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

    /// What the host knew when it sent what is in the register from an instant on, and the instant that it predicted for.
    pub(crate) fn predicted(&self, loaded: Time) -> (Time, Time) {
        let aimed = match self.schedule {
            Some(schedule) => schedule.aimed(schedule.at(loaded)),
            None => self.aimed_at_field(loaded),
        };
        (self.sent(loaded), aimed)
    }

    /// When the host sends what is in the register from an instant on.
    fn sent(&self, loaded: Time) -> Time {
        Time(loaded.0.saturating_sub(self.link.0))
    }

    /// The instant of the aim in the first field that latches what is in the register from an instant on.
    fn aimed_at_field(&self, loaded: Time) -> Time {
        let mut field = self.scan.field_at(loaded);
        let y = |field: PeriodNumber| FieldParity::of_field(field).first_line();
        while self.latches(0, y(field), field).is_none_or(|at| at < loaded) {
            field = field.next();
        }
        self.aim.instant(&lights_of(&self.scan, field))
    }

    /// What the host knew when it sent the orientation that a pixel was turned by (all reports that had come by then), and the instant
    /// that it predicted for. Before the first report it knows the head's start; `None` before anything is loaded.
    #[must_use]
    pub fn turned_by(&self, head: &HeadViews, x: u32, y: u32, field: PeriodNumber) -> Option<(Time, Time)> {
        let latched = self.latches(x, y, field)?;
        if let Some(schedule) = self.schedule {
            let load = schedule.load_of(x, y, field)?;
            return Some((self.sent(schedule.loaded(load)), schedule.aimed(load)));
        }
        let before_any = (latched >= self.loaded(Time::ZERO)).then_some(Time::ZERO);
        let report = head.report_by(self.sent(latched)).or(before_any)?;
        Some((report, self.aimed_at_field(self.loaded(report))))
    }

    /// Where the time from the measurement of an orientation to the light of a pixel goes; `None` before the first report.
    #[must_use]
    pub fn latency(&self, head: &HeadViews, x: u32, y: u32, field: PeriodNumber) -> Option<RotationLatency> {
        let latched = self.latches(x, y, field)?;
        let (known, _) = self.turned_by(head, x, y, field)?;
        let report = head.report_by(known)?;
        let measured = head.measured_at(report)?;
        let scanned = self.scan.lights(x, y, field)?;
        let loaded = self.loaded(report);
        Some(RotationLatency {
            tracker: report.since(measured),
            host: self.link,
            wait_for_latch: latched.since(loaded),
            pipeline: self.depth,
            scan: scanned.since(latched + self.depth),
        })
    }
}

/// Parts of the time from the measurement of an orientation to the light of a pixel that was turned by it, which add up to it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub struct RotationLatency {
    /// From the tracker's measurement to the arrival of its report at the host.
    pub tracker: Span,
    /// From there until the orientation is in the display's register.
    pub host: Span,
    /// From there until it is latched. Where lines or pixels latch the host keeps the report as long and predicts from it.
    pub wait_for_latch: Span,
    /// The stages of the display's pipeline.
    pub pipeline: Span,
    /// From the light of the first pixel that was latched with it to that of this one.
    pub scan: Span,
}

impl RotationLatency {
    /// The parts in the order of time, with their names.
    #[must_use]
    pub const fn parts(&self) -> [(&'static str, Span); 5] {
        [
            ("tracker", self.tracker),
            ("host", self.host),
            ("wait_for_latch", self.wait_for_latch),
            ("pipeline", self.pipeline),
            ("scan", self.scan),
        ]
    }

    /// All of it.
    #[must_use]
    pub fn total(&self) -> Span {
        self.parts().iter().map(|(_, span)| *span).sum()
    }
}
