//! Sequential reader of a file of result rows.

use super::lines::Lines;
use super::{Header, MAX_POINTS, SweepRow};
use pxpl5_sim::parameters::FileError;
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
