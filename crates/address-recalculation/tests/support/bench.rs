//! A test bench with a display: clock, input messages and outputs.

use address_recalculation::{AddressRecalculationPipeline, ArpConfig, ArpTiming, begin_update, region_grid};
use pxpl5_sim::{Context, Time};
use pxpl5_wire::display::{Display, DisplayConfig, DisplayEvent, DisplayOutput};
use pxpl5_wire::{
    Body, CopyTarget, Lines, NodeId, PeriodNumber, PictureNumber, PixelSource, RegionId, RegionPixels, Word,
    swap_request,
};
use std::any::Any;
use std::ops::Range;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// A region with 16,384 equal colours, then 16,384 equal depths, and a count of reads.
#[derive(Debug)]
pub(crate) struct Flat {
    colour: u32,
    depth: u32,
    pub(crate) asked: AtomicU64,
}

impl PixelSource for Flat {
    fn pixels(&self) -> Arc<[Word]> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        [vec![self.colour; 16_384], vec![self.depth; 16_384]].concat().into()
    }
}

/// Returns a region of one colour and one depth.
pub(crate) fn flat(colour: u32, depth: u32) -> Arc<Flat> {
    Arc::new(Flat { colour, depth, asked: AtomicU64::new(0) })
}

/// A display with a clock and its recorded outputs.
pub(crate) struct Bench {
    pub(crate) display: Box<dyn Display>,
    pub(crate) outputs: Vec<(Time, DisplayOutput)>,
    pub(crate) texels: u32,
}

pub(crate) const CONFIG: ArpConfig = ArpConfig {
    timing: ArpTiming { face_texels: 128, display_memories: 2, ..ArpTiming::PAPERS },
    ..ArpConfig::MACHINE
};

impl Bench {
    pub(crate) fn new(config: &ArpConfig) -> Self {
        let nodes: Vec<NodeId> = (40..40 + config.ports(1) as u16).map(NodeId).collect();
        let display = config.build(&nodes, pxpl5_sim::Span::from_ns(50)).expect("valid");
        let mut bench = Self { display, outputs: Vec::new(), texels: config.timing.face_texels as u32 };
        bench.tick(0);
        bench
    }

    pub(crate) fn event(&mut self, at: Time, event: DisplayEvent) {
        let mut context = Context::default();
        self.display.handle(event, context.at(at));
        self.outputs.extend(context.drain_outputs());
    }

    pub(crate) fn tick(&mut self, field: u64) {
        let at = self.display.tick(PeriodNumber(field));
        self.event(at, DisplayEvent::Tick(PeriodNumber(field)));
    }

    pub(crate) fn words(&mut self, at: Time, port: usize, words: Arc<[Word]>) {
        self.event(at, DisplayEvent::Delivered { port, body: Body::Words(words) });
    }

    pub(crate) fn begin(&mut self, port: usize, buffer: u8, regions: &[u16]) {
        let regions: Vec<RegionId> = regions.iter().copied().map(RegionId).collect();
        self.words(Time(10), port, begin_update(self.texels, buffer, &regions));
    }

    pub(crate) fn target(&self, port: usize, buffer: u8, region: u16) -> CopyTarget {
        let grid = region_grid(self.texels);
        let frame_buffer = self.display.nodes()[port];
        CopyTarget {
            frame_buffer,
            buffer,
            lines: Lines::Frame,
            grid,
            region: RegionId(region),
            picture: PictureNumber(0),
        }
    }

    /// Sends some of the 32 messages of a region. `parts` is the range of their indices.
    pub(crate) fn parts(&mut self, port: usize, buffer: u8, region: u16, source: &Arc<Flat>, parts: Range<u32>) {
        let image: Arc<dyn PixelSource> = Arc::<Flat>::clone(source);
        self.parts_of(32, (port, buffer, region), &image, parts);
    }

    /// Sends some messages of a region that consists of `all` messages in total.
    pub(crate) fn parts_of(
        &mut self,
        all: u32,
        (port, buffer, region): (usize, u8, u16),
        image: &Arc<dyn PixelSource>,
        parts: Range<u32>,
    ) {
        for part in parts {
            let target = self.target(port, buffer, region);
            let pixels = RegionPixels { target, image: Arc::clone(image), part, parts: all };
            self.event(Time(100 + u64::from(part)), DisplayEvent::Delivered { port, body: Body::Pixels(pixels) });
        }
    }

    /// Sends the first message of a region to the first port.
    pub(crate) fn pixels(&mut self, target: CopyTarget) {
        let body = Body::Pixels(RegionPixels { target, image: flat(1, 1), part: 0, parts: 32 });
        self.event(Time(9), DisplayEvent::Delivered { port: 0, body });
    }

    /// Sends a complete update of the hidden buffer, with the same region on every face.
    pub(crate) fn update(&mut self, port: usize, buffer: u8, source: &Arc<Flat>) {
        let regions: Vec<u16> = (0..region_grid(self.texels).regions() as u16).collect();
        self.begin(port, buffer, &regions);
        regions.iter().for_each(|region| self.parts(port, buffer, *region, source, 0..32));
        self.words(Time(1_000), port, swap_request(buffer));
    }

    pub(crate) fn pixel(&self, field: u64, x: u32, y: u32) -> u32 {
        let [red, green, blue] = self.display.seen(0, PeriodNumber(field)).expect("remembered").get_pixel(x, y).0;
        u32::from_be_bytes([0, red, green, blue])
    }

    pub(crate) fn arp(&self) -> &AddressRecalculationPipeline {
        (&*self.display as &dyn Any).downcast_ref().expect("an address recalculation pipeline")
    }

    pub(crate) fn arp_mut(&mut self) -> &mut AddressRecalculationPipeline {
        (&mut *self.display as &mut dyn Any).downcast_mut().expect("an address recalculation pipeline")
    }

    pub(crate) fn fault(&self) -> String {
        self.display.faults().1.unwrap_or_default()
    }
}
