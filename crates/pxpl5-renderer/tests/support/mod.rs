//! A test bench with one renderer board.

use pxpl5_renderer::{
    ArrayPool, Command, CommandKind, Layout, Renderer, RendererEvent, RendererOutput, RendererTiming,
};
use pxpl5_sim::{Phase, Span, TestBench, Time};
use pxpl5_wire::{
    Body, CommandContent, CommandList, CommandRun, CopyContent, CopyOrder, CopyPath, CopyTarget, Lines, Message,
    NodeId, PictureNumber, RegionGrid, RegionId, Word,
};
use std::sync::Arc;

pub(crate) const NODE: NodeId = NodeId(3);
pub(crate) const DISPLAY: NodeId = NodeId(9);
pub(crate) const HOST: NodeId = NodeId(1);
pub(crate) const WORD: Span = Span::from_ns(50);
pub(crate) const CYCLE: Span = Span::from_ns(25);

/// A picture of 2 x 1 regions of 100 x 100 pixels, and a third region of 10 columns.
pub(crate) const GRID: RegionGrid = RegionGrid { width: 210, height: 100, region_width: 100, region_height: 100 };

/// Layout of the board, which has four contexts.
pub(crate) const LAYOUT: fn() -> Layout = Layout::slats;

pub(crate) struct Bench {
    pub(crate) device: Renderer,
    pub(crate) bench: TestBench<RendererEvent, RendererOutput>,
}

#[derive(Clone, Debug)]
pub(crate) struct Sent {
    pub(crate) at: Time,
    pub(crate) message: Message,
    pub(crate) ticket: bool,
    pub(crate) hold: bool,
}

impl Bench {
    pub(crate) fn new() -> Self {
        Self::with(RendererTiming::PAPERS)
    }

    pub(crate) fn with(timing: RendererTiming) -> Self {
        let device = Renderer::new(NODE, timing, WORD, CYCLE, ArrayPool::new(LAYOUT()));
        Self { device, bench: TestBench::new() }
    }

    /// Delivers a message whose first word is on the channel immediately.
    pub(crate) fn message(&mut self, at: Time, words: u32, body: Body) {
        let message = Message { source: HOST, destination: NODE, words, body };
        self.bench.feed(at, Phase::Arrive, RendererEvent::Announce { message, first_word_at: at });
    }

    pub(crate) fn announce(&mut self, at: Time, list: CommandList) {
        self.message(at, list.words(), Body::Commands(list));
    }

    /// Reports that the ring has delivered the last pixel of the copied region.
    pub(crate) fn delivered(&mut self, at: Time) {
        self.bench.feed(at, Phase::Arrive, RendererEvent::Sent);
    }

    pub(crate) fn run(&mut self) {
        self.run_until(Time::END);
    }

    pub(crate) fn run_until(&mut self, until: Time) {
        let device = &mut self.device;
        self.bench.run_until(until, |event, context| device.handle(event, context));
    }

    /// Returns two times for each message: the time of the board's notice, and the time at which the last word is in
    /// the FIFO.
    pub(crate) fn accepted(&self) -> Vec<(Time, Time)> {
        let accepted = self.bench.outputs.iter().filter_map(|(at, output)| match output {
            RendererOutput::Accept { last_word_at } => Some((*at, *last_word_at)),
            RendererOutput::Send { .. } => None,
        });
        accepted.collect()
    }

    pub(crate) fn sent(&self) -> Vec<Sent> {
        let sent = self.bench.outputs.iter().filter_map(|(at, output)| match output {
            RendererOutput::Accept { .. } => None,
            RendererOutput::Send { message, ticket, hold } => {
                Some(Sent { at: *at, message: message.clone(), ticket: *ticket, hold: *hold })
            }
        });
        sent.collect()
    }
}

pub(crate) const fn run(kind: CommandKind, count: u32) -> CommandRun {
    CommandRun { opcode: kind.opcode(), words_each: kind.words(), count }
}

/// Returns a list of commands without words, for tests that read no pixels.
pub(crate) fn list(runs: &[CommandRun], copies: &[CopyOrder]) -> CommandList {
    CommandList { runs: runs.to_vec(), context: 0, copies: copies.to_vec(), content: None }
}

/// Returns a list of commands with their words. Equal consecutive commands form one run.
pub(crate) fn list_of(commands: &[Command], copies: &[CopyOrder]) -> CommandList {
    let mut words: Vec<Word> = Vec::new();
    commands.iter().for_each(|command| command.encode(&LAYOUT(), &mut words).expect("it fits"));
    let in_a_row = commands.chunk_by(|one, next| one.kind() == next.kind());
    let runs = in_a_row.map(|equal| run(equal[0].kind(), equal.len() as u32)).collect();
    let content = Some(CommandContent::new(Arc::new(words), 0));
    CommandList { runs, context: 0, copies: copies.to_vec(), content }
}

pub(crate) fn order(region: u16, way: CopyPath, content: CopyContent) -> CopyOrder {
    let (grid, lines) = (GRID, Lines::Frame);
    let (region, picture) = (RegionId(region), PictureNumber(17));
    let target = CopyTarget { frame_buffer: DISPLAY, buffer: 1, lines, grid, region, picture };
    CopyOrder { target, context: 0, way, content, acknowledge: Some(HOST) }
}
