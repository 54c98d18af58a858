//! What a viewer sees.

use crate::buffer::Regions;
use crate::picture::Canvas;
use crate::region::{RegionWrite, Segment};
use crate::video::Video;
use image::RgbImage;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, FieldParity, PeriodNumber};
use std::cell::LazyCell;

/// One field as it was scanned: lazy, cheap to clone, independent of what the board does later.
#[derive(Clone, Debug)]
pub struct SeenField {
    pub(crate) field: PeriodNumber,
    pub(crate) buffer: u8,
    pub(crate) ends_at: Time,
    pub(crate) video: Video,
    pub(crate) word: Span,
    pub(crate) regions: Regions,
}

/// A region of which pixels were scanned before they had arrived, so that older ones are seen in their place. For
/// which field it was meant the board cannot know: compare `target.picture`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SeenLateRegion {
    /// Which region of which picture came.
    pub target: CopyTarget,
    /// When its last message arrived; `None` when that was not before the end of the field.
    pub arrived_at: Option<Time>,
    /// The first line of the frame with an older pixel.
    pub first_line: u32,
    /// Number of such lines in this field.
    pub lines: u32,
    /// Longest time between the scan of a pixel and its arrival; for a pixel whose message did not end in this field the
    /// time to the field's end.
    pub lateness: Span,
}

impl SeenField {
    /// The number of the field.
    #[must_use]
    pub const fn field(&self) -> PeriodNumber {
        self.field
    }

    /// The buffer that was scanned.
    #[must_use]
    pub const fn buffer(&self) -> u8 {
        self.buffer
    }

    /// Which lines of the frame were scanned.
    #[must_use]
    pub const fn parity(&self) -> FieldParity {
        FieldParity::of_field(self.field)
    }

    /// The scanned lines alone, black where nothing was ever written: 640 x 240 for NTSC.
    #[must_use]
    pub fn picture(&self) -> RgbImage {
        let mut canvas = Canvas::new(self.video.width(), self.video.height() / 2);
        self.paint(&mut canvas, |y| y / 2);
        canvas.into_image()
    }

    /// Two fields interlaced, as on a screen: 640 x 480 for NTSC. Two fields of the same lines give the later one
    /// on a black frame.
    #[must_use]
    pub fn interlaced_with(&self, other: &Self) -> RgbImage {
        let (earlier, later) = if self.field < other.field { (self, other) } else { (other, self) };
        let mut canvas = Canvas::new(self.video.width(), self.video.height());
        later.paint(&mut canvas, |y| y);
        if earlier.parity() != later.parity() {
            earlier.paint(&mut canvas, |y| y);
        }
        canvas.into_image()
    }

    /// Regions that came too late for this field, in order of their arrival.
    #[must_use]
    pub fn late_regions(&self) -> Vec<SeenLateRegion> {
        let during = self.regions.iter().filter(|region| self.may_be_late(region));
        during.filter_map(|region| self.late(region)).collect()
    }

    fn may_be_late(&self, region: &RegionWrite) -> bool {
        let begun = region.first_at() < self.ends_at;
        begun && region.last_at().is_none_or(|last| last > self.video.retrace(self.field))
    }

    /// Newest first, so that regions that are hidden are never computed.
    fn paint(&self, canvas: &mut Canvas, row_of: impl Fn(u32) -> u32) {
        for region in self.regions.iter().rev() {
            let pixels = LazyCell::new(|| region.image.pixels());
            for segment in region.segments(self.word) {
                let Some(scanned_at) = self.video.when(segment.x, segment.y, self.field) else {
                    continue;
                };
                let row = canvas.row([segment.x, row_of(segment.y)], segment.length);
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

    /// How much later than the beam a pixel's word came; `None` where the field scans no pixel. Words of a message that is under way when the
    /// field ends have not come: the board learns of whole messages. On a ring whose words come faster than the beam goes over pixels, as the
    /// published one's do, no such word is in time anyhow.
    fn lateness(&self, segment: &Segment, i: u32) -> Option<Span> {
        let scanned_at = self.video.when(segment.x + i, segment.y, self.field)?;
        let has_come = segment.message_at < self.ends_at;
        let arrived = if has_come { segment.arrival(i, self.word) } else { self.ends_at };
        Some(arrived.since(scanned_at))
    }

    fn late(&self, region: &RegionWrite) -> Option<SeenLateRegion> {
        let mut late = SeenLateRegion {
            target: region.target,
            arrived_at: region.last_at().filter(|last| *last < self.ends_at),
            first_line: 0,
            lines: 0,
            lateness: Span::ZERO,
        };
        for row in region.rows() {
            // Beam and words both advance evenly, so the worst pixel stands at one end of a segment.
            let ends = region.row(row, self.word).flat_map(|s| [(s, 0), (s, s.length - 1)]);
            let worst = ends.filter_map(|(s, i)| Some((s.y, self.lateness(&s, i)?))).max_by_key(|w| w.1);
            if let Some((y, lateness)) = worst.filter(|w| w.1 > Span::ZERO) {
                late.add(y, lateness);
            }
        }
        (late.lines > 0).then_some(late)
    }
}

impl SeenLateRegion {
    fn add(&mut self, y: u32, lateness: Span) {
        if self.lines == 0 {
            self.first_line = y;
        }
        self.lines += 1;
        self.lateness = self.lateness.max(lateness);
    }
}

/// A whole buffer as it is: lazy, cheap to clone.
#[derive(Clone, Debug)]
pub struct BufferContents {
    pub(crate) video: Video,
    pub(crate) regions: Regions,
}

impl BufferContents {
    /// Both fields, with all messages that have arrived; black where nothing was ever written.
    #[must_use]
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
