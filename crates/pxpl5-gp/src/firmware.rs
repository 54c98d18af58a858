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

/// A program loaded onto a board; it ends only with a fault. It waits for one thing at a time: of futures that are polled side by side the
/// board would know the last one's wait alone.
pub type Firmware = Pin<Box<dyn Future<Output = Result<(), Fault>>>>;

/// A fault of the simulated machine that stops a program.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Fault {
    /// Something did not fit into the board's memory.
    #[error(transparent)]
    Memory(#[from] OutOfMemory),
    /// A message that the program does not understand.
    #[error("node {}: unexpected message {found}", node.0)]
    Protocol {
        /// The port of the board.
        node: NodeId,
        /// What arrived, in words.
        found: String,
    },
    /// Code did not come to its end.
    #[error(transparent)]
    Processor(#[from] ProcessorFault),
}

/// A message and when its last word arrived.
#[derive(Clone, Debug)]
pub struct Received {
    /// When its last word had arrived.
    pub arrived: Time,
    /// The port of the sender.
    pub source: NodeId,
    /// What it carried: words, or what makes them when asked.
    pub body: Body,
}

/// A batch of messages given to the DMA.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Ticket(pub(crate) u64);

/// A chain of messages that the DMA sends at once, after the chain before has been accepted.
#[derive(Debug)]
pub(crate) struct Batch {
    pub(crate) ticket: Ticket,
    pub(crate) links: Vec<ChainLink>,
}

/// A message in its chain.
#[derive(Debug)]
pub(crate) struct ChainLink {
    pub(crate) message: Message,
    /// Whether the receiver's port stays reserved for the next one.
    pub(crate) hold: bool,
}

/// What the board and its programs share.
#[derive(Debug)]
pub(crate) struct Shared {
    pub(crate) node: NodeId,
    pub(crate) now: Time,
    pub(crate) timing: GpTiming,
    pub(crate) cpu: Cpu,
    pub(crate) memory: Memory,
    /// Where the time of work comes from code.
    pub(crate) processor: Option<Box<Processor>>,
    /// Vertices transformed since the start.
    pub(crate) vertex_transforms: u64,
    pub(crate) inbox: VecDeque<Received>,
    pub(crate) batches: VecDeque<Batch>,
    /// Receivers of the messages of the batch being sent that have not been accepted, by place in the batch.
    pub(crate) in_flight: Vec<(u64, NodeId)>,
    /// Receivers that have not taken any message of that batch.
    pub(crate) not_begun: Vec<NodeId>,
    pub(crate) marks: Vec<Mark>,
    /// Ends of stages that come with the acceptance of a batch, in order.
    pub(crate) ends: VecDeque<(Ticket, Mark)>,
    pub(crate) field: PeriodNumber,
    pub(crate) status: Vec<(NodeId, u64)>,
    /// Last batch of which every receiver has taken a message, and last one of which all were accepted.
    pub(crate) draining: u64,
    pub(crate) accepted: u64,
    pub(crate) issued: u64,
    /// Counts completed waits, so that the board polls until nothing moves.
    pub(crate) progress: u64,
    pub(crate) waits: [Wait; 2],
    /// What stopped the board: software of its own that no program could do anything about.
    pub(crate) stopped_by: Option<Fault>,
}

/// What a program waits for: its name, and what can end the wait.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Wait {
    pub(crate) what: &'static str,
    pub(crate) ended_by: Cause,
}

/// What can end a wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Cause {
    /// The end of work on the board's CPU.
    Work,
    /// The acceptance of a message.
    Acceptance,
    /// A message, a retrace, a status line, or the board's other program.
    Arrival,
    /// A retrace, which always comes.
    Retrace,
    /// Nothing: there is no program.
    Nothing,
}

impl Cause {
    /// Returns true if `other` can end a wait that this cause ends.
    fn includes(self, other: Self) -> bool {
        self == other || (self == Self::Arrival && other == Self::Retrace)
    }
}

impl Wait {
    /// Where no program is loaded.
    pub(crate) const NONE: Self = Self { what: "", ended_by: Cause::Nothing };

    /// Before a program has run for the first time.
    pub(crate) const TO_BEGIN: Self = Self { what: "", ended_by: Cause::Arrival };
}

impl Shared {
    /// Whether a program's wait, or the DMA's, could be over after something has happened.
    pub(crate) fn is_woken_by(&self, cause: Cause) -> bool {
        let next_chain = cause == Cause::Acceptance && self.in_flight.is_empty() && !self.batches.is_empty();
        next_chain || self.waits.iter().any(|wait| wait.ended_by.includes(cause))
    }

    /// Whether a program waits for the end of work that goes on.
    pub(crate) fn is_at_work(&self, priority: Priority) -> bool {
        self.waits[priority as usize].ended_by == Cause::Work && !self.cpu.is_done(priority)
    }

    /// Messages of one instant are kept in order of their senders, whatever the order of their events.
    pub(crate) fn latch(&mut self, Message { source, body, .. }: Message) -> Cause {
        let arrived = self.now;
        let before = self.inbox.iter().rposition(|other| (other.arrived, other.source) <= (arrived, source));
        self.inbox.insert(before.map_or(0, |place| place + 1), Received { arrived, source, body });
        Cause::Arrival
    }

    pub(crate) const fn begin_field(&mut self, field: PeriodNumber) -> Cause {
        self.field = field;
        Cause::Retrace
    }

    pub(crate) fn note_accepted(&mut self, batch: u64, place: u64) -> Cause {
        let Some(i) = self.in_flight.iter().position(|flight| flight.0 == place) else { return Cause::Acceptance };
        let (_, receiver) = self.in_flight.swap_remove(i);
        self.not_begun.retain(|node| *node != receiver);
        if self.not_begun.is_empty() {
            self.draining = batch;
        }
        if self.in_flight.is_empty() {
            self.accepted = batch;
            while let Some((_, mark)) = self.ends.front().filter(|end| end.0.0 <= batch) {
                self.marks.push(Mark { time: self.now, ..*mark });
                self.ends.pop_front();
            }
        }
        Cause::Acceptance
    }

    /// The next batch, if the DMA is free.
    pub(crate) fn next_batch(&mut self) -> Option<Batch> {
        let batch = if self.in_flight.is_empty() { self.batches.pop_front() } else { None }?;
        self.in_flight.extend((0..).zip(batch.links.iter().map(|link| link.message.destination)));
        self.not_begun.clear();
        self.not_begun.extend(self.in_flight.iter().map(|flight| flight.1));
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

/// A program's handle to its board, which knows at which priority the program runs.
#[derive(Clone, Debug)]
pub struct Gp {
    pub(crate) shared: Rc<RefCell<Shared>>,
    pub(crate) priority: Priority,
}

impl Gp {
    /// The same board for a program of another priority.
    #[must_use]
    pub fn at_priority(&self, priority: Priority) -> Self {
        Self { shared: Rc::clone(&self.shared), priority }
    }

    /// The ring port of this board.
    #[must_use]
    pub fn node(&self) -> NodeId {
        self.shared.borrow().node
    }

    /// The present instant of simulated time.
    #[must_use]
    pub fn now(&self) -> Time {
        self.shared.borrow().now
    }

    /// The board's timing table.
    #[must_use]
    pub fn timing(&self) -> GpTiming {
        self.shared.borrow().timing
    }

    /// The period that the first display is in: the field that is being scanned, which the last retrace began.
    #[must_use]
    pub fn field(&self) -> PeriodNumber {
        self.shared.borrow().field
    }

    /// The status line of another board (how often a frame buffer has swapped); zero before it first changed.
    #[must_use]
    pub fn status(&self, from: NodeId) -> u64 {
        self.shared.borrow().status.iter().find(|status| status.0 == from).map_or(0, |status| status.1)
    }

    /// Waits until `ready` gives something; `what` names the wait in a report of a deadlock.
    ///
    /// `ready` is asked again when a message, a retrace or a status line has arrived and when a program of this board has
    /// come on; for the acceptance of messages there is [`Gp::accepted`].
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

    /// Waits until the present field is `first` or a later one, and returns it.
    pub async fn field_from(&self, first: PeriodNumber) -> PeriodNumber {
        let wait = Wait { what: "a retrace", ended_by: Cause::Retrace };
        self.wait(wait, || Some(self.field()).filter(|field| *field >= first)).await
    }

    /// Waits until the clump buffer is free: everything sent before has been accepted.
    pub async fn clump_buffer_free(&self) {
        let issued = self.shared.borrow().issued;
        self.accepted(Ticket(issued)).await;
    }

    /// Waits until every receiver of a batch has accepted a message of it: its clump buffer is being emptied.
    pub async fn draining(&self, ticket: Ticket) {
        let wait = Wait { what: "all receivers to begin with a clump", ended_by: Cause::Acceptance };
        self.wait(wait, || (self.shared.borrow().draining >= ticket.0).then_some(())).await;
    }

    /// Waits until a batch has been accepted by its receivers.
    pub async fn accepted(&self, ticket: Ticket) {
        let wait = Wait { what: "a receiver to accept a message", ended_by: Cause::Acceptance };
        self.wait(wait, || (self.shared.borrow().accepted >= ticket.0).then_some(())).await;
    }

    /// Sets the bytes that an account of the memory holds.
    ///
    /// # Errors
    ///
    /// [`Fault::Memory`] when they do not fit.
    pub fn reserve(&self, account: Account, bytes: u64, region: Option<RegionId>) -> Result<(), Fault> {
        Ok(self.shared.borrow_mut().memory.set(account, bytes, region)?)
    }

    /// Whether the bins of a context would fit beside those that the other context holds now.
    #[must_use]
    pub fn has_room_for_bins(&self, context: u8, bytes: u64) -> bool {
        bytes <= self.shared.borrow().memory.room_for_bins(context)
    }

    /// Tells the observer that a stage begins.
    pub fn begin(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>) {
        self.mark(stage, picture, surface, StageEdge::Begin, self.now());
    }

    /// Tells the observer that a stage ends.
    pub fn end(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>) {
        self.mark(stage, picture, surface, StageEdge::End, self.now());
    }

    /// Tells the observer that a stage ends when a batch is accepted; the program goes on.
    pub fn end_when_accepted(&self, ticket: Ticket, stage: Stage, picture: PictureNumber) {
        let shared = &mut *self.shared.borrow_mut();
        let time = shared.now;
        let node = shared.node;
        shared
            .ends
            .push_back((ticket, Mark { time, node, picture, surface: None, stage, edge: StageEdge::End, view: None }));
    }

    /// Tells the observer of a stage's edge at a time that the program has read off a message.
    pub fn mark(&self, stage: Stage, picture: PictureNumber, surface: Option<SurfaceId>, edge: StageEdge, time: Time) {
        let shared = &mut *self.shared.borrow_mut();
        let node = shared.node;
        shared.marks.push(Mark { time, node, picture, surface, stage, edge, view: None });
    }

    /// Tells the observer that a stage begins on a picture that shows view number `view`.
    pub fn begin_view(&self, stage: Stage, picture: PictureNumber, view: ViewNumber) {
        let shared = &mut *self.shared.borrow_mut();
        let time = shared.now;
        let node = shared.node;
        shared.marks.push(Mark { time, node, picture, surface: None, stage, edge: StageEdge::Begin, view: Some(view) });
    }
}
