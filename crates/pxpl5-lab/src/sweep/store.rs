//! The folder of a sweep: rows are appended with one write each, and survive a kill at any moment.

use super::points::Points;
use super::replacement::Replacement;
use super::rows::RowFile;
use super::shard::Shard;
use super::table::Table;
use super::{Header, SweepError, SweepRow};
use crate::manifest::{MANIFEST_FILE, Manifest};
use serde::Serialize;
use std::fs::{self, File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

/// A header line, then a row a line.
pub const ROWS_FILE: &str = "rows.jsonl";
/// The header line, then how long points took on this host, a line each.
pub const TIMES_FILE: &str = "times.jsonl";
/// The rows as a table.
pub const RESULTS_FILE: &str = "results.csv";
const LOCK_FILE: &str = ".lock";

/// The rows of one folder.
#[derive(Debug)]
pub struct Store {
    folder: PathBuf,
    header: Header,
    rows: RowFile,
    /// Where the next row begins.
    end: u64,
    rows_file: File,
    times_file: File,
    /// True once a row was appended: plots and pages of fewer rows have been taken away.
    is_renewed: bool,
    /// Held as long as the store lives; the operating system gives it back after a kill.
    _lock: File,
}

/// How a point's time is written.
#[derive(Serialize)]
struct PointTime {
    point: u64,
    host_seconds: f64,
}

impl Store {
    /// Opens a folder, or makes it. A torn last line is cut off. Finished points are only taken over to `resume`.
    ///
    /// # Errors
    ///
    /// [`SweepError`] when it cannot be read or written, is in use, holds finished points that nobody wants to
    /// continue, results of another sweep, or a damaged line before the last.
    pub fn open(folder: &Path, header: Header, resume: bool) -> Result<Self, SweepError> {
        check_command(folder)?;
        fs::create_dir_all(folder).map_err(SweepError::io(folder, "cannot be made"))?;
        let lock = lock(folder)?;
        remove_left_over(folder);
        let path = folder.join(ROWS_FILE);
        let rows = RowFile::open_or_none(&path)?;
        check_header(&path, &header, rows.header())?;
        if !resume && rows.finished() > 0 {
            return Err(SweepError::NotEmpty { path: folder.display().to_string(), rows: rows.finished() });
        }
        let end = rows.whole_bytes();
        let rows_file = opened(&path, end)?;
        let times_path = folder.join(TIMES_FILE);
        let times_end = whole_lines(&times_path);
        let times_file = opened(&times_path, times_end)?;
        if Manifest::read(folder)?.is_none() {
            renew_manifest(folder)?;
        }
        let is_renewed = false;
        let mut store =
            Self { folder: folder.to_owned(), header, rows, end, rows_file, times_file, is_renewed, _lock: lock };
        let header = line_of(&store.header);
        if end == 0 {
            store.append_line(&header)?;
        }
        if times_end == 0 {
            store.append_time(&header)?;
        }
        Ok(store)
    }

    /// Whether a point is finished.
    #[must_use]
    pub fn holds(&self, point: u64) -> bool {
        self.rows.holds(point)
    }

    /// The points that are finished.
    pub(super) fn held(&self) -> Points {
        self.rows.points().collect()
    }

    /// How many points of a shard are finished.
    #[must_use]
    pub fn finished(&self, shard: Shard) -> u64 {
        self.rows.points().filter(|point| shard.holds(*point)).count() as u64
    }

    /// The points of a shard that could not be simulated, in order.
    pub fn failed(&self, shard: Shard) -> impl Iterator<Item = u64> {
        self.rows.points().filter(move |point| shard.holds(*point) && self.rows.is_failed(*point))
    }

    /// The row of a point, read from the file; `None` of one that is not finished.
    ///
    /// # Errors
    ///
    /// [`SweepError::Io`].
    pub fn row(&self, point: u64) -> Result<Option<SweepRow>, SweepError> {
        self.rows.reader()?.row(point)
    }

    /// Appends the row of a finished point.
    ///
    /// # Errors
    ///
    /// [`SweepError::Io`].
    pub fn append(&mut self, row: &SweepRow, host_seconds: f64) -> Result<(), SweepError> {
        if !self.is_renewed {
            renew_manifest(&self.folder)?;
            self.is_renewed = true;
        }
        let begin = self.end;
        self.append_line(&line_of(row))?;
        self.append_time(&line_of(&PointTime { point: row.point, host_seconds }))?;
        self.rows.add(row, begin);
        Ok(())
    }

    /// One write, so that a kill tears at most this line.
    fn append_line(&mut self, line: &str) -> Result<(), SweepError> {
        let path = self.folder.join(ROWS_FILE);
        self.rows_file.write_all(line.as_bytes()).map_err(SweepError::io(&path, "cannot be written"))?;
        self.end += line.len() as u64;
        Ok(())
    }

    fn append_time(&mut self, line: &str) -> Result<(), SweepError> {
        let path = self.folder.join(TIMES_FILE);
        self.times_file.write_all(line.as_bytes()).map_err(SweepError::io(&path, "cannot be written"))
    }

    /// Puts the rows in order of their points and writes the table; the file changes at once or not at all.
    ///
    /// # Errors
    ///
    /// [`SweepError::Io`].
    pub fn finish(self) -> Result<(), SweepError> {
        let mut reader = self.rows.reader()?;
        let rows = self.rows.points().filter_map(|point| reader.row(point).transpose());
        write_all(&self.folder, &self.header, rows)
    }
}

/// Refuses a folder that holds what another command wrote.
pub(super) fn check_command(folder: &Path) -> Result<(), SweepError> {
    match Manifest::read(folder)? {
        Some(manifest) if manifest.command() != Manifest::SWEEP => {
            let (path, command) = (folder.display().to_string(), manifest.command().to_owned());
            Err(SweepError::Occupied { path, command })
        }
        _ => Ok(()),
    }
}

/// Lists the files of a sweep alone. Plots and pages that were made of fewer rows are taken away.
pub(super) fn renew_manifest(folder: &Path) -> Result<(), SweepError> {
    let mut manifest = Manifest::new(Manifest::SWEEP);
    [ROWS_FILE, TIMES_FILE, RESULTS_FILE].into_iter().for_each(|name| manifest.add_growing(name));
    let gone = Manifest::read(folder)?.map(|before| manifest.replace(&before, folder)).unwrap_or_default();
    let mut file = Replacement::of(&folder.join(MANIFEST_FILE))?;
    file.put(manifest.to_text().as_bytes())?;
    file.finish()?;
    gone.into_iter().for_each(|path| drop(fs::remove_file(path)));
    Ok(())
}

/// Rows in order, and the table; a row is held at a time.
pub(super) fn write_all(
    folder: &Path,
    header: &Header,
    rows: impl Iterator<Item = Result<SweepRow, SweepError>>,
) -> Result<(), SweepError> {
    let mut lines = Replacement::of(&folder.join(ROWS_FILE))?;
    let mut results = Replacement::of(&folder.join(RESULTS_FILE))?;
    let table = Table::of(header);
    lines.put(line_of(header).as_bytes())?;
    results.put(&table.head())?;
    for row in rows {
        let row = row?;
        lines.put(line_of(&row).as_bytes())?;
        results.put(&table.line(&row))?;
    }
    lines.finish()?;
    results.finish()
}

/// Removes what processes that were killed while they finished have left under temporary names. Nobody else is at work here: the
/// folder is locked.
fn remove_left_over(folder: &Path) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let is_temporary = |file: &str| {
            let stem = file.split('.').next().unwrap_or_default();
            let number =
                name.to_str().and_then(|name| name.strip_prefix(stem)?.strip_prefix('.')?.strip_suffix(".tmp"));
            number.is_some_and(|number| !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()))
        };
        if [ROWS_FILE, TIMES_FILE, RESULTS_FILE, MANIFEST_FILE].into_iter().any(is_temporary) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

pub(super) fn line_of(value: &impl Serialize) -> String {
    let mut line = serde_json::to_string(value).unwrap_or_default();
    line.push('\n');
    line
}

fn lock(folder: &Path) -> Result<File, SweepError> {
    let path = folder.join(LOCK_FILE);
    let file = File::create(&path).map_err(SweepError::io(&path, "cannot be written"))?;
    match file.try_lock() {
        Err(fs::TryLockError::WouldBlock) => Err(SweepError::Locked { path: folder.display().to_string() }),
        // A file system without locks: better no protection than no sweep.
        _ => Ok(file),
    }
}

/// Opens for appending after the first `keep` bytes.
fn opened(path: &Path, keep: u64) -> Result<File, SweepError> {
    let file = OpenOptions::new().create(true).append(true).open(path);
    let cut = file.and_then(|file| {
        file.set_len(keep)?;
        Ok(file)
    });
    cut.map_err(SweepError::io(path, "cannot be written"))
}

/// Bytes up to the end of the last whole line; 0 of a file that cannot be read.
fn whole_lines(path: &Path) -> u64 {
    let Ok(file) = File::open(path) else { return 0 };
    let mut file = BufReader::new(file);
    let mut whole = 0;
    let mut line = Vec::new();
    while file.read_until(b'\n', &mut line).is_ok() && line.last() == Some(&b'\n') {
        whole += line.len() as u64;
        line.clear();
    }
    whole
}

/// Names the first thing in which two headers differ.
pub(super) fn check_header(path: &Path, expected: &Header, found: Option<&Header>) -> Result<(), SweepError> {
    let Some(found) = found.filter(|found| *found != expected) else { return Ok(()) };
    let pairs = [
        ("schema", &expected.schema, &found.schema),
        ("version", &expected.version, &found.version),
        ("machine", &expected.machine, &found.machine),
        ("config_hash", &expected.config_hash, &found.config_hash),
    ];
    let differing = pairs.into_iter().find(|(_, expected, found)| expected != found);
    let (what, expected, found) = match differing {
        Some((what, expected, found)) => (what, expected.clone(), found.clone()),
        None => ("title", format!("{:?}", expected.title), format!("{:?}", found.title)),
    };
    Err(SweepError::Foreign { path: path.display().to_string(), what: what.to_owned(), expected, found })
}
