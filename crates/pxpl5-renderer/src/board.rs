//! The board: input FIFO and controller on one side, the port to the frame buffers on the other.

use crate::command::CommandKind;
use crate::contents::{MAX_CONTEXTS, changes_pixels, words_before_clear};
use crate::fifo::{EqualCommands, InputFifo, Progress};
use crate::job::{ArrayPool, NoPixels, PixelJob};
use crate::look::{RendererLook, SentLists};
use crate::timing::RendererTiming;
use crate::{Lanes, PixelArray};
use pxpl5_sim::{Blocked, Context, Phase, Span, Time};
use pxpl5_wire::{
    Body, COPY_ACKNOWLEDGEMENT_WORDS, CommandContent, CommandList, CommandRun, CopyOrder, CopyTarget, CopyWay,
    MAX_MESSAGE_WORDS, Message, NodeId, PixelSource, RegionPixels,
};
use std::collections::VecDeque;
use std::sync::{Arc, OnceLock};

/// What can happen to the board.
#[derive(Clone, Debug)]
pub enum RendererEvent {
    /// A message begins to arrive (phase `Arrive`).
    Announce {
        /// Commands for the FIFO, or words that mean nothing here.
        message: Message,
        /// Its first word is on the channel from here on.
        first_word_at: Time,
    },
    /// The controller starts the next copy command.
    CopyBegins,
    /// The region's colours are in the backing store.
    Stored,
    /// The ring has delivered the last pixel of the region being copied (phase `Arrive`).
    Sent,
}

/// What leaves the board.
#[derive(Debug)]
pub enum RendererOutput {
    /// The last word of the announced message enters the FIFO at this time.
    Accept {
        /// When the word is in the FIFO: a word time for each word, and the time for which there was no room.
        last_word_at: Time,
    },
    /// A message for the ring.
    Send {
        /// Pixels of a region, or the acknowledgement of a copy.
        message: Message,
        /// Whether [`RendererEvent::Sent`] shall come back.
        ticket: bool,
        /// Whether the receiver's port stays reserved for the next message.
        hold: bool,
    },
}

/// What the board has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct RendererStats {
    /// Commands in all lists that were received, copies and unknown ones included.
    pub commands: u64,
    /// Words that were received, without the overhead of their messages on the ring.
    pub words: u64,
    /// Regions whose last pixel a frame buffer has received.
    pub regions_copied: u64,
    /// Commands with an operation code that no command has; they are skipped.
    pub illegal_commands: u64,
}

/// One renderer board: its FIFO and controller in time, the pixels of its regions as jobs that are computed when somebody
/// looks.
#[derive(Debug)]
pub struct Renderer {
    node: NodeId,
    timing: RendererTiming,
    cycle: Span,
    fifo: InputFifo,
    pool: Arc<ArrayPool>,
    /// Whether regions without primitives are kept, and what touches no pixel is left out.
    saves_regions: bool,
    logs: [ContextLog; MAX_CONTEXTS],
    copies: VecDeque<PendingCopy>,
    /// The transfer to a frame buffer that is going on.
    copying: Option<CopyOrder>,
    /// Copies through the backing store whose regions are in pixel memory; the first may be on its way.
    unstored: VecDeque<PendingCopy>,
    storing: bool,
    /// Copies whose regions are in the backing store and wait for the transfer before them, or for their release.
    stored: VecDeque<PendingCopy>,
    /// When somebody watches: what was sent, to know what of it has been executed.
    sent: Option<SentLists>,
    stats: RendererStats,
}

/// What was sent to a region context, as far as it can still be seen.
#[derive(Clone, Debug, Default)]
struct ContextLog {
    cleared: bool,
    /// Shared with the pixels of regions that were copied.
    lists: Arc<Vec<CommandContent>>,
}

impl ContextLog {
    /// What was sent before is seen no more, unless it was copied.
    fn clear(&mut self) {
        self.cleared = true;
        match Arc::get_mut(&mut self.lists) {
            Some(lists) => lists.clear(),
            // As much room: the next picture's region is much like this one's.
            None => self.lists = Arc::new(Vec::with_capacity(self.lists.len())),
        }
    }
}

/// A copy command in the FIFO, with what its region holds when it executes.
#[derive(Debug)]
struct PendingCopy {
    order: CopyOrder,
    image: Arc<dyn PixelSource>,
    /// Whether it may leave the backing store as soon as it is in it.
    is_released: bool,
}

impl Renderer {
    /// A renderer at a port. `word` is the word time of a channel, `cycle` what a signal needs to leave the board.
    #[must_use]
    pub fn new(node: NodeId, timing: RendererTiming, word: Span, cycle: Span, pool: Arc<ArrayPool>) -> Self {
        let fifo = InputFifo::new(timing.fifo_words as u32, word);
        let logs = std::array::from_fn(|_| ContextLog::default());
        let stats = RendererStats::default();
        Self {
            node,
            timing,
            cycle,
            fifo,
            pool,
            saves_regions: true,
            logs,
            copies: VecDeque::new(),
            copying: None,
            unstored: VecDeque::new(),
            storing: false,
            stored: VecDeque::new(),
            sent: None,
            stats,
        }
    }

    /// Handles one event at `context.now()`; what follows from it is scheduled or put out through `context`.
    pub fn handle(&mut self, event: RendererEvent, context: &mut Context<RendererEvent, RendererOutput>) {
        match event {
            RendererEvent::Announce { message, first_word_at } => self.announce(message, first_word_at, context),
            RendererEvent::CopyBegins => self.copy(context),
            RendererEvent::Stored => self.stored(context),
            RendererEvent::Sent => self.copied(context),
        }
    }

    fn announce(&mut self, message: Message, begins: Time, context: &mut Context<RendererEvent, RendererOutput>) {
        self.note(&message, context.now());
        match message.body {
            Body::Commands(list) => self.take(list),
            // Words of no known command still occupy the FIFO and are thrown away.
            Body::Pixels(_) | Body::Words(_) => {
                self.stats.illegal_commands += 1;
                self.fifo.take(EqualCommands { words_each: message.words, count: 1, span_each: Some(Span::ZERO) });
            }
        }
        let progress = self.fifo.message(begins);
        self.report(progress, context);
    }

    /// Keeps what somebody who watches must know of a message.
    fn note(&mut self, message: &Message, now: Time) {
        let first_word = self.stats.words;
        self.stats.words += u64::from(message.words);
        if let Some(sent) = &mut self.sent {
            let started = self.fifo.passed(now).map_or(0, |passed| passed.started);
            sent.add(message, first_word, started);
            self.fifo.forget_before(now);
        }
    }

    fn report(&self, progress: Progress, context: &mut Context<RendererEvent, RendererOutput>) {
        if let Some(last_word_at) = progress.accepted {
            context.output(context.now() + self.cycle, RendererOutput::Accept { last_word_at });
        }
        if let Some(start) = progress.blocks {
            context.schedule(start, Phase::Work, RendererEvent::CopyBegins);
        }
    }

    fn take(&mut self, list: CommandList) {
        let log = &mut self.logs[usize::from(list.context) % MAX_CONTEXTS];
        if words_before_clear(&list.runs).is_some() {
            log.clear();
        }
        if let Some(content) = list.content.filter(|_| changes_pixels(&list.runs)) {
            Arc::make_mut(&mut log.lists).push(content);
        }
        for order in &list.copies {
            let image = self.image(order);
            let is_released = order.way != CopyWay::IntoBacking;
            self.copies.push_back(PendingCopy { order: *order, image, is_released });
        }
        for run in &list.runs {
            let work = self.work(run);
            self.fifo.take(work);
        }
    }

    fn work(&mut self, run: &CommandRun) -> EqualCommands {
        self.stats.commands += u64::from(run.count);
        let span_each = match CommandKind::from_opcode(run.opcode) {
            Some(kind) => self.timing.span(kind),
            None => {
                self.stats.illegal_commands += u64::from(run.count);
                Some(Span::ZERO)
            }
        };
        EqualCommands { words_each: run.words_each, count: run.count, span_each }
    }

    fn image(&self, order: &CopyOrder) -> Arc<dyn PixelSource> {
        let [_, _, width, height] = order.target.grid.rectangle(order.target.region);
        let ContextLog { cleared, lists } = self.logs[usize::from(order.context) % MAX_CONTEXTS].clone();
        if lists.is_empty() {
            return Arc::new(NoPixels { words: width * height * order.content.words() });
        }
        Arc::new(PixelJob {
            pool: Arc::clone(&self.pool),
            lists,
            cleared,
            saves: self.saves_regions,
            target: order.target,
            content: order.content,
            done: OnceLock::new(),
        })
    }

    fn copy(&mut self, context: &mut Context<RendererEvent, RendererOutput>) {
        let Some(copy) = self.copies.pop_front() else {
            // A copy command without an order addresses no frame buffer; it ends at once.
            self.stats.illegal_commands += 1;
            let progress = self.fifo.resume(context.now());
            return self.report(progress, context);
        };
        match copy.order.way {
            CopyWay::FromPixelMemory => self.transfer(&copy, context),
            CopyWay::FromBacking => self.release(copy.order.target, context),
            CopyWay::ThroughBacking | CopyWay::IntoBacking => {
                self.unstored.push_back(copy);
                self.store_next(context);
            }
        }
    }

    /// Lets a kept region leave the backing store; a command for one that is not there is none.
    fn release(&mut self, target: CopyTarget, context: &mut Context<RendererEvent, RendererOutput>) {
        let kept = self.stored.iter_mut().chain(&mut self.unstored);
        let found = kept.filter(|copy| !copy.is_released).find(|copy| copy.order.target == target);
        match found {
            Some(copy) => copy.is_released = true,
            None => self.stats.illegal_commands += 1,
        }
        let progress = self.fifo.resume(context.now());
        self.report(progress, context);
        self.transfer_next(context);
    }

    /// Moves a finished region's colours (and depths, a block of their own) to the backing store when there is a place for them; the
    /// controller is free when they are there.
    fn store_next(&mut self, context: &mut Context<RendererEvent, RendererOutput>) {
        let Some(blocks) = self.unstored.front().map(|copy| u64::from(copy.order.content.words())) else { return };
        let held: u64 = self
            .stored
            .iter()
            .map(|copy| &copy.order)
            .chain(&self.copying)
            .map(|order| u64::from(order.content.words()))
            .sum();
        if self.storing || held + blocks > self.timing.backing_regions() {
            return;
        }
        self.storing = true;
        let stored_at = context.now() + self.timing.backing_block() * blocks;
        context.schedule(stored_at, Phase::Work, RendererEvent::Stored);
        let progress = self.fifo.resume(stored_at);
        self.report(progress, context);
    }

    fn stored(&mut self, context: &mut Context<RendererEvent, RendererOutput>) {
        self.storing = false;
        self.stored.extend(self.unstored.pop_front());
        self.transfer_next(context);
        self.store_next(context);
    }

    fn transfer_next(&mut self, context: &mut Context<RendererEvent, RendererOutput>) {
        if self.copying.is_some() {
            return;
        }
        let released = self.stored.iter().position(|copy| copy.is_released);
        if let Some(copy) = released.and_then(|place| self.stored.remove(place)) {
            self.transfer(&copy, context);
        }
    }

    fn transfer(
        &mut self,
        PendingCopy { order, image, .. }: &PendingCopy,
        context: &mut Context<RendererEvent, RendererOutput>,
    ) {
        self.copying = Some(*order);
        let [_, _, width, height] = order.target.grid.rectangle(order.target.region);
        let all = width * height * order.content.words();
        let parts = all.div_ceil(MAX_MESSAGE_WORDS);
        for part in 0..parts {
            let words = MAX_MESSAGE_WORDS.min(all - part * MAX_MESSAGE_WORDS);
            let body = Body::Pixels(RegionPixels { target: order.target, image: Arc::clone(image), part, parts });
            let message = Message { source: self.node, destination: order.target.frame_buffer, words, body };
            let last = part + 1 == parts;
            let output = RendererOutput::Send { message, ticket: last, hold: !last };
            context.output(context.now() + self.cycle, output);
        }
    }

    fn copied(&mut self, context: &mut Context<RendererEvent, RendererOutput>) {
        let Some(order) = self.copying.take() else { return };
        self.stats.regions_copied += 1;
        if let Some(destination) = order.acknowledge {
            let body = Body::Words(order.target.acknowledgement());
            let message = Message { source: self.node, destination, words: COPY_ACKNOWLEDGEMENT_WORDS, body };
            context.output(context.now() + self.cycle, RendererOutput::Send { message, ticket: false, hold: false });
        }
        if order.way == CopyWay::FromPixelMemory {
            let progress = self.fifo.resume(context.now());
            self.report(progress, context);
        }
        self.transfer_next(context);
        self.store_next(context);
    }

    /// What the board has done so far.
    #[must_use]
    pub const fn stats(&self) -> RendererStats {
        self.stats
    }

    /// Time spent executing commands, without copies.
    #[must_use]
    pub const fn busy(&self) -> Span {
        self.fifo.busy()
    }

    /// Pixel memory with what has been sent to each region context since it was cleared; `None` where no context was sent pixels'
    /// words, as where pixels are off.
    #[must_use]
    pub fn pixel_memory(&self) -> Option<Lanes> {
        if self.logs.iter().all(|log| log.lists.is_empty()) {
            return None;
        }
        let mut array = Lanes::new(self.pool.layout());
        for list in self.logs.iter().flat_map(|log| log.lists.iter()) {
            let mut words = Vec::new();
            list.append_words(&mut words);
            // A fault stops the list, as on the hardware; what was drawn before stays.
            let _ = array.execute(&words);
        }
        Some(array)
    }

    /// Draws all that is sent to regions from now on, though it may touch none of their pixels, and keeps none.
    pub const fn draw_every_region(&mut self) {
        self.saves_regions = false;
    }

    /// Keeps from now on when words come into the FIFO and leave it.
    pub fn watch_fifo(&mut self) {
        self.fifo.watch();
        self.sent.get_or_insert_default();
    }

    /// What the board does at an instant that is not before the last event. Looking changes nothing.
    #[must_use]
    pub fn look(&self, now: Time) -> RendererLook {
        let passed = self.fifo.passed(now);
        RendererLook {
            fifo_words: passed.map(|passed| (passed.entered - passed.started) as u32),
            fifo_depth_words: self.timing.fifo_words as u32,
            stands_at_copy: self.fifo.is_blocked(),
            copying: self.copying,
            stored_regions: self.stored.len() + self.unstored.len(),
            busy: self.fifo.busy(),
        }
    }

    /// The array as far as commands have started at an instant that is not before the last event: each counts as executed when it
    /// starts. `None` where nobody [watches](Renderer::watch_fifo), and where no words of pixels were sent. Looking changes nothing.
    #[must_use]
    pub fn array_at(&self, now: Time) -> Option<Lanes> {
        let started = self.fifo.passed(now)?.started;
        self.sent.as_ref()?.executed(started, self.pool.layout())
    }

    /// When words of a whole command had come in (positive) and when a command started and its words left (negative)
    /// since the last call, in no order. Times may lie ahead: they follow from what is known now.
    pub fn take_fifo_changes(&mut self) -> Vec<(Time, i64)> {
        self.fifo.take_changes()
    }

    /// What the board waits for.
    #[must_use]
    pub fn blocked(&self, name: &str) -> Option<Blocked> {
        let order = self.copying.filter(|_| self.fifo.is_blocked())?;
        let waits_for =
            format!("frame buffer at node {} to take region {}", order.target.frame_buffer.0, order.target.region.0);
        Some(Blocked { board: name.to_owned(), waits_for })
    }
}
