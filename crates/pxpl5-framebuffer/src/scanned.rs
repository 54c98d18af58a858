//! Fields and pictures as a viewer sees them.

use crate::buffer::Regions;
use crate::picture::Canvas;
use crate::region::{RegionWrite, Segment};
use image::RgbImage;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::Video;
use pxpl5_wire::{CopyTarget, FieldParity, PeriodNumber};
use std::cell::LazyCell;

/// One field as it was scanned. Its pixels are computed when they are read. Later events do not change the field, and a
/// clone is cheap.
#[derive(Clone, Debug)]
pub struct ScannedField {
    pub(crate) field: PeriodNumber,
    pub(crate) buffer: u8,
    pub(crate) ends_at: Time,
    pub(crate) video: Video,
    pub(crate) word: Span,
    pub(crate) regions: Regions,
}

/// A region that arrived too late for a field. The beam passed some pixels before they had arrived, so the viewer sees
/// older pixels instead. `target.picture` gives the picture for which the region was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ScannedLateRegion {
    /// Frame buffer and region of the pixels, and number of the picture to which they belong.
    pub target: CopyTarget,
    /// Arrival time of the region's last message, or `None` if it arrived after the end of the field.
    pub arrived_at: Option<Time>,
    /// First line of the frame in which the viewer sees an older pixel.
    pub first_line: u32,
    /// Number of lines of this field in which the viewer sees an older pixel.
    pub lines: u32,
    /// Longest time from the scan of a pixel to its arrival. For a message that arrived after the end of the field, the
    /// end of the field counts.
    pub lateness: Span,
}

impl ScannedField {
    /// Returns the number of the scanned field.
    pub const fn field(&self) -> PeriodNumber {
        self.field
    }

    /// Returns the number of the buffer that was scanned, 0 or 1.
    pub const fn buffer(&self) -> u8 {
        self.buffer
    }

    /// Returns the parity of the scanned lines: the even or the odd lines of the frame.
    pub const fn parity(&self) -> FieldParity {
        FieldParity::of_field(self.field)
    }

    /// Returns a picture of only the scanned lines: 640 x 240 pixels for NTSC. Pixels that were never written are
    /// black.
    pub fn picture(&self) -> RgbImage {
        let mut canvas = Canvas::new(self.video.width(), self.video.height() / 2);
        self.paint(&mut canvas, |y| y / 2);
        canvas.into_image()
    }

    /// Returns the picture of two interlaced fields, as on a screen: 640 x 480 pixels for NTSC. If both fields have the
    /// same parity, the picture shows the later field, with black lines between.
    pub fn interlaced_with(&self, other: &Self) -> RgbImage {
        let (earlier, later) = if self.field < other.field { (self, other) } else { (other, self) };
        let mut canvas = Canvas::new(self.video.width(), self.video.height());
        later.paint(&mut canvas, |y| y);
        if earlier.parity() != later.parity() {
            earlier.paint(&mut canvas, |y| y);
        }
        canvas.into_image()
    }

    /// Returns the colour of the pixel [x, y] of the frame, or `None` if this field does not scan the pixel. A pixel
    /// that was never written is black. Only the pixels of one region are computed.
    pub fn pixel(&self, [x, y]: [u32; 2]) -> Option<[u8; 3]> {
        self.video.when(x, y, self.field)?;
        let word = self.regions.iter().rev().find_map(|region| {
            let contains = |segment: &Segment| segment.y == y && (segment.x..segment.x + segment.length).contains(&x);
            let segment = region.segments(self.word).find(contains)?;
            let i = x - segment.x;
            let start = self.video.when(segment.x, y, self.field)?;
            let is_in_time = segment.message_at <= start || self.in_time(&segment, i);
            let pixels = is_in_time.then(|| region.image.pixels())?;
            pixels.get(segment.image_range())?.get(i as usize).copied()
        });
        let [_, red, green, blue] = word.unwrap_or_default().to_be_bytes();
        Some([red, green, blue])
    }

    /// Returns the regions that arrived too late for this field, in the order of their arrival.
    pub fn late_regions(&self) -> Vec<ScannedLateRegion> {
        let during = self.regions.iter().filter(|region| self.may_be_late(region));
        during.filter_map(|region| self.late(region)).collect()
    }

    fn may_be_late(&self, region: &RegionWrite) -> bool {
        let begun = region.first_at() < self.ends_at;
        begun && region.last_at().is_none_or(|last| last > self.video.retrace(self.field))
    }

    /// Paints the regions into `canvas`, the newest first, so that the pixels of hidden regions are never computed.
    /// `row_of` returns the row of the canvas for a line of the frame.
    fn paint(&self, canvas: &mut Canvas, row_of: impl Fn(u32) -> u32) {
        for region in self.regions.iter().rev() {
            let pixels = LazyCell::new(|| region.image.pixels());
            for segment in region.segments(self.word) {
                // A field scans every second line only.
                let Some(scanned_at) = self.video.when(segment.x, segment.y, self.field) else {
                    continue;
                };
                let row = canvas.row([segment.x, row_of(segment.y)], segment.length);
                // If the last word of the message was in time, all words of the segment were in time.
                if segment.message_at <= scanned_at {
                    row.put(&pixels, &segment);
                } else {
                    row.put_chosen(&pixels, &segment, |i| self.in_time(&segment, i));
                }
            }
        }
    }

    fn in_time(&self, segment: &Segment, i: u32) -> bool {
        self.lateness(segment, i) == Some(Span::ZERO)
    }

    /// Returns the time from the scan of pixel `i` of a segment to its arrival, or zero if the pixel arrived in time.
    /// Returns `None` if the field does not scan the pixel.
    ///
    /// The board gets an event only at the end of a message. If this is after the end of the field, all words of the
    /// message count as missing. On the published ring, which is faster than the beam, none of them would be in time
    /// anyway.
    fn lateness(&self, segment: &Segment, i: u32) -> Option<Span> {
        let scanned_at = self.video.when(segment.x + i, segment.y, self.field)?;
        let has_come = segment.message_at < self.ends_at;
        let arrived = if has_come { segment.arrival(i, self.word) } else { self.ends_at };
        Some(arrived.since(scanned_at))
    }

    fn late(&self, region: &RegionWrite) -> Option<ScannedLateRegion> {
        let mut late = ScannedLateRegion {
            target: region.target,
            arrived_at: region.last_at().filter(|last| *last < self.ends_at),
            first_line: 0,
            lines: 0,
            lateness: Span::ZERO,
        };
        for row in region.rows() {
            // The beam and the words both advance at constant rates, so the latest pixel is at one end of a segment.
            let ends = region.row(row, self.word).flat_map(|s| [(s, 0), (s, s.length - 1)]);
            let worst = ends.filter_map(|(s, i)| Some((s.y, self.lateness(&s, i)?))).max_by_key(|w| w.1);
            if let Some((y, lateness)) = worst.filter(|w| w.1 > Span::ZERO) {
                late.add(y, lateness);
            }
        }
        (late.lines > 0).then_some(late)
    }
}

impl ScannedLateRegion {
    fn add(&mut self, y: u32, lateness: Span) {
        if self.lines == 0 {
            self.first_line = y;
        }
        self.lines += 1;
        self.lateness = self.lateness.max(lateness);
    }
}

/// The contents of one of the two pixel buffers of a board, with the lines of both fields. Pixels are computed when
/// they are read. A clone is cheap.
#[derive(Clone, Debug)]
pub struct BufferContents {
    pub(crate) video: Video,
    pub(crate) regions: Regions,
}

impl BufferContents {
    /// Returns the picture of both fields, with all messages that have arrived so far. Pixels that were never written
    /// are black.
    pub fn picture(&self) -> RgbImage {
        let mut canvas = Canvas::new(self.video.width(), self.video.height());
        for region in self.regions.iter().rev() {
            let pixels = LazyCell::new(|| region.image.pixels());
            for segment in region.segments(Span::ZERO) {
                let row = canvas.row([segment.x, segment.y], segment.length);
                row.put(&pixels, &segment);
            }
        }
        canvas.into_image()
    }
}
