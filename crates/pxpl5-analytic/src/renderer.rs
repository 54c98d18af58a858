//! A renderer's input FIFO and array, a message at a time.

use pxpl5_renderer::{CommandKind, RendererTiming};
use std::ops::{Add, Sub};

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

/// Times of some configurations at once, nanoseconds: everything is done to each by itself, so that each is what it would be alone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Times<const N: usize>(pub(super) [f64; N]);

impl<const N: usize> Times<N> {
    pub(super) const fn all(ns: f64) -> Self {
        Self([ns; N])
    }

    #[inline(always)]
    pub(super) fn each(ns: impl Fn(usize) -> f64) -> Self {
        Self(std::array::from_fn(ns))
    }

    /// [`later`] of each.
    #[inline(always)]
    pub(super) fn later(self, other: Self) -> Self {
        Self::each(|i| later(self.0[i], other.0[i]))
    }

    /// [`sooner`] of each; of two that are the same the other one.
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

/// A message of equal commands in a row, with all of its times that do not depend on when it comes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Commands<const N: usize> {
    /// Words before the commands, on the channel, and the time that they take: selection, clearing.
    head_wire: Times<N>,
    head: Times<N>,
    /// How many commands, and the time of one.
    count: Times<N>,
    each: Times<N>,
    /// One command and the whole message on the channel.
    first_wire: Times<N>,
    wire: Times<N>,
    /// From the start of the first command to the end of the last one, with the words at their heels.
    drawing: Times<N>,
    /// When the last word finds room: the command that holds the word a FIFO's depth before must have started. Either it is in the
    /// message itself, this long after its first one; or it is in the message before, at this place from its end. What is not so is
    /// before all times, and behind all places.
    room_after: Times<N>,
    room_before: Times<N>,
}

impl<const N: usize> Commands<N> {
    /// A configuration's `count` commands behind a head, and so on, for each configuration.
    #[inline(always)]
    pub(super) fn new(of: impl Fn(usize) -> (Fifo, Cost, f64, Cost)) -> Self {
        let none = Times::all(0.0);
        let mut all = Self {
            head_wire: none,
            head: none,
            count: none,
            each: none,
            first_wire: none,
            wire: none,
            drawing: none,
            room_after: Times::all(f64::MIN),
            room_before: Times::all(f64::INFINITY),
        };
        for i in 0..N {
            let (Fifo { depth_words, word_ns }, head, count, each) = of(i);
            let total = head.words + count * each.words;
            let slowest = each.ns.max(each.words * word_ns);
            let before_last = total - 1.0 - depth_words - head.words;
            if before_last >= 0.0 {
                let command = (before_last / each.words).floor().min(count);
                let behind = before_last - command * each.words + 1.0;
                all.room_after.0[i] = command * each.ns + behind.min(each.words) * word_ns;
            } else {
                all.room_before.0[i] = (-before_last / each.words).ceil();
            }
            all.head.0[i] = head.ns;
            all.head_wire.0[i] = head.words * word_ns;
            all.count.0[i] = count;
            all.each.0[i] = each.ns;
            all.first_wire.0[i] = each.words * word_ns;
            all.wire.0[i] = total * word_ns;
            all.drawing.0[i] = (count * each.ns).max((count - 1.0).max(0.0) * slowest + each.ns);
        }
        all
    }
}

/// What is known of a renderer between messages.
#[derive(Clone, Copy, Debug)]
pub(super) struct Array<const N: usize> {
    /// When everything sent to it so far has been executed.
    pub(super) free: Times<N>,
    /// When the last message's first command started, how many there were, and their time.
    last_start: Times<N>,
    last_count: Times<N>,
    last_each: Times<N>,
}

impl<const N: usize> Array<N> {
    /// An array that is busy, or held by a copy, until `free`.
    pub(super) const fn busy_until(free: Times<N>) -> Self {
        Self { free, last_start: free, last_count: Times::all(0.0), last_each: Times::all(0.0) }
    }

    /// A message whose first word begins at `first_word`: when its last word has entered.
    #[inline(always)]
    pub(super) fn take(&mut self, first_word: Times<N>, commands: &Commands<N>) -> Times<N> {
        let head_at = first_word + commands.head_wire;
        let start = (head_at.later(self.free) + commands.head).later(head_at + commands.first_wire);
        let before = Times::each(|i| {
            let back = commands.room_before.0[i];
            let at = self.last_start.0[i] + (self.last_count.0[i] - back) * self.last_each.0[i];
            if back > self.last_count.0[i] { f64::MIN } else { at }
        });
        let room = (start + commands.room_after).later(before);
        let accepted = (first_word + commands.wire).later(room);
        self.last_start = start;
        self.last_count = commands.count;
        self.last_each = commands.each;
        self.free = (start + commands.drawing).later(accepted);
        accepted
    }
}
