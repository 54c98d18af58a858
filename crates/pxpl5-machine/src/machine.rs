//! The schematic of the machine: no other file connects boards.
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

use crate::board::{Board, EventDescription};
use crate::config::MachineConfig;
use crate::event::{Event, schedule_outputs, schedule_own};
use crate::facts::{facts, host_line_facts, mark_facts};
use crate::host_line::HostLine;
use crate::optimization::Optimization;
use crate::pixels::PixelWorker;
use crate::ports::Ports;
use crate::record::{Attachment, Record};
use crate::run_error::{Blocked, RunError};
use pxpl5_gp::{BreakpointHit, Firmware, Gp, GpBoard, GpEvent, GpOutput, GpUse, Priority};
use pxpl5_renderer::{ArrayPool, Layout, Renderer, RendererEvent, RendererOutput};
use pxpl5_ring::{Request, Ring, RingEvent, RingOutput};
use pxpl5_sim::parameters::SettingError;
use pxpl5_sim::{Context, EventQueue, Phase, Time};
use pxpl5_wire::display::{DisplayContext, DisplayEvent};
use pxpl5_wire::{Body, CopyTarget, Message, NodeId, PeriodNumber};
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;
use std::sync::Arc;

/// A running machine: boards, programs, future events and all observations ([`Record`]).
#[derive(Debug)]
pub struct Machine {
    record: Record,
    queue: EventQueue<Event>,
    /// The host and the graphics processors, indexed by ring port.
    processors: Vec<GpBoard>,
    contexts: Contexts,
    swaps: BTreeMap<NodeId, u64>,
    host_lines: Vec<Box<dyn HostLine>>,
    pixels: Option<Box<dyn PixelWorker>>,
    /// True if boards run at every edge of their clock, because the optimization `IdleBoards` is disabled.
    every_edge: bool,
    failure: Option<RunError>,
    /// Number of events in the current period of the first display, except events of displays, clocks, and host lines
    /// (connections that bypass the ring).
    work_events: u64,
    idle_ticks: u64,
    now: Time,
}

#[derive(Debug, Default)]
struct Contexts {
    ring: Context<RingEvent, RingOutput>,
    gp: Context<GpEvent, GpOutput>,
    renderer: Context<RendererEvent, RendererOutput>,
    display: DisplayContext,
}

/// Number of idle periods of the first display after which a machine with waiting programs counts as deadlocked.
///
/// In an idle period, only displays, clocks and [host lines](HostLine) have events, and no other board has a pending
/// event.
pub const DEADLOCK_TICKS: u64 = 120;

/// Number of events that the start of a period causes on the first graphics processor: the retrace signal, and a poll
/// of its programs. A period with only these events can still be idle.
const EVENTS_OF_A_TICK: u64 = 2;

impl Machine {
    /// Builds a machine in which each display has ring ports for `pictures` pictures: 1, or 2 for two eyes.
    ///
    /// # Errors
    ///
    /// Returns [`SettingError`] if a parameter of the machine or of a display is invalid.
    pub fn new(config: &MachineConfig, pictures: usize, layout: Layout) -> Result<Self, SettingError> {
        config.check()?;
        // Number the ports first: every board needs its own port number.
        let ports = Ports::plug(config, pictures);
        // Renderers are not elastic: they accept a message only when their FIFO has room.
        let renderers = ports.renderers.clone();
        let elastic = move |node: NodeId| !renderers.contains(&node);
        let ring = Ring::new(config.ring, ports.count(), elastic).map_err(SettingError::combination)?;
        // Build the boards in the order of their ports.
        let signal = config.ring.signal();
        let host = GpBoard::new(ports.host, config.host.board(), signal);
        let gps = ports.gps.iter().map(|node| GpBoard::new(*node, config.gp, signal));
        // All renderers share one pool for their pixel arrays.
        let pool = ArrayPool::new(layout);
        let renderer = |node: &NodeId| Renderer::new(*node, config.renderer, config.ring.word(), signal, pool.clone());
        let displays = config
            .displays
            .iter()
            .zip(&ports.displays)
            .map(|(display, nodes)| display.build(nodes, config.ring.word()));
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
                met_full_store: false,
                elapsed: Time::ZERO,
                processors_used: Vec::new(),
                attachments: Vec::new(),
            },
            queue: EventQueue::new(),
            contexts: Contexts::default(),
            host_lines: Vec::new(),
            pixels: None,
            every_edge: false,
            failure: None,
            work_events: 0,
            idle_ticks: 0,
            now: Time::ZERO,
        })
    }

    /// Handles simultaneous events in a pseudo-random order. Tests use different seeds to prove that the order changes
    /// no result.
    pub fn shuffle_ties(&mut self, seed: u64) {
        self.queue.shuffle_ties(seed);
    }

    /// Uses `worker` to compute the pixels of every region that a renderer copies from now on.
    pub fn compute_all_pixels(&mut self, worker: Box<dyn PixelWorker>) {
        self.pixels = Some(worker);
    }

    /// Makes the graphics processors execute i860 code, whose clocks then determine the times of their work. Has an
    /// effect only if the configuration has a code version.
    ///
    /// Call this before loading programs.
    pub fn run_code(&mut self) {
        if let Some(version) = self.record.config.code {
            let core = self.record.config.i860;
            let decoded = Rc::default();
            self.processors.iter_mut().skip(1).for_each(|board| board.run_code(version, core, &decoded));
        }
    }

    /// Disables an optimization of the simulator. Call this method before the machine runs.
    pub fn disable(&mut self, optimization: Optimization) {
        match optimization {
            Optimization::IdleBoards => self.every_edge = true,
            Optimization::Transfers => self.record.ring.move_every_word(),
            Optimization::EmptyRegions => self.record.renderers.iter_mut().for_each(Renderer::draw_every_region),
            Optimization::RepeatedCode => self.processors.iter_mut().for_each(GpBoard::disable_memoization),
        }
    }

    /// Records all ring messages, and all changes of occupied channels and of renderer FIFOs. Call this method before
    /// the machine runs.
    pub fn record_traffic(&mut self) {
        self.record.observation.traffic = Some(Box::default());
        self.record.ring.watch();
        self.record.renderers.iter_mut().for_each(Renderer::watch_fifo);
    }

    /// Discards all observations before an instant, except the last earlier swap of each port. The call changes no
    /// simulated time.
    pub fn discard_before(&mut self, instant: Time) {
        let Record { observation, displays, .. } = &mut self.record;
        observation.discard_before(instant, |period| displays[0].tick(period));
        self.record.attachments.iter().for_each(|attachment| attachment.discard(&self.record));
    }

    /// Returns the boards and all observations so far.
    pub const fn record(&self) -> &Record {
        &self.record
    }

    /// Returns the CPU time up to `now` by kind of work. There is one entry for the host and one for each graphics
    /// processor, in the order of their ports. `now` must not be earlier than the last event.
    pub fn processors_used(&self, now: Time) -> Vec<GpUse> {
        self.processors.iter().map(|board| board.used(now)).collect()
    }

    /// Ends the run and returns the boards and all observations.
    pub fn into_record(mut self) -> Record {
        self.finish_pixels();
        self.record.events = self.queue.events_taken();
        self.record.vertex_transforms = self.processors.iter().map(|board| board.vertex_transforms()).sum();
        self.record.met_full_store = self.record.renderers.iter().any(|board| board.waited_for_room())
            || self.processors.iter().any(GpBoard::found_store_full);
        self.record.elapsed = self.now;
        self.record.processors_used = self.processors_used(self.now);
        self.record
    }

    /// Returns the ring ports of all boards.
    pub const fn ports(&self) -> &Ports {
        &self.record.ports
    }

    /// Returns the handle through which a program controls the host or graphics processor at port `node`. `priority` is
    /// the CPU priority of the program.
    ///
    /// # Panics
    ///
    /// Panics if no processor has this port.
    pub fn processor(&self, node: NodeId, priority: Priority) -> Gp {
        self.processors[usize::from(node.0)].handle_for(priority)
    }

    /// Loads a program with a CPU priority onto the host or graphics processor at a port.
    ///
    /// # Panics
    ///
    /// Panics if no processor has this port.
    pub fn load(&mut self, node: NodeId, priority: Priority, program: Firmware) {
        self.processors[usize::from(node.0)].load(priority, program);
    }

    /// Adds a connection from the host to the first display that bypasses the ring. Call this method before
    /// [`Machine::switch_on`].
    pub fn plug_host_line(&mut self, line: Box<dyn HostLine>) {
        self.host_lines.push(line);
    }

    /// Adds data of the pipeline to the record of the run.
    pub fn attach(&mut self, attachment: Arc<dyn Attachment>) {
        self.record.attachments.push(attachment);
    }

    /// Starts the machine: all programs and the first period of every display begin at time zero.
    pub fn switch_on(&mut self) {
        // Every processor polls its programs first.
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
        // With the optimization `IdleBoards` disabled, poll at every clock edge.
        if self.every_edge {
            self.queue.schedule(Time::ZERO, Phase::Work, Event::Edge);
        }
        (0..self.host_lines.len()).for_each(|line| self.schedule_host_line(line, Time::ZERO));
    }

    /// Handles all events before the instant `end`, not including `end` itself.
    ///
    /// # Errors
    ///
    /// Returns [`RunError`] if a program fails, the machine deadlocks or the ring refuses a message. The [`Record`]
    /// keeps all earlier observations.
    pub fn run_until(&mut self, end: Time) -> Result<(), RunError> {
        while self.takes_event_before(end).is_some() {}
        self.failure.clone().map_or(Ok(()), Err)
    }

    /// Handles the next event if it is before the instant `end`, and returns the event's time.
    ///
    /// # Errors
    ///
    /// Returns the [`RunError`] of this event or of an earlier event. A machine that has failed handles no more events.
    pub fn step_before(&mut self, end: Time) -> Result<Option<Time>, RunError> {
        let taken = self.takes_event_before(end);
        self.failure.clone().map_or(Ok(taken), Err)
    }

    fn takes_event_before(&mut self, end: Time) -> Option<Time> {
        if self.failure.is_some() {
            return None;
        }
        let Some((now, event)) = self.queue.next_event_before(end) else {
            self.now = self.now.max(end);
            // The ring counts the messages that have ended since its last event.
            self.record.ring.settle(self.now);
            return None;
        };
        self.now = now;
        self.handle(now, event);
        Some(now)
    }

    /// Returns a description of the next event, or `None` if no event is pending.
    pub fn next_event_description(&self) -> Option<EventDescription> {
        self.queue.peek().map(|(time, event)| event.happening(time, &self.record.ports))
    }

    fn handle(&mut self, now: Time, event: Event) {
        self.work_events += u64::from(!event.is_of_displays());
        match event {
            Event::Ring(event) => self.ring_event(now, event),
            Event::FromRing(output) => self.take_from_ring(now, output),
            Event::Gp(board, event) => self.gp_event(now, board, event),
            Event::Renderer(board, event) => self.renderer_event(now, board, event),
            Event::HostLine(line) => self.host_line_event(now, line),
            Event::Display(display, event) => self.display_event(now, display, event),
            Event::Tick(display, period) => self.tick(now, display, period),
            Event::Edge => self.edge(now),
        }
    }

    fn edge(&mut self, now: Time) {
        (0..self.processors.len()).for_each(|board| self.gp_event(now, board, GpEvent::Poll));
        self.ring_event(now, RingEvent::Arbitrate);
        self.queue.schedule(now + self.record.config.ring.signal(), Phase::Work, Event::Edge);
    }

    /// Begins a period of a display. The first display also signals a retrace to the first graphics processor.
    fn tick(&mut self, now: Time, display: usize, period: PeriodNumber) {
        self.display_event(now, display, DisplayEvent::Tick(period));
        let next = period.next();
        self.queue.schedule(self.record.displays[display].tick(next), Phase::Arrive, Event::Tick(display, next));
        if display == 0 {
            self.watch(now);
            self.queue.schedule(now, Phase::Arrive, Event::Gp(1, GpEvent::Retrace(period)));
        }
    }

    /// Checks for a deadlock at the start of a period of the first display.
    ///
    /// The machine is deadlocked after [`DEADLOCK_TICKS`] idle periods if a program, renderer or message still waits. A
    /// period with a pending event is not idle, because one task of a board may take longer than all these periods.
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

    fn waits_for_a_board(&self) -> bool {
        self.processors.iter().any(GpBoard::waits_for_a_board)
            || self.record.renderers.iter().any(|renderer| renderer.blocked().is_some())
            || !self.record.ring.waiting().is_empty()
    }

    /// Returns the number of successive idle periods of the first display. [`DEADLOCK_TICKS`] defines an idle period.
    pub const fn idle_ticks(&self) -> u64 {
        self.idle_ticks
    }

    /// Returns true if only displays, clocks and [host lines](HostLine) have pending events.
    ///
    /// The start of a display period can still end the wait of a program.
    pub fn is_at_rest(&self) -> bool {
        self.queue.pending().all(Event::is_of_displays)
    }

    /// Returns all boards that wait, each with the condition for which the board waits.
    pub fn blocked(&self) -> Vec<Blocked> {
        let Record { ports, renderers, ring, .. } = &self.record;
        // Programs that wait. A program that waits for a message does not state the sender of the message.
        let processors = self.processors.iter().enumerate().filter_map(|(port, processor)| {
            let waits_for = processor.blocked()?.to_owned();
            Some(Blocked { board: Board::of_processor(port), waits_on: None, waits_for })
        });
        // Renderers that wait for the end of a copy.
        let renderers = renderers.iter().enumerate().filter_map(|(number, renderer)| {
            let CopyTarget { frame_buffer, region, .. } = renderer.blocked()?;
            let waits_for = format!("frame buffer at node {} to take region {}", frame_buffer.0, region.0);
            Some(Blocked { board: Board::Renderer(number), waits_on: Some(ports.board(frame_buffer)), waits_for })
        });
        // Messages that wait on the ring.
        let messages = ring.waiting().into_iter().map(|message| Blocked {
            board: ports.board(message.source),
            waits_on: message.waits_on().map(|node| ports.board(node)),
            waits_for: message.waits_for(|node| ports.board(node)),
        });
        processors.chain(renderers).chain(messages).collect()
    }

    fn ring_event(&mut self, now: Time, event: RingEvent) {
        let Self { record: Record { ring, observation, .. }, contexts: Contexts { ring: context, .. }, queue, .. } =
            self;
        let mut traffic = observation.traffic.as_deref_mut();
        // Record that a renderer accepts a message.
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

    fn take_from_ring(&mut self, now: Time, output: RingOutput) {
        let record = &mut self.record;
        let mut traffic = record.observation.traffic.as_deref_mut();
        match output {
            // The first words of a message reach a renderer's FIFO.
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
            // Inform the sender that its message was accepted.
            RingOutput::Sent { source, ticket } => {
                record.hash.record(now, &[3, u64::from(source.0), ticket]);
                match record.ports.renderers.binary_search(&source) {
                    Ok(board) => self.renderer_event(now, board, RendererEvent::Sent),
                    Err(_) => self.gp_event(now, usize::from(source.0), GpEvent::Accepted(ticket)),
                }
            }
            // An invalid message stops the machine.
            RingOutput::Refused { error, .. } => {
                self.failure = Some(RunError::Ring { time: now, error });
            }
        }
    }

    fn deliver(&mut self, now: Time, message: Message) {
        match self.record.ports.of_display(message.destination) {
            Some((display, port)) => {
                self.display_event(now, display, DisplayEvent::Delivered { port, body: message.body });
            }
            None => self.gp_event(now, usize::from(message.destination.0), GpEvent::Delivered(message)),
        }
    }

    fn host_line_event(&mut self, now: Time, line: usize) {
        let messages = self.host_lines[line].messages(now);
        self.schedule_host_line(line, now);
        for (port, body) in messages {
            self.record.hash.record(now, &host_line_facts(port, &body));
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
        // Schedule the messages that its programs have sent.
        for (order, (time, output)) in (0..).zip(context.drain_outputs()) {
            let GpOutput::Send { message, ticket, hold } = output;
            let request = Request { message, ticket: Some(ticket), hold, order };
            queue.schedule(time, Phase::Arrive, Event::Ring(RingEvent::Request(request)));
        }
        if let Some(fault) = processor.fault().cloned() {
            self.failure = Some(RunError::Fault { board: Board::of_processor(board), time: now, fault });
        }
        // Record the time stamps that the board's programs have set.
        let Record { hash, observation, .. } = &mut self.record;
        processor.drain_marks(|mark| {
            hash.record(mark.time, &mark_facts(&mark));
            observation.marks.push(mark);
        });
    }

    fn renderer_event(&mut self, now: Time, board: usize, event: RendererEvent) {
        let Self { record, contexts: Contexts { renderer: context, .. }, queue, pixels, .. } = self;
        record.renderers[board].handle(event, context.at(now));
        let drawn = record.renderers[board].drain_drawn().map(|region| (board, region));
        record.observation.drawn.extend(drawn);
        if let Some(traffic) = &mut record.observation.traffic {
            let changes = record.renderers[board].take_fifo_changes();
            traffic.fifo_changes.extend(changes.into_iter().map(|(time, words)| (board, time, words)));
        }
        schedule_own(queue, context, |event| Event::Renderer(board, event));
        let destination = record.ports.renderers[board];
        // Schedule the board's answers to the ring: acceptance of a message, or a region to send.
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

    /// Returns the host and the graphics processors, indexed by port.
    pub fn processors(&self) -> &[GpBoard] {
        &self.processors
    }

    /// Returns the host or a graphics processor, or `None` for any other board.
    pub fn board(&self, board: Board) -> Option<&GpBoard> {
        match board {
            Board::Host => self.processors.first(),
            Board::Gp(number) => self.processors.get(number + 1),
            _ => None,
        }
    }

    /// Sets the code addresses at which the processors record their state, and removes all earlier addresses.
    ///
    /// Such breakpoints change no simulated time. Only a processor that executes i860 code reaches a breakpoint.
    pub fn break_at(&mut self, addresses: &BTreeSet<u32>) {
        self.processors.iter_mut().for_each(|board| board.break_at(addresses));
    }

    /// Removes and returns the breakpoints reached since the last call, in the order of the boards.
    pub fn take_hits(&mut self) -> Vec<BreakpointHit> {
        self.processors.iter_mut().flat_map(GpBoard::take_hits).collect()
    }

    /// Returns the error that stopped the machine, if any.
    pub const fn failure(&self) -> Option<&RunError> {
        self.failure.as_ref()
    }

    /// Returns the number of events handled so far.
    pub const fn events(&self) -> u64 {
        self.queue.events_taken()
    }

    /// Returns the number of events in the queue.
    pub fn pending_events(&self) -> usize {
        self.queue.len()
    }

    /// Waits until all pixels are computed. Returns the number of regions that the worker has computed.
    pub fn finish_pixels(&mut self) -> u64 {
        self.pixels.take().map_or(0, PixelWorker::finish)
    }
}

/// Passes a region to the worker when its first message is sent. The worker then computes the pixels.
fn compute_pixels(worker: &mut Option<Box<dyn PixelWorker>>, body: &Body) {
    if let (Some(worker), Body::Pixels(pixels)) = (worker, body)
        && pixels.part == 0
    {
        worker.compute(&pixels.image);
    }
}
