//! Snapshots of renderers (copies of their state) during a run.

use crate::contents::{MAX_CONTEXTS, changes_pixels, words_before_clear, words_before_copy};
use crate::{Lanes, Layout, PixelArray};
use pxpl5_sim::Span;
use pxpl5_wire::{Body, CommandContent, CopyOrder, CopyPath, Message, RegionPlace};
use std::collections::VecDeque;

/// A snapshot of a renderer board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RendererSnapshot {
    /// Number of words of complete commands in the input FIFO. `None` unless
    /// [`Renderer::watch_fifo`](crate::Renderer::watch_fifo) was called.
    pub fifo_words: Option<u32>,
    pub fifo_depth_words: u32,
    /// True while the controller executes a copy command.
    pub stands_at_copy: bool,
    /// Copy whose region is being sent to a frame buffer.
    pub copying: Option<CopyOrder>,
    /// True while the controller executes commands other than copies.
    pub executing: bool,
    /// Region that the most recently started commands draw. `None` after the start of the copy command, or if the
    /// commands do not contain the region, and always unless [`Renderer::watch_fifo`](crate::Renderer::watch_fifo) was
    /// called.
    pub drawing: Option<RegionPlace>,
    /// Number of finished regions in the backing store, including regions that wait for their transfer to the backing
    /// store.
    pub stored_regions: usize,
    /// Execution time of all commands received since the start of the simulation, without copies. A command counts as
    /// soon as it is received.
    pub busy: Span,
}

impl RendererSnapshot {
    /// Returns true while the controller executes commands other than copies, or has such commands in its FIFO.
    pub fn works(&self) -> bool {
        self.executing || self.fifo_words.is_some_and(|words| words > 0)
    }
}

/// Received command lists that affect pixel memory now, or that will affect it when they start.
#[derive(Debug, Default)]
pub(crate) struct SentLists(VecDeque<SentList>);

#[derive(Debug)]
struct SentList {
    context: usize,
    /// Number of words that the renderer had received before this list.
    first_word: u64,
    /// Index of the first word of the clear command at the start of the list. Words are counted from the start of the
    /// simulation. `None` if the list does not start with a clear command.
    clear: Option<u64>,
    /// Index of the first word of the copy command that ends the region. Words are counted from the start of the
    /// simulation. `None` until the renderer receives this command.
    copy: Option<u64>,
    content: CommandContent,
}

impl SentLists {
    /// Adds the command list of a received message. `started` is the number of words of commands that have started.
    pub(crate) fn add(&mut self, message: &Message, first_word: u64, started: u64) {
        let Body::Commands(list) = &message.body else { return };
        let context = usize::from(list.context) % MAX_CONTEXTS;
        if let Some(content) = list.content.clone().filter(|_| changes_pixels(&list.runs)) {
            let clear = words_before_clear(&list.runs).map(|words| first_word + words);
            self.discard(started);
            self.0.push_back(SentList { context, first_word, clear, copy: None, content });
        }
        // A copy from pixel memory ends the region of its context, in this list or in earlier lists.
        let Some(before) = words_before_copy(&list.runs) else { return };
        let from_pixels = list.copies.iter().filter(|order| order.way != CopyPath::FromBacking);
        let copied: Vec<usize> = from_pixels.map(|order| usize::from(order.context) % MAX_CONTEXTS).collect();
        let open = self.0.iter_mut().filter(|list| list.copy.is_none() && copied.contains(&list.context));
        open.for_each(|list| list.copy = Some(first_word + before));
    }

    /// Returns the region that the last started command list draws, or `None` after the start of the region's copy
    /// command. `started` is the number of words of commands that have started.
    pub(crate) fn drawing(&self, started: u64) -> Option<RegionPlace> {
        let last = self.0.iter().rfind(|list| list.first_word < started)?;
        let is_copied = last.copy.is_some_and(|copy| copy < started);
        if is_copied { None } else { last.content.place() }
    }

    /// Removes the command lists whose pixels are erased because a later clear command has started.
    fn discard(&mut self, started: u64) {
        let cleared: [u64; MAX_CONTEXTS] = std::array::from_fn(|context| self.cleared_at(context, started));
        self.0.retain(|list| list.first_word >= cleared[list.context]);
    }

    /// Returns the index of the first word of the latest list in `context` whose clear command has started, or 0
    /// without such a list. Earlier lists of the context no longer affect pixels.
    fn cleared_at(&self, context: usize, started: u64) -> u64 {
        let of_context = self.0.iter().filter(|list| list.context == context);
        of_context
            .filter(|list| list.clear.is_some_and(|clear| clear < started))
            .map(|list| list.first_word)
            .max()
            .unwrap_or(0)
    }

    /// Returns the pixel array after the commands in the first `started` words. Returns `None` if these commands have
    /// changed no pixel.
    pub(crate) fn executed(&self, started: u64, layout: &Layout) -> Option<Lanes> {
        let mut lists = self.0.iter().filter(|list| list.first_word < started).peekable();
        lists.peek()?;
        let mut array = Lanes::new(layout);
        for list in lists.filter(|list| list.first_word >= self.cleared_at(list.context, started)) {
            let mut words = Vec::new();
            list.content.append_words(&mut words);
            let executed = usize::try_from(started - list.first_word).unwrap_or(usize::MAX);
            words.truncate(executed);
            // A fault ends the list, as on the hardware. Pixels drawn before the fault stay.
            let _ = array.execute(&words);
        }
        Some(array)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::CommandKind;
    use pxpl5_wire::{
        CommandList, CommandRun, CommandWords, CopyContent, CopyTarget, Lines, NodeId, PictureNumber, RegionGrid,
        RegionId, Word,
    };
    use std::sync::Arc;

    #[derive(Debug)]
    struct Placed(u16);

    impl CommandWords for Placed {
        fn append_words(&self, _: u32, _: &mut Vec<Word>) {}

        fn place(&self) -> Option<RegionPlace> {
            let region = RegionId(self.0);
            Some(RegionPlace { frame_buffer: None, lines: Lines::Frame, grid: RegionGrid::FRAME, region })
        }
    }

    const PORT: NodeId = NodeId(7);

    fn message(kinds: &[CommandKind], region: u16, way: Option<CopyPath>) -> Message {
        let runs = kinds.iter().map(|kind| CommandRun { opcode: kind.opcode(), words_each: kind.words(), count: 1 });
        let target = CopyTarget {
            frame_buffer: PORT,
            buffer: 0,
            lines: Lines::Frame,
            grid: RegionGrid::FRAME,
            region: RegionId(region),
            picture: PictureNumber(0),
        };
        let order = |way| CopyOrder { target, context: 0, way, content: CopyContent::Colour, acknowledge: None };
        let list = CommandList {
            runs: runs.collect(),
            context: 0,
            copies: way.map(order).into_iter().collect(),
            content: Some(CommandContent::new(Arc::new(Placed(region)), 0)),
        };
        let list = list.for_frame_buffer(PORT);
        Message { source: NodeId(0), destination: NodeId(1), words: list.words(), body: Body::Commands(list) }
    }

    /// Tests which region a renderer draws: from the first command of a region until its copy command. A copy of an
    /// older region from the backing store, in between, changes nothing.
    #[test]
    fn a_region_is_drawn_from_its_first_command_to_its_copy_command() {
        let [select, clear, triangle, copy] =
            [CommandKind::SelectRegion, CommandKind::Clear, CommandKind::Triangle, CommandKind::CopyRegion];
        let mut sent = SentLists::default();
        let drawn = message(&[select, clear, triangle], 3, None);
        sent.add(&drawn, 0, 0);
        assert_eq!(sent.drawing(0), None, "no command has started");
        let place = sent.drawing(1).expect("the region is drawn");
        assert_eq!((place.region, place.frame_buffer), (RegionId(3), Some(PORT)));
        let end = u64::from(drawn.words);
        let released = message(&[select, copy], 2, Some(CopyPath::FromBacking));
        sent.add(&released, end, 1);
        let later = end + u64::from(released.words);
        assert_eq!(sent.drawing(later), Some(place));
        let copied = message(&[select, copy], 3, Some(CopyPath::FromPixelMemory));
        sent.add(&copied, later, later);
        let copy_word = later + u64::from(select.words());
        assert_eq!(sent.drawing(copy_word), Some(place));
        assert_eq!(sent.drawing(copy_word + 1), None, "the copy command has started");
    }
}
