//! Which fields were scanned from a buffer, and so which of its lines were shown before they were overwritten.

use crate::region::RegionWrite;
use crate::video::Video;
use pxpl5_sim::{Span, Time};
use pxpl5_wire::PeriodNumber;
use std::collections::VecDeque;

/// Fields that are remembered: the newest two of either parity, of which the very last may not have reached a line.
const REMEMBERED: usize = 4;

/// The last fields that were scanned from a buffer, newest first.
#[derive(Clone, Debug, Default)]
pub(crate) struct Scans(VecDeque<PeriodNumber>);

/// A region that another one of the same cut has overwritten, both complete.
pub(crate) struct Overwritten<'a> {
    pub(crate) older: &'a RegionWrite,
    pub(crate) newer: &'a RegionWrite,
    pub(crate) video: &'a Video,
    pub(crate) word: Span,
}

/// From the first pixel of a line, or of more than one, to the last.
#[derive(Clone, Copy, Debug)]
struct Interval {
    begin: Time,
    end: Time,
}

impl Scans {
    pub(crate) fn begin(&mut self, field: PeriodNumber) {
        self.0.truncate(REMEMBERED - 1);
        self.0.push_front(field);
    }

    /// Lines of the older region that were overwritten before the beam had shown them from the first pixel to the last.
    pub(crate) fn lines_never_shown(&self, pair: &Overwritten<'_>) -> u64 {
        if self.shows_all(pair) {
            return 0;
        }
        pair.older.rows().filter(|row| !self.shows_row(*row, pair)).count() as u64
    }

    /// Whether a field has shown the outermost of its lines, and so those between them, after the end of one write and before
    /// the begin of the other. Saves looking at each line.
    fn shows_all(&self, pair: &Overwritten<'_>) -> bool {
        let Some(written_at) = pair.older.last_at() else { return false };
        let Some(overwritten) = row_arrival(pair.newer, 0, pair.word) else { return false };
        let stands = Stands {
            written: Interval { begin: written_at, end: written_at },
            overwritten: Interval { end: overwritten.begin, ..overwritten },
        };
        let rows = pair.older.rows();
        // Every second row lies in the other field, where the region is one of a frame.
        rows.clone().take(2).all(|first| {
            let last = rows.clone().skip(first as usize).step_by(2).next_back().unwrap_or(first);
            self.0.iter().any(|field| [first, last].iter().all(|row| stands.shows(scan(*row, *field, pair))))
        })
    }

    fn shows_row(&self, row: u32, pair: &Overwritten<'_>) -> bool {
        let written = row_arrival(pair.older, row, pair.word);
        let overwritten = row_arrival(pair.newer, row, pair.word);
        let Some((written, overwritten)) = written.zip(overwritten) else { return false };
        let stands = Stands { written, overwritten };
        self.0.iter().any(|field| stands.shows(scan(row, *field, pair)))
    }
}

/// When the pixels of a row were in the buffer.
struct Stands {
    written: Interval,
    overwritten: Interval,
}

impl Stands {
    /// Whether a pass of the beam shows all of them. Of a word that arrives with the beam the new value is shown. Words and
    /// beam both advance evenly, so the ends of the row decide.
    fn shows(&self, scan: Option<Interval>) -> bool {
        scan.is_some_and(|scan| {
            let after = self.written.begin <= scan.begin && self.written.end <= scan.end;
            let before = scan.begin < self.overwritten.begin && scan.end < self.overwritten.end;
            after && before
        })
    }
}

/// When the beam passes over a row of the older region in a field; `None` where it does not.
fn scan(row: u32, field: PeriodNumber, pair: &Overwritten<'_>) -> Option<Interval> {
    let segment = pair.older.row(row, Span::ZERO).next()?;
    let begin = pair.video.when(segment.x, segment.y, field)?;
    Some(Interval { begin, end: pair.video.when(pair.older.last_x(), segment.y, field)? })
}

/// When the first and the last pixel of a complete region's row arrived.
fn row_arrival(region: &RegionWrite, row: u32, word: Span) -> Option<Interval> {
    let begin = region.row(row, word).map(|segment| segment.arrival(0, word)).min()?;
    let end = region.row(row, word).map(|segment| segment.arrival(segment.length - 1, word)).max()?;
    Some(Interval { begin, end })
}
