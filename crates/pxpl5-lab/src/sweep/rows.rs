//! A file of rows: where each point's row begins is held, the rows themselves are read when they are asked for.

use super::points::Points;
use super::{Header, Status, SweepError, SweepRow};
use serde::de::DeserializeOwned;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// What a file of rows holds; eight bytes a point, and a bit for each that failed.
#[derive(Debug, Default)]
pub(super) struct RowFile {
    path: PathBuf,
    header: Option<Header>,
    /// By point: the byte at which its row begins. The header is there, so that no row begins at 0.
    places: Vec<u64>,
    finished: u64,
    failed: Points,
    /// Points that have a second, equal row.
    repeated: Vec<u64>,
    /// Bytes up to the end of the last whole line.
    whole_bytes: u64,
}

impl RowFile {
    /// Reads a file through; a last line without an end is passed over.
    pub(super) fn open(path: &Path) -> Result<Self, SweepError> {
        let file = File::open(path).map_err(SweepError::io(path, "cannot be read"))?;
        let mut found = Self { path: path.to_owned(), ..Self::default() };
        found.scan(BufReader::new(file))?;
        Ok(found)
    }

    /// The same of a file that need not be there.
    pub(super) fn open_or_none(path: &Path) -> Result<Self, SweepError> {
        match path.try_exists() {
            Ok(false) => Ok(Self { path: path.to_owned(), ..Self::default() }),
            _ => Self::open(path),
        }
    }

    fn scan(&mut self, mut file: BufReader<File>) -> Result<(), SweepError> {
        let mut line = Vec::new();
        for number in 1.. {
            line.clear();
            file.read_until(b'\n', &mut line).map_err(SweepError::io(&self.path, "cannot be read"))?;
            if line.last() != Some(&b'\n') {
                break;
            }
            match &self.header {
                None => self.header = Some(self.parsed(&line, number)?),
                Some(header) => {
                    let points = header.points;
                    self.check_and_add(&self.parsed(&line, number)?, points, number)?;
                }
            }
            self.whole_bytes += line.len() as u64;
        }
        Ok(())
    }

    fn check_and_add(&mut self, row: &SweepRow, points: u64, line: usize) -> Result<(), SweepError> {
        let path = self.path.display().to_string();
        if row.point >= points {
            return Err(SweepError::Damaged { path, line, found: format!("point {} of {points}", row.point) });
        }
        if !self.holds(row.point) {
            self.add(row, self.whole_bytes);
        } else if self.reader()?.row(row.point)?.as_ref() == Some(row) {
            self.repeated.push(row.point);
        } else {
            return Err(SweepError::Contradiction { point: row.point, first: path.clone(), second: path });
        }
        Ok(())
    }

    /// What a line of the file holds.
    fn parsed<T: DeserializeOwned>(&self, line: &[u8], number: usize) -> Result<T, SweepError> {
        serde_json::from_slice(line).map_err(|error| SweepError::Damaged {
            path: self.path.display().to_string(),
            line: number,
            found: format!("{} ({error})", excerpt(line)),
        })
    }

    /// Notes that a point's row begins at a byte.
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

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) const fn header(&self) -> Option<&Header> {
        self.header.as_ref()
    }

    /// Whether not even a header is there.
    pub(super) const fn is_empty(&self) -> bool {
        self.header.is_none()
    }

    pub(super) const fn whole_bytes(&self) -> u64 {
        self.whole_bytes
    }

    pub(super) fn repeated(&self) -> &[u64] {
        &self.repeated
    }

    /// How many points have a row.
    pub(super) const fn finished(&self) -> u64 {
        self.finished
    }

    pub(super) fn holds(&self, point: u64) -> bool {
        self.place(point).is_some()
    }

    /// Whether a point has a row that says why it could not be simulated.
    pub(super) fn is_failed(&self, point: u64) -> bool {
        self.failed.holds(point)
    }

    /// The points that have a row, in order.
    pub(super) fn points(&self) -> impl Iterator<Item = u64> {
        (0..).zip(&self.places).filter(|(_, place)| **place > 0).map(|(point, _)| point)
    }

    fn place(&self, point: u64) -> Option<u64> {
        let place = usize::try_from(point).ok().and_then(|point| self.places.get(point));
        place.copied().filter(|place| *place > 0)
    }

    /// Opens the file again, to read rows that it is known to hold.
    pub(super) fn reader(&self) -> Result<RowReader<'_>, SweepError> {
        let file = File::open(&self.path).map_err(SweepError::io(&self.path, "cannot be read"))?;
        Ok(RowReader { rows: self, file: BufReader::new(file), at: 0 })
    }
}

/// Reads rows by point; cheapest in the order of the file.
#[derive(Debug)]
pub(super) struct RowReader<'a> {
    rows: &'a RowFile,
    file: BufReader<File>,
    /// The byte that comes next.
    at: u64,
}

impl RowReader<'_> {
    /// A point's row, if the file has one.
    pub(super) fn row(&mut self, point: u64) -> Result<Option<SweepRow>, SweepError> {
        let Some(place) = self.rows.place(point) else { return Ok(None) };
        let row = self.row_at(place).map_err(SweepError::io(&self.rows.path, "cannot be read again"))?;
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
