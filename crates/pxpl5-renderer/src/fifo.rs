//! The input FIFO and the controller that executes its commands. Formulas give the times of commands, so a command
//! needs no event.
//!
//! Rules (the rules that the papers do not state are assumed):
//!
//! - A word enters the channel as soon as the FIFO has room for it, and takes one word time there.
//! - A command starts when all its words have arrived and the previous command has ended.
//! - The words of a command leave the FIFO when the command starts.
//! - A *blocking* command (copy of a region) ends when [`InputFifo::resume`] is called. No later command starts before
//!   its end.
//!
//! A SIMD array takes the same time for any data, so all start and end times follow from the arrival times.

use pxpl5_sim::{Span, Time};
use std::collections::VecDeque;

/// Consecutive commands of equal length and equal execution time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct CommandBatch {
    pub(crate) words_each: u32,
    pub(crate) count: u32,
    /// Execution time of one command. `None` for blocking commands, which end when a copy ends.
    pub(crate) span_each: Option<Span>,
}

/// Future times at which the state of the FIFO changes. They are computed when words arrive or a copy ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Progress {
    /// Time at which the last word of the arriving message enters the FIFO. `None` while this time is unknown.
    pub(crate) accepted: Option<Time>,
    /// Time at which a blocking command (the copy of a region) starts.
    pub(crate) blocks: Option<Time>,
}

#[derive(Clone, Copy, Debug)]
struct HeldCommand {
    words: u32,
    span: Option<Span>,
    complete: Time,
}

/// Consecutive commands of equal length that start at equal intervals.
///
/// An interval is at least as long as the transfer of a command's words over the channel.
#[derive(Clone, Copy, Debug)]
struct Departure {
    /// Index of the first word for which the FIFO has no room before the first of these commands starts. Words are
    /// counted from 0 since the start of the simulation.
    made_room_for: u64,
    left_at: Time,
    count: u64,
    words_each: u64,
    step: Span,
}

impl Departure {
    /// Returns the index, among these commands, of the command whose start makes room for word `word`. Returns the last
    /// index if none of the commands makes room for this word.
    ///
    /// `word` must be at least `made_room_for`.
    const fn last_for(&self, word: u64) -> u64 {
        if self.count == 1 {
            return 0;
        }
        let place = (word - self.made_room_for) / self.words_each;
        if place < self.count { place } else { self.count - 1 }
    }

    fn behind(self, commands: u64) -> Self {
        Self {
            made_room_for: self.made_room_for + commands * self.words_each,
            left_at: self.left_at + self.step * commands,
            count: self.count - commands,
            ..self
        }
    }
}

/// Start times of past commands. A start time is kept while the arrival of a later word can depend on it.
#[derive(Debug, Default)]
struct StartTimes(VecDeque<Departure>);

impl StartTimes {
    /// Returns the time at which the last of the words `first` to `last` enters the FIFO, but at least `soonest`.
    ///
    /// Each word waits until there is room for it, and then takes one word time on the channel. `first` must be at
    /// least the `first` of the previous call. Of several commands that start at equal intervals, only the last that
    /// makes room matters, since an interval is at least as long as the transfer of a command's words.
    #[inline]
    fn entered(&mut self, first: u64, last: u64, soonest: Time, word: Span) -> Time {
        self.discard_before(first);
        let mut complete = soonest;
        for room in &self.0 {
            if room.made_room_for > last {
                break;
            }
            let Departure { made_room_for, left_at, .. } = room.behind(room.last_for(last));
            complete = complete.max(left_at + word * (last - made_room_for.max(first) + 1));
        }
        complete
    }

    #[inline]
    fn discard_before(&mut self, first: u64) {
        while self.0.get(1).is_some_and(|next| next.made_room_for <= first) {
            self.0.pop_front();
        }
        if let Some(room) = self.0.front_mut().filter(|room| room.made_room_for <= first) {
            *room = room.behind(room.last_for(first));
        }
    }
}

#[derive(Debug)]
pub(crate) struct InputFifo {
    depth: u64,
    word: Span,
    /// Commands of the arriving message whose arrival times are not known yet.
    in_transit: VecDeque<CommandBatch>,
    transit_known: bool,
    last_word_at: Time,
    words_in: u64,
    left: StartTimes,
    words_left: u64,
    waiting: VecDeque<HeldCommand>,
    /// Time from which the controller can start the next command. `None` while a blocking command (the copy of a
    /// region) runs.
    free_at: Option<Time>,
    busy: Span,
    /// Total time for which blocking commands (copies of regions) have occupied the controller.
    blocked: Span,
    last_block: Block,
    /// Start and end of the latest interval in which the controller waited for commands.
    last_wait: (Time, Time),
    watched: Option<Watched>,
}

/// Longest time in which a command can select the region to copy without drawing. The selection takes 6 clocks of 40
/// MHz, 150 ns.
///
/// If no more time lies between a wait of the controller and a copy command, the region was already drawn before the
/// wait. Longer work counts as drawing.
const SELECTION: Span = Span::from_ns(1_000);

/// Times of the latest blocking command (copy of a region), and of the commands before it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Block {
    /// End of the previous blocking command. From this time on, the controller could execute the commands between the
    /// two blocking commands.
    pub(crate) begun_at: Time,
    /// Time at which the drawing before this blocking command ended. A wait for the copy command does not count as
    /// drawing, and neither does the selection of the region after the wait.
    pub(crate) finished_at: Time,
    pub(crate) start: Time,
    /// Sum of the execution times of the commands between the previous blocking command and this command.
    pub(crate) executed: Span,
    /// Sum of the execution times of all commands before this command, since the start of the simulation.
    busy: Span,
    /// End of the latest completed blocking command.
    resumed_at: Time,
}

/// Record of the words that enter and leave the FIFO. Its times can lie in the future.
#[derive(Debug, Default)]
struct Watched {
    /// Changes of the number of words in the FIFO since the last [`InputFifo::take_changes`]: the time, and the number
    /// of words that enter (positive) or leave (negative).
    changes: Vec<(Time, i64)>,
    entered: Course,
    left: Course,
}

/// A count of words that grows with simulated time, for example the words that have entered the FIFO. Entries before
/// the last call of `discard_before` are removed.
#[derive(Debug, Default)]
struct Course {
    /// Steps of the count, in the order of time. Each step has its time, and the count from this time on.
    steps: VecDeque<(Time, u64)>,
    /// Count before the first entry of `steps`.
    before: u64,
    after: u64,
}

impl Course {
    fn add(&mut self, at: Time, words: u32) {
        self.after += u64::from(words);
        self.steps.push_back((at, self.after));
    }

    fn at(&self, now: Time) -> u64 {
        let steps = self.steps.partition_point(|step| step.0 <= now);
        steps.checked_sub(1).map_or(self.before, |last| self.steps[last].1)
    }

    fn discard_before(&mut self, now: Time) {
        self.before = self.at(now);
        let gone = self.steps.partition_point(|step| step.0 <= now);
        self.steps.drain(..gone);
    }
}

/// Numbers of words that have entered and left the FIFO since the start of the simulation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct WordsPassed {
    /// Words of commands that have arrived completely.
    pub(crate) entered: u64,
    /// Words of commands that have started.
    pub(crate) started: u64,
}

impl InputFifo {
    pub(crate) fn new(depth_words: u32, word: Span) -> Self {
        Self {
            depth: u64::from(depth_words),
            word,
            in_transit: VecDeque::new(),
            transit_known: true,
            last_word_at: Time::ZERO,
            words_in: 0,
            left: StartTimes::default(),
            words_left: 0,
            waiting: VecDeque::new(),
            free_at: Some(Time::ZERO),
            busy: Span::ZERO,
            blocked: Span::ZERO,
            last_block: Block::default(),
            last_wait: (Time::ZERO, Time::ZERO),
            watched: None,
        }
    }

    /// Adds commands to the message that [`Self::message`] announces next, in the order of their words in the message.
    pub(crate) fn take(&mut self, work: CommandBatch) {
        self.in_transit.push_back(work);
    }

    /// Computes the arrival of a message, which consists of the commands that calls of `take` have added since the
    /// previous one.
    ///
    /// `begins` is the time at which the first word of the message is on the channel.
    pub(crate) fn message(&mut self, begins: Time) -> Progress {
        self.last_word_at = self.last_word_at.max(begins);
        self.transit_known = false;
        self.advance()
    }

    pub(crate) fn resume(&mut self, now: Time) -> Progress {
        self.free_at = Some(now);
        self.blocked += now.since(self.last_block.start);
        self.last_block.resumed_at = now;
        self.advance()
    }

    /// Returns the sum of the execution times of all received commands, without blocking commands.
    pub(crate) const fn busy(&self) -> Span {
        self.busy
    }

    /// Returns the time until `now` that the controller has spent on commands, without blocking ones, as if it executed
    /// all unfinished commands from `now` on without a gap. `now` must not be earlier than the last handled event.
    pub(crate) fn busy_at(&self, now: Time) -> Span {
        let ahead = self.free_at.map_or(0, |free_at| free_at.0.saturating_sub(now.0));
        Span(self.busy.0.saturating_sub(ahead))
    }

    /// Returns the time until `now` for which blocking commands have occupied the controller.
    pub(crate) fn blocked_at(&self, now: Time) -> Span {
        let goes_on = self.free_at.is_none().then(|| now.0.saturating_sub(self.last_block.start.0));
        self.blocked + Span(goes_on.unwrap_or(0))
    }

    /// Returns the last blocking command (copy of a region). Its times are valid only after the start of the command.
    pub(crate) const fn last_block(&self) -> Block {
        self.last_block
    }

    pub(crate) fn watch(&mut self) {
        self.watched.get_or_insert_default();
    }

    /// Returns the numbers of words that have entered and left the FIFO by `now`, or `None` if recording is off. `now`
    /// must not be earlier than the last handled event.
    pub(crate) fn passed(&self, now: Time) -> Option<WordsPassed> {
        let watched = self.watched.as_ref()?;
        Some(WordsPassed { entered: watched.entered.at(now), started: watched.left.at(now) })
    }

    pub(crate) fn discard_before(&mut self, now: Time) {
        if let Some(Watched { entered, left, .. }) = &mut self.watched {
            entered.discard_before(now);
            left.discard_before(now);
        }
    }

    pub(crate) fn take_changes(&mut self) -> Vec<(Time, i64)> {
        self.watched.as_mut().map(|watched| std::mem::take(&mut watched.changes)).unwrap_or_default()
    }

    /// Returns true if a non-blocking command runs at time `now`, according to the commands received so far.
    pub(crate) fn is_executing(&self, now: Time) -> bool {
        self.free_at.is_some_and(|free_at| free_at > now)
    }

    pub(crate) const fn is_blocked(&self) -> bool {
        self.free_at.is_none()
    }

    fn advance(&mut self) -> Progress {
        let mut progress = Progress { accepted: None, blocks: self.start_waiting() };
        while let Some(work) = self.in_transit.pop_front() {
            // Without a blocking command or a record of words, compute all commands of the batch at once.
            let words = work.words_each;
            let span = work.span_each;
            if let (Some(free_at), Some(span_each), None) = (self.free_at, span, &self.watched)
                && (1..=self.depth).contains(&u64::from(words))
                && work.count > 0
                && span_each >= self.word * u64::from(words)
            {
                self.run_freely(work, free_at, span_each);
                continue;
            }
            // Otherwise words can wait for room, so compute each command alone.
            for entered in 0..work.count {
                let Some(complete) = self.arrival(words) else {
                    self.in_transit.push_front(CommandBatch { count: work.count - entered, ..work });
                    return progress;
                };
                self.words_in += u64::from(words);
                self.last_word_at = complete;
                if let Some(watched) = &mut self.watched {
                    watched.changes.push((complete, i64::from(words)));
                    watched.entered.add(complete, words);
                }
                let blocks = self.start_or_wait(HeldCommand { words, span, complete });
                progress.blocks = progress.blocks.or(blocks);
            }
        }
        if !self.transit_known {
            self.transit_known = true;
            progress.accepted = Some(self.last_word_at);
        }
        progress
    }

    /// Computes the times of all commands of a batch in one step, with the same results as [`InputFifo::arrival`] and
    /// [`InputFifo::start`] for each.
    ///
    /// `free_at` is the end of the command before the batch, and `span` is the execution time of each command.
    /// Recording ([`InputFifo::watch`]) must be off. Each command must fit in the FIFO, must not block, and must take
    /// at least as long as the transfer of its words. So its words arrive while the previous command executes, at whose
    /// end it starts.
    fn run_freely(&mut self, work: CommandBatch, free_at: Time, span: Span) {
        debug_assert!(
            self.waiting.is_empty() && self.words_left == self.words_in,
            "only behind a block does anything wait"
        );
        // The first command can still wait for its words. Each other command starts when the previous one ends.
        let words = u64::from(work.words_each);
        let count = u64::from(work.count);
        let first = self.words_in;
        let end = first + words * count;
        let on_channel = self.word * words;
        let complete = self.left.entered(first, first + words - 1, self.last_word_at + on_channel, self.word);
        let start = free_at.max(complete);
        self.note_wait(free_at, start);
        let made_room_for = first + self.depth;
        self.left.0.push_back(Departure { made_room_for, left_at: start, count, words_each: words, step: span });
        // The last word enters once earlier commands have freed enough room for it.
        self.last_word_at = if count == 1 {
            complete
        } else {
            self.left.entered(first + words, end - 1, complete + on_channel * (count - 1), self.word)
        };
        self.words_in = end;
        self.words_left = end;
        self.free_at = Some(start + span * count);
        self.busy += span * count;
    }

    /// Records an interval in which the controller waited for commands, unless the interval is empty.
    #[inline]
    fn note_wait(&mut self, from: Time, to: Time) {
        if to > from {
            self.last_wait = (from, to);
        }
    }

    /// Returns the time at which the next `words` words have all entered the FIFO. Returns `None` while this time
    /// depends on the end of a blocking command (copy of a region).
    fn arrival(&mut self, words: u32) -> Option<Time> {
        let first = self.words_in;
        let last = self.words_in + u64::from(words) - 1;
        let complete = self.last_word_at + self.word * u64::from(words);
        if last < self.depth {
            return Some(complete);
        }
        (last - self.depth < self.words_left).then(|| self.left.entered(first, last, complete, self.word))
    }

    /// Starts the waiting commands in order, up to and including the first blocking command (copy of a region). Returns
    /// the start time of the blocking command, or `None` if none has started.
    fn start_waiting(&mut self) -> Option<Time> {
        while let Some(free_at) = self.free_at {
            let command = self.waiting.pop_front()?;
            let blocks = self.start(command, free_at);
            if blocks.is_some() {
                return blocks;
            }
        }
        None
    }

    /// Starts a command that has arrived completely, or puts it into the queue while a blocking command runs. Returns
    /// the start time if the new command starts and is a blocking command.
    fn start_or_wait(&mut self, command: HeldCommand) -> Option<Time> {
        match self.free_at {
            Some(free_at) => self.start(command, free_at),
            None => {
                self.waiting.push_back(command);
                None
            }
        }
    }

    /// Starts a command that has arrived completely, at `free_at` or at its arrival, whichever is later. Returns the
    /// start time if the command is a blocking command.
    fn start(&mut self, command: HeldCommand, free_at: Time) -> Option<Time> {
        let start = free_at.max(command.complete);
        // The words of a copy command arrive after the words that select its region. A wait between the two is not a
        // wait for the commands of the region.
        if command.span.is_some() {
            self.note_wait(free_at, start);
        }
        let made_room_for = self.words_left + self.depth;
        self.left.0.push_back(Departure { made_room_for, left_at: start, count: 1, words_each: 0, step: Span::ZERO });
        self.words_left += u64::from(command.words);
        if let Some(watched) = &mut self.watched {
            watched.changes.push((start, -i64::from(command.words)));
            watched.left.add(start, command.words);
        }
        self.free_at = command.span.map(|span| start + span);
        match command.span {
            Some(span) => self.busy += span,
            None => {
                let before = self.last_block;
                // If the copy command arrived late, at most the selection of its region ran after the wait.
                let (idle_from, idle_to) = self.last_wait;
                let is_late = idle_from >= before.resumed_at && free_at.0.saturating_sub(idle_to.0) <= SELECTION.0;
                let finished_at = if is_late { idle_from.min(free_at) } else { free_at };
                self.last_block = Block {
                    begun_at: before.resumed_at,
                    finished_at,
                    start,
                    executed: Span(self.busy.0 - before.busy.0),
                    busy: self.busy,
                    resumed_at: before.resumed_at,
                };
            }
        }
        command.span.is_none().then_some(start)
    }
}

#[cfg(test)]
mod tests;
