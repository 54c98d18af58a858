//! A graphics processor under Slats.

use crate::bind::{Binding, BoundRegion};
use crate::config::SlatsConfig;
use crate::schedule::CopySchedule;
use pphigs::{
    FrameView, PROGRAM_BYTES, Pass, RegionEnvelope, Share, Transforming, ViewWordsError, copy_message, region_messages,
};
use pxpl5_gp::{Account, Chain, Fault, Gp, Priority, Received, Stage, Ticket};
use pxpl5_wire::{
    Body, COPY_ACKNOWLEDGEMENT, CommandList, CopyContent, CopyOrder, CopyWay, Eye, FieldParity, NodeId, PeriodNumber,
    PictureNumber, Word, swap_request,
};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

/// Primitives of a clump: what fits into one message (TR94).
pub const CLUMP: usize = 30;

/// First word of the message that tells the leading GP that a field's clumps have been accepted.
const CLUMPS_ACCEPTED: Word = 0x000C_1A3D;

/// First word of the message by which the leading GP begins a field on the others; number and view follow.
const BEGIN: Word = 0x00BE_6123;

#[derive(Debug, Default)]
struct ProcessorState {
    /// The newest view from the host, on the leading GP.
    newest: Option<FrameView>,
    /// Fields that the leading GP has begun, on the others.
    begun: VecDeque<(PeriodNumber, FrameView)>,
    /// Renderers that have acknowledged the last region which they were told to copy, since they were told so.
    copied: usize,
    /// The copies of the bottom regions, which wait for those of the top ones.
    bottom: Option<Bottom>,
    /// Buffer that holds the last complete field of even and of odd lines.
    complete: [u8; 2],
    /// How many other GPs have finished each of the fields being drawn: (field, GPs).
    finished: Vec<(PeriodNumber, usize)>,
}

/// The chain that has the bottom regions of a field copied, ready to be started.
#[derive(Debug)]
struct Bottom {
    chain: Chain,
    /// The field that they belong to.
    field: PeriodNumber,
    /// The period that must have begun, if the beam scans the lines until then.
    not_before: PeriodNumber,
    /// Renderers that copy top regions: all must have acknowledged them.
    copiers: usize,
    /// True while the field is asked for, just before the chain is started.
    is_taken: bool,
}

type SharedState = Rc<RefCell<ProcessorState>>;

/// The programs of GP number `index`, for both levels of its board.
///
/// Each fails with [`Fault::Memory`] when the display list does not fit, and with [`Fault::Protocol`] for a message
/// that no board sends.
pub fn processor(
    gp: &Gp,
    config: &SlatsConfig,
    binding: &Binding,
    share: Share,
    index: usize,
) -> [(Priority, impl Future<Output = Result<(), Fault>> + use<>); 2] {
    let state = SharedState::default();
    let is_shown = index == 0 && config.copy == CopySchedule::Backup;
    let backup = is_shown.then_some(Backup { frame_buffers: config.frame_buffers });
    [Priority::Interrupt, Priority::Foreground].map(|level| {
        let gp = gp.at_priority(level);
        let config = config.clone();
        let binding = binding.clone();
        let share = share.clone();
        let state = Rc::clone(&state);
        let program = async move {
            match level {
                Priority::Foreground => {
                    SlatsProcessor { gp, config, binding, share, state, index, backup }.fields().await
                }
                Priority::Interrupt => listen(gp, state, backup).await,
            }
        };
        (level, program)
    })
}

/// The frame buffers and the buffers of which they show the last complete fields, under [`CopySchedule::Backup`].
#[derive(Clone, Copy, Debug)]
struct Backup {
    frame_buffers: [NodeId; 2],
}

/// What the interrupt program wakes up for.
enum Event {
    Message(Received),
    Retrace(PeriodNumber),
}

/// Keeps the newest view, counts finished GPs, has the bottom regions copied after the top ones, and with a backup asks for the field that
/// the next retrace begins with.
async fn listen(gp: Gp, state: SharedState, backup: Option<Backup>) -> Result<(), Fault> {
    let mut present = gp.field();
    loop {
        let event = gp
            .until("a message", || {
                let retrace = || Some(gp.field()).filter(|field| backup.is_some() && *field > present);
                gp.take_message().map(Event::Message).or_else(|| retrace().map(Event::Retrace))
            })
            .await;
        match event {
            Event::Message(received) => {
                gp.pay_for(&received).await;
                let Body::Words(words) = &received.body else {
                    let found = "of commands or pixels at a processor".to_owned();
                    return Err(Fault::Protocol { node: gp.node(), found });
                };
                let note = state.borrow_mut().note(words);
                note.map_err(|error| Fault::Protocol { node: gp.node(), found: error.to_string() })?;
                copy_bottom_when_due(&gp, &state, backup).await;
            }
            Event::Retrace(field) => {
                present = field;
                if let Some(backup) = backup {
                    backup.ask(&gp, &state, field.next()).await;
                }
            }
        }
    }
}

impl Backup {
    /// Notes that all top regions of a field are copied, and asks for it if the next retrace is its own. Its bottom regions follow, faster than
    /// the beam.
    async fn show_next(self, gp: &Gp, state: &SharedState, field: PeriodNumber) {
        {
            let state = &mut *state.borrow_mut();
            let complete = &mut state.complete[FieldParity::of_field(field) as usize];
            *complete = 1 - *complete;
        }
        if gp.field().next() == field {
            self.ask(gp, state, field).await;
        }
    }

    /// Asks for the last complete field of the lines that a period scans, unless it has begun meanwhile. A later request takes the place of
    /// an earlier one.
    async fn ask(self, gp: &Gp, state: &SharedState, period: PeriodNumber) {
        let buffer = state.borrow().complete[FieldParity::of_field(period) as usize];
        let requests = self.frame_buffers.map(|node| (node, 2, Body::Words(swap_request(buffer))));
        let chain = gp.prepare(requests.to_vec()).await;
        if gp.field() < period {
            gp.start(chain);
        }
    }
}

/// Starts the copies of the bottom regions of a field when all its top regions are copied and the beam has left the lines. With a backup the
/// field is asked for before: afterwards the ports of the frame buffers are taken by regions.
async fn copy_bottom_when_due(gp: &Gp, state: &SharedState, backup: Option<Backup>) {
    let due = {
        let state = &mut *state.borrow_mut();
        let copied = state.copied;
        let is_due =
            |bottom: &&mut Bottom| !bottom.is_taken && copied >= bottom.copiers && gp.field() >= bottom.not_before;
        state.bottom.as_mut().filter(is_due).map(|bottom| {
            bottom.is_taken = true;
            bottom.field
        })
    };
    let Some(field) = due else { return };
    if let Some(backup) = backup {
        backup.show_next(gp, state, field).await;
    }
    let bottom = state.borrow_mut().bottom.take();
    if let Some(bottom) = bottom {
        gp.start(bottom.chain);
    }
}

impl ProcessorState {
    fn note(&mut self, words: &[Word]) -> Result<(), ViewWordsError> {
        match words {
            [COPY_ACKNOWLEDGEMENT, ..] => self.copied += 1,
            [CLUMPS_ACCEPTED, low, high] => self.note_finished(PeriodNumber::from_words(*low, *high)),
            [BEGIN, low, high, view @ ..] => {
                self.begun.push_back((PeriodNumber::from_words(*low, *high), FrameView::from_words(view)?));
            }
            view => self.newest = Some(FrameView::from_words(view)?),
        }
        Ok(())
    }

    fn note_finished(&mut self, field: PeriodNumber) {
        match self.finished.iter_mut().find(|entry| entry.0 == field) {
            Some(entry) => entry.1 += 1,
            None => self.finished.push((field, 1)),
        }
    }

    fn finished(&mut self, field: PeriodNumber) -> usize {
        self.finished.retain(|entry| entry.0 >= field);
        self.finished.iter().find(|entry| entry.0 == field).map_or(0, |entry| entry.1)
    }
}

struct SlatsProcessor {
    gp: Gp,
    config: SlatsConfig,
    binding: Binding,
    share: Share,
    state: SharedState,
    index: usize,
    backup: Option<Backup>,
}

impl SlatsProcessor {
    async fn fields(self) -> Result<(), Fault> {
        self.gp.reserve(Account::Program, PROGRAM_BYTES, None)?;
        self.gp.reserve(Account::DisplayList, self.share.bytes(), None)?;
        self.gp.install(|processor| self.share.install(processor))?;
        if self.index == 0 { self.lead().await } else { self.follow().await }
    }

    /// Begins a field at every retrace at which the one before is done.
    async fn lead(self) -> Result<(), Fault> {
        self.gp.until("the first view from the host", || self.state.borrow().newest.as_ref().map(|_| ())).await;
        let mut begin_at = self.gp.field().next();
        let mut last = None;
        loop {
            let now = self.gp.field_from(begin_at).await;
            copy_bottom_when_due(&self.gp, &self.state, self.backup).await;
            let field = self.next_field(now, last);
            last = Some(field);
            let view = self.gp.until("a view", || self.state.borrow().newest.clone()).await;
            if !self.is_alone() {
                self.bottom_started().await;
                self.clear(field, &view).await;
                self.tell_others(field, &view).await;
            }
            self.field(field, &view).await?;
            let others = self.config.processors.len() - 1;
            self.gp
                .until("the clumps of the other processors", || {
                    (self.state.borrow_mut().finished(field) >= others).then_some(())
                })
                .await;
            self.gp.end(Stage::Render, PictureNumber::drawn_for(field), None);
            let copies = self.copies(field, true);
            let copiers = copies.len();
            self.state.borrow_mut().copied = 0;
            self.gp.send_batch(copies).await;
            if self.config.copy.is_split() {
                // The chain for the bottom regions is ready before it is due.
                let chain = self.gp.prepare(self.copies(field, false)).await;
                // With a backup the beam is in the other buffer.
                let not_before = if self.config.copy == CopySchedule::Backup { PeriodNumber::FIRST } else { field };
                let bottom = Bottom { chain, field, not_before, copiers, is_taken: false };
                self.state.borrow_mut().bottom = Some(bottom);
                copy_bottom_when_due(&self.gp, &self.state, self.backup).await;
            }
            begin_at = if self.gp.field() < field { field } else { self.gp.field().next() };
        }
    }

    /// Waits until the bottom regions of the field before are being copied: what is sent afterwards clears them.
    async fn bottom_started(&self) {
        self.gp.until("the copies of the top regions", || self.state.borrow().bottom.is_none().then_some(())).await;
    }

    /// The period for which the next field is drawn: the coming one. With a backup it is one of the other lines than the last field's, so
    /// that neither lines stay without a new field when fields are late.
    fn next_field(&self, now: PeriodNumber, last: Option<PeriodNumber>) -> PeriodNumber {
        let field = now.next();
        let same_lines = last.is_some_and(|last| FieldParity::of_field(last) == FieldParity::of_field(field));
        if self.config.copy == CopySchedule::Backup && same_lines { field.next() } else { field }
    }

    /// Where a field is written.
    fn buffer(&self, field: PeriodNumber) -> u8 {
        let complete = self.state.borrow().complete[FieldParity::of_field(field) as usize];
        if self.config.copy == CopySchedule::Backup { 1 - complete } else { 0 }
    }

    /// Draws its share of every field that the leading GP begins.
    async fn follow(self) -> Result<(), Fault> {
        loop {
            let (field, view) =
                self.gp.until("the leading processor", || self.state.borrow_mut().begun.pop_front()).await;
            self.field(field, &view).await?;
            // Queued behind the clumps, so it arrives when they have been accepted.
            let [low, high] = field.to_words();
            let words = [CLUMPS_ACCEPTED, low, high];
            self.gp.send(self.config.processors[0], 3, Body::Words(words.into())).await;
        }
    }

    /// Whether no other GP draws; then the regions are cleared by the first clump.
    fn is_alone(&self) -> bool {
        self.config.processors.len() == 1
    }

    /// Clears all regions by a chain of its own. A chain waits for the one before it, so whoever is told to begin after
    /// this one cannot send a clump that is cleared away.
    async fn clear(&self, field: PeriodNumber, view: &FrameView) {
        let picture = self.config.picture(FieldParity::of_field(field));
        let nothing = self.share.nothing();
        let passes = Eye::BOTH.map(|eye| nothing.transform(view, eye.index(), picture));
        self.send(&passes, true).await;
    }

    async fn tell_others(&self, field: PeriodNumber, view: &FrameView) {
        let [low, high] = field.to_words();
        let words: Arc<[Word]> = [vec![BEGIN, low, high], view.to_words()].concat().into();
        let others = self.config.processors.iter().skip(1);
        let messages = others.map(|node| (*node, words.len() as u32, Body::Words(Arc::clone(&words))));
        self.gp.send_batch(messages.collect()).await;
    }

    /// Draws this GP's share of what is shown from the retrace of `field` on.
    async fn field(&self, field: PeriodNumber, view: &FrameView) -> Result<(), Fault> {
        let number = PictureNumber::drawn_for(field);
        self.gp.begin_view(Stage::Sample, number, view.number);
        self.gp.begin(Stage::Transform, number, None);
        let picture = self.config.picture(FieldParity::of_field(field));
        let mut clumps: Vec<_> = self.share.clumps(CLUMP).collect();
        if clumps.is_empty() {
            // Without a primitive the regions must be cleared all the same.
            clumps.push(self.share.clone());
        }
        let last = clumps.len() - 1;
        for (i, clump) in clumps.iter().enumerate() {
            let passes = Eye::BOTH.map(|eye| clump.transform(view, eye.index(), picture));
            self.gp.work(&Transforming { passes: &passes, context: 0, begins: i == 0 }).await?;
            self.gp.clump_buffer_free().await;
            if i == 0 {
                self.bottom_started().await;
                self.gp.begin(Stage::Render, number, None);
            }
            let sent = self.send(&passes, i == 0 && self.is_alone()).await;
            // There is no second buffer: the next clump is made in this one while it is emptied.
            if let Some(ticket) = sent.filter(|_| i < last) {
                self.gp.draining(ticket).await;
            }
        }
        self.gp.end(Stage::Transform, number, None);
        Ok(())
    }

    /// Sends a clump to all its regions as one chain of messages.
    async fn send(&self, passes: &[Arc<Pass>; 2], begin: bool) -> Option<Ticket> {
        let envelope = RegionEnvelope { begin, ..RegionEnvelope::default() };
        let lists = self.binding.regions().iter().flat_map(|bound| {
            let lists = region_messages(&passes[bound.eye.index()], bound.region, bound.context, envelope);
            lists.into_iter().map(|list| self.addressed(bound.renderer, list))
        });
        let batch: Vec<_> = lists.collect();
        if batch.is_empty() { None } else { Some(self.gp.send_batch(batch).await) }
    }

    fn addressed(&self, renderer: usize, list: CommandList) -> (NodeId, u32, Body) {
        (self.config.renderers[renderer], list.words(), Body::Commands(list))
    }

    /// The copy commands of the top regions and, of a whole copy, the bottom ones; or of the bottom regions.
    fn copies(&self, field: PeriodNumber, top: bool) -> Vec<(NodeId, u32, Body)> {
        let batch = (0..self.binding.renderers()).filter_map(|renderer| {
            let regions = self.binding.copies(renderer, top);
            let mut orders: Vec<_> = regions.iter().map(|bound| self.order(bound, field)).collect();
            if let Some(last) = orders.last_mut().filter(|_| self.config.copy.is_split() && top) {
                last.acknowledge = Some(self.gp.node());
            }
            let list = copy_message(self.config.layout, orders, self.config.pixels);
            (!regions.is_empty()).then(|| self.addressed(renderer, list))
        });
        batch.collect()
    }

    fn order(&self, bound: &BoundRegion, field: PeriodNumber) -> CopyOrder {
        CopyOrder {
            target: self.config.target(bound, field, self.buffer(field)),
            context: bound.context,
            way: CopyWay::FromPixelMemory,
            acknowledge: None,
            content: CopyContent::Colour,
        }
    }
}

#[cfg(test)]
mod tests;
