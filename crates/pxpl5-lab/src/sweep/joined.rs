//! Reader of the rows in many files through one index of points.
//!
//! The index takes 13 bytes for each point and [`BLOCK`] bytes for each file. Only one file is open at a time. A
//! thousand shards of a million points take 29 MB. A separate table for each file would take 8 GB and exceed the number
//! of files that a process may open.

use super::rows::{ROWS_FILE, Scan};
use super::{Header, Status, SweepRow};
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

/// Number of bytes of a file of rows that are read at a time: some tens of rows.
const BLOCK: usize = 16 << 10;

const AGAIN: &str = "cannot be read again";

#[derive(Debug)]
pub(super) struct Joined {
    header: Header,
    files: Vec<RowBlocks>,
    /// Number of the file with the row of each point, counted from 1. 0 means that the point has no row.
    holders: Vec<u32>,
    places: Vec<u64>,
    /// True for each point that could not be simulated.
    failed: Vec<bool>,
    duplicates: Vec<u64>,
}

impl Joined {
    /// Builds the index of the rows in all folders. A folder without a complete header is ignored. Fails if no folder
    /// holds a row, if a folder belongs to another sweep, or if a point has different rows.
    pub(super) fn of(folders: &[PathBuf]) -> Result<Self, FileError> {
        let mut joined: Option<Self> = None;
        for folder in folders {
            let path = folder.join(ROWS_FILE);
            let mut scan = Scan::open(&path)?;
            // A shard that was interrupted at its start contributes nothing.
            let Some(header) = scan.header.take() else { continue };
            let joined = joined.get_or_insert_with(|| Self::new(header.clone()));
            joined.header.check(&path, &header)?;
            joined.files.push(RowBlocks::of(path));
            while let Some((row, byte)) = scan.next()? {
                joined.add(&row, byte)?;
            }
        }
        let mut joined = joined.ok_or_else(|| missing_points(0, 0, "no folder holds a row"))?;
        joined.duplicates.sort_unstable();
        joined.duplicates.dedup();
        Ok(joined)
    }

    /// Builds the index of the rows in one file, for the sweep of `header`. The file may be empty. Also returns the length
    /// in bytes up to the end of the last complete line.
    pub(super) fn of_file(path: &Path, header: &Header) -> Result<(Self, u64), FileError> {
        let mut joined = Self::new(header.clone());
        joined.files.push(RowBlocks::of(path.to_owned()));
        let mut scan = Scan::open(path)?;
        if let Some(found) = &scan.header {
            header.check(path, found)?;
        }
        while let Some((row, byte)) = scan.next()? {
            joined.add(&row, byte)?;
        }
        Ok((joined, scan.whole_bytes()))
    }

    fn new(header: Header) -> Self {
        let points = usize::try_from(header.points).unwrap_or(usize::MAX);
        let (files, duplicates) = (Vec::new(), Vec::new());
        let (holders, places, failed) = (vec![0; points], vec![0; points], vec![false; points]);
        Self { header, files, holders, places, failed, duplicates }
    }

    /// Adds a row of the last added file to the index. `byte` is the byte position of the row in the file.
    pub(super) fn add(&mut self, row: &SweepRow, byte: u64) -> Result<(), FileError> {
        let point = row.point as usize;
        // A second row of a point must equal the first.
        if let Some(first) = self.row(row.point)? {
            if first != *row {
                let [first, second] = [self.holders[point] as usize, self.files.len()]
                    .map(|number| self.files[number - 1].path.display().to_string());
                let reason = format_args!("point {point} has different rows in {first} and {second}");
                return Err(FileError::because(FileErrorKind::Damaged, reason));
            }
            self.duplicates.push(row.point);
            return Ok(());
        }
        self.holders[point] = self.files.len() as u32;
        self.places[point] = byte;
        self.failed[point] = row.status == Status::Failed;
        Ok(())
    }

    pub(super) const fn header(&self) -> &Header {
        &self.header
    }

    pub(super) fn holds(&self, point: u64) -> bool {
        usize::try_from(point).ok().and_then(|point| self.holders.get(point)).is_some_and(|holder| *holder > 0)
    }

    /// Returns the points with a row, in ascending order.
    pub(super) fn points(&self) -> impl Iterator<Item = u64> {
        (0..self.header.points).filter(|point| self.holds(*point))
    }

    pub(super) fn missing(&self) -> Vec<u64> {
        (0..self.header.points).filter(|point| !self.holds(*point)).collect()
    }

    /// Returns the points that could not be simulated, in ascending order.
    pub(super) fn failed(&self) -> impl Iterator<Item = u64> {
        (0..self.header.points).filter(|point| self.failed[*point as usize])
    }

    pub(super) fn duplicates(&self) -> &[u64] {
        &self.duplicates
    }

    /// Returns the row of a point, if it has one.
    pub(super) fn row(&mut self, point: u64) -> Result<Option<SweepRow>, FileError> {
        if !self.holds(point) {
            return Ok(None);
        }
        let file = self.holders[point as usize] as usize - 1;
        self.files[file].row_at(self.places[point as usize]).map(Some)
    }
}

/// Reader of a file of rows in pieces of [`BLOCK`] bytes or more. The file is open only while a piece is read.
#[derive(Debug)]
struct RowBlocks {
    path: PathBuf,
    begin: u64,
    block: Vec<u8>,
}

impl RowBlocks {
    const fn of(path: PathBuf) -> Self {
        Self { path, begin: 0, block: Vec::new() }
    }

    /// Returns the row at a byte position. Reading is fastest in the order of the file, because a piece holds many
    /// rows.
    fn row_at(&mut self, byte: u64) -> Result<SweepRow, FileError> {
        if self.line_at(byte).is_none() {
            self.read(byte).map_err(FileError::io(&self.path, AGAIN))?;
        }
        let line = self.line_at(byte).unwrap_or_default();
        serde_json::from_slice(line).map_err(io::Error::from).map_err(FileError::io(&self.path, AGAIN))
    }

    /// Returns the line at a byte position, if the last piece holds the complete line.
    fn line_at(&self, byte: u64) -> Option<&[u8]> {
        let begin = usize::try_from(byte.checked_sub(self.begin)?).ok()?;
        let rest = self.block.get(begin..)?;
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        Some(&rest[..end])
    }

    /// Reads the piece at a byte position. The piece is extended until it contains a complete line or the file ends.
    fn read(&mut self, byte: u64) -> io::Result<()> {
        let mut file = File::open(&self.path)?;
        file.seek(SeekFrom::Start(byte))?;
        self.begin = byte;
        self.block.clear();
        // A row may be longer than a block.
        loop {
            let read = (&mut file).take(BLOCK as u64).read_to_end(&mut self.block)?;
            if read == 0 || self.line_at(byte).is_some() {
                return Ok(());
            }
        }
    }
}

/// Creates the error of points without a row in any folder. `which` contains the indices of these points as ranges.
pub(super) fn missing_points(missing: u64, points: u64, which: &str) -> FileError {
    FileError::because(
        FileErrorKind::Truncated,
        format_args!("{missing} of {points} points are missing: {which}; resume the shards that hold them"),
    )
}
