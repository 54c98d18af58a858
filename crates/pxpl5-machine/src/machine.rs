//! The schematic: this file alone plugs boards together.
//!
//! ```text
//!   port   0      1 .. n_gps      then renderers       then the displays' ports
//!        +------+ +----+ +----+   +--------+           +---------+ +---------+
//!        | host | | GP | | GP |.. |renderer| ...       | display | | display | ...
//!        +--+---+ +-+--+ +-+--+   +---+----+           +--+---+--+ +----+----+
//!   ========+=======+======+==========+===================+===+=========+=====  ring, 8 channels
//!                   ^                                     |
//!                   +---- tick and swap status -----------+  (of the first display, to the first GP)
//! ```

mod displays;

use crate::agenda::{schedule_outputs, schedule_own};
use crate::board::{Board, Happening};
use crate::config::{ConfigError, MachineConfig};
use crate::event::Event;
use crate::facts::{facts, facts_of, facts_of_line};
use crate::host_line::HostLine;
use crate::pixels::PixelWorker;
use crate::ports::Ports;
use crate::record::Record;
use crate::run_error::RunError;
use crate::savings::Saving;
use pxpl5_display::{DisplayContext, DisplayEvent};
use pxpl5_gp::{BreakpointHit, Firmware, Gp, GpBoard, GpEvent, GpOutput, Priority};
use pxpl5_renderer::{ArrayPool, Layout, Renderer, RendererEvent, RendererOutput};
use pxpl5_ring::{Request, Ring, RingEvent, RingOutput};
use pxpl5_sim::{Blocked, Clock, Context, Cycles, EventQueue, Phase, Span, Time};
use pxpl5_wire::{Body, Message, NodeId, PeriodNumber};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

/// A whole machine at work: its boards and what was observed of them ([`Record`]), programs, and what is going to happen.
#[derive(Debug)]
pub struct Machine {
    record: Record,
    queue: EventQueue<Event>,
    /// The host, then the graphics processors: all boards that run programs, by their port.
    processors: Vec<GpBoard>,
    contexts: Contexts,
    /// Swaps of what is behind each port so far.
    swaps: BTreeMap<NodeId, u64>,
    /// What the host says to the first display past the ring.
    host_lines: Vec<Box<dyn HostLine>>,
    pixels: Option<Box<dyn PixelWorker>>,
    /// Whether every edge of the boards' clock is an event.
    every_edge: bool,
    failure: Option<RunError>,
    /// Events since the last tick of the first display that were no tick, and the ticks up to it without any.
    work_events: u64,
    idle_ticks: u64,
}

#[derive(Debug, Default)]
struct Contexts {
    ring: Context<RingEvent, RingOutput>,
    gp: Context<GpEvent, GpOutput>,
    renderer: Context<RendererEvent, RendererOutput>,
    display: DisplayContext,
}

/// Ticks of the first display with no other event between or ahead after which a machine with waiting programs is said to be deadlocked.
pub const DEADLOCK_TICKS: u64 = 120;

/// Events that a tick of the first display causes by itself: the signal to the first GP, and the poll of its programs.
const EVENTS_OF_A_TICK: u64 = 2;

/// What a signal needs to leave a board: one cycle of the boards' 40 MHz.
fn cycle() -> Span {
    Clock::from_hz(40_000_000).map_or(Span(25_000), |clock| clock.span(Cycles(1)))
}

impl Machine {
    /// Builds the machine with displays for a pipeline that draws so many pictures at a time: 1, or 2 for two eyes.
    ///
    /// # Errors
    ///
    /// [`ConfigError`] when a number is out of range.
    pub fn new(config: &MachineConfig, pictures: usize, layout: Layout) -> Result<Self, ConfigError> {
        config.check()?;
        let ports = Ports::plug(config, pictures);
        let renderers = ports.renderers.clone();
        let elastic = move |node: NodeId| !renderers.contains(&node);
        let ring =
            Ring::new(config.ring, ports.count(), elastic).map_err(|error| ConfigError::Board(error.to_string()))?;
        let host = GpBoard::new(ports.host, config.host.board(), cycle());
        let gps = ports.gps.iter().map(|node| GpBoard::new(*node, config.gp, cycle()));
        let pool = ArrayPool::new(layout);
        let renderer = |node: &NodeId| Renderer::new(*node, config.renderer, config.ring.word(), cycle(), pool.clone());
        let displays = config.displays.iter().zip(&ports.displays).map(|(display, nodes)| display.build(nodes));
        let displays = displays.collect::<Result<Vec<_>, _>>()?;
        Ok(Self {
            processors: [host].into_iter().chain(gps).collect(),
            swaps: BTreeMap::new(),
            record: Record {
                config: config.clone(),
                renderers: ports.renderers.iter().map(renderer).collect(),
                ports,
                ring,
                displays,
                observation: crate::Observation::default(),
                hash: pxpl5_sim::TraceHash::default(),
                events: 0,
                vertex_transforms: 0,
            },
            queue: EventQueue::new(),
            contexts: Contexts::default(),
            host_lines: Vec::new(),
            pixels: None,
            every_edge: false,
            failure: None,
            work_events: 0,
            idle_ticks: 0,
        })
    }

    /// Takes ties of events in an order hashed from a seed, to prove that no result depends on it.
    pub fn shuffle_ties(&mut self, seed: u64) {
        self.queue.shuffle_ties(seed);
    }

    /// Has the pixels of every region that is copied from now on computed by a worker.
    pub fn compute_all_pixels(&mut self, worker: Box<dyn PixelWorker>) {
        self.pixels = Some(worker);
    }

    /// Has the graphics processors tell the time of their work by the i860 code of the machine's configuration, if it names
    /// any; to be called before programs are loaded.
    pub fn run_code(&mut self) {
        if let Some(version) = self.record.config.code {
            let core = self.record.config.i860;
            let shelf = Rc::default();
            self.processors.iter_mut().skip(1).for_each(|board| board.run_code(version, core, &shelf));
        }
    }

    /// Gives up a saving: what it skips is done from now on. To be called before the machine has run.
    pub fn give_up(&mut self, saving: Saving) {
        match saving {
            Saving::IdleBoards => self.every_edge = true,
            Saving::Transfers => self.record.ring.move_every_word(),
            Saving::EmptyRegions => self.record.renderers.iter_mut().for_each(Renderer::draw_every_region),
            Saving::RepeatedCode => self.processors.iter_mut().for_each(GpBoard::count_every_clock),
        }
    }

    /// Records messages, busy channels and FIFOs, each when it happens. To be called before the machine has run.
    pub fn record_traffic(&mut self) {
        self.record.observation.traffic = Some(Box::default());
        self.record.ring.watch();
        self.record.renderers.iter_mut().for_each(Renderer::watch_fifo);
    }

    /// Gives up marks, arrivals and swaps before an instant: nobody will ask for them. No time changes.
    pub fn forget_before(&mut self, instant: Time) {
        let Record { observation, displays, .. } = &mut self.record;
        observation.forget_before(instant, |period| displays[0].tick(period));
    }

    /// Its boards and everything observed so far.
    #[must_use]
    pub const fn record(&self) -> &Record {
        &self.record
    }

    /// What is left of it when it is over.
    #[must_use]
    pub fn into_record(mut self) -> Record {
        self.finish_pixels();
        self.record.events = self.queue.events_taken();
        self.record.vertex_transforms = self.processors.iter().map(|board| board.vertex_transforms()).sum();
        self.record
    }

    /// The ports of the boards.
    #[must_use]
    pub const fn ports(&self) -> &Ports {
        &self.record.ports
    }

    /// A handle for a program on the board at a port (host or graphics processor).
    ///
    /// # Panics
    ///
    /// If no processor has this port.
    #[must_use]
    pub fn processor(&self, node: NodeId, level: Priority) -> Gp {
        self.processors[usize::from(node.0)].handle_for(level)
    }

    /// Loads a program onto the board at a port.
    ///
    /// # Panics
    ///
    /// If no processor has this port.
    pub fn load(&mut self, node: NodeId, level: Priority, program: Firmware) {
        self.processors[usize::from(node.0)].load(level, program);
    }

    /// Plugs one more line into the first display, past the ring; to be called before the machine is switched on.
    pub fn plug_host_line(&mut self, line: Box<dyn HostLine>) {
        self.host_lines.push(line);
    }

    /// Switches on: every board's programs begin at time zero, and so does the first period of every display.
    pub fn switch_on(&mut self) {
        for board in 0..self.processors.len() {
            self.queue.schedule(Time::ZERO, Phase::Work, Event::Gp(board, GpEvent::Poll));
        }
        for (display, device) in self.record.displays.iter().enumerate() {
            self.queue.schedule(
                device.tick(PeriodNumber::FIRST),
                Phase::Arrive,
                Event::Tick(display, PeriodNumber::FIRST),
            );
        }
        if self.every_edge {
            self.queue.schedule(Time::ZERO, Phase::Work, Event::Edge);
        }
        (0..self.host_lines.len()).for_each(|line| self.schedule_host_line(line, Time::ZERO));
    }

    /// Runs up to, and not including, an instant.
    ///
    /// # Errors
    ///
    /// [`RunError`]; everything observed before it is kept.
    pub fn run_until(&mut self, end: Time) -> Result<(), RunError> {
        while self.takes_event_before(end).is_some() {}
        self.failure.clone().map_or(Ok(()), Err)
    }

    /// Handles the next event, if it is before an instant, and gives its time.
    ///
    /// # Errors
    ///
    /// [`RunError`], of this event or of one before: a machine that has failed goes on no more.
    pub fn step_before(&mut self, end: Time) -> Result<Option<Time>, RunError> {
        let taken = self.takes_event_before(end);
        self.failure.clone().map_or(Ok(taken), Err)
    }

    /// Handles the next event, if it is before an instant and the machine has not failed, and gives its time.
    fn takes_event_before(&mut self, end: Time) -> Option<Time> {
        if self.failure.is_some() {
            return None;
        }
        let (now, event) = self.queue.next_event_before(end)?;
        self.handle(now, event);
        Some(now)
    }

    /// What will happen next; `None` where nothing will.
    #[must_use]
    pub fn next_happening(&self) -> Option<Happening> {
        self.queue.peek().map(|(time, event)| event.happening(time, &self.record.ports))
    }

    fn handle(&mut self, now: Time, event: Event) {
        self.work_events += u64::from(!event.is_of_displays());
        match event {
            Event::Ring(event) => self.ring_event(now, event),
            Event::FromRing(output) => self.bring(now, output),
            Event::Gp(board, event) => self.gp_event(now, board, event),
            Event::Renderer(board, event) => self.renderer_event(now, board, event),
            Event::HostLine(line) => self.host_says(now, line),
            Event::Display(display, event) => self.display_event(now, display, event),
            Event::Tick(display, period) => self.tick(now, display, period),
            Event::Edge => self.edge(now),
        }
    }

    /// Asks every board that could have something to do, and the next edge.
    fn edge(&mut self, now: Time) {
        (0..self.processors.len()).for_each(|board| self.gp_event(now, board, GpEvent::Poll));
        self.ring_event(now, RingEvent::Arbitrate);
        self.queue.schedule(now + cycle(), Phase::Work, Event::Edge);
    }

    /// A display's clock ticks; that of the first one is the sync generator of the first graphics processor.
    fn tick(&mut self, now: Time, display: usize, period: PeriodNumber) {
        self.display_event(now, display, DisplayEvent::Tick(period));
        let next = period.next();
        self.queue.schedule(self.record.displays[display].tick(next), Phase::Arrive, Event::Tick(display, next));
        if display == 0 {
            self.watch(now);
            self.queue.schedule(now, Phase::Arrive, Event::Gp(1, GpEvent::Retrace(period)));
        }
    }

    /// Notices when nothing has happened for long though programs wait, and nothing is going to: work may take longer than that.
    fn watch(&mut self, now: Time) {
        let is_idle = self.work_events <= EVENTS_OF_A_TICK && self.is_at_rest();
        self.idle_ticks = if is_idle { self.idle_ticks + 1 } else { 0 };
        self.work_events = 0;
        if self.idle_ticks < DEADLOCK_TICKS {
            return;
        }
        if self.waits_for_a_board() {
            self.failure = Some(RunError::Deadlock { time: now, blocked: self.blocked() });
        }
    }

    /// Returns true if a program, a renderer or a message waits for something that no retrace brings.
    fn waits_for_a_board(&self) -> bool {
        self.processors.iter().any(GpBoard::waits_for_a_board)
            || self.record.renderers.iter().any(|renderer| renderer.blocked("").is_some())
            || !self.record.ring.waiting().is_empty()
    }

    /// Ticks of the first display, up to the last one, between which nothing happened but ticks.
    #[must_use]
    pub const fn idle_ticks(&self) -> u64 {
        self.idle_ticks
    }

    /// Whether nothing is under way but the displays and the boards' clock: perhaps only until the next tick.
    #[must_use]
    pub fn is_at_rest(&self) -> bool {
        self.queue.pending().all(Event::is_of_displays)
    }

    /// Who waits for what.
    #[must_use]
    pub fn blocked(&self) -> Vec<Blocked> {
        let processors = self
            .processors
            .iter()
            .enumerate()
            .filter_map(|(i, board)| board.blocked(&Board::of_processor(i).to_string()));
        let renderers = self.record.renderers.iter().enumerate();
        let renderers = renderers.filter_map(|(i, board)| board.blocked(&Board::Renderer(i).to_string()));
        processors.chain(renderers).chain(self.record.ring.blocked()).collect()
    }

    fn ring_event(&mut self, now: Time, event: RingEvent) {
        let Self { record: Record { ring, observation, .. }, contexts: Contexts { ring: context, .. }, queue, .. } =
            self;
        let mut traffic = observation.traffic.as_deref_mut();
        if let (Some(traffic), RingEvent::Accept { destination, last_word_at }) = (&mut traffic, &event) {
            traffic.accept(*destination, *last_word_at);
        }
        ring.handle(event, context.at(now));
        if let Some(traffic) = &mut traffic {
            traffic.channels(now, ring.busy_channels());
        }
        schedule_own(queue, context, Event::Ring);
        schedule_outputs(queue, context);
    }

    /// What the ring has brought to a board enters the trace now.
    fn bring(&mut self, now: Time, output: RingOutput) {
        let record = &mut self.record;
        let mut traffic = record.observation.traffic.as_deref_mut();
        match output {
            RingOutput::Announce { message, first_word_at, .. } => {
                record.hash.record(now, &facts(1, &message));
                if let Some(traffic) = &mut traffic {
                    traffic.announce(&message, first_word_at);
                }
                let board = usize::from(message.destination.0 - record.ports.renderers[0].0);
                self.renderer_event(now, board, RendererEvent::Announce { message, first_word_at });
            }
            RingOutput::Delivered(message) => {
                record.hash.record(now, &facts(2, &message));
                if let Some(traffic) = &mut traffic {
                    traffic.deliver(&message, now, record.ring.timing().word());
                }
                self.deliver(now, message);
            }
            RingOutput::Sent { source, ticket } => {
                record.hash.record(now, &[3, u64::from(source.0), ticket]);
                match record.ports.renderers.binary_search(&source) {
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
        match self.record.ports.of_display(message.destination) {
            Some((display, port)) => {
                self.display_event(now, display, DisplayEvent::Delivered { port, body: message.body });
            }
            None => self.gp_event(now, usize::from(message.destination.0), GpEvent::Delivered(message)),
        }
    }

    /// Messages of a line of the host reach ports of the first display, and the next ones are on their way.
    fn host_says(&mut self, now: Time, line: usize) {
        let messages = self.host_lines[line].messages(now);
        self.schedule_host_line(line, now);
        for (port, body) in messages {
            self.record.hash.record(now, &facts_of_line(port, &body));
            compute_pixels(&mut self.pixels, &body);
            self.display_event(now, 0, DisplayEvent::Delivered { port, body });
        }
    }

    fn schedule_host_line(&mut self, line: usize, after: Time) {
        if let Some(at) = self.host_lines[line].next(after) {
            self.queue.schedule(at, Phase::Arrive, Event::HostLine(line));
        }
    }

    fn gp_event(&mut self, now: Time, board: usize, event: GpEvent) {
        let Self { processors, contexts: Contexts { gp: context, .. }, queue, .. } = self;
        let processor = &mut processors[board];
        processor.handle(event, context.at(now));
        schedule_own(queue, context, |event| Event::Gp(board, event));
        for (order, (time, output)) in (0..).zip(context.drain_outputs()) {
            let GpOutput::Send { message, ticket, hold } = output;
            let request = Request { message, ticket: Some(ticket), hold, order };
            queue.schedule(time, Phase::Arrive, Event::Ring(RingEvent::Request(request)));
        }
        if let Some(fault) = processor.fault().cloned() {
            self.failure = Some(RunError::Fault { board: Board::of_processor(board).to_string(), time: now, fault });
        }
        let Record { hash, observation, .. } = &mut self.record;
        processor.drain_marks(|mark| {
            hash.record(mark.time, &facts_of(&mark));
            observation.marks.push(mark);
        });
    }

    fn renderer_event(&mut self, now: Time, board: usize, event: RendererEvent) {
        let Self { record, contexts: Contexts { renderer: context, .. }, queue, pixels, .. } = self;
        record.renderers[board].handle(event, context.at(now));
        if let Some(traffic) = &mut record.observation.traffic {
            let changes = record.renderers[board].take_fifo_changes();
            traffic.fifo_changes.extend(changes.into_iter().map(|(time, words)| (board, time, words)));
        }
        schedule_own(queue, context, |event| Event::Renderer(board, event));
        let destination = record.ports.renderers[board];
        for (order, (time, output)) in (0..).zip(context.drain_outputs()) {
            let event = match output {
                RendererOutput::Accept { last_word_at } => RingEvent::Accept { destination, last_word_at },
                RendererOutput::Send { message, ticket, hold } => {
                    compute_pixels(pixels, &message.body);
                    RingEvent::Request(Request { message, ticket: ticket.then_some(0), hold, order })
                }
            };
            queue.schedule(time, Phase::Arrive, Event::Ring(event));
        }
    }

    /// The host and the graphics processors, by port.
    #[must_use]
    pub fn processors(&self) -> &[GpBoard] {
        &self.processors
    }

    /// The host or a graphics processor; `None` for other boards, and those that it does not have.
    #[must_use]
    pub fn board(&self, board: Board) -> Option<&GpBoard> {
        match board {
            Board::Host => self.processors.first(),
            Board::Gp(number) => self.processors.get(number + 1),
            _ => None,
        }
    }

    /// Has i860s keep what they find at some addresses of code, instead of those given before; no time changes. Where the time of work
    /// does not come from code nothing is found.
    pub fn break_at(&mut self, addresses: &BTreeSet<u32>) {
        self.processors.iter_mut().for_each(|board| board.break_at(addresses));
    }

    /// Breakpoints that were met since the last call of this, by board.
    #[must_use]
    pub fn take_hits(&mut self) -> Vec<BreakpointHit> {
        self.processors.iter_mut().flat_map(GpBoard::take_hits).collect()
    }

    /// Why the machine goes on no more, if it does not.
    #[must_use]
    pub const fn failure(&self) -> Option<&RunError> {
        self.failure.as_ref()
    }

    /// Events that the simulation has handled so far.
    #[must_use]
    pub const fn events(&self) -> u64 {
        self.queue.events_taken()
    }

    /// Events that wait.
    #[must_use]
    pub fn pending_events(&self) -> usize {
        self.queue.len()
    }

    /// Waits for the worker that computes pixels; the number of regions that it computed.
    pub fn finish_pixels(&mut self) -> u64 {
        self.pixels.take().map_or(0, PixelWorker::finish)
    }
}

/// Hands a region over when its first message is on its way.
fn compute_pixels(worker: &mut Option<Box<dyn PixelWorker>>, body: &Body) {
    if let (Some(worker), Body::Pixels(pixels)) = (worker, body)
        && pixels.part == 0
    {
        worker.compute(&pixels.image);
    }
}
