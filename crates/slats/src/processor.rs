//! The programs of a graphics processor (GP) under Slats.

use crate::bind::{Binding, BoundRegion, CopySchedule};
use crate::config::SlatsConfig;
use pphigs::{FrameView, PROGRAM_BYTES, Pass, RegionEnvelope, Share, TransformWork, copy_message, region_messages};
use pxpl5_gp::{Account, Chain, Fault, Gp, Priority, Received, Stage, Ticket};
use pxpl5_sim::parameters::SettingError;
use pxpl5_wire::{
    Body, COPY_ACKNOWLEDGEMENT, CommandList, CopyContent, CopyOrder, CopyPath, Eye, FieldParity, NodeId, PeriodNumber,
    PictureNumber, Word, swap_request,
};
use std::cell::RefCell;
use std::collections::VecDeque;
use std::rc::Rc;
use std::sync::Arc;

/// Largest number of primitives in a clump. The commands of a clump for one region fit into one message (TR94).
pub const CLUMP: usize = 30;

/// First word of a message to the first graphics processor: all clumps of the sender were accepted. The number of the
/// field follows.
const CLUMPS_ACCEPTED: Word = 0x000C_1A3D;

/// First word of a message from the first graphics processor to the other graphics processors: begin a field. The
/// number and the view of the field follow.
const BEGIN: Word = 0x00BE_6123;

#[derive(Debug, Default)]
struct ProcessorState {
    newest: Option<FrameView>,
    /// Fields that this graphics processor must still draw. Empty on the first graphics processor.
    begun: VecDeque<(PeriodNumber, FrameView)>,
    /// Number of renderers that have reported the end of their copies since the newest copy order.
    copied: usize,
    bottom: Option<Bottom>,
    /// Index of the buffer with the last complete field, for even and for odd lines.
    complete: [u8; 2],
    /// For each unfinished field, the number of graphics processors that have reported the end of their work.
    finished: Vec<(PeriodNumber, usize)>,
}

/// The copies of a field's bottom regions, as a chain of messages that is ready to start.
#[derive(Debug)]
struct Bottom {
    chain: Chain,
    field: PeriodNumber,
    /// Earliest period in which the copies may start. Without a second buffer, this is the period that shows the field.
    not_before: PeriodNumber,
    /// Number of renderers that must acknowledge the copies of their top regions before the chain starts.
    copiers: usize,
    /// True if one of the board's two programs is about to start the chain. The other program must then not start the
    /// chain.
    is_taken: bool,
}

type SharedState = Rc<RefCell<ProcessorState>>;

/// Returns the two programs of a graphics processor, with their priorities. `index` is the index of the processor.
///
/// Each program fails with [`Fault::Memory`] if the display list does not fit into memory. A program fails with
/// [`Fault::Protocol`] for an unknown message.
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
    // Both programs share the state of the board.
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

#[derive(Clone, Copy, Debug)]
struct Backup {
    frame_buffers: [NodeId; 2],
}

enum Event {
    Message(Received),
    Retrace(PeriodNumber),
}

/// Runs the interrupt program, which receives all messages. When the top regions are copied, the program starts the
/// copies of the bottom regions.
///
/// With a backup buffer, the program also selects the buffer that the displays show in each period.
async fn listen(gp: Gp, state: SharedState, backup: Option<Backup>) -> Result<(), Fault> {
    let mut present = gp.field();
    loop {
        // With a backup buffer, a retrace also ends the wait.
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
                // Request the field for the next period early. A later request can replace this request.
                present = field;
                if let Some(backup) = backup {
                    backup.ask(&gp, &state, field.next()).await;
                }
            }
        }
    }
}

impl Backup {
    /// Records that a field is complete. If `field` is the number of the next period, the function also requests that
    /// the frame buffers show the field at the next retrace.
    ///
    /// The field counts as complete before its bottom regions are copied, because the copies are faster than the beam.
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

    /// Requests that the frame buffers show the last complete field with the lines (even or odd) of `period`. If
    /// `period` has already begun, the function requests nothing.
    ///
    /// A later request replaces an earlier request.
    async fn ask(self, gp: &Gp, state: &SharedState, period: PeriodNumber) {
        let buffer = state.borrow().complete[FieldParity::of_field(period) as usize];
        let requests = self.frame_buffers.map(|node| (node, 2, Body::Words(swap_request(buffer))));
        let chain = gp.prepare(requests.to_vec()).await;
        if gp.field() < period {
            gp.start(chain);
        }
    }
}

/// Starts the copies of a field's bottom regions, if all top regions are copied and the period [`Bottom::not_before`]
/// has begun.
///
/// With a backup buffer, the function first requests the display of the field. The copies would otherwise delay this
/// request at the ports of the frame buffers.
async fn copy_bottom_when_due(gp: &Gp, state: &SharedState, backup: Option<Backup>) {
    // Decide within one borrow, and mark the chain as taken. In the steps below, the program can wait while the other
    // program runs.
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
    fn note(&mut self, words: &[Word]) -> Result<(), SettingError> {
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

    /// Runs the program of the first graphics processor. At each retrace, the program begins a new field, if the
    /// previous field is finished.
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
            // Clear the regions before the other GPs may send clumps.
            if !self.is_alone() {
                self.bottom_started().await;
                self.clear(field, &view).await;
                self.send_to_followers(field, &view).await;
            }
            self.field(field, &view).await?;
            // COPY begins when the clumps of all GPs have been accepted.
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
                // Prepare the chain for the bottom regions before it is due.
                let chain = self.gp.prepare(self.copies(field, false)).await;
                // With a backup buffer, the beam scans the other buffer, so the copy need not wait for the period.
                let not_before = if self.config.copy == CopySchedule::Backup { PeriodNumber::FIRST } else { field };
                let bottom = Bottom { chain, field, not_before, copiers, is_taken: false };
                self.state.borrow_mut().bottom = Some(bottom);
                copy_bottom_when_due(&self.gp, &self.state, self.backup).await;
            }
            begin_at = if self.gp.field() < field { field } else { self.gp.field().next() };
        }
    }

    /// Waits until the bottom regions of the previous field are being copied. The first clump of the next field clears
    /// these regions.
    async fn bottom_started(&self) {
        self.gp.until("the copies of the top regions", || self.state.borrow().bottom.is_none().then_some(())).await;
    }

    /// Returns the next field to draw, which is normally the field after `now`.
    ///
    /// With a backup buffer, a field with the same lines as the field `last` is skipped. Even and odd lines are then
    /// renewed in turn, even if fields are late.
    fn next_field(&self, now: PeriodNumber, last: Option<PeriodNumber>) -> PeriodNumber {
        let field = now.next();
        let same_lines = last.is_some_and(|last| FieldParity::of_field(last) == FieldParity::of_field(field));
        if self.config.copy == CopySchedule::Backup && same_lines { field.next() } else { field }
    }

    fn buffer(&self, field: PeriodNumber) -> u8 {
        let complete = self.state.borrow().complete[FieldParity::of_field(field) as usize];
        if self.config.copy == CopySchedule::Backup { 1 - complete } else { 0 }
    }

    /// Runs the program of every graphics processor except the first. The program draws a share of each field that the
    /// first graphics processor begins.
    async fn follow(self) -> Result<(), Fault> {
        loop {
            let (field, view) =
                self.gp.until("the leading processor", || self.state.borrow_mut().begun.pop_front()).await;
            self.field(field, &view).await?;
            // This message is sent after the clumps, so the leading GP receives it only after the acceptance of the
            // clumps.
            let [low, high] = field.to_words();
            let words = [CLUMPS_ACCEPTED, low, high];
            self.gp.send(self.config.processors[0], 3, Body::Words(words.into())).await;
        }
    }

    /// Returns true if there is only one graphics processor. The first clump of a single processor also clears the
    /// regions.
    fn is_alone(&self) -> bool {
        self.config.processors.len() == 1
    }

    /// Clears all regions before the other graphics processors send their clumps.
    ///
    /// With several graphics processors, the first clump of one processor cannot clear the regions, because clumps of
    /// another processor may arrive earlier.
    async fn clear(&self, field: PeriodNumber, view: &FrameView) {
        let picture = self.config.picture(FieldParity::of_field(field));
        let nothing = self.share.nothing();
        let passes = Eye::BOTH.map(|eye| nothing.transform(view, eye.index(), picture));
        self.send(&passes, true).await;
    }

    async fn send_to_followers(&self, field: PeriodNumber, view: &FrameView) {
        let [low, high] = field.to_words();
        let words: Arc<[Word]> = [vec![BEGIN, low, high], view.to_words()].concat().into();
        let others = self.config.processors.iter().skip(1);
        let messages = others.map(|node| (*node, words.len() as u32, Body::Words(Arc::clone(&words))));
        self.gp.send_batch(messages.collect()).await;
    }

    async fn field(&self, field: PeriodNumber, view: &FrameView) -> Result<(), Fault> {
        let number = PictureNumber::drawn_for(field);
        self.gp.begin_view(Stage::Sample, number, view.number);
        self.gp.begin(Stage::Transform, number, None);
        let picture = self.config.picture(FieldParity::of_field(field));
        let mut clumps: Vec<_> = self.share.clumps(CLUMP).collect();
        if clumps.is_empty() {
            // Regions must be cleared even if there is no primitive.
            clumps.push(self.share.clone());
        }
        let last = clumps.len() - 1;
        // For each clump: TRANSFORM, then send it to its regions.
        for (i, clump) in clumps.iter().enumerate() {
            let passes = Eye::BOTH.map(|eye| clump.transform(view, eye.index(), picture));
            self.gp.work(&TransformWork { passes: &passes, context: 0, begins: i == 0 }).await?;
            self.gp.clump_buffer_free().await;
            if i == 0 {
                self.bottom_started().await;
                self.gp.begin(Stage::Render, number, None);
            }
            let sent = self.send(&passes, i == 0 && self.is_alone()).await;
            // A GP has only one clump buffer. The next clump is made in this buffer while the DMA empties the buffer.
            if let Some(ticket) = sent.filter(|_| i < last) {
                self.gp.draining(ticket).await;
            }
        }
        self.gp.end(Stage::Transform, number, None);
        Ok(())
    }

    /// Sends a clump to its regions. If `begin` is true, the messages also clear the regions. Returns `None` if no
    /// region needs a message.
    async fn send(&self, passes: &[Arc<Pass>; 2], begin: bool) -> Option<Ticket> {
        let envelope = RegionEnvelope { begin, ..RegionEnvelope::default() };
        let lists = self.binding.regions().iter().flat_map(|bound| {
            let lists = region_messages(&passes[bound.eye.index()], bound.region, bound.context, envelope);
            let frame_buffer = self.config.frame_buffers[bound.eye.index()];
            lists.into_iter().map(move |list| self.addressed(bound.renderer, list.for_frame_buffer(frame_buffer)))
        });
        let batch: Vec<_> = lists.collect();
        if batch.is_empty() { None } else { Some(self.gp.send_batch(batch).await) }
    }

    fn addressed(&self, renderer: usize, list: CommandList) -> (NodeId, u32, Body) {
        (self.config.renderers[renderer], list.words(), Body::Commands(list))
    }

    /// Returns the copy commands for the top regions if `top` is true, otherwise for the bottom regions. If copies are
    /// not split, the commands for the top regions also copy the bottom regions.
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
            way: CopyPath::FromPixelMemory,
            acknowledge: None,
            content: CopyContent::Colour,
        }
    }
}
