//! The address recalculation display as a board on the ring: a port for each memory, and for each eye an orientation
//! register and a picture.

use crate::address::Footprint;
use crate::config::ArpConfig;
use crate::face::Vector;
use crate::field::{Field, Optics, ShownBuffers};
use crate::lookup::LookupStats;
use crate::memory::{DisplayMemory, MemoryKind, PixelReceipt};
use crate::orientation::{MatrixWords, OrientationLatch};
use crate::protocol::{ArpMessage, read};
use image::RgbImage;
use pxpl5_sim::parameters::{ParameterTable, SettingError};
use pxpl5_sim::{Span, Time};
use pxpl5_wire::display::{
    Counter, Coverage, Display, DisplayConfig, DisplayContext, DisplayEvent, DisplayOutput, Surface,
};
use pxpl5_wire::{Body, Eye, NodeId, PeriodNumber, RegionPixels, Word};
use std::collections::VecDeque;
use std::sync::OnceLock;

#[derive(Debug)]
struct EyeBoards {
    memories: Vec<DisplayMemory>,
    latch: OrientationLatch,
    /// Buffers that were shown in past fields. The newest field is last.
    scanned: VecDeque<(PeriodNumber, ShownBuffers)>,
}

impl EyeBoards {
    fn shown(&self) -> ShownBuffers {
        ShownBuffers { memories: self.memories.iter().map(|memory| (memory.kind(), memory.shown())).collect() }
    }

    /// Swaps the buffers of all memories that are ready at a retrace. Returns the index of each swapped memory with its
    /// new buffer.
    ///
    /// A group of memories that must swap together swaps only if all memories of the group are ready.
    fn retrace(&mut self, now: Time) -> Vec<(usize, u8)> {
        let ready: Vec<Option<u8>> = self.memories.iter().map(|memory| memory.is_ready(now)).collect();
        // A memory that is ready to swap with another set, or alone, does not count as ready for this set.
        let all_ready = |set: u8| (0..u8::BITS as usize).all(|k| set >> k & 1 == 0 || ready.get(k) == Some(&Some(set)));
        let may_swap: Vec<bool> = ready.iter().map(|set| set.is_some_and(all_ready)).collect();
        let memories = (0..).zip(self.memories.iter_mut().zip(may_swap));
        memories.filter_map(|(k, (memory, may_swap))| Some((k, memory.retrace(may_swap, now)?))).collect()
    }
}

/// An address recalculation pipeline with its display memories, for one or two eyes. The pipeline computes the texel of
/// each pixel at scan-out.
#[derive(Debug)]
pub struct AddressRecalculationPipeline {
    optics: Optics,
    nodes: Vec<NodeId>,
    /// Time in which a port receives one word.
    word: Span,
    surfaces: Vec<Surface>,
    eyes: Vec<EyeBoards>,
    fields: u64,
    faults: u64,
    first_fault: Option<String>,
}

impl AddressRecalculationPipeline {
    pub const fn config(&self) -> &ArpConfig {
        &self.optics.config
    }

    /// Returns the display memories of an eye, with the background memory last. Returns an empty slice for an eye that
    /// does not exist.
    pub fn memories(&self, eye: Eye) -> &[DisplayMemory] {
        self.eyes.get(eye.index()).map_or(&[], |boards| &boards.memories)
    }

    /// Loads an orientation into the register of an eye, as the host does through its own port. `rows` is the matrix
    /// from head axes to world axes.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the matrix is not a rotation. The refusal is counted, and the previous
    /// matrix stays valid.
    pub fn load_orientation(&mut self, eye: Eye, rows: [Vector; 3], now: Time) -> Result<(), SettingError> {
        self.eyes.get_mut(eye.index()).map_or(Ok(()), |boards| boards.latch.load(rows, now))
    }

    /// Returns the matrix with which a pixel of a past field was computed. Returns `None` if the display no longer
    /// stores the field, or if the field does not scan the pixel.
    pub fn latched(&self, eye: Eye, x: u32, y: u32, field: PeriodNumber) -> Option<MatrixWords> {
        self.field(eye.index(), field)?.matrix(x, y)
    }

    /// Returns the texels and weights from which a pixel of a past field was computed.
    ///
    /// Returns `None` if the display no longer stores the field, or if the field does not scan the pixel.
    pub fn footprint(&self, eye: Eye, x: u32, y: u32, field: PeriodNumber) -> Option<Footprint> {
        self.field(eye.index(), field)?.footprint(x, y)
    }

    /// Returns the number of extra memory accesses for a past field, beyond one access per pixel and memory.
    pub fn lookup_stats(&self, eye: Eye, field: PeriodNumber) -> Option<LookupStats> {
        let mut frame = self.empty_frame();
        Some(self.field(eye.index(), field)?.draw(&mut frame))
    }

    fn field(&self, eye: usize, number: PeriodNumber) -> Option<Field<'_>> {
        let boards = self.eyes.get(eye)?;
        let (_, shown) = boards.scanned.iter().find(|(scanned, _)| *scanned == number)?;
        Some(Field { optics: &self.optics, latch: &boards.latch, shown, number })
    }

    fn empty_frame(&self) -> RgbImage {
        RgbImage::new(self.optics.scan.width(), self.optics.scan.height())
    }

    fn retrace(&mut self, tick: PeriodNumber, context: &mut DisplayContext) {
        let now = context.now();
        let at = now + self.word;
        let kept = self.optics.config.fields_kept;
        let oldest = self.optics.scan.retrace(tick.before(kept).unwrap_or(PeriodNumber::FIRST));
        // Remember the buffers that the past field showed.
        self.fields += 1;
        for (surface, boards) in self.eyes.iter_mut().enumerate() {
            if let Some(over) = tick.before(1) {
                boards.scanned.push_back((over, boards.shown()));
            }
            while boards.scanned.len() as u64 > kept {
                boards.scanned.pop_front();
            }
            boards.latch.discard_before(Time(oldest.0.saturating_sub(self.optics.config.timing.depth().0)));
            // Swap the memories that are ready for this retrace.
            for (memory, buffer) in boards.retrace(now) {
                let port = self.nodes[surface * self.optics.config.ports_of_an_eye() + memory];
                context.output(at, DisplayOutput::Updated { surface, port, buffer, tick });
            }
        }
    }

    fn receive(&mut self, port: usize, body: Body, context: &mut DisplayContext) -> Result<(), String> {
        let ports = self.optics.config.ports_of_an_eye();
        let node = *self.nodes.get(port).ok_or("a port that it does not have")?;
        match body {
            Body::Pixels(pixels) if pixels.target.frame_buffer != node => Err("pixels for another port".to_owned()),
            Body::Pixels(pixels) => self.pixels(port / ports, port % ports, pixels, context).map_err(str::to_owned),
            Body::Words(words) => self.words(port / ports, port % ports, &words, context.now()),
            Body::Commands(_) => Err("commands for a renderer".to_owned()),
        }
    }

    fn pixels(
        &mut self,
        surface: usize,
        memory: usize,
        pixels: RegionPixels,
        context: &mut DisplayContext,
    ) -> Result<(), &'static str> {
        let target = pixels.target;
        let last_part_at = context.now();
        let receipt = self.eyes[surface].memories[memory].receive(pixels, last_part_at)?;
        // Report a complete region one word time after its last message.
        if let PixelReceipt::Region(first_part_at) = receipt {
            let at = last_part_at + self.word;
            context.output(at, DisplayOutput::RegionArrived { surface, target, first_part_at, last_part_at });
        }
        Ok(())
    }

    fn words(&mut self, surface: usize, memory: usize, words: &[Word], now: Time) -> Result<(), String> {
        let message = read(words, self.optics.config.timing.face_texels as u32).map_err(|error| error.to_string())?;
        let boards = &mut self.eyes[surface];
        match message {
            ArpMessage::Begin { buffer, regions } => {
                boards.memories[memory].begin(buffer, regions).map_err(str::to_owned)
            }
            ArpMessage::Swap { buffer, together } => {
                boards.memories[memory].ask(buffer, together, now);
                Ok(())
            }
            ArpMessage::Matrix(rows) => boards.latch.load(rows, now).map_err(|error| error.to_string()),
        }
    }

    fn sum(&self, count: fn(&DisplayMemory) -> u64) -> u64 {
        self.eyes.iter().flat_map(|boards| &boards.memories).map(count).sum()
    }

    fn matrices(&self, which: usize) -> u64 {
        self.eyes.iter().map(|boards| boards.latch.counts()[which]).sum()
    }
}

const NAME: &str = "arp";

impl Display for AddressRecalculationPipeline {
    fn name(&self) -> &'static str {
        NAME
    }

    fn nodes(&self) -> &[NodeId] {
        &self.nodes
    }

    fn surfaces(&self) -> &[Surface] {
        &self.surfaces
    }

    fn tick(&self, period: PeriodNumber) -> Time {
        self.optics.scan.retrace(period)
    }

    fn period_at(&self, time: Time) -> PeriodNumber {
        self.optics.scan.field_at(time)
    }

    fn handle(&mut self, event: DisplayEvent, context: &mut DisplayContext) {
        match event {
            DisplayEvent::Tick(tick) => self.retrace(tick, context),
            DisplayEvent::Delivered { port, body } => {
                if let Err(fault) = self.receive(port, body, context) {
                    self.faults += 1;
                    self.first_fault.get_or_insert_with(|| format!("{}: {fault}", context.now()));
                }
            }
            DisplayEvent::Timer(_) => {}
        }
    }

    fn lights(&self, _surface: usize, x: u32, y: u32, period: PeriodNumber) -> Option<Time> {
        self.optics.scan.when(x, y, period)
    }

    fn shown(&self, surface: usize) -> Option<RgbImage> {
        let boards = self.eyes.get(surface)?;
        let shown = boards.shown();
        let mut frame = self.empty_frame();
        let now = PeriodNumber(self.fields.saturating_sub(1));
        for number in [now, now.next()] {
            Field { optics: &self.optics, latch: &boards.latch, shown: &shown, number }.draw(&mut frame);
        }
        Some(frame)
    }

    fn seen(&self, surface: usize, period: PeriodNumber) -> Option<RgbImage> {
        let mut frame = self.empty_frame();
        self.field(surface, period)?.draw(&mut frame);
        if let Some(before) = period.before(1).and_then(|field| self.field(surface, field)) {
            before.draw(&mut frame);
        }
        Some(frame)
    }

    fn last_seen(&self) -> Option<PeriodNumber> {
        self.fields.checked_sub(2).map(PeriodNumber)
    }

    fn rows_lit(&self, period: PeriodNumber) -> (u32, u32) {
        (pxpl5_wire::FieldParity::of_field(period).first_line(), 2)
    }

    fn counters(&self) -> Vec<Counter> {
        vec![
            Counter { name: "fields", count: self.fields },
            Counter { name: "regions", count: self.sum(|memory| memory.stats().regions) },
            Counter { name: "swaps", count: self.sum(|memory| memory.stats().swaps) },
            Counter { name: "swaps missed", count: self.sum(|memory| memory.stats().missed) },
            Counter { name: "matrix loads", count: self.matrices(0) },
            Counter { name: "matrices refused", count: self.matrices(1) },
        ]
    }

    fn faults(&self) -> (u64, Option<String>) {
        (self.faults, self.first_fault.clone())
    }
}

impl DisplayConfig for ArpConfig {
    fn name(&self) -> &'static str {
        NAME
    }

    fn about(&self) -> &'static str {
        "address recalculation pipeline: six faces around the head, looked up at scan-out by the newest orientation (VRAIS 93)"
    }

    fn tables(&self) -> Vec<(&'static str, &dyn ParameterTable)> {
        vec![("arp", &self.timing), ("arp_scan", &self.scan)]
    }

    fn tables_mut(&mut self) -> Vec<(&'static str, &mut dyn ParameterTable)> {
        vec![("arp", &mut self.timing), ("arp_scan", &mut self.scan)]
    }

    /// Returns the number of ring ports: one for each memory of each eye.
    fn ports(&self, pictures: usize) -> usize {
        pictures.clamp(1, Eye::BOTH.len()) * self.ports_of_an_eye()
    }

    fn check(&self) -> Result<(), SettingError> {
        Self::check(self)
    }

    fn build(&self, nodes: &[NodeId], word: Span) -> Result<Box<dyn Display>, SettingError> {
        Self::check(self)?;
        let scan = self.scan()?;
        // The number of ports determines the number of eyes.
        let eyes = nodes.len() / self.ports_of_an_eye();
        if nodes.len() != self.ports(eyes) {
            let expected = format!("{} ports for one eye, {} for two", self.ports(1), self.ports(2));
            return Err(SettingError::value("arp", expected, nodes.len()));
        }
        Ok(Box::new(AddressRecalculationPipeline {
            surfaces: Surface::of_frame_buffers(eyes, scan.width(), scan.height()),
            optics: Optics { config: self.clone(), table: OnceLock::new(), scan },
            nodes: nodes.to_vec(),
            word,
            eyes: (0..eyes).map(|_| boards(self)).collect(),
            fields: 0,
            faults: 0,
            first_fault: None,
        }))
    }

    fn boxed(&self) -> Box<dyn DisplayConfig> {
        Box::new(self.clone())
    }

    fn remember(&mut self, periods: u64) {
        self.fields_kept = periods;
    }

    fn set_background(&mut self, background: u32) {
        self.background = background & 0x00FF_FFFF;
    }

    fn coverage(&self) -> Coverage {
        Coverage::Surroundings
    }

    fn equals(&self, other: &dyn DisplayConfig) -> bool {
        (other as &dyn std::any::Any).downcast_ref::<Self>() == Some(self)
    }
}

fn boards(config: &ArpConfig) -> EyeBoards {
    let kind = MemoryKind { face_texels: config.timing.face_texels as u32, format: config.format(), has_depth: true };
    let mut memories = vec![DisplayMemory::new(kind); config.timing.display_memories as usize];
    if config.has_background_memory {
        memories.push(DisplayMemory::new(MemoryKind { has_depth: false, ..kind }));
    }
    EyeBoards { memories, latch: OrientationLatch::new(config.timing.matrix_bits), scanned: VecDeque::new() }
}
