//! The graphics processor board. After each event that can end the wait of a program, the board polls its programs. A
//! polled program continues until it must wait again.

use crate::cpu::{Cpu, Priority};
use crate::firmware::{Cause, ChainLink, Fault, Firmware, Gp, Shared, Wait};
use crate::memory::Memory;
use crate::probe::Mark;
use crate::processor::{BreakpointHit, CodeVersion, Processor};
use crate::snapshot::GpSnapshot;
use crate::timing::GpTiming;
use pxpl5_sim::{Context, Phase, Span, Time};
use pxpl5_wire::{Message, NodeId, PeriodNumber};
use std::cell::RefCell;
use std::collections::{BTreeSet, VecDeque};
use std::fmt;
use std::rc::Rc;
use std::task::{Context as TaskContext, Poll, Waker};

#[derive(Clone, Debug)]
pub enum GpEvent {
    /// The last word of a message has arrived. The event belongs to phase `Arrive`.
    Delivered(Message),
    /// A receiver has accepted a message. The number is the `ticket` of the message in [`GpOutput::Send`]. The event
    /// belongs to phase `Arrive`.
    Accepted(u64),
    /// A retrace begins a field. The event belongs to phase `Arrive`.
    Retrace(PeriodNumber),
    /// The status signal of another board has changed. A status signal carries one number, for example the number of
    /// swaps of a frame buffer. The event belongs to phase `Arrive`.
    Status { from: NodeId, value: u64 },
    /// The programs of the board continue. They can read all inputs that have arrived at this instant.
    Poll,
    /// The current CPU work ends at this instant. The event has no effect if an interrupt has delayed the end.
    WorkEnds,
}

#[derive(Debug)]
pub enum GpOutput {
    /// A message for the ring. When the receiver accepts it, the board gets `ticket` back in [`GpEvent::Accepted`].
    Send {
        message: Message,
        /// Two numbers in one word. The lower [`PLACE_BITS`] bits have the index of the message in its batch, a group
        /// of messages that the board sends together. The upper bits have the number of the batch.
        ticket: u64,
        /// True if the receiver's port stays reserved for the next message of this board.
        hold: bool,
    },
}

/// Number of bits of a ticket for the index of a message in its batch.
pub const PLACE_BITS: u32 = 20;
const PLACE_MASK: u64 = (1 << PLACE_BITS) - 1;

/// The CPU time of a board, by kind of work.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GpUse {
    /// CPU time of all work.
    pub busy: Span,
    /// CPU time of the software that receives and sends messages.
    pub messages: Span,
    /// CPU time of work that [answers](crate::Gp::answer) messages. For example, a slave answers the token of a region
    /// with the transfer of its bin to the renderer.
    pub tokens: Span,
}

impl GpUse {
    /// Returns the CPU time of all work except messages and tokens, for example of EDIT and TRANSFORM.
    pub const fn work(&self) -> Span {
        Span(self.busy.0.saturating_sub(self.messages.0 + self.tokens.0))
    }
}

struct Task {
    firmware: Firmware,
    priority: Priority,
    has_ended: bool,
}

/// A graphics processor board with its programs.
pub struct GpBoard {
    shared: Rc<RefCell<Shared>>,
    tasks: Vec<Task>,
    /// Times at which a [`GpEvent::WorkEnds`] is scheduled: the next end of CPU work, and earlier ends that an
    /// interrupt has delayed.
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
    /// Makes a board without programs at the ring port `node`. `cycle` is the time from an event to the resulting
    /// output at the ring port.
    pub fn new(node: NodeId, timing: GpTiming, cycle: Span) -> Self {
        let shared = Shared {
            node,
            now: Time::ZERO,
            timing,
            cpu: Cpu::default(),
            memory: Memory::new(node, timing.memory_bytes, timing.bin_bytes),
            processor: None,
            vertex_transforms: 0,
            found_store_full: false,
            message_software: Span::ZERO,
            answer_work: Span::ZERO,
            inbox: VecDeque::new(),
            batches: VecDeque::new(),
            in_flight: Vec::new(),
            unaccepting_receivers: Vec::new(),
            marks: Vec::new(),
            field: PeriodNumber::FIRST,
            status: Vec::new(),
            draining: 0,
            accepted: 0,
            ends: VecDeque::new(),
            issued: 0,
            progress: 0,
            waits: [Wait::NONE; 2],
            software_fault: None,
        };
        let shared = Rc::new(RefCell::new(shared));
        Self { shared, tasks: Vec::new(), announced: Vec::new(), poll_pending: false, cycle, fault: None }
    }

    /// Makes the board run i860 code for each [`Work`](crate::Work), instead of using the timing table. `core`
    /// configures the i860. Boards with the same store `decoded` share decoded programs and their memoized clocks.
    pub fn run_code(&mut self, version: CodeVersion, core: i860::Config, decoded: &Rc<RefCell<i860::DecodedPrograms>>) {
        let shared = &mut *self.shared.borrow_mut();
        let mut processor = Processor::new(shared.node, shared.timing.memory_bytes, version, core);
        processor.share(decoded);
        shared.processor = Some(Box::new(processor));
    }

    /// Turns off memoization, so that the i860 counts every clock again. Call this function before the first event.
    pub fn disable_memoization(&mut self) {
        if let Some(processor) = &mut self.shared.borrow_mut().processor {
            processor.disable_memoization();
        }
    }

    /// Returns the handle through which the program of priority `priority` uses the board.
    pub fn handle_for(&self, priority: Priority) -> Gp {
        Gp { shared: Rc::clone(&self.shared), priority }
    }

    /// Loads the program of priority `priority`. Each priority can have only one program.
    pub fn load(&mut self, priority: Priority, firmware: Firmware) {
        self.shared.borrow_mut().waits[priority as usize] = Wait::NOT_STARTED;
        self.tasks.push(Task { firmware, priority, has_ended: false });
        self.tasks.sort_by_key(|task| task.priority);
    }

    /// Handles one event at time `context.now()`.
    pub fn handle(&mut self, event: GpEvent, context: &mut Context<GpEvent, GpOutput>) {
        let mut shared = self.shared.borrow_mut();
        shared.now = context.now();
        // Record the event, which the programs read at their next poll.
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
        // Poll only if the event can end a wait, and only once for all events of an instant.
        if !self.poll_pending && shared.can_end_wait(cause) {
            self.poll_pending = true;
            context.schedule(context.now(), Phase::Work, GpEvent::Poll);
        }
    }

    fn work(&mut self, context: &mut Context<GpEvent, GpOutput>) {
        self.poll_pending = false;
        {
            let shared = &mut *self.shared.borrow_mut();
            shared.cpu.settle(shared.now);
        }
        // If work ends at this instant, run the programs until they wait.
        self.poll_until_quiet();
        let mut shared = self.shared.borrow_mut();
        if let Some(batch) = shared.next_batch() {
            // Pass all messages of a chain to the board's ring port at once.
            for (place, ChainLink { message, hold }) in (0..).zip(batch.links) {
                let ticket = batch.ticket.0 << PLACE_BITS | place;
                context.output(context.now() + self.cycle, GpOutput::Send { message, ticket, hold });
            }
        }
        // A program may have begun new work.
        let end = shared.cpu.next_end();
        drop(shared);
        self.announce(end, context);
    }

    /// Polls the programs if the current CPU work ends now. Does nothing if an interrupt has delayed its end.
    fn end_of_work(&mut self, context: &mut Context<GpEvent, GpOutput>) {
        let now = context.now();
        self.announced.retain(|at| *at > now);
        if self.shared.borrow().cpu.next_end() == Some(now) {
            self.work(context);
        }
    }

    /// Schedules a [`GpEvent::WorkEnds`] at time `end`, unless such an event is already scheduled at this time.
    fn announce(&mut self, end: Option<Time>, context: &mut Context<GpEvent, GpOutput>) {
        if let Some(end) = end.filter(|end| !self.announced.contains(end)) {
            self.announced.push(end);
            context.schedule(end, Phase::Work, GpEvent::WorkEnds);
        }
    }

    /// Polls the programs in turn until all of them wait for an event outside the board. After its first poll, a
    /// program is polled again only if the other program has progressed.
    fn poll_until_quiet(&mut self) {
        let mut task_context = TaskContext::from_waker(Waker::noop());
        let mut quiet = 0;
        // Stop after one poll of every program without progress.
        for place in (0..self.tasks.len()).cycle() {
            let before = self.shared.borrow().progress;
            self.poll(place, &mut task_context);
            let has_progressed = self.shared.borrow().progress != before;
            quiet = if has_progressed { 1 } else { quiet + 1 };
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
            // Keep only the first fault of the board.
            self.fault = self.fault.take().or(result.err());
        }
    }

    /// Ends all programs and returns true if the message software of the board has had a fault.
    fn stop(&mut self) -> bool {
        let Some(fault) = self.shared.borrow_mut().software_fault.take() else { return false };
        self.fault.get_or_insert(fault);
        self.tasks.clear();
        true
    }

    /// Returns the fault (an input that cannot be processed) that has stopped a program or the board.
    pub const fn fault(&self) -> Option<&Fault> {
        self.fault.as_ref()
    }

    /// Removes the records of stages that the programs have made, and passes them to `take`, the oldest record first.
    pub fn drain_marks(&mut self, take: impl FnMut(Mark)) {
        let marks = &mut self.shared.borrow_mut().marks;
        if !marks.is_empty() {
            marks.drain(..).for_each(take);
        }
    }

    pub fn busy(&self) -> Span {
        self.shared.borrow().cpu.busy()
    }

    /// Returns the CPU time up to `now`, by kind of work. `now` must not be earlier than the last handled event.
    pub fn used(&self, now: Time) -> GpUse {
        let shared = self.shared.borrow();
        // Messages and answers are counted when they begin. Only the part before `now` belongs to the busy time.
        let busy = shared.cpu.busy_at(now);
        let messages = shared.message_software.min(busy);
        GpUse { busy, messages, tokens: shared.answer_work.min(Span(busy.0 - messages.0)) }
    }

    /// Returns the number of vertices that the programs have transformed
    /// ([`Work::vertex_transforms`](crate::Work::vertex_transforms)).
    pub fn vertex_transforms(&self) -> u64 {
        self.shared.borrow().vertex_transforms
    }

    /// Returns true if a decision of a program has ever depended on a full backing store of a renderer
    /// ([`Gp::note_full_store`]).
    pub fn found_store_full(&self) -> bool {
        self.shared.borrow().found_store_full
    }

    /// Returns the greatest number of bytes of memory that were in use at the same time.
    pub fn memory_peak_bytes(&self) -> u64 {
        self.shared.borrow().memory.peak()
    }

    /// Returns a snapshot of the board at time `now`, which must not be earlier than the last handled event.
    pub fn snapshot(&self, now: Time) -> GpSnapshot {
        GpSnapshot::of(&self.shared.borrow(), self.tasks.iter().map(|task| task.priority), now)
    }

    /// Calls `look` with the board's i860, and returns its result. Returns `None` if the board does not run i860 code.
    pub fn with_processor<T>(&self, look: impl FnOnce(&Processor) -> T) -> Option<T> {
        self.shared.borrow().processor.as_deref().map(look)
    }

    /// Sets breakpoints at code addresses. Calls of i860 code then record [`BreakpointHit`]s ([`Processor::break_at`]).
    /// Has no effect on boards without i860 code.
    pub fn break_at(&mut self, addresses: &BTreeSet<u32>) {
        if let Some(processor) = &mut self.shared.borrow_mut().processor {
            processor.break_at(addresses.clone());
        }
    }

    /// Removes and returns the recorded breakpoint hits, if the board runs i860 code.
    pub fn take_hits(&mut self) -> Vec<BreakpointHit> {
        self.shared.borrow_mut().processor.as_mut().map(|processor| processor.take_hits()).unwrap_or_default()
    }

    /// Returns the name of the condition for which the board waits, for reports of deadlocks. If both programs wait,
    /// returns the condition of the foreground program.
    pub fn blocked(&self) -> Option<&'static str> {
        Some(self.wait()?.what)
    }

    /// Returns true if the board waits for an event that only another board can cause. A retrace is no such event.
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

    /// Sends each message back to its sender after 100 ns of work.
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

    /// Simulates the board until it sends nothing more. Each message of the board is accepted at once.
    fn run(board: &mut GpBoard, bench: &mut TestBench<GpEvent, GpOutput>) {
        let mut n_before = 0;
        loop {
            bench.run(|event, context| board.handle(event, context));
            let fresh: Vec<_> = bench.outputs[n_before..]
                .iter()
                .map(|(time, GpOutput::Send { ticket, .. })| (*time, *ticket))
                .collect();
            n_before = bench.outputs.len();
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
    fn an_echo_leaves_the_board_after_reception_work_sending_and_one_cycle() {
        let mut board = board();
        let mut bench = TestBench::new();
        bench.feed(Time(500_000), Phase::Arrive, GpEvent::Delivered(words(2, 7)));
        bench.run(|event, context| board.handle(event, context));
        assert_eq!(sent(bench), [(Time(500_000 + 2_100_000) + CYCLE, 2, 7)]);
    }

    #[test]
    fn simultaneous_messages_are_taken_in_the_order_of_their_senders() {
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
    fn a_second_batch_waits_only_until_the_clump_buffer_is_free() {
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
    fn a_group_of_messages_reserves_its_receiver_until_the_last_message_of_the_group() {
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
    fn a_blocked_board_names_the_cause_of_its_wait() {
        let mut board = board();
        let mut bench = TestBench::new();
        bench.feed(Time(0), Phase::Work, GpEvent::Poll);
        bench.run(|event, context| board.handle(event, context));
        assert_eq!(board.blocked(), Some("a message"));
    }
}
