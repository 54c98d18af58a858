//! Reader of a file of result rows through an index of byte positions. A row is read only when it is needed.

use super::{Header, MAX_POINTS, Status, SweepRow};
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use serde::de::DeserializeOwned;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// Index of a file of result rows, with eight bytes for each point and one bit for each failed point.
#[derive(Debug, Default)]
pub(super) struct RowFile {
    path: PathBuf,
    header: Option<Header>,
    /// Byte position of the row of each point. 0 means no row, because the header is at position 0.
    places: Vec<u64>,
    finished: u64,
    failed: Points,
    /// Length in bytes up to the end of the last complete line.
    whole_bytes: u64,
}

impl RowFile {
    /// Builds the index of a file of result rows. An incomplete last line is ignored.
    pub(super) fn open(path: &Path) -> Result<Self, FileError> {
        let mut scan = Scan::open(path)?;
        let mut found = Self { path: path.to_owned(), header: scan.header.take(), ..Self::default() };
        while let Some((row, byte)) = scan.next()? {
            found.check_and_add(&row, byte)?;
        }
        found.whole_bytes = scan.whole_bytes;
        Ok(found)
    }

    /// Builds the index of a file of result rows. The index is empty if the file does not exist.
    pub(super) fn open_or_none(path: &Path) -> Result<Self, FileError> {
        match path.try_exists() {
            Ok(false) => Ok(Self { path: path.to_owned(), ..Self::default() }),
            _ => Self::open(path),
        }
    }

    fn check_and_add(&mut self, row: &SweepRow, byte: u64) -> Result<(), FileError> {
        if !self.holds(row.point) {
            self.add(row, byte);
        } else if self.reader()?.row(row.point)?.as_ref() != Some(row) {
            let path = self.path.display().to_string();
            return Err(contradiction(row.point, &path, &path));
        }
        Ok(())
    }

    pub(super) fn add(&mut self, row: &SweepRow, byte: u64) {
        let point = row.point as usize;
        if self.places.len() <= point {
            self.places.resize(point + 1, 0);
        }
        self.places[point] = byte;
        self.finished += 1;
        if row.status == Status::Failed {
            self.failed.put(row.point);
        }
    }

    pub(super) const fn header(&self) -> Option<&Header> {
        self.header.as_ref()
    }

    pub(super) const fn whole_bytes(&self) -> u64 {
        self.whole_bytes
    }

    pub(super) const fn finished(&self) -> u64 {
        self.finished
    }

    pub(super) fn holds(&self, point: u64) -> bool {
        self.place(point).is_some()
    }

    pub(super) fn is_failed(&self, point: u64) -> bool {
        self.failed.holds(point)
    }

    pub(super) fn points(&self) -> impl Iterator<Item = u64> {
        (0..).zip(&self.places).filter(|(_, place)| **place > 0).map(|(point, _)| point)
    }

    fn place(&self, point: u64) -> Option<u64> {
        let place = usize::try_from(point).ok().and_then(|point| self.places.get(point));
        place.copied().filter(|place| *place > 0)
    }

    pub(super) fn reader(&self) -> Result<RowReader<'_>, FileError> {
        let file = File::open(&self.path).map_err(FileError::io(&self.path, "cannot be read"))?;
        Ok(RowReader { rows: self, file: BufReader::new(file), at: 0 })
    }
}

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

/// Reader of the row of any point. Reading is fastest in the order of the file.
#[derive(Debug)]
pub(super) struct RowReader<'a> {
    rows: &'a RowFile,
    file: BufReader<File>,
    at: u64,
}

impl RowReader<'_> {
    pub(super) fn row(&mut self, point: u64) -> Result<Option<SweepRow>, FileError> {
        let Some(place) = self.rows.place(point) else { return Ok(None) };
        let row = self.row_at(place).map_err(FileError::io(&self.rows.path, "cannot be read again"))?;
        Ok(Some(row))
    }

    fn row_at(&mut self, place: u64) -> std::io::Result<SweepRow> {
        self.file.seek_relative(place.wrapping_sub(self.at).cast_signed())?;
        let mut line = Vec::new();
        self.at = place + self.file.read_until(b'\n', &mut line)? as u64;
        Ok(serde_json::from_slice(&line)?)
    }
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
