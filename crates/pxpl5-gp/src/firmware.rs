//! The interface between a program and its board.

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

/// A program on a board, which ends only with a fault.
/// A program must wait for one future at a time. If it polls several futures side by side, the board knows only the
/// last wait.
pub type Firmware = Pin<Box<dyn Future<Output = Result<(), Fault>>>>;

/// A fault of the simulated machine that stops a program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Data did not fit into the board's memory.
    #[error(transparent)]
    Memory(#[from] OutOfMemory),
    /// A message that the program does not expect.
    #[error("node {}: unexpected message {found}", node.0)]
    Protocol {
        /// Port of the board that received the message.
        node: NodeId,
        /// Description of the message.
        found: String,
    },
    /// i860 code trapped, did not end or had no memory.
    #[error(transparent)]
    Processor(#[from] ProcessorFault),
}

/// A message, with the arrival time of its last word.
#[derive(Clone, Debug)]
pub struct Received {
    /// Arrival time of the last word.
    pub arrived: Time,
    /// Port of the sender.
    pub source: NodeId,
    /// Content of the message: words, commands or pixels.
    pub body: Body,
}

/// The number of a batch of messages given to the DMA.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ticket(pub(crate) u64);

/// A chain of messages that the DMA sends at once, after the previous chain was accepted.
#[derive(Debug)]
pub(crate) struct Batch {
    pub(crate) ticket: Ticket,
    pub(crate) links: Vec<ChainLink>,
}

/// One message of a chain.
#[derive(Debug)]
pub(crate) struct ChainLink {
    pub(crate) message: Message,
    /// True if the receiver's port stays reserved for the next message.
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
    /// Processor that runs i860 code; `None` if times come from the timing table.
    pub(crate) processor: Option<Box<Processor>>,
    /// Number of vertices transformed since the start.
    pub(crate) vertex_transforms: u64,
    /// CPU time that the software of messages has asked for, and the work of answers to messages.
    pub(crate) message_software: Span,
    pub(crate) answer_work: Span,
    pub(crate) inbox: VecDeque<Received>,
    pub(crate) batches: VecDeque<Batch>,
    /// Messages of the current batch that were not accepted yet: their places in the batch and their receivers.
    pub(crate) in_flight: Vec<(u64, NodeId)>,
    /// Receivers that have not accepted any message of the current batch.
    pub(crate) unaccepting_receivers: Vec<NodeId>,
    pub(crate) marks: Vec<Mark>,
    /// Marks for ends of stages that wait for the acceptance of a batch, in order.
    pub(crate) ends: VecDeque<(Ticket, Mark)>,
    pub(crate) field: PeriodNumber,
    pub(crate) status: Vec<(NodeId, u64)>,
    /// Number of the last batch of which every receiver has accepted a message, then number of the last completely
    /// accepted batch.
    pub(crate) draining: u64,
    pub(crate) accepted: u64,
    pub(crate) issued: u64,
    /// Number of completed waits. The board polls its programs until this number stays the same.
    pub(crate) progress: u64,
    pub(crate) waits: [Wait; 2],
    /// Fault of the board's own software, which stops all programs.
    pub(crate) software_fault: Option<Fault>,
}

/// A wait of a program: its name, and the cause that can end it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wait {
    pub(crate) what: &'static str,
    pub(crate) ended_by: Cause,
}

/// A cause that can end a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cause {
    /// The end of work on the board's CPU.
    Work,
    /// The acceptance of a message by its receiver.
    Acceptance,
    /// A message, a retrace, a status line, or progress of the board's other program.
    Arrival,
    /// A retrace, which always comes.
    Retrace,
    /// No cause: no program is loaded.
    Nothing,
}

impl Cause {
    /// Returns true if `other` can end a wait that this cause ends.
    fn includes(self, other: Self) -> bool {
        self == other || (self == Self::Arrival && other == Self::Retrace)
    }
}

impl Wait {
    /// The wait of a priority without a program.
    pub(crate) const NONE: Self = Self { what: "", ended_by: Cause::Nothing };

    /// The wait of a program that has not run yet.
    pub(crate) const NOT_STARTED: Self = Self { what: "", ended_by: Cause::Arrival };
}

impl Shared {
    /// Returns true if a cause can end the wait of a program or of the DMA.
    pub(crate) fn can_end_wait(&self, cause: Cause) -> bool {
        let next_chain = cause == Cause::Acceptance && self.in_flight.is_empty() && !self.batches.is_empty();
        next_chain || self.waits.iter().any(|wait| wait.ended_by.includes(cause))
    }

    /// Returns true if a program waits for the end of work that is not finished.
    pub(crate) fn is_at_work(&self, priority: Priority) -> bool {
        self.waits[priority as usize].ended_by == Cause::Work && !self.cpu.is_done(priority)
    }

    /// Adds a message to the inbox. Messages of one instant are sorted by sender, so that the order of their events
    /// does not matter.
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

    /// Returns the next batch if the DMA is free, and records its receivers.
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

/// A program's handle to its board, with the priority of the program.
#[derive(Clone, Debug)]
pub struct Gp {
    pub(crate) shared: Rc<RefCell<Shared>>,
    pub(crate) priority: Priority,
}

impl Gp {
    /// Returns a handle to the same board for a program of another priority.
    #[must_use]
    pub fn at_priority(&self, priority: Priority) -> Self {
        Self { shared: Rc::clone(&self.shared), priority }
    }

    /// Returns the ring port of this board.
    #[must_use]
    pub fn node(&self) -> NodeId {
        self.shared.borrow().node
    }

    /// Returns the current simulated time.
    #[must_use]
    pub fn now(&self) -> Time {
        self.shared.borrow().now
    }

    /// Returns the board's timing table.
    #[must_use]
    pub fn timing(&self) -> GpTiming {
        self.shared.borrow().timing
    }

    /// Returns the current field of the first display: the period that began with the last retrace.
    #[must_use]
    pub fn field(&self) -> PeriodNumber {
        self.shared.borrow().field
    }

    /// Returns the value of another board's status line, for example the number of swaps of a frame buffer. The value
    /// is zero before its first change.
    #[must_use]
    pub fn status(&self, from: NodeId) -> u64 {
        self.shared.borrow().status.iter().find(|status| status.0 == from).map_or(0, |status| status.1)
    }

    /// Waits until `ready` returns a value. `what` names the wait in a report of a deadlock.
    ///
    /// The board calls `ready` again after a message, a retrace or a change of a status line, and after progress of
    /// another program of this board. To wait for the acceptance of messages, use [`Gp::accepted`].
    pub async fn until<T>(&self, what: &'static str, ready: impl FnMut() -> Option<T>) -> T {
        self.wait(Wait { what, ended_by: Cause::Arrival }, ready).await
    }

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

    /// Spends CPU time at this program's priority.
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

    /// Waits for the next retrace and returns the field that it begins.
    pub async fn retrace(&self) -> PeriodNumber {
        self.field_from(self.field().next()).await
    }

    /// Waits until the current field is `first` or a later one, and returns it.
    pub async fn field_from(&self, first: PeriodNumber) -> PeriodNumber {
        let wait = Wait { what: "a retrace", ended_by: Cause::Retrace };
        self.wait(wait, || Some(self.field()).filter(|field| *field >= first)).await
    }

    /// Waits until the clump buffer is free, that is, until all earlier messages were accepted.
    pub async fn clump_buffer_free(&self) {
        let issued = self.shared.borrow().issued;
        self.accepted(Ticket(issued)).await;
    }

    /// Waits until every receiver of a batch has accepted at least one message, so that the clump buffer is being
    /// emptied.
    pub async fn draining(&self, ticket: Ticket) {
        let wait = Wait { what: "all receivers to begin with a clump", ended_by: Cause::Acceptance };
        self.wait(wait, || (self.shared.borrow().draining >= ticket.0).then_some(())).await;
    }

    /// Waits until the receivers have accepted all messages of a batch.
    pub async fn accepted(&self, ticket: Ticket) {
        let wait = Wait { what: "a receiver to accept a message", ended_by: Cause::Acceptance };
        self.wait(wait, || (self.shared.borrow().accepted >= ticket.0).then_some(())).await;
    }

    /// Sets the number of bytes that an account of the memory holds.
    ///
    /// # Errors
    ///
    /// [`Fault::Memory`] if the bytes do not fit.
    pub fn reserve(&self, account: Account, bytes: u64, region: Option<RegionId>) -> Result<(), Fault> {
        Ok(self.shared.borrow_mut().memory.set(account, bytes, region)?)
    }

    /// Returns true if `bytes` of bins of a context fit beside the bins that the other context holds now.
    #[must_use]
    pub fn has_room_for_bins(&self, context: u8, bytes: u64) -> bool {
        bytes <= self.shared.borrow().memory.room_for_bins(context)
    }

    /// Records the begin of a stage for the observer.
    pub fn begin(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>) {
        self.mark(stage, picture, surface, StageEdge::Begin, self.now());
    }

    /// Records the end of a stage for the observer.
    pub fn end(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>) {
        self.mark(stage, picture, surface, StageEdge::End, self.now());
    }

    /// Records the end of a stage for the time at which a batch is accepted. The program continues at once.
    pub fn end_when_accepted(&self, ticket: Ticket, stage: Stage, picture: PictureNumber) {
        let shared = &mut *self.shared.borrow_mut();
        let time = shared.now;
        let node = shared.node;
        shared
            .ends
            .push_back((ticket, Mark { time, node, picture, surface: None, stage, edge: StageEdge::End, view: None }));
    }

    /// Records a begin or end of a stage at a time that the program has read from a message.
    pub fn mark(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>, edge: StageEdge, time: Time) {
        let shared = &mut *self.shared.borrow_mut();
        let node = shared.node;
        shared.marks.push(Mark { time, node, picture, surface, stage, edge, view: None });
    }

    /// Records the begin of a stage for a picture that shows view number `view`.
    pub fn begin_view(&self, stage: Stage, picture: PictureNumber, view: ViewNumber) {
        let shared = &mut *self.shared.borrow_mut();
        let time = shared.now;
        let node = shared.node;
        shared.marks.push(Mark { time, node, picture, surface: None, stage, edge: StageEdge::Begin, view: Some(view) });
    }
}
