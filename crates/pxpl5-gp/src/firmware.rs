//! The interface between a program (firmware) and its board.

use crate::cpu::{Cpu, Priority};
use crate::memory::{Account, Memory, OutOfMemory};
use crate::probe::{Mark, Stage, StageEdge};
use crate::processor::{Processor, ProcessorFault};
use crate::timing::GpTiming;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::{Body, Message, NodeId, PeriodNumber, PictureNumber, RegionId, SurfaceId, ViewNumber};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::future::{Future, poll_fn};
use std::pin::Pin;
use std::rc::Rc;
use std::task::Poll;

/// A program on a board.
///
/// It runs forever or ends with a fault. Since the board records one wait for each program, it must await only one
/// future at a time.
pub type Firmware = Pin<Box<dyn Future<Output = Result<(), Fault>>>>;

/// A fault of the simulated machine that stops a program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Data do not fit in the memory of the board.
    #[error(transparent)]
    Memory(#[from] OutOfMemory),
    #[error("node {}: unexpected message {found}", node.0)]
    Protocol { node: NodeId, found: String },
    /// The i860 code trapped, did not return, or needed more memory than was free.
    #[error(transparent)]
    Processor(#[from] ProcessorFault),
}

/// A received message, with the arrival time of its last word.
#[derive(Clone, Debug)]
pub struct Received {
    /// Arrival time of the last word of the message.
    pub arrived: Time,
    pub source: NodeId,
    pub body: Body,
}

/// Number of a batch of messages that a program has passed to the DMA.
///
/// The DMA (direct memory access) is the part of the board that sends messages in the background.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ticket(pub(crate) u64);

/// A group of messages that the DMA sends together. The receivers must first have accepted the previous group.
#[derive(Debug)]
pub(crate) struct Batch {
    pub(crate) ticket: Ticket,
    pub(crate) links: Vec<ChainLink>,
}

#[derive(Debug)]
pub(crate) struct ChainLink {
    pub(crate) message: Message,
    /// True if the port of the receiver stays reserved for the next message of this board.
    pub(crate) hold: bool,
}

#[derive(Debug)]
pub(crate) struct Shared {
    pub(crate) node: NodeId,
    pub(crate) now: Time,
    pub(crate) timing: GpTiming,
    pub(crate) cpu: Cpu,
    pub(crate) memory: Memory,
    /// The i860 that runs code. `None` if all times come from the timing table.
    pub(crate) processor: Option<Box<Processor>>,
    pub(crate) vertex_transforms: u64,
    /// True if a decision of a program has ever depended on a full backing store of a renderer.
    pub(crate) found_store_full: bool,
    pub(crate) message_software: Span,
    /// CPU time that was requested so far for answers to messages.
    pub(crate) answer_work: Span,
    pub(crate) inbox: VecDeque<Received>,
    pub(crate) batches: VecDeque<Batch>,
    /// Messages of the current batch that the receivers have not accepted yet: the index in the batch, and the
    /// receiver.
    pub(crate) in_flight: Vec<(u64, NodeId)>,
    /// Receivers that have not accepted any message of the current batch yet.
    pub(crate) unaccepting_receivers: Vec<NodeId>,
    pub(crate) marks: Vec<Mark>,
    /// Ends of stages that are not recorded yet. An end is recorded when the receivers have accepted the last batch of
    /// messages of the stage. Each entry has the number of this batch and the record. The list is sorted by batch.
    pub(crate) ends: VecDeque<(Ticket, Mark)>,
    pub(crate) field: PeriodNumber,
    pub(crate) status: Vec<(NodeId, u64)>,
    /// Number of the last batch of messages of which every receiver has accepted at least one message.
    pub(crate) draining: u64,
    /// Number of the last batch of messages that the receivers have accepted completely.
    pub(crate) accepted: u64,
    pub(crate) issued: u64,
    /// Number of waits that have ended so far. The board polls its programs until this number stays the same.
    pub(crate) progress: u64,
    pub(crate) waits: [Wait; 2],
    /// Fault in the message software of the board, which stops all programs.
    pub(crate) software_fault: Option<Fault>,
}

/// A wait of a program: the name of the condition, and the kind of event that can make the condition true.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wait {
    pub(crate) what: &'static str,
    pub(crate) ended_by: Cause,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cause {
    /// Work on the board's CPU has ended.
    Work,
    /// A receiver has accepted a message.
    Acceptance,
    /// A message, a retrace or a new status signal has arrived, or the board's other program has progressed.
    Arrival,
    /// A retrace, which always comes, because each field begins with a retrace.
    Retrace,
    /// No event can end the wait, because the board has no program of this priority.
    Nothing,
}

impl Cause {
    /// Returns true if an event of the kind `other` can end a wait whose kind is `self`.
    fn includes(self, other: Self) -> bool {
        self == other || (self == Self::Arrival && other == Self::Retrace)
    }
}

impl Wait {
    pub(crate) const NONE: Self = Self { what: "", ended_by: Cause::Nothing };

    pub(crate) const NOT_STARTED: Self = Self { what: "", ended_by: Cause::Arrival };
}

impl Shared {
    /// Returns true if an event of the kind `cause` can end the wait of a program, or permit the DMA to send another
    /// chain.
    pub(crate) fn can_end_wait(&self, cause: Cause) -> bool {
        let next_chain = cause == Cause::Acceptance && self.in_flight.is_empty() && !self.batches.is_empty();
        next_chain || self.waits.iter().any(|wait| wait.ended_by.includes(cause))
    }

    /// Returns true if the program of this priority waits for the end of its own CPU work.
    pub(crate) fn is_at_work(&self, priority: Priority) -> bool {
        self.waits[priority as usize].ended_by == Cause::Work && !self.cpu.is_done(priority)
    }

    /// Adds a message to the inbox. Messages of the same instant are sorted by sender, so the order of their events has
    /// no effect.
    pub(crate) fn latch(&mut self, Message { source, body, .. }: Message) -> Cause {
        let arrived = self.now;
        // Insert after messages of earlier instants, and after messages of the same instant from ports with lower
        // numbers.
        let before = self.inbox.iter().rposition(|other| (other.arrived, other.source) <= (arrived, source));
        self.inbox.insert(before.map_or(0, |place| place + 1), Received { arrived, source, body });
        Cause::Arrival
    }

    pub(crate) const fn begin_field(&mut self, field: PeriodNumber) -> Cause {
        self.field = field;
        Cause::Retrace
    }

    pub(crate) fn note_accepted(&mut self, batch: u64, place: u64) -> Cause {
        // The receivers accept the messages of a batch in any order.
        let Some(i) = self.in_flight.iter().position(|flight| flight.0 == place) else { return Cause::Acceptance };
        let (_, receiver) = self.in_flight.swap_remove(i);
        self.unaccepting_receivers.retain(|node| *node != receiver);
        if self.unaccepting_receivers.is_empty() {
            self.draining = batch;
        }
        // The receivers have accepted the whole batch, so stages that waited for it end now.
        if self.in_flight.is_empty() {
            self.accepted = batch;
            while let Some((_, mark)) = self.ends.front().filter(|end| end.0.0 <= batch) {
                self.marks.push(Mark { time: self.now, ..*mark });
                self.ends.pop_front();
            }
        }
        Cause::Acceptance
    }

    /// Removes the oldest batch of messages from the queue if the DMA is free, and records its receivers.
    pub(crate) fn next_batch(&mut self) -> Option<Batch> {
        let batch = if self.in_flight.is_empty() { self.batches.pop_front() } else { None }?;
        // All messages of the batch now wait for their acceptance.
        self.in_flight.extend((0..).zip(batch.links.iter().map(|link| link.message.destination)));
        self.unaccepting_receivers.clear();
        self.unaccepting_receivers.extend(self.in_flight.iter().map(|flight| flight.1));
        Some(batch)
    }

    pub(crate) fn set_status(&mut self, from: NodeId, value: u64) -> Cause {
        match self.status.iter_mut().find(|status| status.0 == from) {
            Some(status) => status.1 = value,
            None => self.status.push((from, value)),
        }
        Cause::Arrival
    }
}

/// A program's access to its board, with the CPU priority of the program.
#[derive(Clone, Debug)]
pub struct Gp {
    pub(crate) shared: Rc<RefCell<Shared>>,
    pub(crate) priority: Priority,
}

impl Gp {
    /// Returns a handle to this board for the program of priority `priority`.
    #[must_use]
    pub fn at_priority(&self, priority: Priority) -> Self {
        Self { shared: Rc::clone(&self.shared), priority }
    }

    #[inline]
    pub fn node(&self) -> NodeId {
        self.shared.borrow().node
    }

    #[inline]
    pub fn now(&self) -> Time {
        self.shared.borrow().now
    }

    #[inline]
    pub fn timing(&self) -> GpTiming {
        self.shared.borrow().timing
    }

    /// Returns the number of the current field of the first display, which began at the last retrace.
    pub fn field(&self) -> PeriodNumber {
        self.shared.borrow().field
    }

    /// Returns the value of another board's status signal, or zero before its first change. The status signal of a
    /// frame buffer carries the number of its swaps.
    pub fn status(&self, from: NodeId) -> u64 {
        self.shared.borrow().status.iter().find(|status| status.0 == from).map_or(0, |status| status.1)
    }

    /// Waits until `ready` returns a value, and returns this value. `what` is the name of the wait in reports of
    /// deadlocks.
    ///
    /// `ready` is called again after a message, a retrace or a change of a status signal, and after progress of the
    /// other program. The acceptance of messages does not cause a call: use [`Gp::accepted`] for this.
    #[inline]
    pub async fn until<T>(&self, what: &'static str, ready: impl FnMut() -> Option<T>) -> T {
        self.wait(Wait { what, ended_by: Cause::Arrival }, ready).await
    }

    #[inline]
    async fn wait<T>(&self, wait: Wait, mut ready: impl FnMut() -> Option<T>) -> T {
        poll_fn(|_| match ready() {
            Some(value) => {
                self.shared.borrow_mut().progress += 1;
                Poll::Ready(value)
            }
            None => {
                self.shared.borrow_mut().waits[self.priority as usize] = wait;
                Poll::Pending
            }
        })
        .await
    }

    #[inline]
    pub async fn spend(&self, span: Span) {
        if span == Span::ZERO {
            return;
        }
        {
            let shared = &mut *self.shared.borrow_mut();
            shared.cpu.begin(self.priority, span, shared.now);
        }
        let wait = Wait { what: "the end of its own work", ended_by: Cause::Work };
        self.wait(wait, || self.shared.borrow().cpu.is_done(self.priority).then_some(())).await;
    }

    /// Waits until the instant `time`, if it is later than now. The wait counts as no work of the CPU.
    pub async fn sleep_until(&self, time: Time) {
        while self.now() < time {
            {
                let shared = &mut *self.shared.borrow_mut();
                shared.cpu.begin_wait(self.priority, time.since(shared.now), shared.now);
            }
            let wait = Wait { what: "an instant", ended_by: Cause::Work };
            self.wait(wait, || self.shared.borrow().cpu.is_done(self.priority).then_some(())).await;
        }
    }

    /// Waits for the next retrace, and returns the number of the field that begins then.
    pub async fn retrace(&self) -> PeriodNumber {
        self.field_from(self.field().next()).await
    }

    /// Waits until the number of the current field is at least `first`, and returns this number.
    pub async fn field_from(&self, first: PeriodNumber) -> PeriodNumber {
        let wait = Wait { what: "a retrace", ended_by: Cause::Retrace };
        self.wait(wait, || Some(self.field()).filter(|field| *field >= first)).await
    }

    /// Waits until the clump buffer (the memory for outgoing messages) is free. It is free when the receivers have
    /// accepted all earlier messages.
    #[inline]
    pub async fn clump_buffer_free(&self) {
        let issued = self.shared.borrow().issued;
        self.accepted(Ticket(issued)).await;
    }

    pub(crate) fn is_clump_buffer_free(&self) -> bool {
        let shared = self.shared.borrow();
        shared.accepted >= shared.issued
    }

    /// Waits until every receiver of a batch has accepted at least one of its messages. From then on, the DMA empties
    /// the clump buffer (the memory for outgoing messages).
    pub async fn draining(&self, ticket: Ticket) {
        let wait = Wait { what: "all receivers to begin with a clump", ended_by: Cause::Acceptance };
        self.wait(wait, || (self.shared.borrow().draining >= ticket.0).then_some(())).await;
    }

    pub async fn accepted(&self, ticket: Ticket) {
        let wait = Wait { what: "a receiver to accept a message", ended_by: Cause::Acceptance };
        self.wait(wait, || (self.shared.borrow().accepted >= ticket.0).then_some(())).await;
    }

    /// Sets the number of bytes of memory in use for the purpose `account`.
    ///
    /// # Errors
    ///
    /// Returns [`Fault::Memory`] if the bytes do not fit.
    pub fn reserve(&self, account: Account, bytes: u64, region: Option<RegionId>) -> Result<(), Fault> {
        Ok(self.shared.borrow_mut().memory.set(account, bytes, region)?)
    }

    /// Returns true if the bins of `context` (one of two sets of bins) can use `bytes` bytes while the other set keeps
    /// its size.
    pub fn has_room_for_bins(&self, context: u8, bytes: u64) -> bool {
        bytes <= self.shared.borrow().memory.room_for_bins(context)
    }

    /// Records that a decision of the program depended on a full backing store of a renderer. Takes no simulated time.
    pub fn note_full_store(&self) {
        self.shared.borrow_mut().found_store_full = true;
    }

    /// Records that a stage begins now, for observers of the run. `surface` is the surface for which the stage draws,
    /// for example the picture of an eye. It is `None` if the stage does not draw one surface at a time.
    pub fn begin(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>) {
        self.mark(stage, picture, surface, StageEdge::Begin, self.now());
    }

    /// Records that a stage ends now, for observers of the run.
    pub fn end(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>) {
        self.mark(stage, picture, surface, StageEdge::End, self.now());
    }

    /// Records the end of a stage later, when the receivers have accepted the batch `ticket`. The program does not
    /// wait.
    pub fn end_when_accepted(&self, ticket: Ticket, stage: Stage, picture: PictureNumber) {
        let shared = &mut *self.shared.borrow_mut();
        let time = shared.now;
        let node = shared.node;
        shared
            .ends
            .push_back((ticket, Mark { time, node, picture, surface: None, stage, edge: StageEdge::End, view: None }));
    }

    /// Records that a stage began or ended at `time`. The program has read this time from a message.
    pub fn mark(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>, edge: StageEdge, time: Time) {
        let shared = &mut *self.shared.borrow_mut();
        let node = shared.node;
        shared.marks.push(Mark { time, node, picture, surface, stage, edge, view: None });
    }

    /// Records that a stage begins now for a picture, which shows the view with the number `view`.
    pub fn begin_view(&self, stage: Stage, picture: PictureNumber, view: ViewNumber) {
        let shared = &mut *self.shared.borrow_mut();
        let time = shared.now;
        let node = shared.node;
        shared.marks.push(Mark { time, node, picture, surface: None, stage, edge: StageEdge::Begin, view: Some(view) });
    }
}
