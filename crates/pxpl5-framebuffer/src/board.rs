//! The frame buffer board: two pixel buffers, the ring port and the video scan.

use crate::buffer::{Buffer, Regions};
use crate::region::RegionWrite;
use crate::scanned::{BufferContents, ScannedField};
use crate::{Faults, FrameBufferConfig, FrameBufferEvent, FrameBufferFault, FrameBufferOutput, Video};
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Context, Span, Time};
use pxpl5_wire::{NodeId, PeriodNumber, RegionPixels};
use std::collections::VecDeque;

/// Counts of a frame buffer since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct FrameBufferStats {
    /// Number of fields whose scan has begun so far.
    pub fields: u64,
    /// Number of received messages of pixels.
    pub messages: u64,
    /// Number of regions for which all messages were received.
    pub regions: u64,
    /// Number of swap requests that took effect.
    pub swaps: u64,
    /// Number of lines that a newer region overwrote before the beam had shown all of their pixels. Either it came too
    /// early, or the older region too late. A third cause is a buffer that was shown for only one field, which scans
    /// every second line.
    pub lines_never_shown: u64,
}

type Out = Context<FrameBufferEvent, FrameBufferOutput>;

/// A frame buffer board: two pixel buffers, a port on the ring, and a video scan.
#[derive(Clone, Debug)]
pub struct FrameBuffer {
    node: NodeId,
    video: Video,
    word: Span,
    fields_kept: usize,
    buffers: [Buffer; 2],
    displayed: u8,
    /// Field that is being scanned. `None` before the first retrace.
    scanning: Option<PeriodNumber>,
    /// Swap requests that have not taken effect: the arrival time, and the number of the requested buffer.
    swaps: Vec<(Time, u8)>,
    seen: VecDeque<ScannedField>,
    stats: FrameBufferStats,
    faults: Faults,
}

impl FrameBuffer {
    /// Makes a board at ring port `node`, which receives a word in the time `word`. Both buffers are black, and buffer 0
    /// is displayed.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] with the name of the parameter that is out of range.
    pub fn new(config: FrameBufferConfig, node: NodeId, word: Span) -> Result<Self, SettingError> {
        config.check()?;
        Ok(Self {
            node,
            video: config.video.video()?,
            word,
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

    /// Handles an event: pixels from the ring, a swap request or a retrace. Events that cannot occur on the real board
    /// are recorded as faults.
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

    /// Returns the ring port of the board.
    pub const fn node(&self) -> NodeId {
        self.node
    }

    /// Returns the video signal, which gives the place of the beam at any time.
    pub const fn video(&self) -> &Video {
        &self.video
    }

    /// Returns the number of the displayed buffer, 0 or 1.
    pub const fn displayed(&self) -> u8 {
        self.displayed
    }

    /// Returns the field that is being scanned, or `None` before the first retrace.
    pub const fn scanning(&self) -> Option<PeriodNumber> {
        self.scanning
    }

    /// Returns a field as it was scanned. Returns `None` before the end of the field, and after the board has discarded
    /// the field.
    pub fn seen(&self, field: PeriodNumber) -> Option<ScannedField> {
        self.seen.iter().find(|seen| seen.field == field).cloned()
    }

    /// Returns the last completely scanned field, or `None` before the end of the first field.
    pub fn last_seen(&self) -> Option<ScannedField> {
        self.seen.back().cloned()
    }

    /// Returns the current field as it was scanned up to `now`, or `None` before the first retrace. Pixels that arrive
    /// after `now` are not included.
    pub fn current_scan(&self, now: Time) -> Option<ScannedField> {
        let buffer = self.displayed;
        let regions: Regions = self.buffers[usize::from(buffer)].regions();
        Some(ScannedField { field: self.scanning?, buffer, ends_at: now, video: self.video, word: self.word, regions })
    }

    /// Returns the contents of the displayed buffer, with all pixels that have arrived so far.
    pub fn displayed_frame(&self) -> BufferContents {
        BufferContents { video: self.video, regions: self.buffers[usize::from(self.displayed)].regions() }
    }

    /// Returns the contents of buffer 0 or 1, with all pixels that have arrived so far. Returns `None` for all other
    /// numbers.
    pub fn buffer(&self, buffer: u8) -> Option<BufferContents> {
        let regions = self.buffers.get(usize::from(buffer))?.regions();
        Some(BufferContents { video: self.video, regions })
    }

    /// Returns the counts of fields, messages, regions and swaps.
    pub const fn stats(&self) -> &FrameBufferStats {
        &self.stats
    }

    /// Returns the events that the board could not handle.
    pub const fn faults(&self) -> &Faults {
        &self.faults
    }

    fn receive(&mut self, pixels: &RegionPixels, context: &mut Out) -> Result<(), FrameBufferFault> {
        let target = pixels.target;
        // Refuse pixels for another board or for a buffer that does not exist.
        if target.frame_buffer != self.node {
            return Err(FrameBufferFault::WrongBoard { expected: self.node, found: target.frame_buffer });
        }
        let found = target.buffer;
        let buffer = self.buffers.get_mut(usize::from(found)).ok_or(FrameBufferFault::NoSuchBuffer { found })?;
        // Record the arrival in the region. The first message of a region also adds the region to the buffer.
        let place = arriving(buffer, pixels, &self.video)?;
        buffer.region_mut(place).arrive(pixels.part, context.now());
        self.stats.messages += 1;
        // The region is complete. Hide the older region with the same pixels, and report the arrival.
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
        // Discard hidden regions, then swap and begin the next field.
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
        // Discard the oldest field if the board keeps the greatest number of fields.
        if self.seen.len() == self.fields_kept {
            self.seen.pop_front();
        }
        let regions: Regions = self.buffers[usize::from(self.displayed)].share();
        self.seen.push_back(ScannedField {
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
        // The last swap request that arrived before this instant takes effect.
        let due = self.swaps.iter().filter(|swap| swap.0 < now).max().copied();
        let Some((_, buffer)) = due else { return };
        self.swaps.retain(|swap| swap.0 >= now);
        self.displayed = buffer;
        self.stats.swaps += 1;
        context.output(now + self.word, FrameBufferOutput::Swapped { buffer, field });
    }
}

/// Returns the index of the region in `buffer` to which a message belongs. The first message of a region adds the
/// region.
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

/// Returns the fault for a message that does not exist in its region, or that has already arrived.
const fn unexpected_part(pixels: &RegionPixels) -> FrameBufferFault {
    FrameBufferFault::Part { target: pixels.target, found: pixels.part, parts: pixels.parts }
}
