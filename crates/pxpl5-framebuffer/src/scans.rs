//! A record of the fields that showed a buffer. With this record, the board counts lines that were overwritten before
//! the beam had shown them.

use crate::region::RegionWrite;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::Video;
use pxpl5_wire::{MAX_MESSAGE_WORDS, PeriodNumber};
use std::collections::VecDeque;

/// Number of recorded fields: the newest two fields of each parity, while a buffer is displayed without a swap. One
/// field of each parity is not enough, because the beam may not have reached a line of the current field yet.
const REMEMBERED: usize = 4;

/// Numbers of the last fields that were scanned from a buffer, the newest first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scans(VecDeque<PeriodNumber>);

/// A complete region whose pixels were overwritten by another complete region.
pub(crate) struct Overwritten<'a> {
    pub(crate) older: &'a RegionWrite,
    pub(crate) newer: &'a RegionWrite,
    pub(crate) video: &'a Video,
    pub(crate) word: Span,
}

impl Scans {
    pub(crate) fn begin(&mut self, field: PeriodNumber) {
        self.0.truncate(REMEMBERED - 1);
        self.0.push_front(field);
    }

    /// Returns the number of lines of the older region that the beam had not shown completely when the newer region
    /// overwrote them.
    pub(crate) fn lines_never_shown(&self, pair: &Overwritten<'_>) -> u64 {
        if self.shows_all(pair) {
            return 0;
        }
        pair.older.rows().filter(|row| !self.shows_row(*row, pair)).count() as u64
    }

    /// Returns true if a fast test proves that the beam has shown the older region completely. Even and odd rows are
    /// tested separately.
    ///
    /// Each group needs a field in which the beam passes the first and the last pixel after the older region was
    /// written, and before the newer one. It then also passes the other pixels of the group in this time.
    fn shows_all(&self, pair: &Overwritten<'_>) -> bool {
        // The older region must be complete before a field shows it.
        let Some(written) = pair.older.last_at() else { return false };
        // The first word of a message arrives at most 1,023 word times before its last word.
        let overwritten =
            Time(pair.newer.first_at().0.saturating_sub((pair.word * u64::from(MAX_MESSAGE_WORDS - 1)).0));
        let rows = pair.older.rows();
        // In a region of a frame, every second row belongs to the same field.
        rows.clone().take(2).all(|first| {
            let last = rows.clone().skip(first as usize).step_by(2).next_back().unwrap_or(first);
            let shows = |(at, field)| scan(at, field, pair).is_some_and(|scan| written <= scan && scan < overwritten);
            self.0.iter().any(|field| corners(pair.older, [first, last]).all(|at| shows((at, *field))))
        })
    }

    fn shows_row(&self, row: u32, pair: &Overwritten<'_>) -> bool {
        // If the new word arrives at the instant of the beam, the pixel shows the new word.
        let shows = |field| {
            let beam = |at| scan(at, field, pair);
            let stood = ends(pair.older, row, pair.word).all(|(at, came)| beam(at).is_some_and(|scan| came <= scan));
            stood && ends(pair.newer, row, pair.word).all(|(at, came)| beam(at).is_some_and(|scan| scan < came))
        };
        self.0.iter().any(|field| shows(*field))
    }
}

/// Returns the time at which the beam passes a pixel in `field`, or `None` if this field does not scan the pixel.
fn scan([x, y]: [u32; 2], field: PeriodNumber, pair: &Overwritten<'_>) -> Option<Time> {
    pair.video.when(x, y, field)
}

/// Iterates over two corners of a region: the first pixel of row `first` and the last pixel of row `last`.
fn corners(region: &RegionWrite, [first, last]: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let [first, last] = [first, last].map(|row| ends(region, row, Span::ZERO));
    let [first, last] = [first.map(|end| end.0).next(), last.map(|end| end.0).last()];
    first.into_iter().chain(last)
}

/// Iterates over the first and the last pixel of each part of a row that arrived in one message. Each item has the
/// pixel and the arrival time of its word. The region must be complete.
///
/// Beam and words of a message both advance at constant rates. If the beam passes these two pixels in time, it also
/// passes those between them in time.
fn ends(region: &RegionWrite, row: u32, word: Span) -> impl Iterator<Item = ([u32; 2], Time)> + '_ {
    region.row(row, word).flat_map(move |segment| {
        [0, segment.length - 1].map(|i| ([segment.x + i, segment.y], segment.arrival(i, word)))
    })
}
