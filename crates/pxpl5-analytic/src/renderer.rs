//! A renderer's input FIFO and array, a message at a time.

use pxpl5_renderer::{CommandKind, RendererTiming};
use std::ops::{Add, Mul, Sub};

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

/// Times of some configurations at once, nanoseconds: everything is done to each by itself, so that each is what it would be alone.
/// A register's width apart in memory: what lies across two lines of the cache takes twice as long, and the stack is as it comes.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(super) struct Times<const N: usize>(pub(super) [f64; N]);

impl<const N: usize> Times<N> {
    pub(super) const fn all(ns: f64) -> Self {
        Self([ns; N])
    }

    #[inline(always)]
    pub(super) fn each(ns: impl Fn(usize) -> f64) -> Self {
        // A loop, because `from_fn` is not always inlined, and then compiled for any processor.
        let mut all = [0.0; N];
        for (i, lane) in all.iter_mut().enumerate() {
            *lane = ns(i);
        }
        Self(all)
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

impl<const N: usize> Mul for Times<N> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self::each(|i| self.0[i] * other.0[i])
    }
}

/// Depth and speed of the FIFOs of some configurations.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fifos<const N: usize> {
    pub(super) depth_words: Times<N>,
    pub(super) word_ns: Times<N>,
}

/// Words and times of what is sent on some configurations.
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

/// A message of equal commands in a row, with all of its times that do not depend on when it comes.
///
/// Of a message's first word everything else is sums and the latest of some: `max(a, b) + c` is exactly `max(a + c, b + c)`, whatever is
/// rounded, so sums are taken before maxima where fewer then wait for each other.
#[derive(Clone, Copy, Debug)]
pub(super) struct Commands<const N: usize> {
    /// Words before the commands on the channel, and the time that they take: selection, clearing.
    head_wire: Times<N>,
    head: Times<N>,
    /// From the head's last word to the start of the first command, if the array is free.
    lead: Times<N>,
    /// How many commands, and the time of one.
    count: f64,
    each: Times<N>,
    /// The whole message on the channel.
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
    /// So many commands behind a head.
    #[inline(always)]
    pub(super) fn new(fifos: &Fifos<N>, head: &Costs<N>, count: f64, each: &Costs<N>) -> Self {
        let (word_ns, counts) = (fifos.word_ns, Times::all(count));
        let total = head.words + counts * each.words;
        let first_wire = each.words * word_ns;
        let slowest = each.ns.later(first_wire);
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

    /// From the start of the first command of the message before to when its room is there for the last word of this one; before all
    /// times where no room of that message is waited for.
    #[inline(always)]
    pub(super) fn room_behind(&self, before: &Self) -> Times<N> {
        Times::each(|i| {
            let back = self.room_before.0[i];
            if back > before.count { f64::NEG_INFINITY } else { (before.count - back) * before.each.0[i] }
        })
    }
}

/// What is known of a renderer between messages.
#[derive(Clone, Copy, Debug)]
pub(super) struct Array<const N: usize> {
    /// When everything sent to it so far has been executed, or the copy that holds it has ended.
    pub(super) free: Times<N>,
    /// When its port was free again.
    pub(super) released: Times<N>,
    /// When the last message's first command started.
    last_start: Times<N>,
}

impl<const N: usize> Array<N> {
    /// An array without anything to do.
    pub(super) const fn idle() -> Self {
        Self { free: Times::all(0.0), released: Times::all(0.0), last_start: Times::all(0.0) }
    }

    /// A message whose first word begins at `first_word`, behind one that leaves room [so long](Commands::room_behind) after its first
    /// command: when its last word has entered.
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
