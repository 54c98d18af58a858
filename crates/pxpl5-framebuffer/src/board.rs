//! The board: two buffers, the port of the ring and the scan.

use crate::buffer::{Buffer, Regions};
use crate::region::RegionWrite;
use crate::seen::{BufferContents, SeenField};
use crate::{
    Faults, FrameBufferConfig, FrameBufferConfigError, FrameBufferEvent, FrameBufferFault, FrameBufferOutput,
    FrameBufferStats, Video,
};
use pxpl5_sim::{Context, Span, Time};
use pxpl5_wire::{NodeId, PeriodNumber, RegionPixels};
use std::collections::VecDeque;

type Out = Context<FrameBufferEvent, FrameBufferOutput>;

/// A frame-buffer board: two buffers of pixels, its port on the ring, and the scan.
#[derive(Clone, Debug)]
pub struct FrameBuffer {
    node: NodeId,
    video: Video,
    word: Span,
    fields_kept: usize,
    buffers: [Buffer; 2],
    displayed: u8,
    /// The field that is being scanned.
    scanning: Option<PeriodNumber>,
    /// Requests that have not taken effect: (when, buffer).
    swaps: Vec<(Time, u8)>,
    seen: VecDeque<SeenField>,
    stats: FrameBufferStats,
    faults: Faults,
}

impl FrameBuffer {
    /// A board with two black buffers of which the first is displayed, at a port of the ring.
    ///
    /// # Errors
    ///
    /// [`FrameBufferConfigError`] names the number that is out of range.
    pub fn new(config: FrameBufferConfig, node: NodeId) -> Result<Self, FrameBufferConfigError> {
        config.check()?;
        Ok(Self {
            node,
            video: Video::new(config.video)?,
            word: Span::from_ns(config.port.word_ns),
            fields_kept: config.fields_kept as usize,
            buffers: [Buffer::new(), Buffer::new()],
            displayed: 0,
            scanning: None,
            swaps: Vec::new(),
            seen: VecDeque::new(),
            stats: FrameBufferStats::default(),
            faults: Faults::default(),
        })
    }

    /// Takes what happens to it: pixels from the ring, swap requests, retraces.
    pub fn handle(&mut self, event: FrameBufferEvent, context: &mut Out) {
        let done = match event {
            FrameBufferEvent::Pixels(pixels) => self.receive(&pixels, context),
            FrameBufferEvent::SwapRequested { buffer } => self.request_swap(buffer, context.now()),
            FrameBufferEvent::Retrace { field } => self.retrace(field, context),
        };
        if let Err(fault) = done {
            self.faults.record(context.now(), fault);
        }
    }

    /// Where the board is plugged into the ring.
    #[must_use]
    pub const fn node(&self) -> NodeId {
        self.node
    }

    /// Where the beam is.
    #[must_use]
    pub const fn video(&self) -> &Video {
        &self.video
    }

    /// The displayed buffer, 0 or 1.
    #[must_use]
    pub const fn displayed(&self) -> u8 {
        self.displayed
    }

    /// The field that is being scanned; `None` before the first retrace.
    #[must_use]
    pub const fn scanning(&self) -> Option<PeriodNumber> {
        self.scanning
    }

    /// A field as it was scanned; `None` until it has been, and when it is no longer remembered.
    #[must_use]
    pub fn seen(&self, field: PeriodNumber) -> Option<SeenField> {
        self.seen.iter().find(|seen| seen.field == field).cloned()
    }

    /// The field scanned last.
    #[must_use]
    pub fn last_seen(&self) -> Option<SeenField> {
        self.seen.back().cloned()
    }

    /// The field that is being scanned, as far as the beam has come at `now`: what has not arrived by then is not in it. `None` before
    /// the first retrace.
    #[must_use]
    pub fn scanned_so_far(&self, now: Time) -> Option<SeenField> {
        let buffer = self.displayed;
        let regions: Regions = self.buffers[usize::from(buffer)].regions();
        Some(SeenField { field: self.scanning?, buffer, ends_at: now, video: self.video, word: self.word, regions })
    }

    /// The whole displayed buffer with everything that has arrived.
    #[must_use]
    pub fn displayed_frame(&self) -> BufferContents {
        BufferContents { video: self.video, regions: self.buffers[usize::from(self.displayed)].regions() }
    }

    /// A whole buffer, 0 or 1, with everything that has arrived; `None` when there is no such buffer.
    #[must_use]
    pub fn buffer(&self, buffer: u8) -> Option<BufferContents> {
        let regions = self.buffers.get(usize::from(buffer))?.regions();
        Some(BufferContents { video: self.video, regions })
    }

    /// What the board has done.
    #[must_use]
    pub const fn stats(&self) -> &FrameBufferStats {
        &self.stats
    }

    /// What it could not do.
    #[must_use]
    pub const fn faults(&self) -> &Faults {
        &self.faults
    }

    fn receive(&mut self, pixels: &RegionPixels, context: &mut Out) -> Result<(), FrameBufferFault> {
        let target = pixels.target;
        if target.frame_buffer != self.node {
            return Err(FrameBufferFault::WrongBoard { expected: self.node, found: target.frame_buffer });
        }
        let found = target.buffer;
        let buffer = self.buffers.get_mut(usize::from(found)).ok_or(FrameBufferFault::NoSuchBuffer { found })?;
        let place = arriving(buffer, pixels, &self.video)?;
        buffer.region_mut(place).arrive(pixels.part, context.now());
        self.stats.messages += 1;
        if let Some(last_part_at) = buffer.region(place).last_at() {
            self.stats.regions += 1;
            if let Some(older) = buffer.hide_below(place) {
                self.stats.lines_never_shown += buffer.lines_never_shown(older, place, &self.video, self.word);
            }
            let arrived = FrameBufferOutput::RegionArrived {
                target,
                first_part_at: buffer.region(place).first_at(),
                last_part_at,
            };
            context.output(context.now() + self.word, arrived);
        }
        Ok(())
    }

    fn request_swap(&mut self, buffer: u8, now: Time) -> Result<(), FrameBufferFault> {
        if usize::from(buffer) >= self.buffers.len() {
            return Err(FrameBufferFault::NoSuchBuffer { found: buffer });
        }
        self.swaps.push((now, buffer));
        Ok(())
    }

    fn retrace(&mut self, field: PeriodNumber, context: &mut Out) -> Result<(), FrameBufferFault> {
        let now = context.now();
        if let Some(scanned) = self.scanning {
            self.remember(scanned, now);
        }
        for buffer in &mut self.buffers {
            buffer.prune(self.video.width(), self.video.height());
        }
        self.swap(field, context);
        self.buffers[usize::from(self.displayed)].scan(field);
        self.scanning = Some(field);
        self.stats.fields += 1;
        let expected = self.video.retrace(field);
        if now == expected {
            return Ok(());
        }
        Err(FrameBufferFault::Retrace { field, expected, found: now })
    }

    fn remember(&mut self, field: PeriodNumber, ends_at: Time) {
        if self.seen.len() == self.fields_kept {
            self.seen.pop_front();
        }
        let regions: Regions = self.buffers[usize::from(self.displayed)].share();
        self.seen.push_back(SeenField {
            field,
            buffer: self.displayed,
            ends_at,
            video: self.video,
            word: self.word,
            regions,
        });
    }

    fn swap(&mut self, field: PeriodNumber, context: &mut Out) {
        let now = context.now();
        let due = self.swaps.iter().filter(|swap| swap.0 < now).max().copied();
        let Some((_, buffer)) = due else { return };
        self.swaps.retain(|swap| swap.0 >= now);
        self.displayed = buffer;
        self.stats.swaps += 1;
        context.output(now + self.word, FrameBufferOutput::Swapped { buffer, field });
    }
}

/// The place of the region that a message belongs to, a new one if it is the first.
fn arriving(buffer: &mut Buffer, pixels: &RegionPixels, video: &Video) -> Result<usize, FrameBufferFault> {
    let Some(place) = buffer.arriving(&pixels.target) else {
        let region = RegionWrite::new(pixels, video)?;
        if !region.lacks(pixels.part) {
            return Err(unexpected_part(pixels));
        }
        return Ok(buffer.add(region));
    };
    if buffer.region(place).lacks(pixels.part) {
        return Ok(place);
    }
    Err(unexpected_part(pixels))
}

/// A message that has come before, or of a number that its region does not have.
const fn unexpected_part(pixels: &RegionPixels) -> FrameBufferFault {
    FrameBufferFault::Part { target: pixels.target, found: pixels.part, parts: pixels.parts }
}
