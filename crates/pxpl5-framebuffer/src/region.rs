//! A region in a buffer, during and after its arrival.

use crate::FrameBufferFault;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{CopyTarget, MAX_MESSAGE_WORDS, PixelSource, REGION_SIZE, RegionPixels};
use pxpl5_wire::{Video, frame_line};
use std::ops::Range;
use std::sync::Arc;

const MAX_PARTS: usize = (REGION_SIZE * REGION_SIZE).div_ceil(MAX_MESSAGE_WORDS) as usize;
const NEVER: Time = Time(u64::MAX);

#[derive(Clone, Debug)]
pub(crate) struct RegionWrite {
    pub(crate) target: CopyTarget,
    pub(crate) image: Arc<dyn PixelSource>,
    rectangle: [u32; 4],
    parts: u32,
    n_arrived: u32,
    arrived: [Time; MAX_PARTS],
}

/// Adjacent pixels of one line of a region, which arrived in the same message.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Segment {
    pub(crate) y: u32,
    pub(crate) x: u32,
    pub(crate) length: u32,
    /// Index of the segment's first pixel in the image of the region.
    pub(crate) index: u32,
    /// Arrival time of the word of the segment's first pixel.
    first_at: Time,
    /// Arrival time of the last word of the segment's message.
    pub(crate) message_at: Time,
}

impl Segment {
    /// Returns the arrival time of the word of pixel `i` of the segment. `word` is the time in which the port receives
    /// one word.
    pub(crate) fn arrival(&self, i: u32, word: Span) -> Time {
        self.first_at + word * u64::from(i)
    }

    pub(crate) fn image_range(&self) -> Range<usize> {
        self.index as usize..(self.index + self.length) as usize
    }
}

impl RegionWrite {
    pub(crate) fn new(pixels: &RegionPixels, video: &Video) -> Result<Self, FrameBufferFault> {
        let target = pixels.target;
        let outside = FrameBufferFault::Region { target, frame: [video.width(), video.height()] };
        let Some(rectangle) = video.rectangle(&target) else { return Err(outside) };
        let [_, _, width, height] = rectangle;
        // The number of messages follows from the size of the region.
        let expected = (width * height).div_ceil(MAX_MESSAGE_WORDS);
        if pixels.parts != expected {
            let found = pixels.parts;
            return Err(FrameBufferFault::Parts { target, expected, found });
        }
        Ok(Self {
            target,
            image: Arc::clone(&pixels.image),
            rectangle,
            parts: expected,
            n_arrived: 0,
            arrived: [NEVER; MAX_PARTS],
        })
    }

    pub(crate) fn lacks(&self, part: u32) -> bool {
        part < self.parts && self.arrived[part as usize] == NEVER
    }

    pub(crate) fn arrive(&mut self, part: u32, now: Time) {
        self.arrived[part as usize] = now;
        self.n_arrived += 1;
    }

    pub(crate) const fn is_complete(&self) -> bool {
        self.n_arrived == self.parts
    }

    /// Returns the arrival time of the region's first message, or `NEVER` if no message has arrived.
    pub(crate) fn first_at(&self) -> Time {
        self.arrived.iter().copied().min().unwrap_or(NEVER)
    }

    /// Returns the arrival time of the region's last message, or `None` while a message is missing.
    pub(crate) fn last_at(&self) -> Option<Time> {
        let arrived = &self.arrived[..self.parts as usize];
        self.is_complete().then(|| arrived.iter().copied().max())?
    }

    /// Iterates over the pixels that have arrived, line by line. A line that arrives in two messages has two segments.
    /// `word` is the time in which the port receives one word.
    pub(crate) fn segments(&self, word: Span) -> impl Iterator<Item = Segment> + '_ {
        let [_, _, _, height] = self.rectangle;
        (0..height).flat_map(move |row| self.row(row, word)).filter(|segment| segment.message_at != NEVER)
    }

    /// Iterates over the segments of one row, including segments that have not arrived. `word` is the time in which the
    /// port receives one word.
    pub(crate) fn row(&self, row: u32, word: Span) -> impl Iterator<Item = Segment> + '_ {
        let [_, _, width, _] = self.rectangle;
        let begin = row * width;
        let end = begin + width;
        // The pixels of a row can be in two messages.
        let parts = begin / MAX_MESSAGE_WORDS..=(end - 1) / MAX_MESSAGE_WORDS;
        parts.map(move |part| {
            let first = begin.max(part * MAX_MESSAGE_WORDS);
            let last = end.min((part + 1) * MAX_MESSAGE_WORDS);
            self.segment(row, part, first..last, word)
        })
    }

    pub(crate) fn rows(&self) -> Range<u32> {
        0..self.rectangle[3]
    }

    fn segment(&self, row: u32, part: u32, words: Range<u32>, word: Span) -> Segment {
        let [left, top, width, height] = self.rectangle;
        // The words of a message arrive one word time apart, and the last word arrives at `message_at`.
        let message_at = self.arrived[part as usize];
        let message_end = (width * height).min((part + 1) * MAX_MESSAGE_WORDS);
        let before_end = word * u64::from(message_end - 1 - words.start);
        Segment {
            y: frame_line(self.target.lines, top + row),
            x: left + words.start - row * width,
            length: words.end - words.start,
            index: words.start,
            first_at: Time(message_at.0.saturating_sub(before_end.0)),
            message_at,
        }
    }
}
