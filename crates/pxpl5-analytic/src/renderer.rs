//! A renderer's input FIFO and its array of pixel processors, computed one message at a time.

use pxpl5_renderer::{CommandKind, RendererTiming};
use std::ops::{Add, Mul, Sub};

/// Returns the later of two times. No time is NaN, so this function can be faster than `f64::max`.
#[inline]
pub(super) fn later(a: f64, b: f64) -> f64 {
    if a > b { a } else { b }
}

#[inline]
pub(super) fn sooner(a: f64, b: f64) -> f64 {
    if a < b { a } else { b }
}

/// Number of words and execution time, of a command or of a message.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cost {
    pub(super) words: f64,
    pub(super) ns: f64,
}

impl Cost {
    pub(super) fn of_command(timing: &RendererTiming, kind: CommandKind) -> Self {
        let ns = timing.span(kind).map_or(0.0, |span| span.as_ms() * 1e6);
        Self { words: f64::from(kind.words()), ns }
    }
}

/// One time for each of several machines, in nanoseconds.
///
/// The values are aligned like vector registers, because a vector across two cache lines takes twice as long.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Times<const N: usize>(pub(super) [f64; N]);

impl<const N: usize> Times<N> {
    pub(super) const fn all(ns: f64) -> Self {
        Self([ns; N])
    }

    #[inline(always)]
    pub(super) fn each(ns: impl Fn(usize) -> f64) -> Self {
        // Use a loop: `from_fn` is not always inlined, and its code would then lack the vector instructions.
        let mut all = [0.0; N];
        for (i, lane) in all.iter_mut().enumerate() {
            *lane = ns(i);
        }
        Self(all)
    }

    #[inline(always)]
    pub(super) fn later(self, other: Self) -> Self {
        Self::each(|i| later(self.0[i], other.0[i]))
    }

    #[inline(always)]
    pub(super) fn sooner(self, other: Self) -> Self {
        Self::each(|i| sooner(self.0[i], other.0[i]))
    }
}

impl<const N: usize> Add for Times<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self::each(|i| self.0[i] + other.0[i])
    }
}

impl<const N: usize> Sub for Times<N> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self::each(|i| self.0[i] - other.0[i])
    }
}

impl<const N: usize> Mul for Times<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::each(|i| self.0[i] * other.0[i])
    }
}

/// Depth of the renderers' FIFOs in words, and time of a word on the ring, for several machines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fifos<const N: usize> {
    pub(super) depth_words: Times<N>,
    pub(super) word_ns: Times<N>,
}

/// Number of words and execution time of a command or of a message, for several machines.
#[derive(Clone, Copy, Debug)]
pub(super) struct Costs<const N: usize> {
    pub(super) words: Times<N>,
    pub(super) ns: Times<N>,
}

impl<const N: usize> Costs<N> {
    #[inline(always)]
    pub(super) fn each(of: impl Fn(usize) -> Cost) -> Self {
        Self { words: Times::each(|i| of(i).words), ns: Times::each(|i| of(i).ns) }
    }
}

impl<const N: usize> Add for Costs<N> {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self { words: self.words + other.words, ns: self.ns + other.ns }
    }
}

/// A message to a renderer: a header of a few commands, then many equal commands. This struct stores the times that do
/// not depend on the arrival of the message.
///
/// All later times follow from the arrival of the first word by sums and maxima. `max(a, b) + c` equals `max(a + c, b +
/// c)` exactly, even with rounding. Sums are therefore computed before maxima, which shortens the chain of dependent
/// operations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Commands<const N: usize> {
    /// Time of the header on the ring. The header selects and clears the region.
    head_wire: Times<N>,
    head: Times<N>,
    /// Time from the last word of the header to the start of the first command after the header, if no earlier command
    /// is running.
    lead: Times<N>,
    count: f64,
    each: Times<N>,
    wire: Times<N>,
    /// Time from the start of the first command after the header to the end of the last command. The slower of
    /// execution and arrival determines this time.
    drawing: Times<N>,
    /// Time from the start of the first command after the header until the FIFO has room for the last word.
    ///
    /// The FIFO gets this room when an earlier command starts and its words leave the FIFO. The value is `f64::MIN` if
    /// the earlier command belongs to the previous message.
    room_after: Times<N>,
    /// Position of the command whose start makes room for the last word, as a number of commands before the end of the
    /// previous message. The value is infinite if a command of the same message makes the room.
    room_before: Times<N>,
}

impl<const N: usize> Commands<N> {
    #[inline(always)]
    pub(super) fn new(fifos: &Fifos<N>, head: &Costs<N>, count: f64, each: &Costs<N>) -> Self {
        let (word_ns, counts) = (fifos.word_ns, Times::all(count));
        let total = head.words + counts * each.words;
        // A command needs at least the time of its words on the channel.
        let first_wire = each.words * word_ns;
        let slowest = each.ns.later(first_wire);
        // Number of the word that must have left the FIFO before the last word has room, counted from the first
        // command.
        let before_last = total - Times::all(1.0) - fifos.depth_words - head.words;
        let room_after = Times::each(|i| {
            let command = sooner((before_last.0[i] / each.words.0[i]).floor(), count);
            let behind = before_last.0[i] - command * each.words.0[i] + 1.0;
            let after = command * each.ns.0[i] + sooner(behind, each.words.0[i]) * word_ns.0[i];
            if before_last.0[i] >= 0.0 { after } else { f64::MIN }
        });
        let room_before = Times::each(|i| {
            let place = (-before_last.0[i] / each.words.0[i]).ceil();
            if before_last.0[i] >= 0.0 { f64::INFINITY } else { place }
        });
        Self {
            head_wire: head.words * word_ns,
            head: head.ns,
            lead: head.ns.later(first_wire),
            count,
            each: each.ns,
            wire: total * word_ns,
            drawing: (counts * each.ns).later(Times::all(later(count - 1.0, 0.0)) * slowest + each.ns),
            room_after,
            room_before,
        }
    }

    /// Returns the time until the FIFO has room for this message's last word, if this message follows the message
    /// `before`.
    ///
    /// The time counts from the start of the first command of `before`. The time is negative infinity if `before` does
    /// not delay this message.
    #[inline(always)]
    pub(super) fn room_behind(&self, before: &Self) -> Times<N> {
        Times::each(|i| {
            let back = self.room_before.0[i];
            if back > before.count { f64::NEG_INFINITY } else { (before.count - back) * before.each.0[i] }
        })
    }
}

/// A renderer between two messages: the times at which its parts become free.
#[derive(Clone, Copy, Debug)]
pub(super) struct Array<const N: usize> {
    /// Time at which the renderer has executed all commands, or has ended a copy.
    pub(super) free: Times<N>,
    /// Time from which the port accepts a message.
    pub(super) released: Times<N>,
    /// Start of the first command after the header, in the last message.
    last_start: Times<N>,
}

impl<const N: usize> Array<N> {
    pub(super) const fn idle() -> Self {
        Self { free: Times::all(0.0), released: Times::all(0.0), last_start: Times::all(0.0) }
    }

    /// Receives a message whose first word arrives at `first_word`. Returns the time at which the last word has entered
    /// the FIFO.
    ///
    /// `behind` is the time until the FIFO has room after the previous message ([`Commands::room_behind`]).
    #[inline(always)]
    pub(super) fn take(&mut self, first_word: Times<N>, commands: &Commands<N>, behind: Times<N>) -> Times<N> {
        let start = (first_word + commands.head_wire + commands.lead).later(self.free + commands.head);
        let sent = (first_word + commands.wire).later(self.last_start + behind);
        let accepted = (start + commands.room_after).later(sent);
        self.last_start = start;
        self.free = (start + commands.drawing).later(accepted);
        accepted
    }
}
