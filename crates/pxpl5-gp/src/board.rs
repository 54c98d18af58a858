//! The board: it polls its programs whenever something has happened to them.

use crate::cpu::{Cpu, Priority};
use crate::firmware::{Cause, ChainLink, Fault, Firmware, Gp, Shared, Wait};
use crate::look::GpLook;
use crate::memory::Memory;
use crate::probe::Mark;
use crate::processor::{BreakpointHit, CodeVersion, Processor};
use crate::timing::GpTiming;
use pxpl5_sim::{Blocked, Context, Phase, Span, Time};
use pxpl5_wire::{Message, NodeId, PeriodNumber};
use std::cell::RefCell;
use std::collections::{BTreeSet, VecDeque};
use std::fmt;
use std::rc::Rc;
use std::task::{Context as TaskContext, Poll, Waker};

/// What can happen to the board.
#[derive(Clone, Debug)]
pub enum GpEvent {
    /// The last word of a message has arrived (phase `Arrive`).
    Delivered(Message),
    /// A receiver has accepted a message of a batch (phase `Arrive`).
    Accepted(u64),
    /// A field begins (phase `Arrive`).
    Retrace(PeriodNumber),
    /// A status line of another board changes (phase `Arrive`).
    Status {
        /// The port of that board.
        from: NodeId,
        /// What the line says from now on.
        value: u64,
    },
    /// The programs look at what has arrived.
    Poll,
    /// The running work may end: where an interrupt has delayed it, it does so later.
    WorkEnds,
}

/// What leaves the board for others.
#[derive(Debug)]
pub enum GpOutput {
    /// A message for the ring; `ticket` comes back when it was accepted.
    Send {
        /// What is sent, with its destination.
        message: Message,
        /// Its batch, and its place in it in the lower [`PLACE_BITS`].
        ticket: u64,
        /// Whether the receiver's port stays reserved for the next message.
        hold: bool,
    },
}

/// Bits of a ticket that give the place of a message in its batch.
pub const PLACE_BITS: u32 = 20;
const PLACE_MASK: u64 = (1 << PLACE_BITS) - 1;

struct Task {
    firmware: Firmware,
    priority: Priority,
    has_ended: bool,
}

/// One board with its programs.
pub struct GpBoard {
    shared: Rc<RefCell<Shared>>,
    tasks: Vec<Task>,
    /// Instants at which an end of work is scheduled: the next end, and earlier announcements that an interrupt has delayed.
    announced: Vec<Time>,
    poll_pending: bool,
    cycle: Span,
    fault: Option<Fault>,
}

impl fmt::Debug for GpBoard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("GpBoard").field("shared", &self.shared).field("fault", &self.fault).finish_non_exhaustive()
    }
}

impl GpBoard {
    /// A board at a port, without a program. `cycle` is the time that anything needs to leave it.
    #[must_use]
    pub fn new(node: NodeId, timing: GpTiming, cycle: Span) -> Self {
        let shared = Shared {
            node,
            now: Time::ZERO,
            timing,
            cpu: Cpu::default(),
            memory: Memory::new(node, timing.memory_bytes, timing.bin_bytes),
            processor: None,
            vertex_transforms: 0,
            inbox: VecDeque::new(),
            batches: VecDeque::new(),
            in_flight: Vec::new(),
            not_begun: Vec::new(),
            marks: Vec::new(),
            field: PeriodNumber::FIRST,
            status: Vec::new(),
            draining: 0,
            accepted: 0,
            ends: VecDeque::new(),
            issued: 0,
            progress: 0,
            waits: [Wait::NONE; 2],
            stopped_by: None,
        };
        let shared = Rc::new(RefCell::new(shared));
        Self { shared, tasks: Vec::new(), announced: Vec::new(), poll_pending: false, cycle, fault: None }
    }

    /// Has the time of [`Work`](crate::Work) come from this code on such a core from now on, whatever the timing table says; what is
    /// known of its programs is shared with the boards of the same shelf.
    pub fn run_code(&mut self, version: CodeVersion, core: i860::Config, shelf: &Rc<RefCell<i860::Shelf>>) {
        let shared = &mut *self.shared.borrow_mut();
        let mut processor = Processor::new(shared.node, shared.timing.memory_bytes, version, core);
        processor.share(shelf);
        shared.processor = Some(Box::new(processor));
    }

    /// Has the processor that runs code memoise nothing; to be called before programs run.
    pub fn count_every_clock(&mut self) {
        if let Some(processor) = &mut self.shared.borrow_mut().processor {
            processor.count_every_clock();
        }
    }

    /// A handle to the board for a program of a priority.
    #[must_use]
    pub fn handle_for(&self, priority: Priority) -> Gp {
        Gp { shared: Rc::clone(&self.shared), priority }
    }

    /// Loads a program; there is one for each priority.
    pub fn load(&mut self, priority: Priority, firmware: Firmware) {
        self.shared.borrow_mut().waits[priority as usize] = Wait::TO_BEGIN;
        self.tasks.push(Task { firmware, priority, has_ended: false });
        self.tasks.sort_by_key(|task| task.priority);
    }

    /// Handles one event at its instant.
    pub fn handle(&mut self, event: GpEvent, context: &mut Context<GpEvent, GpOutput>) {
        let mut shared = self.shared.borrow_mut();
        shared.now = context.now();
        let cause = match event {
            GpEvent::Delivered(message) => shared.latch(message),
            GpEvent::Accepted(ticket) => shared.note_accepted(ticket >> PLACE_BITS, ticket & PLACE_MASK),
            GpEvent::Retrace(field) => shared.begin_field(field),
            GpEvent::Status { from, value } => shared.set_status(from, value),
            GpEvent::Poll => {
                drop(shared);
                return self.work(context);
            }
            GpEvent::WorkEnds => {
                drop(shared);
                return self.end_of_work(context);
            }
        };
        if !self.poll_pending && shared.is_woken_by(cause) {
            self.poll_pending = true;
            context.schedule(context.now(), Phase::Work, GpEvent::Poll);
        }
    }

    /// The programs look at this instant's arrivals together, if one of them waits for such.
    fn work(&mut self, context: &mut Context<GpEvent, GpOutput>) {
        self.poll_pending = false;
        {
            let shared = &mut *self.shared.borrow_mut();
            shared.cpu.settle(shared.now);
        }
        self.poll_until_quiet();
        let mut shared = self.shared.borrow_mut();
        if let Some(batch) = shared.next_batch() {
            for (place, ChainLink { message, hold }) in (0..).zip(batch.links) {
                let ticket = batch.ticket.0 << PLACE_BITS | place;
                context.output(context.now() + self.cycle, GpOutput::Send { message, ticket, hold });
            }
        }
        let end = shared.cpu.next_end();
        drop(shared);
        self.announce(end, context);
    }

    /// Lets the programs go on if work ends now. An interrupt may have delayed it since its end was announced.
    fn end_of_work(&mut self, context: &mut Context<GpEvent, GpOutput>) {
        let now = context.now();
        self.announced.retain(|at| *at > now);
        if self.shared.borrow().cpu.next_end() == Some(now) {
            self.work(context);
        }
    }

    /// Schedules an event at the end of work, once.
    fn announce(&mut self, end: Option<Time>, context: &mut Context<GpEvent, GpOutput>) {
        if let Some(end) = end.filter(|end| !self.announced.contains(end)) {
            self.announced.push(end);
            context.schedule(end, Phase::Work, GpEvent::WorkEnds);
        }
    }

    /// Asks programs in turn until all of them wait for what another would have to do. A program goes as far as it can when it is asked,
    /// so it is asked again only when another has come on since.
    fn poll_until_quiet(&mut self) {
        let mut task_context = TaskContext::from_waker(Waker::noop());
        let mut quiet = 0;
        for place in (0..self.tasks.len()).cycle() {
            let before = self.shared.borrow().progress;
            self.poll(place, &mut task_context);
            let has_come_on = self.shared.borrow().progress != before;
            quiet = if has_come_on { 1 } else { quiet + 1 };
            if self.stop() || quiet >= self.tasks.len() {
                break;
            }
        }
        self.tasks.retain(|task| !task.has_ended);
    }

    fn poll(&mut self, place: usize, context: &mut TaskContext<'_>) {
        let task = &mut self.tasks[place];
        if task.has_ended || self.shared.borrow().is_at_work(task.priority) {
            return;
        }
        if let Poll::Ready(result) = task.firmware.as_mut().poll(context) {
            task.has_ended = true;
            self.fault = self.fault.take().or(result.err());
        }
    }

    /// Ends all programs where a fault of the board's own software has stopped it.
    fn stop(&mut self) -> bool {
        let Some(fault) = self.shared.borrow_mut().stopped_by.take() else { return false };
        self.fault.get_or_insert(fault);
        self.tasks.clear();
        true
    }

    /// The fault that stopped a program, or the board.
    #[must_use]
    pub const fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    /// Takes what the programs have told the observer, in order.
    pub fn drain_marks(&mut self, take: impl FnMut(Mark)) {
        let marks = &mut self.shared.borrow_mut().marks;
        if !marks.is_empty() {
            marks.drain(..).for_each(take);
        }
    }

    /// CPU time spent so far.
    #[must_use]
    pub fn busy(&self) -> Span {
        self.shared.borrow().cpu.busy()
    }

    /// Vertices that its programs have transformed since the start: see [`Work::vertex_transforms`](crate::Work::vertex_transforms).
    #[must_use]
    pub fn vertex_transforms(&self) -> u64 {
        self.shared.borrow().vertex_transforms
    }

    /// Most bytes of memory ever in use.
    #[must_use]
    pub fn memory_peak_bytes(&self) -> u64 {
        self.shared.borrow().memory.peak()
    }

    /// What the board does at an instant that is not before the last event. Looking changes nothing.
    #[must_use]
    pub fn look(&self, now: Time) -> GpLook {
        GpLook::of(&self.shared.borrow(), self.tasks.iter().map(|task| task.priority), now)
    }

    /// Shows somebody the processor, where the time of work comes from code.
    pub fn with_processor<T>(&self, look: impl FnOnce(&Processor) -> T) -> Option<T> {
        self.shared.borrow().processor.as_deref().map(look)
    }

    /// Has calls keep what they find at some addresses of code ([`Processor::break_at`]); without a processor nothing happens.
    pub fn break_at(&mut self, addresses: &BTreeSet<u32>) {
        if let Some(processor) = &mut self.shared.borrow_mut().processor {
            processor.break_at(addresses.clone());
        }
    }

    /// Breakpoints that were met since the last call of this.
    #[must_use]
    pub fn take_hits(&mut self) -> Vec<BreakpointHit> {
        self.shared.borrow_mut().processor.as_mut().map(|processor| processor.take_hits()).unwrap_or_default()
    }

    /// Returns the name of the wait that keeps the board from going on: the foreground's, if it waits, else the interrupt's.
    #[must_use]
    pub fn blocked(&self, name: &str) -> Option<Blocked> {
        let waits_for = self.wait()?.what.to_owned();
        Some(Blocked { board: name.to_owned(), waits_for })
    }

    /// Returns true if the board waits for something that no retrace brings.
    #[must_use]
    pub fn waits_for_a_board(&self) -> bool {
        self.wait().is_some_and(|wait| wait.ended_by != Cause::Retrace)
    }

    fn wait(&self) -> Option<Wait> {
        let waits = self.shared.borrow().waits;
        let waits = self.tasks.iter().rev().map(|task| waits[task.priority as usize]);
        waits.into_iter().find(|wait| !wait.what.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pxpl5_sim::TestBench;
    use pxpl5_wire::Body;

    const CYCLE: Span = Span(25_000);

    fn words(source: u16, value: u32) -> Message {
        Message { source: NodeId(source), destination: NodeId(9), words: 1, body: Body::Words([value].into()) }
    }

    fn value(body: &Body) -> u32 {
        match body {
            Body::Words(words) => words[0],
            _ => panic!("the test sends words only"),
        }
    }

    /// Echoes each message to its sender after 100 ns of work.
    async fn echo(gp: Gp) -> Result<(), Fault> {
        loop {
            let received = gp.receive().await;
            gp.spend(Span::from_ns(100)).await;
            gp.send(received.source, 1, received.body).await;
        }
    }

    fn board() -> GpBoard {
        let timing = GpTiming { message_ns: 1_000, ..GpTiming::PAPERS };
        let mut board = GpBoard::new(NodeId(9), timing, CYCLE);
        let gp = board.handle_for(Priority::Foreground);
        board.load(Priority::Foreground, Box::pin(echo(gp)));
        board
    }

    /// Runs the board; every message is accepted as soon as it has left.
    fn run(board: &mut GpBoard, bench: &mut TestBench<GpEvent, GpOutput>) {
        let mut told = 0;
        loop {
            bench.run(|event, context| board.handle(event, context));
            let fresh: Vec<_> =
                bench.outputs[told..].iter().map(|(time, GpOutput::Send { ticket, .. })| (*time, *ticket)).collect();
            told = bench.outputs.len();
            if fresh.is_empty() {
                return;
            }
            let now = bench.queue().now();
            fresh
                .iter()
                .for_each(|(time, ticket)| bench.feed((*time).max(now), Phase::Arrive, GpEvent::Accepted(*ticket)));
        }
    }

    fn sent(bench: TestBench<GpEvent, GpOutput>) -> Vec<(Time, u16, u32)> {
        let sends = bench.outputs.into_iter();
        sends
            .map(|(time, GpOutput::Send { message, .. })| (time, message.destination.0, value(&message.body)))
            .collect()
    }

    #[test]
    fn an_echo_leaves_after_both_software_costs_the_work_and_one_cycle() {
        let mut board = board();
        let mut bench = TestBench::new();
        bench.feed(Time(500_000), Phase::Arrive, GpEvent::Delivered(words(2, 7)));
        bench.run(|event, context| board.handle(event, context));
        assert_eq!(sent(bench), [(Time(500_000 + 2_100_000) + CYCLE, 2, 7)]);
    }

    #[test]
    fn simultaneous_messages_are_taken_in_the_order_of_their_senders_whatever_the_tie() {
        for seed in 0..20 {
            let mut board = board();
            let mut bench = TestBench::new();
            bench.queue().shuffle_ties(seed);
            for source in [5, 3, 8, 1] {
                bench.feed(Time(0), Phase::Arrive, GpEvent::Delivered(words(source, 0)));
            }
            run(&mut board, &mut bench);
            assert_eq!(sent(bench).iter().map(|s| s.1).collect::<Vec<_>>(), [1, 3, 5, 8]);
        }
    }

    #[test]
    fn a_batch_waits_for_the_clump_buffer_and_not_for_the_ring() {
        async fn two_clumps(gp: Gp) -> Result<(), Fault> {
            for clump in 0..2 {
                gp.clump_buffer_free().await;
                gp.send(NodeId(1), 1, Body::Words([clump].into())).await;
            }
            Ok(())
        }
        let mut board = GpBoard::new(NodeId(9), GpTiming { message_ns: 1_000, ..GpTiming::PAPERS }, CYCLE);
        let gp = board.handle_for(Priority::Foreground);
        board.load(Priority::Foreground, Box::pin(two_clumps(gp)));
        let mut bench = TestBench::new();
        bench.feed(Time(0), Phase::Work, GpEvent::Poll);
        bench.feed(Time(9_000_000), Phase::Arrive, GpEvent::Accepted(1 << PLACE_BITS));
        bench.run(|event, context| board.handle(event, context));
        let first = Time(1_000_000) + CYCLE;
        assert_eq!(sent(bench), [(first, 1, 0), (Time(10_000_000) + CYCLE, 1, 1)]);
    }

    #[test]
    fn a_group_keeps_its_receiver_until_its_last_message() {
        async fn groups(gp: Gp) -> Result<(), Fault> {
            let word = |value: u32| (1, Body::Words([value].into()));
            gp.send_groups(vec![(NodeId(1), vec![word(0), word(1), word(2)]), (NodeId(2), vec![word(3)])]).await;
            Ok(())
        }
        let mut board = GpBoard::new(NodeId(9), GpTiming::PAPERS, CYCLE);
        let gp = board.handle_for(Priority::Foreground);
        board.load(Priority::Foreground, Box::pin(groups(gp)));
        let mut bench = TestBench::new();
        bench.feed(Time(0), Phase::Work, GpEvent::Poll);
        bench.run(|event, context| board.handle(event, context));
        let held: Vec<_> = bench
            .outputs
            .iter()
            .map(|(_, GpOutput::Send { message, hold, .. })| (message.destination.0, value(&message.body), *hold))
            .collect();
        assert_eq!(held, [(1, 0, true), (1, 1, true), (1, 2, false), (2, 3, false)]);
    }

    #[test]
    fn a_blocked_board_names_what_it_waits_for() {
        let mut board = board();
        let mut bench = TestBench::new();
        bench.feed(Time(0), Phase::Work, GpEvent::Poll);
        bench.run(|event, context| board.handle(event, context));
        let blocked = board.blocked("GP 9").expect("it waits");
        assert_eq!(blocked.waits_for, "a message");
    }
}
