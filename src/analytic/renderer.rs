//! A renderer's input FIFO and array, a message at a time.

/// Equal commands in a row, in one message.
#[derive(Clone, Copy, Debug)]
pub(super) struct Commands {
    /// Words before them: selection, clearing.
    pub(super) head_words: f64,
    /// Time of those.
    pub(super) head_ns: f64,
    /// How many.
    pub(super) count: f64,
    /// Words of one.
    pub(super) words: f64,
    /// Time of one.
    pub(super) each_ns: f64,
}

impl Commands {
    pub(super) fn total_words(&self) -> f64 {
        self.head_words + self.count * self.words
    }
}

/// What is known of a renderer between messages.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Array {
    /// When everything sent to it so far has been executed.
    pub(super) free_ns: f64,
    /// When the last message's first command started, how many there were, their words and their time.
    last: (f64, f64, f64, f64),
}

/// Depth and speed of the FIFO.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fifo {
    pub(super) depth_words: f64,
    pub(super) word_ns: f64,
}

impl Array {
    /// An array that is busy, or held by a copy, until `free_ns`.
    pub(super) const fn busy_until(free_ns: f64) -> Self {
        Self { free_ns, last: (free_ns, 0.0, 1.0, 0.0) }
    }

    /// A message whose first word begins at `first_word_ns`: when its last word has entered.
    pub(super) fn take(&mut self, fifo: Fifo, first_word_ns: f64, commands: &Commands) -> f64 {
        let Commands { head_words, head_ns, count, words, each_ns } = *commands;
        let total = commands.total_words();
        let undisturbed = first_word_ns + total * fifo.word_ns;
        let head_at = first_word_ns + head_words * fifo.word_ns;
        let start = (head_at.max(self.free_ns) + head_ns).max(head_at + words * fifo.word_ns);
        let accepted = undisturbed.max(self.room_for(fifo, total, start, commands));
        self.last = (start, count, words, each_ns);
        let slowest = each_ns.max(words * fifo.word_ns);
        let executed = (start + count * each_ns).max(start + (count - 1.0).max(0.0) * slowest + each_ns);
        self.free_ns = executed.max(accepted);
        accepted
    }

    /// When the last word finds room: the command that holds the word `depth` before it must have started.
    fn room_for(&self, fifo: Fifo, total: f64, start: f64, commands: &Commands) -> f64 {
        let before_last = total - 1.0 - fifo.depth_words - commands.head_words;
        if before_last >= 0.0 {
            let command = (before_last / commands.words).floor().min(commands.count);
            let behind = before_last - command * commands.words + 1.0;
            return start + command * commands.each_ns + behind.min(commands.words) * fifo.word_ns;
        }
        let (last_start, last_count, last_words, last_ns) = self.last;
        let back = (-before_last / last_words).ceil();
        if back > last_count { f64::MIN } else { last_start + (last_count - back) * last_ns }
    }
}
