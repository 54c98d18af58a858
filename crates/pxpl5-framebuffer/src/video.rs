//! Exact times of the video signal, and the position of the beam.

use crate::{FrameBufferConfigError, VideoTiming};
use pxpl5_sim::{Clock, Time};
use pxpl5_wire::{CopyTarget, FieldParity, Lines, PeriodNumber};

/// The times of retraces, lines and pixels. All times are computed from time zero, so no rounding errors accumulate.
///
/// Field `n` begins at retrace `n`. The field scans the even lines of the frame if `n` is even, else the odd lines.
/// Lines follow an uninterrupted line clock. A field has 262.5 lines, so an odd field begins in the middle of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Video {
    timing: VideoTiming,
    pixel: Clock,
    line: Clock,
    field: Clock,
}

impl Video {
    /// Makes the video signal described by a timing table.
    ///
    /// # Errors
    ///
    /// Returns the errors of [`VideoTiming::check`], and [`FrameBufferConfigError::Clock`].
    pub fn new(timing: VideoTiming) -> Result<Self, FrameBufferConfigError> {
        timing.check()?;
        Ok(Self {
            timing,
            pixel: timing.pixel_clock().ok_or(FrameBufferConfigError::Clock)?,
            line: timing.line_clock().ok_or(FrameBufferConfigError::Clock)?,
            field: timing.field_clock().ok_or(FrameBufferConfigError::Clock)?,
        })
    }

    /// Returns the time of the retrace with which a field begins.
    #[must_use]
    pub const fn retrace(&self, field: PeriodNumber) -> Time {
        self.field.edge(field.0)
    }

    /// Returns the number of the field that is being scanned at `time`. At a retrace this is the field that begins.
    #[must_use]
    pub const fn field_at(&self, time: Time) -> PeriodNumber {
        let n = self.field.edge_at_or_after(time);
        PeriodNumber(if self.field.edge(n).0 == time.0 { n } else { n - 1 })
    }

    /// Returns the time at which the beam begins line `y` of the frame in a field. The line begins with its blanking.
    /// Returns `None` if the field does not scan the line.
    #[must_use]
    pub fn line_start(&self, y: u32, field: PeriodNumber) -> Option<Time> {
        Some(self.line.edge(self.line_number(y, field)?))
    }

    /// Returns the time at which the beam is at pixel `x` of line `y` of the frame in a field. Returns `None` if the
    /// field does not scan the pixel.
    #[must_use]
    pub fn when(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        if x >= self.width() {
            return None;
        }
        let line = self.line_number(y, field)?;
        // Count pixel periods from time zero, so that no error accumulates.
        let blanked = line.saturating_mul(self.timing.line_pixels).saturating_add(self.timing.left_blanking);
        Some(self.pixel.edge(blanked.saturating_add(u64::from(x))))
    }

    /// Returns the time at which the beam reaches the first pixel of a region in a field. The region is shown
    /// completely if all its pixels have arrived by this time. Returns `None` for a region outside the frame, or for a
    /// region without a line in this field.
    #[must_use]
    pub fn reaches(&self, target: &CopyTarget, field: PeriodNumber) -> Option<Time> {
        let [left, top, _, height] = rectangle(self, target)?;
        (top..top + height).find_map(|row| self.when(left, frame_line(target.lines, row), field))
    }

    /// Returns the number of visible pixels in a line.
    #[must_use]
    pub const fn width(&self) -> u32 {
        self.timing.visible_pixels as u32
    }

    /// Returns the number of visible lines in a frame.
    #[must_use]
    pub const fn height(&self) -> u32 {
        self.timing.visible_lines as u32 * 2
    }

    /// Returns the timing table of the signal.
    #[must_use]
    pub const fn timing(&self) -> &VideoTiming {
        &self.timing
    }

    /// Returns the number of scan lines between time zero and line `y` of a field. The half line at the start of an odd
    /// field is blanked.
    fn line_number(&self, y: u32, field: PeriodNumber) -> Option<u64> {
        let parity = FieldParity::of_field(field);
        if y >= self.height() || y % 2 != parity.first_line() {
            return None;
        }
        // An odd field begins in the middle of a line. Lines of the field are counted from its first whole line.
        let start = field.0.saturating_mul(self.timing.frame_lines).div_ceil(2);
        Some(start + self.timing.top_blanking + u64::from(y / 2))
    }
}

/// Returns the line of the frame to which row `row` of a picture belongs.
pub(crate) const fn frame_line(lines: Lines, row: u32) -> u32 {
    match lines {
        Lines::Frame => row,
        Lines::Field(parity) => parity.first_line() + 2 * row,
    }
}

/// Returns left, top, width and height of a region, in the pixels and rows of its picture. Returns `None` if the region
/// does not lie in the frame or is larger than a renderer's pixel array.
pub(crate) fn rectangle(video: &Video, target: &CopyTarget) -> Option<[u32; 4]> {
    let rows = match target.lines {
        Lines::Frame => video.height(),
        Lines::Field(_) => video.height() / 2,
    };
    target.grid.rectangle_within(target.region, video.width(), rows)
}
