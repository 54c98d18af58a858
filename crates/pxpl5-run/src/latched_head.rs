//! Which orientation a display with faces latched when.

use crate::head_views::HeadViews;
use address_recalculation::{AddressRecalculationPipeline, Latch, Scan};
use pxpl5_display::{Aim, Display, LightSpan};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{FieldParity, PeriodNumber};

/// Words that an orientation takes on the host's own line.
pub(crate) const ORIENTATION_WORDS: u32 = 9;

/// Which of a tracker's reports is in a display's orientation register when.
#[derive(Clone, Copy, Debug)]
pub struct LatchedHead {
    scan: Scan,
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
        Some(Self { scan: config.scan().ok()?, latch: config.latch, depth: config.timing.depth(), link, aim })
    }

    /// When a report's orientation is in the register.
    #[must_use]
    pub fn loaded(&self, report: Time) -> Time {
        report + self.link
    }

    /// The report whose orientation comes into the register at an instant.
    pub(crate) fn report_of(&self, loaded: Time) -> Time {
        Time(loaded.0.saturating_sub(self.link.0))
    }

    /// When a pixel's orientation is latched; `None` for one that the field does not scan.
    #[must_use]
    pub fn latches(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        self.scan.latches(self.latch, x, y, field)
    }

    /// The instant that the orientation of a report is predicted for: that of the aim in the first field that latches it; where lines
    /// or pixels latch, the middle of all that light before the next report is there.
    #[must_use]
    pub fn aimed(&self, report: Time, next: Option<Time>) -> Time {
        let loaded = self.loaded(report);
        if self.latch != Latch::Field {
            let replaced = next.map_or(loaded, |next| self.loaded(next));
            return Time(loaded.0.midpoint(replaced.0)) + self.depth;
        }
        let mut field = self.scan.field_at(loaded);
        let y = |field: PeriodNumber| FieldParity::of_field(field).first_line();
        while self.latches(0, y(field), field).is_none_or(|at| at < loaded) {
            field = field.next();
        }
        let light = |x: u32, y: u32| self.scan.lights(x, y, field).unwrap_or(loaded);
        let first = light(0, y(field));
        let last = light(self.scan.width() - 1, self.scan.height() - 2 + y(field));
        self.aim.instant(&LightSpan { tick: self.scan.retrace(field), first, last })
    }

    /// The report that a pixel was turned by, and the instant that its orientation was predicted for. Before the first report it is
    /// what the host knows at the beginning of time; `None` before that is loaded.
    #[must_use]
    pub fn turned_by(&self, head: &HeadViews, x: u32, y: u32, field: PeriodNumber) -> Option<(Time, Time)> {
        let latched = self.latches(x, y, field)?;
        let before_any = (latched >= self.loaded(Time::ZERO)).then_some(Time::ZERO);
        let report = head.report_by(self.report_of(latched)).or(before_any)?;
        Some((report, self.aimed(report, head.report_after(report))))
    }

    /// Where the time from the measurement of an orientation to the light of a pixel goes; `None` before the first report.
    #[must_use]
    pub fn latency(&self, head: &HeadViews, x: u32, y: u32, field: PeriodNumber) -> Option<RotationLatency> {
        let latched = self.latches(x, y, field)?;
        let report = head.report_by(self.report_of(latched))?;
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
    /// From there until it is latched.
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
