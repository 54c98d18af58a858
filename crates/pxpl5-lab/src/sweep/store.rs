//! The folder of a sweep, with one row of results for each simulated point. Each row is appended by one write, so
//! finished rows survive a crash at any moment.

use super::joined::Joined;
use super::lines::{LineFile, line_of};
use super::replacement::Replacement;
use super::rows::ROWS_FILE;
use super::shard::Shard;
use super::table::Table;
use super::{Header, SweepRow};
use crate::manifest::{MANIFEST_FILE, Manifest, is_temporary};
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use serde::Serialize;
use std::fs::{self, File};
use std::path::{Path, PathBuf};

/// Name of the file of durations: the header line, then one line for each point with its computing time.
pub const TIMES_FILE: &str = "times.jsonl";
/// Name of the file with the rows as comma-separated values.
pub const RESULTS_FILE: &str = "results.csv";
const LOCK_FILE: &str = ".lock";

/// The result rows of a sweep, stored in one folder.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    header: Header,
    rows: Joined,
    rows_file: LineFile,
    times_file: LineFile,
    /// True after this process has appended a row, and has removed the plots and pages that were made from fewer rows.
    is_renewed: bool,
    /// Lock of the folder. No other process can open the folder while this object exists. The operating system releases
    /// the lock after a crash.
    _lock: File,
}

#[derive(Serialize)]
struct PointTime {
    point: u64,
    host_seconds: f64,
}

impl Store {
    /// Opens or creates the folder of a sweep. An incomplete last line is removed. If `resume` is true, finished points
    /// are kept.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] in these cases:
    ///
    /// - The folder cannot be read or written, or is in use.
    /// - A line of the file of rows is damaged, and is not the last line.
    /// - The folder holds results of another sweep.
    /// - The folder holds finished points although `resume` is false.
    pub fn open(folder: &Path, header: Header, resume: bool) -> Result<Self, FileError> {
        check_command(folder)?;
        fs::create_dir_all(folder).map_err(FileError::io(folder, "cannot be made"))?;
        // The folder is locked before any change.
        let lock = lock(folder)?;
        remove_leftover_files(folder);
        let path = folder.join(ROWS_FILE);
        let mut rows_file = LineFile::open(path.clone())?;
        let (rows, end) = Joined::of_file(&path, &header)?;
        // Without `resume`, existing rows are never extended by accident.
        let points = rows.points().count();
        if !resume && points > 0 {
            let reason = format_args!(
                "there are {points} finished points here already; resume the sweep, or choose another folder"
            );
            return Err(FileError::because(FileErrorKind::Unfinished, reason).in_file(folder.display()));
        }
        // Both files continue after their last complete line; a new file starts with the header.
        rows_file.cut(end, &header)?;
        let mut times_file = LineFile::open(folder.join(TIMES_FILE))?;
        let mut times = times_file.lines("a time of a sweep")?;
        while times.read()? {}
        times_file.cut(times.whole_bytes, &header)?;
        // The manifest marks the folder as a sweep's from the start.
        if Manifest::read(folder)?.is_none() {
            renew_manifest(folder)?;
        }
        Ok(Self { folder: folder.to_owned(), header, rows, rows_file, times_file, is_renewed: false, _lock: lock })
    }

    /// Returns true if the folder has a row for this point.
    pub fn holds(&self, point: u64) -> bool {
        self.rows.holds(point)
    }

    /// Returns true for each point with a row.
    pub(super) fn held(&self) -> Vec<bool> {
        (0..self.header.points).map(|point| self.rows.holds(point)).collect()
    }

    /// Returns the number of finished points in one shard (part of the sweep).
    pub fn finished(&self, shard: Shard) -> u64 {
        self.rows.points().filter(|point| shard.holds(*point)).count() as u64
    }

    /// Returns the points of a shard (part of the sweep) that could not be simulated, in ascending order.
    pub fn failed(&self, shard: Shard) -> impl Iterator<Item = u64> {
        self.rows.failed().filter(move |point| shard.holds(*point))
    }

    /// Reads the row of a point from its file. Returns `None` if the point is not finished.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if the file cannot be read.
    pub fn row(&mut self, point: u64) -> Result<Option<SweepRow>, FileError> {
        self.rows.row(point)
    }

    /// Appends the row of a finished point, and the computing time of the point in seconds.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if a file cannot be written.
    pub fn append(&mut self, row: &SweepRow, host_seconds: f64) -> Result<(), FileError> {
        // Plots and pages of fewer rows become outdated with the first new row.
        if !self.is_renewed {
            renew_manifest(&self.folder)?;
            self.is_renewed = true;
        }
        let begin = self.rows_file.end;
        self.rows_file.put(&line_of(row))?;
        self.times_file.put(&line_of(&PointTime { point: row.point, host_seconds }))?;
        self.rows.add(row, begin)
    }

    /// Sorts the rows by the number of their point, and writes the table. The file of rows changes completely or not at
    /// all.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if a file cannot be read or written.
    pub fn finish(mut self) -> Result<(), FileError> {
        let Self { folder, header, rows, .. } = &mut self;
        let rows = (0..header.points).filter_map(|point| rows.row(point).transpose());
        write_all(folder, header, rows)
    }
}

pub(super) fn check_command(folder: &Path) -> Result<(), FileError> {
    match Manifest::read(folder)? {
        Some(manifest) if manifest.command() != Manifest::SWEEP => {
            let reason = format_args!("these are files of `pxpl5 {}`; choose another folder", manifest.command());
            Err(FileError::because(FileErrorKind::Occupied, reason).in_file(folder.display()))
        }
        _ => Ok(()),
    }
}

/// Rewrites the folder's manifest with only the files of the sweep. Plots and pages that were made from fewer rows are
/// removed.
pub(super) fn renew_manifest(folder: &Path) -> Result<(), FileError> {
    let mut manifest = Manifest::new(Manifest::SWEEP);
    [ROWS_FILE, TIMES_FILE, RESULTS_FILE].into_iter().for_each(|name| manifest.add_growing(name));
    let gone = Manifest::read(folder)?.map(|before| manifest.replace(&before, folder)).unwrap_or_default();
    let mut file = Replacement::of(&folder.join(MANIFEST_FILE))?;
    file.put(manifest.to_text().as_bytes())?;
    file.finish()?;
    gone.into_iter().for_each(|path| drop(fs::remove_file(path)));
    Ok(())
}

/// Writes the rows in ascending order of their points, and the table. Only one row is in memory at a time.
pub(super) fn write_all(
    folder: &Path,
    header: &Header,
    rows: impl Iterator<Item = Result<SweepRow, FileError>>,
) -> Result<(), FileError> {
    let mut lines = Replacement::of(&folder.join(ROWS_FILE))?;
    let mut results = Replacement::of(&folder.join(RESULTS_FILE))?;
    let table = Table::of(header);
    lines.put(line_of(header).as_bytes())?;
    results.put(&table.head())?;
    // Both files are written in one pass over the rows.
    for row in rows {
        let row = row?;
        lines.put(line_of(&row).as_bytes())?;
        results.put(&table.line(&row))?;
    }
    lines.finish()?;
    results.finish()
}

/// Removes temporary files of processes that have ended. The folder is locked, so no other process uses these files.
fn remove_leftover_files(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        if entry.file_name().to_str().is_some_and(is_temporary) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

pub(crate) fn lock(folder: &Path) -> Result<File, FileError> {
    let path = folder.join(LOCK_FILE);
    let file = File::create(&path).map_err(FileError::io(&path, "cannot be written"))?;
    match file.try_lock() {
        Err(fs::TryLockError::WouldBlock) => {
            let reason = "another process is writing here; wait for it, or choose another folder";
            Err(FileError::because(FileErrorKind::Locked, reason).in_file(folder.display()))
        }
        // If the file system has no locks, the sweep continues without protection.
        _ => Ok(file),
    }
}
