//! Exact times of an interlaced video signal, and the position of its beam.

use crate::{CopyTarget, FieldParity, Lines, PeriodNumber};
use pxpl5_sim::parameters::{MAX, SettingError, check};
use pxpl5_sim::{Clock, Time};

/// Numbers of an interlaced video signal with two fields in each video frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VideoNumbers {
    /// Period of the pixel clock, multiplied by `pixel_divisor`, in picoseconds.
    pub pixel_ps: u64,
    pub pixel_divisor: u64,
    /// Number of pixel periods in a line, including blanking.
    pub line_pixels: u64,
    /// Number of lines in a video frame of two fields, including blanking.
    pub frame_lines: u64,
    pub visible_pixels: u64,
    pub visible_lines: u64,
    /// Number of blanked pixel periods before the visible pixels of a line.
    pub left_blanking: u64,
    /// Number of blanked lines between a retrace and the first visible line.
    pub top_blanking: u64,
}

/// The times of retraces, lines and pixels. All times are computed from time zero, so no rounding errors accumulate.
///
/// Field `n` begins at retrace `n` and scans the even lines of the video frame if `n` is even, else the odd ones. Lines
/// follow an uninterrupted line clock. Since a field has 262.5 of them, an odd one begins in the middle of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Video {
    numbers: VideoNumbers,
    pixel: Clock,
    line: Clock,
    field: Clock,
}

impl Video {
    /// Makes the video signal that `numbers` describes.
    ///
    /// # Errors
    ///
    /// [`SettingError`] names the first of these faults. The period of a pixel is shorter than a picosecond. The visible
    /// pixels and their blanking do not fit in a line, or the visible lines and their blanking do not fit in a field.
    /// The period of a field is too long for 64-bit arithmetic.
    pub fn new(numbers: VideoNumbers) -> Result<Self, SettingError> {
        let VideoNumbers { pixel_ps, pixel_divisor, line_pixels, frame_lines, .. } = numbers;
        let VideoNumbers { visible_pixels, visible_lines, left_blanking, top_blanking, .. } = numbers;
        check("pixel_ps", pixel_ps, (pixel_divisor, MAX))?;
        check("visible_pixels", visible_pixels, (1, line_pixels))?;
        check("left_blanking", left_blanking, (0, line_pixels - visible_pixels))?;
        // Each field contains half of the lines of a frame.
        let field_lines = frame_lines / 2;
        check("visible_lines", visible_lines, (1, field_lines))?;
        check("top_blanking", top_blanking, (0, field_lines - visible_lines))?;
        let clocks = || {
            let line_ps = pixel_ps.checked_mul(line_pixels)?;
            let pixel = Clock::new(pixel_ps, pixel_divisor)?;
            let line = Clock::new(line_ps, pixel_divisor)?;
            let field = Clock::new(line_ps.checked_mul(frame_lines)?, pixel_divisor.checked_mul(2)?)?;
            Some(Self { numbers, pixel, line, field })
        };
        clocks().ok_or_else(|| SettingError::value("pixel_ps", "a period of a field below 2^63 ps", pixel_ps))
    }

    /// Returns the time of the retrace with which a field begins.
    pub const fn retrace(&self, field: PeriodNumber) -> Time {
        self.field.edge(field.0)
    }

    /// Returns the number of the field that is being scanned at `time`. At a retrace, the result is the field that
    /// begins.
    pub const fn field_at(&self, time: Time) -> PeriodNumber {
        let n = self.field.edge_at_or_after(time);
        PeriodNumber(if self.field.edge(n).0 == time.0 { n } else { n - 1 })
    }

    /// Returns the time at which the beam begins line `y` of the video frame in a field. The line begins with its
    /// blanking. Returns `None` if the field does not scan the line.
    pub fn line_start(&self, y: u32, field: PeriodNumber) -> Option<Time> {
        Some(self.line.edge(self.line_number(y, field)?))
    }

    /// Returns the time at which the beam is at pixel `x` of line `y` of the video frame in a field. Returns `None` if
    /// the field does not scan the pixel.
    pub fn when(&self, x: u32, y: u32, field: PeriodNumber) -> Option<Time> {
        if x >= self.width() {
            return None;
        }
        let line = self.line_number(y, field)?;
        // Count pixel periods from time zero, so that no error accumulates.
        let blanked = line.saturating_mul(self.numbers.line_pixels).saturating_add(self.numbers.left_blanking);
        Some(self.pixel.edge(blanked.saturating_add(u64::from(x))))
    }

    /// Returns the time at which the beam reaches the first pixel of a region in a field. Pixels that have arrived by
    /// then are shown completely. Returns `None` for a region outside the video frame, or without a line in this field.
    pub fn reaches(&self, target: &CopyTarget, field: PeriodNumber) -> Option<Time> {
        let [left, top, _, height] = self.rectangle(target)?;
        (top..top + height).find_map(|row| self.when(left, frame_line(target.lines, row), field))
    }

    /// Returns left, top, width and height of a region, in the pixels and rows of its picture. Returns `None` if the
    /// region does not lie in the video frame or is larger than a renderer's pixel array.
    pub fn rectangle(&self, target: &CopyTarget) -> Option<[u32; 4]> {
        let rows = match target.lines {
            Lines::Frame => self.height(),
            Lines::Field(_) => self.height() / 2,
        };
        target.grid.rectangle_within(target.region, self.width(), rows)
    }

    pub const fn width(&self) -> u32 {
        self.numbers.visible_pixels as u32
    }

    /// Returns the number of visible lines in a video frame.
    pub const fn height(&self) -> u32 {
        self.numbers.visible_lines as u32 * 2
    }

    /// Returns the number of whole scan lines between time zero and the start of line `y` of the video frame in a
    /// field. Returns `None` if the field does not scan the line. An odd field begins with a blanked half line, so its
    /// first whole line begins half a line time after the retrace.
    fn line_number(&self, y: u32, field: PeriodNumber) -> Option<u64> {
        let parity = FieldParity::of_field(field);
        if y >= self.height() || y % 2 != parity.first_line() {
            return None;
        }
        // An odd field begins in the middle of a line. Lines of the field are counted from its first whole line.
        let start = field.0.saturating_mul(self.numbers.frame_lines).div_ceil(2);
        Some(start + self.numbers.top_blanking + u64::from(y / 2))
    }
}

/// Returns the line of the video frame to which row `row` of a picture belongs.
pub const fn frame_line(lines: Lines, row: u32) -> u32 {
    match lines {
        Lines::Frame => row,
        Lines::Field(parity) => parity.first_line() + 2 * row,
    }
}
