//! Exact times at which each pixel is displayed and its orientation is read.

use crate::timing::{ArpTiming, ScanTiming};
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{PeriodNumber, Video};
use serde::{Deserialize, Serialize};
use std::ops::Deref;

/// The part of the video signal for which the display uses one orientation. The newest orientation is read (latched)
/// just before this part.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Latch {
    /// One orientation for each field, which is read before the field's first visible pixel (published).
    #[default]
    Field,
    /// One orientation for each line, which is read before the line's first visible pixel.
    Line,
    /// One orientation for each visible pixel.
    Pixel,
}

pxpl5_sim::parameters::named!(Latch, "latch event", Latch::ALL);

impl Latch {
    pub const ALL: [(&str, Self); 3] = [("field", Self::Field), ("line", Self::Line), ("pixel", Self::Pixel)];
}

/// The times of a [`Video`] signal, and the times at which texels and the orientation for each pixel are read.
#[derive(Clone, Copy, Debug)]
pub struct FaceScan {
    video: Video,
    depth: Span,
    read_ahead: Span,
}

impl Deref for FaceScan {
    type Target = Video;

    fn deref(&self) -> &Video {
        &self.video
    }
}

impl FaceScan {
    /// Creates a scan for a pipeline with the stages of `arp`.
    ///
    /// # Errors
    ///
    /// Fails in the same cases as [`ScanTiming::check`] and [`ArpTiming::check`].
    pub fn new(timing: ScanTiming, arp: &ArpTiming) -> Result<Self, SettingError> {
        arp.check()?;
        Ok(Self { video: timing.video()?, depth: arp.depth(), read_ahead: arp.read_ahead() })
    }

    /// Returns the time at which the texels of a pixel are read. Returns `None` if the field does not scan the pixel.
    pub fn reads(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        Some(Time(self.video.when(x, y, field)?.0.saturating_sub(self.read_ahead.0)))
    }

    /// Returns the time at which the orientation for a pixel is read.
    ///
    /// The time precedes the display of one pixel by the duration of all stages. This pixel is (x, y) with
    /// [`Latch::Pixel`], and otherwise the first visible pixel of the same line or field.
    pub fn latches(&self, latch: Latch, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        let lit = self.video.when(x, y, field)?;
        let first = match latch {
            Latch::Field => self.video.when(0, y % 2, field)?,
            Latch::Line => self.video.when(0, y, field)?,
            Latch::Pixel => lit,
        };
        Some(Time(first.0.saturating_sub(self.depth.0)))
    }
}
