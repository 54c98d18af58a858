//! A frame buffer on a test bench, and pixel sources that count their evaluations.

use pxpl5_framebuffer::{FrameBuffer, FrameBufferConfig, FrameBufferEvent, FrameBufferOutput};
use pxpl5_sim::{Phase, Span, TestBench, Time};
use pxpl5_wire::{
    CopyTarget, FieldParity, Lines, MAX_MESSAGE_WORDS, NodeId, PeriodNumber, PictureNumber, PixelSource, RegionGrid,
    RegionId, RegionPixels, Word,
};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

pub(crate) const NODE: NodeId = NodeId(7);
pub(crate) const WORD: Span = Span::from_ns(50);
/// Time of a message of 1,024 words on the ring, including the overhead.
pub(crate) const MESSAGE: Span = Span::from_us(52);

/// A pixel source. Pixel `i` has the value `first + step * i`.
#[derive(Debug)]
pub(crate) struct Counted {
    pub(crate) first: Word,
    pub(crate) step: Word,
    pub(crate) n: u32,
    pub(crate) asked: AtomicUsize,
}

impl PixelSource for Counted {
    fn pixels(&self) -> Arc<[Word]> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        (0..self.n).map(|i| self.first + self.step * i).collect()
    }
}

pub(crate) fn source(first: Word, step: Word, n: u32) -> Arc<Counted> {
    Arc::new(Counted { first, step, n, asked: AtomicUsize::new(0) })
}

pub(crate) fn colour(word: Word) -> Arc<Counted> {
    source(word, 0, 128 * 128)
}

pub(crate) fn target(buffer: u8, lines: Lines, grid: RegionGrid, region: u16, picture: u64) -> CopyTarget {
    CopyTarget { frame_buffer: NODE, buffer, lines, grid, region: RegionId(region), picture: PictureNumber(picture) }
}

pub(crate) fn field_target(buffer: u8, parity: FieldParity, region: u16, picture: u64) -> CopyTarget {
    target(buffer, Lines::Field(parity), RegionGrid::FIELD, region, picture)
}

pub(crate) fn n_parts(target: &CopyTarget) -> u32 {
    let [_, _, width, height] = target.grid.rectangle(target.region);
    (width * height).div_ceil(MAX_MESSAGE_WORDS)
}

pub(crate) struct Board {
    pub(crate) device: FrameBuffer,
    pub(crate) bench: TestBench<FrameBufferEvent, FrameBufferOutput>,
    /// Word time in units of 50 ns.
    pub(crate) slowness: u64,
}

impl Board {
    pub(crate) fn new() -> Self {
        Self::with(FrameBufferConfig::NTSC)
    }

    pub(crate) fn with(config: FrameBufferConfig) -> Self {
        Self::build(config, 1)
    }

    fn build(config: FrameBufferConfig, slowness: u64) -> Self {
        let device = FrameBuffer::new(config, NODE, WORD * slowness).expect("valid");
        Self { device, bench: TestBench::new(), slowness }
    }

    /// Makes a board on a slower ring, with word times of `slowness` x 50 ns. With a slowness of 2 or more, words
    /// arrive more slowly than the beam passes pixels.
    pub(crate) fn slow(slowness: u64) -> Self {
        Self::build(FrameBufferConfig::NTSC, slowness)
    }

    pub(crate) fn feed(&mut self, at: Time, event: FrameBufferEvent) {
        self.bench.feed(at, Phase::Arrive, event);
    }

    pub(crate) fn retraces(&mut self, fields: std::ops::RangeInclusive<u64>) {
        for field in fields.map(PeriodNumber) {
            let at = self.device.video().retrace(field);
            self.feed(at, FrameBufferEvent::Retrace { field });
        }
    }

    pub(crate) fn swap(&mut self, at: Time, buffer: u8) {
        self.feed(at, FrameBufferEvent::SwapRequested { buffer });
    }

    pub(crate) fn part(&mut self, at: Time, target: CopyTarget, image: &Arc<Counted>, part: u32) {
        let image: Arc<dyn PixelSource> = Arc::clone(image) as _;
        let pixels = RegionPixels { target, image, part, parts: n_parts(&target) };
        self.feed(at, FrameBufferEvent::Pixels(pixels));
    }

    /// Sends all messages of a region. The last message arrives at `last`.
    pub(crate) fn region(&mut self, last: Time, target: CopyTarget, image: &Arc<Counted>) {
        let parts = n_parts(&target);
        for part in 0..parts {
            let before = MESSAGE * self.slowness * u64::from(parts - 1 - part);
            self.part(Time(last.0 - before.0), target, image, part);
        }
    }

    pub(crate) fn run(&mut self) {
        let device = &mut self.device;
        self.bench.run(|event, context| device.handle(event, context));
    }
}
