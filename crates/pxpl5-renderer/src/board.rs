//! The renderer board: an input FIFO for commands, a controller that executes the commands, and an output port to the
//! frame buffers.

use crate::command::CommandKind;
use crate::contents::{MAX_CONTEXTS, changes_pixels, words_before_clear};
use crate::fifo::{Block, CommandBatch, InputFifo, Progress};
use crate::job::{ArrayPool, NoPixels, PixelJob};
use crate::snapshot::{RendererSnapshot, SentLists};
use crate::timing::RendererTiming;
use crate::{Lanes, PixelArray};
use pxpl5_sim::{Context, Phase, Span, Time};
use pxpl5_wire::{
    Body, COPY_ACKNOWLEDGEMENT_WORDS, CommandContent, CommandList, CommandRun, CopyOrder, CopyPath, CopyTarget,
    MAX_MESSAGE_WORDS, Message, NodeId, PixelSource, RegionPixels,
};
use std::collections::VecDeque;
use std::sync::{Arc, OnceLock};

#[derive(Clone, Debug)]
pub enum RendererEvent {
    /// The first word of a message arrives. The event must be scheduled in phase `Arrive`.
    Announce {
        /// Message with commands for the FIFO. Words that are not commands are discarded and counted as illegal.
        message: Message,
        first_word_at: Time,
    },
    /// The controller starts a copy command, which copies a region to a frame buffer.
    CopyBegins,
    /// The colours of the region to copy are now complete in the backing store.
    Stored,
    /// The last pixel of a copied region has arrived at its frame buffer. The event must be scheduled in phase
    /// `Arrive`.
    Sent,
}

#[derive(Debug)]
pub enum RendererOutput {
    /// The renderer has accepted an announced message. The sender needs the time at which the last word of the message
    /// enters the FIFO.
    Accept {
        /// Time at which the last word of the message is in the FIFO. Each word takes one word time of the channel,
        /// plus the time that it waits for room in the FIFO.
        last_word_at: Time,
    },
    Send {
        /// The pixels of a region, or the acknowledgement of a copy.
        message: Message,
        /// True if the ring must report the delivery of the message with [`RendererEvent::Sent`].
        ticket: bool,
        /// True if the ring must keep the receiver's port reserved for the next message of this renderer.
        hold: bool,
    },
}

/// Counters of a renderer board since the start of the simulation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct RendererStats {
    /// Number of commands received, including copies and unknown commands.
    pub commands: u64,
    /// Number of words of received commands. The words that the ring adds to transport messages do not count.
    pub words: u64,
    /// Number of regions whose last pixel has arrived at a frame buffer.
    pub regions_copied: u64,
    /// Number of commands that were skipped because their operation code is unknown.
    pub illegal_commands: u64,
}

/// One renderer board. The simulation computes the times of the FIFO and the controller by events. The pixels of a
/// region are computed only when they are read.
#[derive(Debug)]
pub struct Renderer {
    node: NodeId,
    timing: RendererTiming,
    cycle: Span,
    fifo: InputFifo,
    pool: Arc<ArrayPool>,
    /// True while two optimizations are on: the board caches the pixels of regions without primitives, and skips
    /// commands that touch no pixel.
    caches_empty_regions: bool,
    logs: [ContextLog; MAX_CONTEXTS],
    copies: VecDeque<PendingCopy>,
    copying: Option<CopyOrder>,
    /// Copies that go through the backing store, but whose regions are still in pixel memory. The first of these
    /// regions can be on its way to the backing store.
    unstored: VecDeque<PendingCopy>,
    storing: bool,
    /// Copies whose regions are in the backing store. Each copy waits for the end of an earlier transfer to a frame
    /// buffer, or for a command that releases the region.
    stored: VecDeque<PendingCopy>,
    /// Command lists received so far. `None` unless [`Renderer::watch_fifo`] was called.
    sent: Option<SentLists>,
    /// Regions whose copy commands have started since the last call of `drain_drawn`.
    drawn: Vec<DrawnRegion>,
    stats: RendererStats,
    waited_for_room: bool,
}

/// A region that a renderer has drawn, with the times of the region's commands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DrawnRegion {
    /// Frame buffer that receives the region, and the place of the region in the picture.
    pub target: CopyTarget,
    /// Length, in words, of the message that transfers the pixels of the region to the frame buffer.
    pub words: u32,
    /// Time at which the controller finished its work on the region before this region.
    pub begun_at: Time,
    /// End of the last command before the copy command. From this time on, the controller waited for the copy command.
    pub finished_at: Time,
    /// Start time of the copy command. This time is later than `finished_at` if the copy command arrived later.
    pub copy_at: Time,
    /// Time since `begun_at` in which the controller executed commands. In the rest of the time, it waited for
    /// commands.
    pub executed: Span,
}

/// Command lists that a region context has received since its last clear. A region context is the part of pixel memory
/// that holds one region.
#[derive(Clone, Debug, Default)]
struct ContextLog {
    cleared: bool,
    /// Lists that change pixels. Copied regions share these lists, to compute their pixels later.
    lists: Arc<Vec<CommandContent>>,
}

impl ContextLog {
    /// Empties the log. Copied regions keep their own references to the lists.
    fn clear(&mut self) {
        self.cleared = true;
        match Arc::get_mut(&mut self.lists) {
            Some(lists) => lists.clear(),
            // Reserve as much room as before, because the next region has a similar number of lists.
            None => self.lists = Arc::new(Vec::with_capacity(self.lists.len())),
        }
    }
}

#[derive(Debug)]
struct PendingCopy {
    order: CopyOrder,
    image: Arc<dyn PixelSource>,
    /// True if the region can leave the backing store as soon as the store holds the complete region.
    is_released: bool,
}

impl Renderer {
    /// Creates a renderer at ring port `node`.
    ///
    /// `word` is the time that a channel needs for one word. `cycle` is the time that a signal takes to leave the
    /// board.
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
            caches_empty_regions: true,
            logs,
            copies: VecDeque::new(),
            copying: None,
            unstored: VecDeque::new(),
            storing: false,
            stored: VecDeque::new(),
            sent: None,
            drawn: Vec::new(),
            stats,
            waited_for_room: false,
        }
    }

    /// Handles one event at time `context.now()`. The resulting events and outputs go to `context`.
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
            // Words that are not a known command also occupy the FIFO. The controller discards them.
            Body::Pixels(_) | Body::Words(_) => {
                self.stats.illegal_commands += 1;
                self.fifo.take(CommandBatch { words_each: message.words, count: 1, span_each: Some(Span::ZERO) });
            }
        }
        let progress = self.fifo.message(begins);
        self.report(progress, context);
    }

    /// Records a received message for [`Self::array_at`]. Does nothing unless [`Self::watch_fifo`] was called.
    fn note(&mut self, message: &Message, now: Time) {
        let first_word = self.stats.words;
        self.stats.words += u64::from(message.words);
        if let Some(sent) = &mut self.sent {
            let started = self.fifo.passed(now).map_or(0, |passed| passed.started);
            sent.add(message, first_word, started);
            self.fifo.discard_before(now);
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
            // A clear hides all earlier drawing in the context.
            log.clear();
        }
        if let Some(content) = list.content.filter(|_| changes_pixels(&list.runs)) {
            // Keep the list only if it can change pixels.
            Arc::make_mut(&mut log.lists).push(content);
        }
        for order in &list.copies {
            let image = self.image(order);
            let is_released = order.way != CopyPath::IntoBacking;
            self.copies.push_back(PendingCopy { order: *order, image, is_released });
        }
        for run in &list.runs {
            let work = self.work(run);
            self.fifo.take(work);
        }
    }

    fn work(&mut self, run: &CommandRun) -> CommandBatch {
        self.stats.commands += u64::from(run.count);
        let span_each = match CommandKind::from_opcode(run.opcode) {
            Some(kind) => self.timing.span(kind),
            None => {
                self.stats.illegal_commands += u64::from(run.count);
                Some(Span::ZERO)
            }
        };
        CommandBatch { words_each: run.words_each, count: run.count, span_each }
    }

    fn image(&self, order: &CopyOrder) -> Arc<dyn PixelSource> {
        let [_, _, width, height] = order.target.grid.rectangle(order.target.region);
        let ContextLog { cleared, lists } = self.logs[usize::from(order.context) % MAX_CONTEXTS].clone();
        if lists.is_empty() {
            return Arc::new(NoPixels { words: width * height * order.content.words() });
        }
        Arc::new(PixelJob {
            pool: Arc::clone(&self.pool),
            // The pixels are computed later, from the lists that have arrived until now.
            lists,
            cleared,
            saves: self.caches_empty_regions,
            target: order.target,
            content: order.content,
            done: OnceLock::new(),
        })
    }

    fn copy(&mut self, context: &mut Context<RendererEvent, RendererOutput>) {
        // Copy commands execute in the order in which their lists arrived.
        let Some(copy) = self.copies.pop_front() else {
            // Without an order, the frame buffer of a copy command is unknown, so the command ends at once.
            self.stats.illegal_commands += 1;
            let progress = self.fifo.resume(context.now());
            return self.report(progress, context);
        };
        if copy.order.way != CopyPath::FromBacking {
            let Block { begun_at, finished_at, start, executed, .. } = self.fifo.last_block();
            let target = copy.order.target;
            let [_, _, width, height] = target.grid.rectangle(target.region);
            let words = width * height * copy.order.content.words();
            self.drawn.push(DrawnRegion { target, words, begun_at, finished_at, copy_at: start, executed });
        }
        match copy.order.way {
            CopyPath::FromPixelMemory => self.transfer(&copy, context),
            CopyPath::FromBacking => self.release(copy.order.target, context),
            CopyPath::ThroughBacking | CopyPath::IntoBacking => {
                self.unstored.push_back(copy);
                self.store_next(context);
            }
        }
    }

    /// Permits a region to leave the backing store. If the store does not hold the region, the command counts as
    /// illegal.
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

    /// Moves the colours of a finished region to the backing store when it has room, and depths, if they are copied, as
    /// a second block.
    ///
    /// The controller continues when the move is complete.
    fn store_next(&mut self, context: &mut Context<RendererEvent, RendererOutput>) {
        let Some(blocks) = self.unstored.front().map(|copy| u64::from(copy.order.content.words())) else { return };
        // Only one region moves at a time, and only into free blocks. A region that is being sent still occupies its
        // blocks.
        let held: u64 = self
            .stored
            .iter()
            .map(|copy| &copy.order)
            .chain(&self.copying)
            .map(|order| u64::from(order.content.words()))
            .sum();
        if self.storing {
            return;
        }
        // No other line uses the capacity. If this test never fails, a larger store gives the same result.
        if held + blocks > self.timing.backing_regions() {
            self.waited_for_room = true;
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
        // Reserve the frame buffer's port for all parts. Only the last part requests a report of its delivery.
        for part in 0..parts {
            let words = MAX_MESSAGE_WORDS.min(all - part * MAX_MESSAGE_WORDS);
            let body = Body::Pixels(RegionPixels { target: order.target, image: Arc::clone(image), part, parts });
            let message = Message { source: self.node, destination: order.target.frame_buffer, words, body };
            // Acknowledge the copy before the next transfer, if the order requests an acknowledgement.
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
        if order.way == CopyPath::FromPixelMemory {
            let progress = self.fifo.resume(context.now());
            self.report(progress, context);
        }
        self.transfer_next(context);
        self.store_next(context);
    }

    /// Returns true if a finished region has ever waited for room in the backing store. If false, a larger backing
    /// store would change nothing.
    pub const fn waited_for_room(&self) -> bool {
        self.waited_for_room
    }

    pub const fn stats(&self) -> RendererStats {
        self.stats
    }

    /// Returns the time that the board has spent on commands so far, without copies.
    pub const fn busy(&self) -> Span {
        self.fifo.busy()
    }

    /// Returns the time until `now` that the board has spent on commands, without copies. `now` must not be earlier
    /// than the last handled event.
    pub fn busy_at(&self, now: Time) -> Span {
        self.fifo.busy_at(now)
    }

    /// Returns the time until `now` for which copy commands have occupied the controller.
    pub fn copying_at(&self, now: Time) -> Span {
        self.fifo.blocked_at(now)
    }

    /// Removes and returns the regions whose copy commands have started, in the order of the starts.
    pub fn drain_drawn(&mut self) -> impl Iterator<Item = DrawnRegion> + '_ {
        self.drawn.drain(..)
    }

    /// Returns pixel memory as it is after the execution of all received command lists. In each region context, lists
    /// before the last clear have no effect.
    ///
    /// Returns `None` if no context has received lists that change pixels. This is the case, for example, if the
    /// computation of pixels is off.
    pub fn pixel_memory(&self) -> Option<Lanes> {
        if self.logs.iter().all(|log| log.lists.is_empty()) {
            return None;
        }
        let mut array = Lanes::new(self.pool.layout());
        for list in self.logs.iter().flat_map(|log| log.lists.iter()) {
            let mut words = Vec::new();
            list.append_words(&mut words);
            // A fault ends the list, as on the hardware. Pixels drawn before the fault stay.
            let _ = array.execute(&words);
        }
        Some(array)
    }

    /// Turns off two optimizations. From this call on, the board always computes the pixels of regions without
    /// primitives, and also executes commands that touch no pixel.
    pub const fn draw_every_region(&mut self) {
        self.caches_empty_regions = false;
    }

    /// Starts to record the words that enter and leave the FIFO.
    pub fn watch_fifo(&mut self) {
        self.fifo.watch();
        self.sent.get_or_insert_default();
    }

    /// Returns a snapshot of the board at time `now`, which must not be earlier than the last handled event.
    pub fn snapshot(&self, now: Time) -> RendererSnapshot {
        let passed = self.fifo.passed(now);
        RendererSnapshot {
            fifo_words: passed.map(|passed| (passed.entered - passed.started) as u32),
            fifo_depth_words: self.timing.fifo_words as u32,
            stands_at_copy: self.fifo.is_blocked(),
            copying: self.copying,
            executing: self.fifo.is_executing(now),
            drawing: passed.zip(self.sent.as_ref()).and_then(|(passed, sent)| sent.drawing(passed.started)),
            stored_regions: self.stored.len() + self.unstored.len(),
            busy: self.fifo.busy(),
        }
    }

    /// Returns the pixel array with the effects of all commands that have started by `now`. `now` must not be earlier
    /// than the last handled event.
    ///
    /// A command takes effect when it starts. Returns `None` if [`Renderer::watch_fifo`] was not called, or if no
    /// command has changed a pixel.
    pub fn array_at(&self, now: Time) -> Option<Lanes> {
        let started = self.fifo.passed(now)?.started;
        self.sent.as_ref()?.executed(started, self.pool.layout())
    }

    /// Returns the changes of the number of words in the FIFO since the last call. The changes are not sorted by time.
    ///
    /// It increases when a complete command has arrived, and decreases when a command starts. Changes in the future are
    /// predictions from the messages so far.
    pub fn take_fifo_changes(&mut self) -> Vec<(Time, i64)> {
        self.fifo.take_changes()
    }

    /// Returns the region to copy and its frame buffer if a copy blocks the board.
    pub fn blocked(&self) -> Option<CopyTarget> {
        Some(self.copying.filter(|_| self.fifo.is_blocked())?.target)
    }
}
