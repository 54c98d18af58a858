//! Simulation of one volume, event by event. The ring, the display's frame stores and the renderers with FIFO,
//! controller and backing store are complete board models. A graphics processor (GP) is only a table of times and a
//! ring port.
//!
//! ```text
//!  GP k mod G --commands of slice k, region by region--> ring --> renderer k mod R --packed tiles--> ring --> Perspecta
//! ```
//!
//! # Behaviour
//!
//! - Slice k goes to processor k mod G and to renderer k mod R. A processor computes the commands of a slice and hands
//!   them to its port as one transfer. The transfer occupies the renderer's port until the last word. Meanwhile the
//!   processor computes the commands of at most one more slice.
//! - A renderer is a complete board. A full input FIFO stops the sender. The instructions of the programs determine the
//!   clocks of the controller. A region with at least one occupied tile is copied to the backing store, and sent from
//!   there while the next region's commands arrive.
//! - Instead of 32-bit pixels, the tiles of the region are sent, one message each, in the format of the display.
//!
//! # Not modelled
//!
//! The renderer's decision which tiles to send, and its packing of eight pixels into a word: the backing store holds 32
//! bits per pixel. The programs of the processors: only their times are modelled ([`GpTiming`]).

use super::bounds::{BoundRow, SliceBounds};
use super::command::SliceTriangle;
use super::halftone::{halftone_clocks, halftone_words};
use super::traffic::SliceTraffic;
use pxpl5_gp::GpTiming;
use pxpl5_renderer::{ArrayPool, CommandKind, Layout, Renderer, RendererEvent, RendererOutput, RendererTiming};
use pxpl5_ring::{Request, Ring, RingEvent, RingOutput, RingTiming};
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Clock, Context, Cycles, EventQueue, Phase, Span, Time};
use pxpl5_wire::display::{Display, DisplayConfig, DisplayEvent};
use pxpl5_wire::{
    Body, CommandList, CommandRun, CopyContent, CopyOrder, CopyPath, CopyTarget, Lines, MAX_MESSAGE_WORDS, Message,
    NodeId, PeriodNumber, PictureNumber, REGION_SIZE, RegionGrid, RegionId, Word, swap_request,
};
use serde::Serialize;
use spatialgl::perspecta::PerspectaConfig;
use std::collections::VecDeque;
use std::sync::Arc;

/// The result of simulating one volume on a machine with certain numbers of boards.
#[derive(Clone, Debug, Serialize)]
pub struct SimulatedRow {
    /// Number of renderers among which the slices are divided.
    pub renderers: u64,
    /// Number of graphics processors among which the slices are divided.
    pub processors: u64,
    /// Time from the start of the first command to the arrival of the last tile, in milliseconds.
    pub ms: f64,
    /// Volumes per second if each volume begins after all tiles of the previous volume have arrived.
    pub volumes_hz: f64,
    /// Lower bound of the time for the same messages: the time of the slowest part of the machine.
    pub bound: BoundRow,
    /// Difference between the simulated time and its lower bound, as a percentage of the bound.
    pub over_bound_percent: f64,
    /// Percentage of the time in which renderers execute commands, averaged over the renderers.
    pub renderers_busy_percent: f64,
    /// Percentage of the time in which processors compute commands, averaged over the processors.
    pub processors_busy_percent: f64,
    /// Percentage of the time in which the ring's channels are occupied, averaged over the channels.
    pub channels_busy_percent: f64,
    /// Number of messages that the display rejected, plus one if the volume was not shown.
    pub faults: u64,
    /// Number of events in the simulation.
    pub events: u64,
}

/// Number of ring words that a [`CopyTarget`] takes in a command.
const COPY_WORDS: u32 = 9;

/// Simulates the messages of a volume on a machine with `renderers` renderers and `processors` graphics processors,
/// each 1 or more.
///
/// # Errors
///
/// Returns a [`SettingError`] if there are more boards than ports on a ring.
pub fn simulate(
    traffic: &SliceTraffic,
    bounds: &SliceBounds,
    renderers: u64,
    processors: u64,
) -> Result<SimulatedRow, SettingError> {
    Ok(Machine::new(traffic, renderers, processors)?.run(bounds))
}

#[derive(Debug)]
enum Event {
    Ring(RingEvent),
    FromRing(RingOutput),
    Renderer(usize, RendererEvent),
    /// The processor with this index has finished the commands of its current slice.
    Made(usize),
}

#[derive(Debug, Default)]
struct Processor {
    slices: VecDeque<usize>,
    working_on: Option<usize>,
    /// A slice with finished commands, which waits until the previous slice has left the port.
    waiting: Option<usize>,
    is_sending: bool,
    busy: Span,
}

struct Machine<'a> {
    traffic: &'a SliceTraffic,
    layout: Layout,
    queue: EventQueue<Event>,
    ring: Ring,
    ring_context: Context<RingEvent, RingOutput>,
    renderer_context: Context<RendererEvent, RendererOutput>,
    processors: Vec<Processor>,
    renderers: Vec<Renderer>,
    display: Box<dyn Display>,
    cycle: Span,
    last_tile_at: Time,
}

impl<'a> Machine<'a> {
    fn new(traffic: &'a SliceTraffic, renderers: u64, processors: u64) -> Result<Self, SettingError> {
        let boards = renderers.max(1) + processors.max(1) + 1;
        let nodes = u16::try_from(boards)
            .map_err(|_| SettingError::value("boards", format_args!("at most {} on a ring", u16::MAX), boards))?;
        let layout = Layout::rendering_control_phong();
        // Processors come first on the ring, then the renderers, then the display.
        let timing = slice_timing(&layout);
        let first = processors.max(1) as u16;
        let is_elastic = |node: NodeId| node.0 < first || node.0 + 1 == nodes;
        let ring = Ring::new(RingTiming::PAPERS, nodes, is_elastic).expect("pxpl5-volume: the published ring");
        let word = ring.timing().word();
        let cycle = Clock::from_hz(timing.clock_hz).map_or(Span(1), |clock| clock.span(Cycles(1)));
        let pool = ArrayPool::new(layout);
        let board = |node| Renderer::new(NodeId(node), timing, word, cycle, Arc::clone(&pool));
        let [width, height] = traffic.size.map(u64::from);
        let display = PerspectaConfig { slices: traffic.slices.len() as u64, width, height, ..PerspectaConfig::PAPERS };
        let display = display
            .build(&[NodeId(nodes - 1)], word)
            .map_err(|error| SettingError::value("display", "one that takes the volume", error))?;
        // Assign the slices to the processors in turn.
        let mut dealt: Vec<Processor> = (0..first).map(|_| Processor::default()).collect();
        for slice in 0..traffic.slices.len() {
            dealt[slice % usize::from(first)].slices.push_back(slice);
        }
        Ok(Self {
            traffic,
            layout,
            queue: EventQueue::new(),
            ring,
            ring_context: Context::default(),
            renderer_context: Context::default(),
            processors: dealt,
            renderers: (first..nodes - 1).map(board).collect(),
            display,
            cycle,
            last_tile_at: Time::ZERO,
        })
    }

    fn display_node(&self) -> NodeId {
        NodeId(self.ring.n_nodes() - 1)
    }

    fn renderer_node(&self, renderer: usize) -> NodeId {
        NodeId((self.processors.len() + renderer) as u16)
    }

    fn run(mut self, bounds: &SliceBounds) -> SimulatedRow {
        // The maps leave at time zero, and all processors start.
        self.send_maps();
        for processor in 0..self.processors.len() {
            self.begin_next(processor, Time::ZERO);
        }
        while let Some((now, _, event)) = self.queue.next_event() {
            match event {
                Event::Ring(event) => self.ring_event(now, event),
                Event::FromRing(output) => self.take_from_ring(now, output),
                Event::Renderer(board, event) => self.renderer_event(now, board, event),
                Event::Made(processor) => self.made(processor, now),
            }
        }
        self.swap();
        self.row(bounds)
    }

    /// Sends all maps of tiles before any tile, because a tile must not overtake its map.
    fn send_maps(&mut self) {
        let destination = self.display_node();
        for (order, map) in (0..).zip(&self.traffic.maps) {
            let message = message_of(NodeId(0), destination, Arc::clone(map));
            self.request(Time::ZERO, Request { message, ticket: None, hold: false, order });
        }
    }

    fn request(&mut self, at: Time, request: Request) {
        self.queue.schedule(at, Phase::Arrive, Event::Ring(RingEvent::Request(request)));
    }

    fn begin_next(&mut self, number: usize, now: Time) {
        let processor = &mut self.processors[number];
        if processor.working_on.is_some() || processor.waiting.is_some() {
            return;
        }
        let Some(slice) = processor.slices.pop_front() else { return };
        processor.working_on = Some(slice);
        let span = making(&self.traffic.slices[slice].load);
        processor.busy += span;
        self.queue.schedule(now + span, Phase::Work, Event::Made(number));
    }

    fn made(&mut self, number: usize, now: Time) {
        let processor = &mut self.processors[number];
        processor.waiting = processor.working_on.take();
        self.send_finished_slice(number, now);
    }

    /// Hands the commands of the finished slice to the port if the commands of the previous slice have left the port.
    fn send_finished_slice(&mut self, number: usize, now: Time) {
        if self.processors[number].is_sending {
            return;
        }
        let Some(slice) = self.processors[number].waiting.take() else { return };
        self.processors[number].is_sending = true;
        let destination = self.renderer_node(slice % self.renderers.len());
        let lists = self.lists(slice);
        let last = lists.len().saturating_sub(1);
        // `hold` keeps the connection until the last message of the slice.
        for (i, list) in lists.into_iter().enumerate() {
            let message =
                Message { source: NodeId(number as u16), destination, words: list.words(), body: Body::Commands(list) };
            let request = Request { message, ticket: (i == last).then_some(1), hold: i != last, order: i as u32 };
            self.request(now + self.cycle, request);
        }
        self.begin_next(number, now);
    }

    /// Returns the commands of a slice, region by region. Each list of commands is one message.
    fn lists(&self, slice: usize) -> Vec<CommandList> {
        let load = &self.traffic.slices[slice].load;
        let regions = load.commands.iter().enumerate();
        regions.flat_map(|(region, commands)| self.lists_of_region(slice, region, *commands)).collect()
    }

    fn lists_of_region(&self, slice: usize, region: usize, commands: u32) -> Vec<CommandList> {
        let run = |kind: CommandKind, words_each, count| CommandRun { opcode: kind as u8, words_each, count };
        let each = SliceTriangle::words(&self.layout) as u32;
        // The halftone and the triangles use the codes of existing commands.
        let mut runs = VecDeque::from([run(CommandKind::SelectRegion, 2, 1), run(CommandKind::Clear, 5, 1)]);
        runs.extend((0..commands).map(|_| run(CommandKind::Triangle, each, 1)));
        runs.push_back(run(CommandKind::Shade, halftone_words(&self.layout).len() as u32, 1));
        let has_tiles = self.traffic.slices[slice].tiles.get(region).is_some_and(|tiles| !tiles.is_empty());
        if has_tiles {
            runs.push_back(run(CommandKind::CopyRegion, COPY_WORDS, 1));
        }
        let mut lists = vec![list_of(Vec::new())];
        // Start a new list when a message would exceed the limit.
        for run in runs {
            let list = lists.last_mut().expect("there is one");
            if list.words() + run.words_each > MAX_MESSAGE_WORDS {
                lists.push(list_of(vec![run]));
            } else {
                list.runs.push(run);
            }
        }
        if has_tiles {
            lists.last_mut().expect("there is one").copies.push(self.copy(slice, region));
        }
        lists
    }

    /// Returns the command to copy a region to the display, as a single message. [`Self::send_tiles`] later replaces
    /// this message by the tiles.
    fn copy(&self, slice: usize, region: usize) -> CopyOrder {
        let [columns, rows] = self.traffic.size.map(|side| side.div_ceil(REGION_SIZE));
        let side = 32;
        let grid = RegionGrid { width: columns * side, height: rows * side, region_width: side, region_height: side };
        let target = CopyTarget {
            frame_buffer: self.display_node(),
            buffer: 0,
            lines: Lines::Frame,
            grid,
            region: RegionId(region as u16),
            picture: PictureNumber(slice as u64),
        };
        CopyOrder { target, context: 0, way: CopyPath::ThroughBacking, acknowledge: None, content: CopyContent::Colour }
    }

    fn ring_event(&mut self, now: Time, event: RingEvent) {
        self.ring.handle(event, self.ring_context.at(now));
        for (time, phase, event) in self.ring_context.drain_events() {
            self.queue.schedule(time, phase, Event::Ring(event));
        }
        for (time, output) in self.ring_context.drain_outputs() {
            self.queue.schedule(time, Phase::Arrive, Event::FromRing(output));
        }
    }

    fn take_from_ring(&mut self, now: Time, output: RingOutput) {
        let first = self.processors.len();
        match output {
            RingOutput::Announce { message, first_word_at, .. } => {
                // Only renderers receive announced messages: their FIFOs may hold the words back.
                let board = usize::from(message.destination.0) - first;
                self.renderer_event(now, board, RendererEvent::Announce { message, first_word_at });
            }
            RingOutput::Delivered(message) => {
                // Messages from renderers are tiles, and messages from processors are maps.
                if usize::from(message.source.0) >= first {
                    self.last_tile_at = now;
                }
                self.deliver(now, message.body);
            }
            RingOutput::Sent { source, .. } => match usize::from(source.0).checked_sub(first) {
                Some(board) => self.renderer_event(now, board, RendererEvent::Sent),
                None => {
                    let number = usize::from(source.0);
                    self.processors[number].is_sending = false;
                    self.send_finished_slice(number, now);
                    self.begin_next(number, now);
                }
            },
            RingOutput::Refused { error, .. } => unreachable!("pxpl5-volume: messages of our own: {error}"),
        }
    }

    fn deliver(&mut self, now: Time, body: Body) {
        let mut context = Context::default();
        self.display.handle(DisplayEvent::Delivered { port: 0, body }, context.at(now));
    }

    fn renderer_event(&mut self, now: Time, board: usize, event: RendererEvent) {
        self.renderers[board].handle(event, self.renderer_context.at(now));
        for (time, phase, event) in self.renderer_context.drain_events() {
            self.queue.schedule(time, phase, Event::Renderer(board, event));
        }
        // Collect the outputs first, because sending tiles needs the whole machine.
        let outputs: Vec<_> = self.renderer_context.drain_outputs().collect();
        for (time, output) in outputs {
            match output {
                RendererOutput::Accept { last_word_at } => {
                    let destination = self.renderer_node(board);
                    let event = Event::Ring(RingEvent::Accept { destination, last_word_at });
                    self.queue.schedule(time, Phase::Arrive, event);
                }
                RendererOutput::Send { message, .. } => self.send_tiles(time, &message),
            }
        }
    }

    /// Sends the occupied tiles of a region in place of its pixels.
    fn send_tiles(&mut self, at: Time, message: &Message) {
        let Body::Pixels(pixels) = &message.body else { return };
        let slice = pixels.target.picture.0 as usize;
        let region = usize::from(pixels.target.region.0);
        let tiles: Vec<Arc<[Word]>> = self.traffic.slices[slice].tiles[region].clone();
        // The last tile has the ticket, which notifies the renderer that its region has left.
        let last = tiles.len().saturating_sub(1);
        for (i, words) in tiles.into_iter().enumerate() {
            let message = message_of(message.source, message.destination, words);
            let request = Request { message, ticket: (i == last).then_some(0), hold: i != last, order: i as u32 };
            self.request(at, request);
        }
    }

    /// Requests a swap of the display's stores. The volume is shown at the first strobe 0 (first flash of a turn) after
    /// the arrival of the last tile.
    fn swap(&mut self) {
        let body = Body::Words(swap_request(1));
        self.deliver(self.last_tile_at, body);
        let period = PeriodNumber(self.display.period_at(self.last_tile_at).0 + 1);
        let at = self.display.tick(period);
        self.display.handle(DisplayEvent::Tick(period), Context::default().at(at));
    }

    fn row(mut self, bounds: &SliceBounds) -> SimulatedRow {
        let renderers = self.renderers.len() as u64;
        let processors = self.processors.len() as u64;
        let all = self.last_tile_at.since(Time::ZERO);
        let ms = all.as_ms();
        self.ring.settle(self.last_tile_at);
        let bound = bounds.with(renderers, processors);
        let slowest = bound.ms.iter().copied().fold(0.0, f64::max);
        // Mean busy time of the boards of a kind, relative to the total time.
        let share = |spans: Vec<Span>| {
            let sum: f64 = spans.iter().map(|span| span.as_ms()).sum();
            100.0 * sum / (ms * spans.len() as f64).max(f64::MIN_POSITIVE)
        };
        let (faults, _) = self.display.faults();
        let is_shown =
            self.display.counters().iter().any(|counter| counter.name == "volumes swapped" && counter.count == 1);
        SimulatedRow {
            renderers,
            processors,
            ms,
            volumes_hz: if ms > 0.0 { 1e3 / ms } else { 0.0 },
            over_bound_percent: if slowest > 0.0 { 100.0 * (ms / slowest - 1.0) } else { 0.0 },
            bound,
            renderers_busy_percent: share(self.renderers.iter().map(Renderer::busy).collect()),
            processors_busy_percent: share(self.processors.iter().map(|processor| processor.busy).collect()),
            channels_busy_percent: share(self.ring.stats().channel_busy.clone()),
            faults: faults + u64::from(!is_shown),
            events: self.queue.events_taken(),
        }
    }
}

fn list_of(runs: Vec<CommandRun>) -> CommandList {
    CommandList { runs, context: 0, copies: Vec::new(), content: None }
}

fn message_of(source: NodeId, destination: NodeId, words: Arc<[Word]>) -> Message {
    Message { source, destination, words: words.len() as u32, body: Body::Words(words) }
}

/// Returns the renderer's times for drawing slices. A slice triangle has the command code of a triangle, and a halftone
/// has the code of deferred shading. Both codes therefore get the times of the programs for slices.
fn slice_timing(layout: &Layout) -> RendererTiming {
    RendererTiming {
        triangle_clocks: u64::from(SliceTriangle::clocks(layout)),
        shade_clocks: halftone_clocks(layout),
        ..RendererTiming::PAPERS
    }
}

/// Returns the time that a processor needs to compute the commands of a slice and to hand the commands to its port.
fn making(load: &super::renderer::SliceLoad) -> Span {
    let gp = GpTiming::PAPERS;
    let commands: u64 = load.commands.iter().map(|count| u64::from(*count)).sum();
    Span::from_ns(gp.message_ns + load.triangles * gp.triangle_ns + commands * gp.bin_entry_ns)
}
