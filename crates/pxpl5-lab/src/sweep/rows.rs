//! Sequential reader of a file of result rows.

use super::lines::Lines;
use super::{Header, MAX_POINTS, SweepRow};
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::path::Path;

/// Name of the file of result rows: a header line, then one line for each point.
pub const ROWS_FILE: &str = "rows.jsonl";

/// Sequential reader of a file of rows, from its beginning to its last complete line.
#[derive(Debug)]
pub(super) struct Scan {
    lines: Lines,
    points: u64,
    /// Header of the file. `None` if the header is incomplete.
    pub(super) header: Option<Header>,
}

impl Scan {
    pub(super) fn open(path: &Path) -> Result<Self, FileError> {
        let mut lines = Lines::open(path, "a row of a sweep")?;
        let header: Option<Header> = lines.next()?;
        let points = header.as_ref().map_or(0, |header| header.points);
        if points > MAX_POINTS {
            return Err(lines.damaged(format!("a sweep of {points} points, more than {MAX_POINTS}")));
        }
        Ok(Self { lines, points, header })
    }

    /// Returns the next row and its byte position.
    pub(super) fn next(&mut self) -> Result<Option<(SweepRow, u64)>, FileError> {
        let begin = self.whole_bytes();
        let row: Option<SweepRow> = self.lines.next()?;
        match &row {
            Some(SweepRow { point, .. }) if *point >= self.points => {
                Err(self.lines.damaged(format!("point {point} of {}", self.points)))
            }
            _ => Ok(row.map(|row| (row, begin))),
        }
    }

    pub(super) const fn whole_bytes(&self) -> u64 {
        self.lines.whole_bytes
    }
}

/// Creates the error of a point with two different rows. `first` and `second` name the files of these rows, and can be
/// equal.
pub(super) fn contradiction(point: u64, first: &str, second: &str) -> FileError {
    let reason = format_args!("point {point} has different rows in {first} and {second}");
    FileError::because(FileErrorKind::Damaged, reason)
}

/// A set of points of a sweep, with one bit for each point. Ten million points take 1.25 MB.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Points(Vec<u64>);

impl Points {
    pub(super) fn put(&mut self, point: u64) {
        let word = (point / 64) as usize;
        if self.0.len() <= word {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= 1 << (point % 64);
    }

    pub(super) fn holds(&self, point: u64) -> bool {
        self.0.get((point / 64) as usize).is_some_and(|word| word >> (point % 64) & 1 == 1)
    }
}

impl FromIterator<u64> for Points {
    fn from_iter<I: IntoIterator<Item = u64>>(numbers: I) -> Self {
        let mut points = Self::default();
        numbers.into_iter().for_each(|point| points.put(point));
        points
    }
}
