//! A renderer's input FIFO and array, a message at a time.

use pxpl5_renderer::{CommandKind, RendererTiming};

/// The later of two times. (`f64::max` has to look for a NaN; there is none.)
#[inline]
pub(super) fn later(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

/// The sooner of two times.
#[inline]
pub(super) fn sooner(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Words and time of what is sent.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cost {
    pub(super) words: f64,
    pub(super) ns: f64,
}

impl Cost {
    /// Words and time of one command on a renderer.
    pub(super) fn of_command(timing: &RendererTiming, kind: CommandKind) -> Self {
        let ns = timing.span(kind).map_or(0.0, |span| span.as_ms() * 1e6);
        Self { words: f64::from(kind.words()), ns }
    }
}

/// Depth and speed of the FIFO.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fifo {
    pub(super) depth_words: f64,
    pub(super) word_ns: f64,
}

/// A message of equal commands in a row, with all of its times that do not depend on when it comes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Commands {
    /// Words before the commands, on the channel, and the time that they take: selection, clearing.
    head: Cost,
    head_wire_ns: f64,
    /// How many commands, and the time of one.
    count: f64,
    each_ns: f64,
    /// One command and the whole message on the channel.
    first_wire_ns: f64,
    wire_ns: f64,
    /// From the start of the first command to the end of the last one, with the words at their heels.
    drawing_ns: f64,
    room: Room,
}

/// When the last word of a message finds room: the command that holds the word a FIFO's depth before must have started.
#[derive(Clone, Copy, Debug)]
enum Room {
    /// That command is in the message itself: this long after its first one.
    After(f64),
    /// It is in the message before, at this place from its end.
    Before(f64),
}

impl Commands {
    /// `count` commands behind a head.
    pub(super) fn new(fifo: Fifo, head: Cost, count: f64, each: Cost) -> Self {
        let total = head.words + count * each.words;
        let word_ns = fifo.word_ns;
        let slowest = each.ns.max(each.words * word_ns);
        let before_last = total - 1.0 - fifo.depth_words - head.words;
        let room = if before_last >= 0.0 {
            let command = (before_last / each.words).floor().min(count);
            let behind = before_last - command * each.words + 1.0;
            Room::After(command * each.ns + behind.min(each.words) * word_ns)
        } else {
            Room::Before((-before_last / each.words).ceil())
        };
        Self {
            head,
            head_wire_ns: head.words * word_ns,
            count,
            each_ns: each.ns,
            first_wire_ns: each.words * word_ns,
            wire_ns: total * word_ns,
            drawing_ns: (count * each.ns).max((count - 1.0).max(0.0) * slowest + each.ns),
            room,
        }
    }
}

/// What is known of a renderer between messages.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Array {
    /// When everything sent to it so far has been executed.
    pub(super) free_ns: f64,
    /// When the last message's first command started, how many there were, and their time.
    last: (f64, f64, f64),
}

impl Array {
    /// An array that is busy, or held by a copy, until `free_ns`.
    pub(super) const fn busy_until(free_ns: f64) -> Self {
        Self { free_ns, last: (free_ns, 0.0, 0.0) }
    }

    /// A message whose first word begins at `first_word_ns`: when its last word has entered.
    #[inline]
    pub(super) fn take(&mut self, first_word_ns: f64, commands: &Commands) -> f64 {
        let head_at = first_word_ns + commands.head_wire_ns;
        let start = later(later(head_at, self.free_ns) + commands.head.ns, head_at + commands.first_wire_ns);
        let (last_start, last_count, last_ns) = self.last;
        let room = match commands.room {
            Room::After(span) => start + span,
            Room::Before(back) if back > last_count => f64::MIN,
            Room::Before(back) => last_start + (last_count - back) * last_ns,
        };
        let accepted = later(first_word_ns + commands.wire_ns, room);
        self.last = (start, commands.count, commands.each_ns);
        self.free_ns = later(start + commands.drawing_ns, accepted);
        accepted
    }
}
