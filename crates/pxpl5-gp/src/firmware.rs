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

/// A program on a board. The program runs forever or ends with a fault. A program must await only one future at a time,
/// because the board records only one wait for each program.
pub type Firmware = Pin<Box<dyn Future<Output = Result<(), Fault>>>>;

/// A fault of the simulated machine that stops a program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Data did not fit into the memory of the board.
    #[error(transparent)]
    Memory(#[from] OutOfMemory),
    /// The program has received a message that it does not expect.
    #[error("node {}: unexpected message {found}", node.0)]
    Protocol {
        /// Ring port of the board that received the message.
        node: NodeId,
        /// Description of the unexpected message.
        found: String,
    },
    /// The i860 code trapped, did not return, or needed more memory than was free.
    #[error(transparent)]
    Processor(#[from] ProcessorFault),
}

/// A received message, with the arrival time of its last word.
#[derive(Clone, Debug)]
pub struct Received {
    /// Arrival time of the last word of the message.
    pub arrived: Time,
    /// Ring port of the board that sends the message.
    pub source: NodeId,
    /// Content of the message: words, commands or pixels.
    pub body: Body,
}

/// The number of a batch of messages that a program has passed to the DMA. The DMA (direct memory access) is the part
/// of the board that sends messages in the background.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ticket(pub(crate) u64);

/// A chain of messages that the DMA sends together, after the receivers have accepted the previous chain.
#[derive(Debug)]
pub(crate) struct Batch {
    pub(crate) ticket: Ticket,
    pub(crate) links: Vec<ChainLink>,
}

#[derive(Debug)]
pub(crate) struct ChainLink {
    pub(crate) message: Message,
    /// True if the receiver's port stays reserved for the next message of this board.
    pub(crate) hold: bool,
}

/// State shared by the board and its programs.
#[derive(Debug)]
pub(crate) struct Shared {
    pub(crate) node: NodeId,
    pub(crate) now: Time,
    pub(crate) timing: GpTiming,
    pub(crate) cpu: Cpu,
    pub(crate) memory: Memory,
    /// The i860 that runs code, or `None` if all times come from the timing table.
    pub(crate) processor: Option<Box<Processor>>,
    /// Number of vertices that the programs have transformed since the start of the simulation.
    pub(crate) vertex_transforms: u64,
    /// True if a decision of a program has depended on the fact that a backing store was full.
    pub(crate) found_store_full: bool,
    /// CPU time requested so far for the message software.
    pub(crate) message_software: Span,
    /// CPU time requested so far for work that answers messages.
    pub(crate) answer_work: Span,
    pub(crate) inbox: VecDeque<Received>,
    pub(crate) batches: VecDeque<Batch>,
    /// Messages of the current batch (the messages that were sent together) that the receivers have not accepted yet.
    /// Each entry has the message's index in the batch and its receiver.
    pub(crate) in_flight: Vec<(u64, NodeId)>,
    /// Receivers that have accepted no message of the current batch so far.
    pub(crate) unaccepting_receivers: Vec<NodeId>,
    pub(crate) marks: Vec<Mark>,
    /// Records of ends of stages that must be made when a batch of messages is accepted. Each entry has the number of
    /// the batch and the record. The entries are sorted by batch.
    pub(crate) ends: VecDeque<(Ticket, Mark)>,
    pub(crate) field: PeriodNumber,
    pub(crate) status: Vec<(NodeId, u64)>,
    /// Number of the last batch of messages for which every receiver has accepted at least one message.
    pub(crate) draining: u64,
    /// Number of the last batch of messages that the receivers have accepted completely.
    pub(crate) accepted: u64,
    pub(crate) issued: u64,
    /// Number of waits that have ended so far. The board polls all its programs again and again until this number stays
    /// the same.
    pub(crate) progress: u64,
    pub(crate) waits: [Wait; 2],
    /// Fault in the message software of the board. This fault stops all programs.
    pub(crate) software_fault: Option<Fault>,
}

/// A wait of a program: the name of the condition, and the kind of event that can make the condition true.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wait {
    pub(crate) what: &'static str,
    pub(crate) ended_by: Cause,
}

/// A kind of event that can end the wait of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cause {
    /// Work on the board's CPU has ended.
    Work,
    /// A receiver has accepted a message.
    Acceptance,
    /// A message, a retrace or a new value of a status signal has arrived, or the board's other program has progressed.
    Arrival,
    /// A retrace. Each field begins with a retrace, so a wait for a retrace always ends.
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
    /// The wait that is recorded for a priority without a program.
    pub(crate) const NONE: Self = Self { what: "", ended_by: Cause::Nothing };

    /// The wait that is recorded for a program before its first poll.
    pub(crate) const NOT_STARTED: Self = Self { what: "", ended_by: Cause::Arrival };
}

impl Shared {
    /// Returns true if an event of the kind `cause` can end the wait of a program, or can allow the DMA to send another
    /// chain.
    pub(crate) fn can_end_wait(&self, cause: Cause) -> bool {
        let next_chain = cause == Cause::Acceptance && self.in_flight.is_empty() && !self.batches.is_empty();
        next_chain || self.waits.iter().any(|wait| wait.ended_by.includes(cause))
    }

    /// Returns true if the program of this priority waits for the end of its own CPU work.
    pub(crate) fn is_at_work(&self, priority: Priority) -> bool {
        self.waits[priority as usize].ended_by == Cause::Work && !self.cpu.is_done(priority)
    }

    /// Adds a message to the inbox. Messages that arrive at the same instant are sorted by sender, so the order in
    /// which the events are handled has no effect.
    pub(crate) fn latch(&mut self, Message { source, body, .. }: Message) -> Cause {
        let arrived = self.now;
        // Insert after all messages of earlier instants and lower senders.
        let before = self.inbox.iter().rposition(|other| (other.arrived, other.source) <= (arrived, source));
        self.inbox.insert(before.map_or(0, |place| place + 1), Received { arrived, source, body });
        Cause::Arrival
    }

    pub(crate) const fn begin_field(&mut self, field: PeriodNumber) -> Cause {
        self.field = field;
        Cause::Retrace
    }

    pub(crate) fn note_accepted(&mut self, batch: u64, place: u64) -> Cause {
        // Messages of a batch are accepted one by one, in any order.
        let Some(i) = self.in_flight.iter().position(|flight| flight.0 == place) else { return Cause::Acceptance };
        let (_, receiver) = self.in_flight.swap_remove(i);
        self.unaccepting_receivers.retain(|node| *node != receiver);
        if self.unaccepting_receivers.is_empty() {
            self.draining = batch;
        }
        // The whole batch is accepted: stages that waited for it end now.
        if self.in_flight.is_empty() {
            self.accepted = batch;
            while let Some((_, mark)) = self.ends.front().filter(|end| end.0.0 <= batch) {
                self.marks.push(Mark { time: self.now, ..*mark });
                self.ends.pop_front();
            }
        }
        Cause::Acceptance
    }

    /// If the DMA is free, removes the oldest waiting batch of messages, records its receivers, and returns the batch.
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

/// A program's handle to its board. The handle contains the CPU priority of the program.
#[derive(Clone, Debug)]
pub struct Gp {
    pub(crate) shared: Rc<RefCell<Shared>>,
    pub(crate) priority: Priority,
}

impl Gp {
    /// Returns a handle to the same board for the program of the CPU priority `priority`.
    #[must_use]
    pub fn at_priority(&self, priority: Priority) -> Self {
        Self { shared: Rc::clone(&self.shared), priority }
    }

    /// Returns the ring port of this board.
    #[must_use]
    #[inline]
    pub fn node(&self) -> NodeId {
        self.shared.borrow().node
    }

    /// Returns the current simulated time.
    #[must_use]
    #[inline]
    pub fn now(&self) -> Time {
        self.shared.borrow().now
    }

    /// Returns the board's timing table.
    #[must_use]
    #[inline]
    pub fn timing(&self) -> GpTiming {
        self.shared.borrow().timing
    }

    /// Returns the number of the current field of the first display. This field began at the last retrace.
    #[must_use]
    pub fn field(&self) -> PeriodNumber {
        self.shared.borrow().field
    }

    /// Returns the value of another board's status signal. The status signal of a frame buffer carries the number of
    /// its swaps. The value is zero before the first change.
    #[must_use]
    pub fn status(&self, from: NodeId) -> u64 {
        self.shared.borrow().status.iter().find(|status| status.0 == from).map_or(0, |status| status.1)
    }

    /// Waits until `ready` returns a value, and returns this value. `what` is the name of the wait in a deadlock
    /// report.
    ///
    /// The board calls `ready` again after a message, a retrace or a change of a status signal, and after progress of
    /// the board's other program. To wait for the acceptance of messages, use [`Gp::accepted`].
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

    /// Spends CPU time at the priority of this program.
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

    /// Waits for the next retrace and returns the number of the field that begins at this retrace.
    pub async fn retrace(&self) -> PeriodNumber {
        self.field_from(self.field().next()).await
    }

    /// Waits until the number of the current field is at least `first`, and returns the number.
    pub async fn field_from(&self, first: PeriodNumber) -> PeriodNumber {
        let wait = Wait { what: "a retrace", ended_by: Cause::Retrace };
        self.wait(wait, || Some(self.field()).filter(|field| *field >= first)).await
    }

    /// Waits until the clump buffer, the memory for outgoing messages, is free. The buffer is free when the receivers
    /// have accepted all earlier messages.
    #[inline]
    pub async fn clump_buffer_free(&self) {
        let issued = self.shared.borrow().issued;
        self.accepted(Ticket(issued)).await;
    }

    /// Waits until every receiver of a batch of messages has accepted at least one message. From this time on, the DMA
    /// empties the clump buffer (the memory for outgoing messages).
    pub async fn draining(&self, ticket: Ticket) {
        let wait = Wait { what: "all receivers to begin with a clump", ended_by: Cause::Acceptance };
        self.wait(wait, || (self.shared.borrow().draining >= ticket.0).then_some(())).await;
    }

    /// Waits until the receivers have accepted all messages of a batch.
    pub async fn accepted(&self, ticket: Ticket) {
        let wait = Wait { what: "a receiver to accept a message", ended_by: Cause::Acceptance };
        self.wait(wait, || (self.shared.borrow().accepted >= ticket.0).then_some(())).await;
    }

    /// Sets the number of memory bytes that the purpose `account` uses.
    ///
    /// # Errors
    ///
    /// Returns [`Fault::Memory`] if the bytes do not fit.
    pub fn reserve(&self, account: Account, bytes: u64, region: Option<RegionId>) -> Result<(), Fault> {
        Ok(self.shared.borrow_mut().memory.set(account, bytes, region)?)
    }

    /// Returns true if the bins of `context` can occupy `bytes` bytes of memory beside the bins of the other context. A
    /// context is one of two sets of bins.
    #[must_use]
    pub fn has_room_for_bins(&self, context: u8, bytes: u64) -> bool {
        bytes <= self.shared.borrow().memory.room_for_bins(context)
    }

    /// Records that a decision of the program depended on the fact that the backing store of a renderer was full. The
    /// record takes no time.
    pub fn note_full_store(&self) {
        self.shared.borrow_mut().found_store_full = true;
    }

    /// Records, for observers of the run, that a stage begins now. `surface` is the surface (such as the picture of an
    /// eye) for which the stage draws. `surface` is `None` if the stage does not draw one surface at a time.
    pub fn begin(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>) {
        self.mark(stage, picture, surface, StageEdge::Begin, self.now());
    }

    /// Records that a stage ends now, for observers of the run.
    pub fn end(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>) {
        self.mark(stage, picture, surface, StageEdge::End, self.now());
    }

    /// Records the end of a stage at the time at which the receivers have accepted the batch `ticket`. The program
    /// continues immediately.
    pub fn end_when_accepted(&self, ticket: Ticket, stage: Stage, picture: PictureNumber) {
        let shared = &mut *self.shared.borrow_mut();
        let time = shared.now;
        let node = shared.node;
        shared
            .ends
            .push_back((ticket, Mark { time, node, picture, surface: None, stage, edge: StageEdge::End, view: None }));
    }

    /// Records that a stage began or ended at `time`, which the program has read from a message.
    pub fn mark(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>, edge: StageEdge, time: Time) {
        let shared = &mut *self.shared.borrow_mut();
        let node = shared.node;
        shared.marks.push(Mark { time, node, picture, surface, stage, edge, view: None });
    }

    /// Records that a stage begins now for a picture. `view` is the number of the view that the picture shows.
    pub fn begin_view(&self, stage: Stage, picture: PictureNumber, view: ViewNumber) {
        let shared = &mut *self.shared.borrow_mut();
        let time = shared.now;
        let node = shared.node;
        shared.marks.push(Mark { time, node, picture, surface: None, stage, edge: StageEdge::Begin, view: Some(view) });
    }
}
