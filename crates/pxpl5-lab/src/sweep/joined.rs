//! Rows of many files as if they were one: which file has the row of a point, and where in it.
//!
//! It takes 12 bytes a point and [`BLOCK`] bytes a file, and holds one file open at a time: a thousand shards of a million points
//! are 28 MB, where a table for each file would be 8 GB, and more files than a process may have open.

use super::points::Points;
use super::rows::Scan;
use super::store::check_header;
use super::{Header, ROWS_FILE, Status, SweepError, SweepRow};
use std::fs::File;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::PathBuf;

/// Bytes that are read of a file at a time: some tens of rows.
const BLOCK: usize = 16 << 10;

/// What failed of a file that could be read before.
const AGAIN: &str = "cannot be read again";

/// The rows of all files.
#[derive(Debug)]
pub(super) struct Joined {
    header: Header,
    files: Vec<RowBlocks>,
    /// By point: number of the file with its row, from 1; 0 of a point that has none.
    holders: Vec<u32>,
    /// By point: the byte of that file at which the row begins.
    places: Vec<u64>,
    failed: Points,
    /// Points that have several rows, all equal.
    duplicates: Vec<u64>,
}

impl Joined {
    /// Reads the rows of all folders through. A folder in which not even a header is whole counts for nothing.
    ///
    /// # Errors
    ///
    /// [`SweepError::Missing`] when no folder holds a row, [`SweepError::Foreign`] when one is of another sweep,
    /// [`SweepError::Contradiction`] when a point has different rows.
    pub(super) fn of(folders: &[PathBuf]) -> Result<Self, SweepError> {
        let mut joined: Option<Self> = None;
        for folder in folders {
            let path = folder.join(ROWS_FILE);
            let mut scan = Scan::open(&path)?;
            let Some(header) = scan.header.take() else { continue };
            let joined = joined.get_or_insert_with(|| Self::new(header.clone()));
            check_header(&path, &joined.header, Some(&header))?;
            joined.files.push(RowBlocks::of(path));
            while let Some((row, byte)) = scan.next()? {
                joined.add(&row, byte)?;
            }
        }
        let mut joined = joined.ok_or_else(|| SweepError::Missing {
            missing: 0,
            points: 0,
            which: "no folder holds a row".to_owned(),
        })?;
        joined.duplicates.sort_unstable();
        joined.duplicates.dedup();
        Ok(joined)
    }

    fn new(header: Header) -> Self {
        let points = usize::try_from(header.points).unwrap_or(usize::MAX);
        let (files, failed, duplicates) = (Vec::new(), Points::default(), Vec::new());
        Self { holders: vec![0; points], places: vec![0; points], header, files, failed, duplicates }
    }

    /// Takes a row of the newest file in.
    fn add(&mut self, row: &SweepRow, byte: u64) -> Result<(), SweepError> {
        let point = row.point as usize;
        if let Some(first) = self.row(row.point)? {
            if first != *row {
                let [first, second] = [self.holders[point] as usize, self.files.len()]
                    .map(|number| self.files[number - 1].path.display().to_string());
                return Err(SweepError::Contradiction { point: row.point, first, second });
            }
            self.duplicates.push(row.point);
            return Ok(());
        }
        self.holders[point] = self.files.len() as u32;
        self.places[point] = byte;
        if row.status == Status::Failed {
            self.failed.put(row.point);
        }
        Ok(())
    }

    /// What all rows have in common.
    pub(super) const fn header(&self) -> &Header {
        &self.header
    }

    /// The points that have no row, in order.
    pub(super) fn missing(&self) -> Vec<u64> {
        (0..).zip(&self.holders).filter(|(_, holder)| **holder == 0).map(|(point, _)| point).collect()
    }

    /// How many points could not be simulated.
    pub(super) fn failed(&self) -> u64 {
        (0..self.header.points).filter(|point| self.failed.holds(*point)).count() as u64
    }

    /// The points that have several rows, all equal, in order.
    pub(super) fn duplicates(&self) -> &[u64] {
        &self.duplicates
    }

    /// The row of a point below the number of points, if there is one.
    pub(super) fn row(&mut self, point: u64) -> Result<Option<SweepRow>, SweepError> {
        let Some(file) = (self.holders[point as usize] as usize).checked_sub(1) else { return Ok(None) };
        self.files[file].row_at(self.places[point as usize]).map(Some)
    }
}

/// A file of rows that is open only while a block of it is read.
#[derive(Debug)]
struct RowBlocks {
    path: PathBuf,
    /// The byte of the file at which the block begins.
    begin: u64,
    block: Vec<u8>,
}

impl RowBlocks {
    const fn of(path: PathBuf) -> Self {
        Self { path, begin: 0, block: Vec::new() }
    }

    /// The row that begins at a byte; cheapest in the order of the file.
    fn row_at(&mut self, byte: u64) -> Result<SweepRow, SweepError> {
        if self.line_at(byte).is_none() {
            self.read(byte).map_err(SweepError::io(&self.path, AGAIN))?;
        }
        let line = self.line_at(byte).unwrap_or_default();
        serde_json::from_slice(line).map_err(io::Error::from).map_err(SweepError::io(&self.path, AGAIN))
    }

    /// A line of the block, if it is in it to its end.
    fn line_at(&self, byte: u64) -> Option<&[u8]> {
        let begin = usize::try_from(byte.checked_sub(self.begin)?).ok()?;
        let rest = self.block.get(begin..)?;
        let end = rest.iter().position(|byte| *byte == b'\n')?;
        Some(&rest[..end])
    }

    /// Reads the block that begins at a byte, with at least one whole line where the file has one.
    fn read(&mut self, byte: u64) -> io::Result<()> {
        let mut file = File::open(&self.path)?;
        file.seek(SeekFrom::Start(byte))?;
        self.begin = byte;
        self.block.clear();
        loop {
            let read = (&mut file).take(BLOCK as u64).read_to_end(&mut self.block)?;
            if read == 0 || self.line_at(byte).is_some() {
                return Ok(());
            }
        }
    }
}
