//! The schematic: this file alone plugs boards together.
//!
//! ```text
//!   port   0      1 .. n_gps      then renderers       then frame buffers
//!        +------+ +----+ +----+   +--------+           +------+ +------+
//!        | host | | GP | | GP |.. |renderer| ...       | left | | right|
//!        +--+---+ +-+--+ +-+--+   +---+----+           +--+---+ +--+---+
//!   ========+=======+======+==========+===================+========+====  ring, 8 channels
//!                   ^                                     |
//!                   +---- retrace and swap status --------+  (to the first GP)
//! ```

use crate::config::{ConfigError, MachineConfig};
use crate::observation::{Arrival, Observation, Swap};
use crate::savings::Saving;
use crate::workers::PixelWorkers;
use pxpl5_framebuffer::{FrameBuffer, FrameBufferEvent, FrameBufferOutput, Video};
use pxpl5_gp::{CodeVersion, Fault, Firmware, Gp, GpBoard, GpEvent, GpOutput, Priority};
use pxpl5_renderer::{ArrayPool, Layout, Renderer, RendererEvent, RendererOutput};
use pxpl5_ring::{Request, Ring, RingEvent, RingOutput};
use pxpl5_sim::{Blocked, Clock, Context, Cycles, EventQueue, Phase, Span, Time, TraceHash};
use pxpl5_wire::{Body, Message, NodeId, read_swap_request};
use std::fmt;

/// An event of any board.
#[derive(Debug)]
enum Event {
    Ring(RingEvent),
    /// What the ring brings to a board.
    FromRing(RingOutput),
    Gp(usize, GpEvent),
    Renderer(usize, RendererEvent),
    FrameBuffer(usize, FrameBufferEvent),
    Retrace(u64),
    /// An edge of the boards' clock, where every one of them counts.
    Edge,
}

/// Why a run ended early.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum RunError {
    /// A program stopped: something did not fit, or a message made no sense.
    Fault {
        /// The board.
        board: String,
        /// When.
        time: Time,
        /// Why.
        fault: Fault,
    },
    /// Nothing can happen any more but retraces.
    Deadlock {
        /// When that was noticed.
        time: Time,
        /// Who waits for what.
        blocked: Vec<Blocked>,
    },
    /// The ring could not carry a message.
    Ring {
        /// When.
        time: Time,
        /// Why.
        reason: String,
    },
}

impl fmt::Display for RunError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Fault { board, time, fault } => write!(f, "{board} stopped at {time}: {fault}"),
            Self::Deadlock { time, blocked } => {
                write!(f, "nothing can happen any more at {time}:")?;
                blocked.iter().try_for_each(|b| write!(f, " {} waits for {};", b.board, b.waits_for))
            }
            Self::Ring { time, reason } => write!(f, "ring, at {time}: {reason}"),
        }
    }
}

impl std::error::Error for RunError {}

/// Which port each board has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Ports {
    /// The host interface.
    pub host: NodeId,
    /// The graphics processors.
    pub gps: Vec<NodeId>,
    /// The renderers.
    pub renderers: Vec<NodeId>,
    /// The frame buffers: left, right.
    pub frame_buffers: Vec<NodeId>,
}

impl Ports {
    fn new(n_gps: usize, n_renderers: usize, n_frame_buffers: usize) -> Self {
        let mut next = 0u16;
        let mut take = |n: usize| -> Vec<NodeId> {
            let first = next;
            next += n as u16;
            (first..next).map(NodeId).collect()
        };
        let host = take(1)[0];
        Self { host, gps: take(n_gps), renderers: take(n_renderers), frame_buffers: take(n_frame_buffers) }
    }

    fn count(&self) -> u16 {
        (1 + self.gps.len() + self.renderers.len() + self.frame_buffers.len()) as u16
    }
}

/// A whole machine.
#[derive(Debug)]
pub struct Machine {
    ports: Ports,
    video: Video,
    queue: EventQueue<Event>,
    ring: Ring,
    /// The host, then the graphics processors: all boards that run programs, by their port.
    processors: Vec<GpBoard>,
    renderers: Vec<Renderer>,
    frame_buffers: Vec<FrameBuffer>,
    contexts: Contexts,
    observation: Observation,
    hash: TraceHash,
    swaps: Vec<u64>,
    workers: Option<PixelWorkers>,
    /// Whether every edge of the boards' clock is an event.
    every_edge: bool,
    failure: Option<RunError>,
    /// Events other than retraces, and the retrace up to which there were none.
    work_events: u64,
    idle_fields: u64,
}

#[derive(Debug, Default)]
struct Contexts {
    ring: Context<RingEvent, RingOutput>,
    gp: Context<GpEvent, GpOutput>,
    renderer: Context<RendererEvent, RendererOutput>,
    frame_buffer: Context<FrameBufferEvent, FrameBufferOutput>,
}

/// Fields without any event after which a machine with waiting programs is said to be deadlocked.
const DEADLOCK_FIELDS: u64 = 120;

/// What a signal needs to leave a board: one cycle of the boards' 40 MHz.
fn cycle() -> Span {
    Clock::from_hz(40_000_000).map_or(Span(25_000), |clock| clock.span(Cycles(1)))
}

impl Machine {
    /// Builds the machine with one frame buffer (mono) or two.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] when a number is out of range.
    pub fn new(config: &MachineConfig, eyes: usize, layout: Layout) -> Result<Self, ConfigError> {
        config.check()?;
        let board = |error: &dyn fmt::Display| ConfigError::Board(error.to_string());
        let ports = Ports::new(config.n_gps, config.n_renderers, eyes);
        let video = Video::new(config.frame_buffer.video).map_err(|error| board(&error))?;
        let renderers = ports.renderers.clone();
        let elastic = move |node: NodeId| !renderers.contains(&node);
        let ring = Ring::new(config.ring, ports.count(), elastic).map_err(|error| board(&error))?;
        let host = GpBoard::new(ports.host, config.host.board(), cycle());
        let gps = ports.gps.iter().map(|node| GpBoard::new(*node, config.gp, cycle()));
        let pool = ArrayPool::new(layout);
        let renderer = |node: &NodeId| Renderer::new(*node, config.renderer, config.ring.word(), cycle(), pool.clone());
        let frame_buffer = |node: &NodeId| FrameBuffer::new(config.frame_buffer, *node).map_err(|error| board(&error));
        Ok(Self {
            processors: [host].into_iter().chain(gps).collect(),
            renderers: ports.renderers.iter().map(renderer).collect(),
            frame_buffers: ports.frame_buffers.iter().map(frame_buffer).collect::<Result<_, _>>()?,
            swaps: vec![0; ports.frame_buffers.len()],
            ports,
            video,
            queue: EventQueue::new(),
            ring,
            contexts: Contexts::default(),
            observation: Observation::default(),
            hash: TraceHash::default(),
            workers: None,
            every_edge: false,
            failure: None,
            work_events: 0,
            idle_fields: 0,
        })
    }

    /// Takes ties of events in an order hashed from a seed, to prove that no result depends on it.
    pub fn shuffle_ties(&mut self, seed: u64) {
        self.queue.shuffle_ties(seed);
    }

    /// Computes the pixels of every copied region on as many worker threads; 0: on the thread that simulates.
    pub fn compute_all_pixels(&mut self, threads: usize) {
        self.workers = Some(PixelWorkers::new(threads));
    }

    /// Has the graphics processors tell the time of their work by i860 code; to be called before programs are loaded.
    pub fn run_code(&mut self, version: CodeVersion) {
        self.processors.iter_mut().skip(1).for_each(|gp| gp.run_code(version));
    }

    /// Gives up a saving: what it skips is done from now on. To be called before the machine is switched on.
    pub fn give_up(&mut self, saving: Saving) {
        match saving {
            Saving::IdleBoards => self.every_edge = true,
            Saving::Transfers => self.ring.move_every_word(),
            Saving::EmptyRegions => self.renderers.iter_mut().for_each(Renderer::draw_every_region),
            Saving::RepeatedCode => self.processors.iter_mut().for_each(GpBoard::count_every_clock),
        }
    }

    /// Records messages, busy channels and FIFOs from now on.
    pub fn record_traffic(&mut self) {
        self.observation.traffic = Some(Box::default());
        self.ring.watch();
        self.renderers.iter_mut().for_each(Renderer::watch_fifo);
    }

    /// The ports of the boards.
    #[must_use]
    pub const fn ports(&self) -> &Ports {
        &self.ports
    }

    /// Retraces and beam.
    #[must_use]
    pub const fn video(&self) -> &Video {
        &self.video
    }

    /// A handle for a program on the board at a port (host or graphics processor).
    ///
    /// # Panics
    ///
    /// If no processor has this port.
    #[must_use]
    pub fn processor(&self, node: NodeId, priority: Priority) -> Gp {
        self.processors[usize::from(node.0)].handle_for(priority)
    }

    /// Loads a program onto the board at a port.
    ///
    /// # Panics
    ///
    /// If no processor has this port.
    pub fn load(&mut self, node: NodeId, priority: Priority, firmware: Firmware) {
        self.processors[usize::from(node.0)].load(priority, firmware);
    }

    /// Switches on: every board's programs begin at time zero, and so does field 0.
    pub fn switch_on(&mut self) {
        for board in 0..self.processors.len() {
            self.queue.schedule(Time::ZERO, Phase::Work, Event::Gp(board, GpEvent::Poll));
        }
        self.queue.schedule(Time::ZERO, Phase::Arrive, Event::Retrace(0));
        if self.every_edge {
            self.queue.schedule(Time::ZERO, Phase::Work, Event::Edge);
        }
    }

    /// Runs up to, and not including, an instant.
    ///
    /// # Errors
    ///
    /// [`RunError`]; everything observed before it is kept.
    pub fn run_until(&mut self, end: Time) -> Result<(), RunError> {
        while self.queue.next_time().is_some_and(|time| time < end) {
            let Some((now, _, event)) = self.queue.next_event() else { break };
            self.handle(now, event);
            if let Some(failure) = &self.failure {
                return Err(failure.clone());
            }
        }
        Ok(())
    }

    fn handle(&mut self, now: Time, event: Event) {
        self.work_events += u64::from(!matches!(event, Event::Edge));
        match event {
            Event::Ring(event) => self.ring_event(now, event),
            Event::FromRing(output) => self.bring(now, output),
            Event::Gp(board, event) => self.gp_event(now, board, event),
            Event::Renderer(board, event) => self.renderer_event(now, board, event),
            Event::FrameBuffer(board, event) => self.frame_buffer_event(now, board, event),
            Event::Retrace(field) => self.retrace(now, field),
            Event::Edge => self.edge(now),
        }
    }

    /// Asks every board that could have something to do, and the next edge.
    fn edge(&mut self, now: Time) {
        (0..self.processors.len()).for_each(|board| self.gp_event(now, board, GpEvent::Poll));
        self.ring_event(now, RingEvent::Arbitrate);
        self.queue.schedule(now + cycle(), Phase::Work, Event::Edge);
    }

    /// The sync generator: all frame buffers in lock-step, and the first graphics processor.
    fn retrace(&mut self, now: Time, field: u64) {
        for board in 0..self.frame_buffers.len() {
            self.queue.schedule(now, Phase::Arrive, Event::FrameBuffer(board, FrameBufferEvent::Retrace { field }));
        }
        self.queue.schedule(now, Phase::Arrive, Event::Gp(1, GpEvent::Retrace(field)));
        self.queue.schedule(self.video.retrace(field + 1), Phase::Arrive, Event::Retrace(field + 1));
        self.watch(now);
    }

    /// A field's own events: retrace, its frame buffers, the first GP and its poll.
    fn watch(&mut self, now: Time) {
        let own = self.frame_buffers.len() as u64 + 3;
        self.idle_fields = if self.work_events <= own { self.idle_fields + 1 } else { 0 };
        self.work_events = 0;
        if self.idle_fields < DEADLOCK_FIELDS {
            return;
        }
        let blocked = self.blocked();
        if blocked.iter().any(|b| b.waits_for != "a retrace") {
            self.failure = Some(RunError::Deadlock { time: now, blocked });
        }
    }

    /// Who waits for what.
    #[must_use]
    pub fn blocked(&self) -> Vec<Blocked> {
        let processors = self.processors.iter().enumerate().filter_map(|(i, board)| board.blocked(&self.name(i)));
        let renderers =
            self.renderers.iter().enumerate().filter_map(|(i, board)| board.blocked(&format!("renderer {i}")));
        processors.chain(renderers).chain(self.ring.blocked()).collect()
    }

    fn name(&self, processor: usize) -> String {
        if processor == 0 { "host".to_owned() } else { format!("GP {}", processor - 1) }
    }

    fn ring_event(&mut self, now: Time, event: RingEvent) {
        let Contexts { ring: context, .. } = &mut self.contexts;
        let mut traffic = self.observation.traffic.as_deref_mut();
        if let (Some(traffic), RingEvent::Accept { destination, last_word_at }) = (&mut traffic, &event) {
            traffic.accept(*destination, *last_word_at);
        }
        self.ring.handle(event, context.at(now));
        if let Some(traffic) = &mut traffic {
            traffic.channels(now, self.ring.busy_channels());
        }
        for (time, phase, event) in context.drain_events() {
            self.queue.schedule(time, phase, Event::Ring(event));
        }
        for (time, output) in context.drain_outputs() {
            self.queue.schedule(time, Phase::Arrive, Event::FromRing(output));
        }
    }

    /// What the ring has brought to a board enters the trace now.
    fn bring(&mut self, now: Time, output: RingOutput) {
        let mut traffic = self.observation.traffic.as_deref_mut();
        let facts = |kind: u64, message: &Message| {
            [kind, u64::from(message.source.0), u64::from(message.destination.0), u64::from(message.words)]
        };
        match output {
            RingOutput::Announce { message, first_word_at, .. } => {
                self.hash.record(now, &facts(1, &message));
                if let Some(traffic) = &mut traffic {
                    traffic.announce(&message, first_word_at);
                }
                let board = usize::from(message.destination.0 - self.ports.renderers[0].0);
                self.renderer_event(now, board, RendererEvent::Announce { message, first_word_at });
            }
            RingOutput::Delivered(message) => {
                self.hash.record(now, &facts(2, &message));
                if let Some(traffic) = &mut traffic {
                    traffic.deliver(&message, now, self.ring.timing().word());
                }
                self.deliver(now, message);
            }
            RingOutput::Sent { source, ticket } => {
                self.hash.record(now, &[3, u64::from(source.0), ticket]);
                match self.ports.renderers.binary_search(&source) {
                    Ok(board) => self.renderer_event(now, board, RendererEvent::Sent),
                    Err(_) => self.gp_event(now, usize::from(source.0), GpEvent::Accepted(ticket)),
                }
            }
            RingOutput::Refused { error, .. } => {
                self.failure = Some(RunError::Ring { time: now, reason: error.to_string() });
            }
        }
    }

    /// The last word of a message is with its receiver.
    fn deliver(&mut self, now: Time, message: Message) {
        let Ok(board) = self.ports.frame_buffers.binary_search(&message.destination) else {
            return self.gp_event(now, usize::from(message.destination.0), GpEvent::Delivered(message));
        };
        let event = match message.body {
            Body::Pixels(pixels) => FrameBufferEvent::Pixels(pixels),
            // A frame buffer counts a request for a buffer that it does not have.
            Body::Words(words) => {
                FrameBufferEvent::SwapRequested { buffer: read_swap_request(&words).unwrap_or(u8::MAX) }
            }
            Body::Commands(_) => FrameBufferEvent::SwapRequested { buffer: u8::MAX },
        };
        self.frame_buffer_event(now, board, event);
    }

    fn gp_event(&mut self, now: Time, board: usize, event: GpEvent) {
        let Contexts { gp: context, .. } = &mut self.contexts;
        let processor = &mut self.processors[board];
        processor.handle(event, context.at(now));
        for (time, phase, event) in context.drain_events() {
            self.queue.schedule(time, phase, Event::Gp(board, event));
        }
        for (order, (time, GpOutput::Send { message, ticket })) in (0..).zip(context.drain_outputs()) {
            let request = Request { message, ticket: Some(ticket), hold: false, order };
            self.queue.schedule(time, Phase::Arrive, Event::Ring(RingEvent::Request(request)));
        }
        if let Some(fault) = processor.fault() {
            let fault = fault.clone();
            self.failure = Some(RunError::Fault { board: self.name(board), time: now, fault });
        }
        let marks = self.processors[board].take_marks();
        for mark in &marks {
            let facts = [
                4,
                u64::from(mark.node.0),
                mark.picture,
                mark.eye.map_or(2, |eye| eye as u64),
                mark.stage as u64,
                mark.edge as u64,
            ];
            self.hash.record(mark.time, &facts);
        }
        self.observation.marks.extend(marks);
    }

    fn renderer_event(&mut self, now: Time, board: usize, event: RendererEvent) {
        let Contexts { renderer: context, .. } = &mut self.contexts;
        self.renderers[board].handle(event, context.at(now));
        if let Some(traffic) = &mut self.observation.traffic {
            let changes = self.renderers[board].take_fifo_changes();
            traffic.fifo_changes.extend(changes.into_iter().map(|(time, words)| (board, time, words)));
        }
        for (time, phase, event) in context.drain_events() {
            self.queue.schedule(time, phase, Event::Renderer(board, event));
        }
        let destination = self.ports.renderers[board];
        for (order, (time, output)) in (0..).zip(context.drain_outputs()) {
            let event = match output {
                RendererOutput::Accept { last_word_at } => RingEvent::Accept { destination, last_word_at },
                RendererOutput::Send { message, ticket, hold } => {
                    if let (Some(workers), Body::Pixels(pixels)) = (&mut self.workers, &message.body) {
                        workers.compute(pixels);
                    }
                    RingEvent::Request(Request { message, ticket: ticket.then_some(0), hold, order })
                }
            };
            self.queue.schedule(time, Phase::Arrive, Event::Ring(event));
        }
    }

    fn frame_buffer_event(&mut self, now: Time, board: usize, event: FrameBufferEvent) {
        let Contexts { frame_buffer: context, .. } = &mut self.contexts;
        self.frame_buffers[board].handle(event, context.at(now));
        for (time, phase, event) in context.drain_events() {
            self.queue.schedule(time, phase, Event::FrameBuffer(board, event));
        }
        for (time, output) in context.drain_outputs() {
            match output {
                FrameBufferOutput::RegionArrived { target, first_part_at, last_part_at } => {
                    self.hash.record(last_part_at, &[5, board as u64, u64::from(target.region.0), target.picture]);
                    self.observation.arrivals.push(Arrival { board, target, first_part_at, last_part_at });
                }
                FrameBufferOutput::Swapped { buffer, field } => {
                    self.hash.record(time, &[6, board as u64, u64::from(buffer), field]);
                    self.observation.swaps.push(Swap { board, field });
                    self.swaps[board] += 1;
                    let event = GpEvent::Status { from: self.ports.frame_buffers[board], value: self.swaps[board] };
                    self.queue.schedule(time, Phase::Arrive, Event::Gp(1, event));
                }
            }
        }
    }

    /// What happened so far.
    #[must_use]
    pub const fn observation(&self) -> &Observation {
        &self.observation
    }

    /// The frame buffers: left, right.
    #[must_use]
    pub fn frame_buffers(&self) -> &[FrameBuffer] {
        &self.frame_buffers
    }

    /// The renderers.
    #[must_use]
    pub fn renderers(&self) -> &[Renderer] {
        &self.renderers
    }

    /// The host and the graphics processors, by port.
    #[must_use]
    pub fn processors(&self) -> &[GpBoard] {
        &self.processors
    }

    /// The ring.
    #[must_use]
    pub const fn ring(&self) -> &Ring {
        &self.ring
    }

    /// Hash of everything that happened.
    #[must_use]
    pub const fn trace_hash(&self) -> TraceHash {
        self.hash
    }

    /// Events handled.
    #[must_use]
    pub const fn events(&self) -> u64 {
        self.queue.events_taken()
    }

    /// Waits for the worker threads; the number of regions that they computed.
    pub fn finish_pixels(&mut self) -> u64 {
        self.workers.take().map_or(0, PixelWorkers::finish)
    }
}
