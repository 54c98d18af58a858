//! What somebody who looks at a renderer while it works sees.

use crate::contents::{MAX_CONTEXTS, changes_pixels, words_before_clear};
use crate::{Lanes, Layout, PixelArray};
use pxpl5_sim::Span;
use pxpl5_wire::{Body, CommandContent, CopyOrder, Message};
use std::collections::VecDeque;

/// What a renderer does at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RendererLook {
    /// Words of complete commands that wait in the input FIFO; `None` where nobody watches it.
    pub fifo_words: Option<u32>,
    /// Words that the FIFO holds.
    pub fifo_depth_words: u32,
    /// Whether its controller stands at a copy command.
    pub stands_at_copy: bool,
    /// The region that is on its way to a display.
    pub copying: Option<CopyOrder>,
    /// Regions that are in the backing store, or on their way into it.
    pub stored_regions: usize,
    /// Time spent executing commands since the start, without copies; commands that have been received count at once.
    pub busy: Span,
}

/// Lists of commands that can still be seen in pixel memory, or will be.
#[derive(Debug, Default)]
pub(crate) struct SentLists(VecDeque<SentList>);

#[derive(Debug)]
struct SentList {
    context: usize,
    /// Words that were sent before it, since the start.
    first_word: u64,
    /// The first word of the clear with which it begins, counted alike; `None` where it begins otherwise.
    clear: Option<u64>,
    content: CommandContent,
}

impl SentLists {
    /// A message has come; the commands in the first `started` words of all have started.
    pub(crate) fn add(&mut self, message: &Message, first_word: u64, started: u64) {
        let Body::Commands(list) = &message.body else { return };
        let Some(content) = list.content.clone().filter(|_| changes_pixels(&list.runs)) else { return };
        let context = usize::from(list.context) % MAX_CONTEXTS;
        let clear = words_before_clear(&list.runs).map(|words| first_word + words);
        self.forget(started);
        self.0.push_back(SentList { context, first_word, clear, content });
    }

    /// Gives up what a clear that has started has hidden.
    fn forget(&mut self, started: u64) {
        let cleared: [u64; MAX_CONTEXTS] = std::array::from_fn(|context| self.cleared_at(context, started));
        self.0.retain(|list| list.first_word >= cleared[list.context]);
    }

    /// The first word of the last list whose clear of a context has started; 0 without any.
    fn cleared_at(&self, context: usize, started: u64) -> u64 {
        let of_context = self.0.iter().filter(|list| list.context == context);
        of_context
            .filter(|list| list.clear.is_some_and(|clear| clear < started))
            .map(|list| list.first_word)
            .max()
            .unwrap_or(0)
    }

    /// The array after the commands in the first `started` words; `None` where none of them changed a pixel.
    pub(crate) fn executed(&self, started: u64, layout: &Layout) -> Option<Lanes> {
        let mut lists = self.0.iter().filter(|list| list.first_word < started).peekable();
        lists.peek()?;
        let mut array = Lanes::new(layout);
        for list in lists.filter(|list| list.first_word >= self.cleared_at(list.context, started)) {
            let mut words = Vec::new();
            list.content.append_words(&mut words);
            let executed = usize::try_from(started - list.first_word).unwrap_or(usize::MAX);
            words.truncate(executed);
            // A fault stops the list, as on the hardware; what was drawn before stays.
            let _ = array.execute(&words);
        }
        Some(array)
    }
}
