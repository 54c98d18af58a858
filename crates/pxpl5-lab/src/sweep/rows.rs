//! Sequential reader of a file of result rows.

use super::{Header, MAX_POINTS, SweepRow};
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use serde::de::DeserializeOwned;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// Name of the file of result rows: a header line, then one line for each point.
pub const ROWS_FILE: &str = "rows.jsonl";

/// Sequential reader of a file of rows, from its beginning to its last complete line.
#[derive(Debug)]
pub(super) struct Scan {
    path: PathBuf,
    file: BufReader<File>,
    text: Vec<u8>,
    /// Number of the last read line, counted from 1.
    line: usize,
    points: u64,
    /// Header of the file. `None` if the header is incomplete.
    pub(super) header: Option<Header>,
    pub(super) whole_bytes: u64,
}

impl Scan {
    pub(super) fn open(path: &Path) -> Result<Self, FileError> {
        let file = File::open(path)
            .map_err(|error| FileError::unreadable(path.display(), "a readable file of rows", error))?;
        let (file, text) = (BufReader::new(file), Vec::new());
        let mut scan = Self { path: path.to_owned(), file, text, line: 0, points: 0, header: None, whole_bytes: 0 };
        if scan.read_line()? {
            let header: Header = scan.parsed()?;
            if header.points > MAX_POINTS {
                return Err(scan.damaged(format!("a sweep of {} points, more than {MAX_POINTS}", header.points)));
            }
            scan.points = header.points;
            scan.header = Some(header);
        }
        Ok(scan)
    }

    pub(super) fn next(&mut self) -> Result<Option<(SweepRow, u64)>, FileError> {
        let begin = self.whole_bytes;
        if !self.read_line()? {
            return Ok(None);
        }
        let row: SweepRow = self.parsed()?;
        if row.point >= self.points {
            return Err(self.damaged(format!("point {} of {}", row.point, self.points)));
        }
        Ok(Some((row, begin)))
    }

    /// Reads a line of the file. Returns false if the line is incomplete.
    fn read_line(&mut self) -> Result<bool, FileError> {
        self.text.clear();
        self.file.read_until(b'\n', &mut self.text).map_err(FileError::io(&self.path, "cannot be read"))?;
        let is_whole = self.text.last() == Some(&b'\n');
        if is_whole {
            self.line += 1;
            self.whole_bytes += self.text.len() as u64;
        }
        Ok(is_whole)
    }

    fn parsed<T: DeserializeOwned>(&self) -> Result<T, FileError> {
        serde_json::from_slice(&self.text).map_err(|error| self.damaged(format!("{} ({error})", excerpt(&self.text))))
    }

    fn damaged(&self, found: String) -> FileError {
        let file = format!("{}, line {}", self.path.display(), self.line);
        FileError::new(FileErrorKind::Damaged, "a row of a sweep", found).in_file(file)
    }
}

/// Creates the error of a point with two different rows. `first` and `second` name the files of these rows, and can be
/// equal.
pub(super) fn contradiction(point: u64, first: &str, second: &str) -> FileError {
    let reason = format_args!("point {point} has different rows in {first} and {second}");
    FileError::because(FileErrorKind::Damaged, reason)
}

fn excerpt(line: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(line).trim_end().chars().take(40).collect();
    format!("{text:?}")
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
