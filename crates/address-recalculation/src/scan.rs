//! When pixels light, exactly, and when they ask for their orientation.

use crate::error::ArpError;
use crate::timing::{ArpTiming, ScanTiming};
use pxpl5_sim::{Clock, Span, Time};
use pxpl5_wire::{FieldParity, PeriodNumber};
use serde::{Deserialize, Serialize};

/// Before what the newest orientation is latched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Latch {
    /// The first visible pixel of a field, as published.
    #[default]
    Field,
    /// The first visible pixel of each line.
    Line,
    /// Each pixel by itself.
    Pixel,
}

impl Latch {
    /// All, by their names on the command line.
    pub const ALL: [(&str, Self); 3] = [("field", Self::Field), ("line", Self::Line), ("pixel", Self::Pixel)];
}

/// Times of retraces, pixels and latches, all computed from zero; field `n` scans the even lines if `n` is even.
///
/// They are those of the frame buffer of Pixel-Planes 5 with the same numbers: boards do not know each other.
#[derive(Clone, Copy, Debug)]
pub struct Scan {
    timing: ScanTiming,
    pixel: Clock,
    field: Clock,
    depth: Span,
    read_ahead: Span,
}

impl Scan {
    /// The scan of these numbers, before a pipeline of those stages.
    ///
    /// # Errors
    ///
    /// As [`ScanTiming::check`] and [`ArpTiming::check`].
    pub fn new(timing: ScanTiming, arp: &ArpTiming) -> Result<Self, ArpError> {
        arp.check()?;
        timing.check()?;
        let clocks = timing.clocks().ok_or_else(|| ArpError::Number("arp_scan.pixel_ps".to_owned()))?;
        Ok(Self { timing, pixel: clocks[0], field: clocks[1], depth: arp.depth(), read_ahead: arp.read_ahead() })
    }

    /// Visible pixels of a line.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.timing.visible_pixels as u32
    }

    /// Visible lines of a frame of two fields.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.timing.visible_lines as u32 * 2
    }

    /// The retrace at which a field starts.
    #[must_use]
    pub const fn retrace(&self, field: PeriodNumber) -> Time {
        self.field.edge(field.0)
    }

    /// The field that is scanned at an instant; at a retrace the one that begins.
    #[must_use]
    pub const fn field_at(&self, time: Time) -> PeriodNumber {
        let n = self.field.edge_at_or_after(time);
        PeriodNumber(if self.field.edge(n).0 == time.0 { n } else { n - 1 })
    }

    /// When pixel `x` of line `y` of the frame lights in a field; `None` when that field does not scan it.
    #[must_use]
    pub fn lights(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        let parity = FieldParity::of_field(field).first_line();
        if x >= self.width() || y >= self.height() || y % 2 != parity {
            return None;
        }
        let start = field.0.saturating_mul(self.timing.frame_lines).div_ceil(2);
        let line = start + self.timing.top_blanking + u64::from(y / 2);
        let blanked = line.saturating_mul(self.timing.line_pixels).saturating_add(self.timing.left_blanking);
        Some(self.pixel.edge(blanked.saturating_add(u64::from(x))))
    }

    /// When the texels of a pixel are read.
    #[must_use]
    pub fn reads(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        Some(Time(self.lights(x, y, field)?.0.saturating_sub(self.read_ahead.0)))
    }

    /// When the orientation of a pixel is latched: all stages before the first visible pixel of its field or line, or
    /// before itself.
    #[must_use]
    pub fn latches(&self, latch: Latch, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        let lit = self.lights(x, y, field)?;
        let first = match latch {
            Latch::Field => self.lights(0, y % 2, field)?,
            Latch::Line => self.lights(0, y, field)?,
            Latch::Pixel => lit,
        };
        Some(Time(first.0.saturating_sub(self.depth.0)))
    }
}
