//! The folder of a sweep: rows are appended with one write each, and survive a kill at any moment.

use super::points::Points;
use super::{Header, SweepError, SweepRow};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::fs::{self, File, OpenOptions};
use std::io::Write;
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
    rows: BTreeMap<u64, SweepRow>,
    rows_file: File,
    times_file: File,
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
        fs::create_dir_all(folder).map_err(SweepError::io(folder, "cannot be made"))?;
        let lock = lock(folder)?;
        remove_left_over(folder);
        let path = folder.join(ROWS_FILE);
        let found = match fs::read(&path) {
            Ok(bytes) => read_rows(&path, &bytes)?,
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => Found::default(),
            Err(error) => return Err(SweepError::io(&path, "cannot be read")(error)),
        };
        check_header(&path, &header, found.header.as_ref())?;
        if !resume && !found.rows.is_empty() {
            return Err(SweepError::NotEmpty { path: folder.display().to_string(), rows: found.rows.len() });
        }
        let rows_file = opened(&path, found.whole_bytes)?;
        let times_path = folder.join(TIMES_FILE);
        let times_whole = whole_lines(&fs::read(&times_path).unwrap_or_default());
        let times_file = opened(&times_path, times_whole)?;
        let fresh = found.header.is_none();
        let mut store =
            Self { folder: folder.to_owned(), header, rows: found.rows, rows_file, times_file, _lock: lock };
        let header = line_of(&store.header);
        if fresh {
            store.append_line(&header)?;
        }
        if times_whole == 0 {
            store.append_time(&header)?;
        }
        Ok(store)
    }

    /// Whether a point is finished.
    #[must_use]
    pub fn holds(&self, point: u64) -> bool {
        self.rows.contains_key(&point)
    }

    /// The points that are finished.
    pub(super) fn held(&self) -> Points {
        self.rows.keys().copied().collect()
    }

    /// The rows of all finished points, by the number of the point.
    #[must_use]
    pub const fn rows(&self) -> &BTreeMap<u64, SweepRow> {
        &self.rows
    }

    /// Appends the row of a finished point.
    ///
    /// # Errors
    ///
    /// [`SweepError::Io`].
    pub fn append(&mut self, row: &SweepRow, host_seconds: f64) -> Result<(), SweepError> {
        self.append_line(&line_of(row))?;
        self.append_time(&line_of(&PointTime { point: row.point, host_seconds }))?;
        self.rows.insert(row.point, row.clone());
        Ok(())
    }

    /// One write, so that a kill tears at most this line.
    fn append_line(&mut self, line: &str) -> Result<(), SweepError> {
        let path = self.folder.join(ROWS_FILE);
        self.rows_file.write_all(line.as_bytes()).map_err(SweepError::io(&path, "cannot be written"))
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
        write_all(&self.folder, &self.header, &self.rows)
    }
}

/// Rows in order, and the table.
pub(super) fn write_all(folder: &Path, header: &Header, rows: &BTreeMap<u64, SweepRow>) -> Result<(), SweepError> {
    let lines: String = rows.values().map(line_of).collect();
    replace(&folder.join(ROWS_FILE), &format!("{}{lines}", line_of(header)))?;
    replace(&folder.join(RESULTS_FILE), &table(header, rows))
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
        if [ROWS_FILE, TIMES_FILE, RESULTS_FILE].into_iter().any(is_temporary) {
            let _ = fs::remove_file(entry.path());
        }
    }
}

pub(super) fn replace(path: &Path, text: &str) -> Result<(), SweepError> {
    let temporary = path.with_extension(format!("{}.tmp", std::process::id()));
    let written = File::create(&temporary).and_then(|mut file| {
        file.write_all(text.as_bytes())?;
        file.sync_all()?;
        fs::rename(&temporary, path)
    });
    written.map_err(|error| {
        let _ = fs::remove_file(&temporary);
        SweepError::io(path, "cannot be written")(error)
    })
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
fn opened(path: &Path, keep: usize) -> Result<File, SweepError> {
    let file = OpenOptions::new().create(true).append(true).open(path);
    let cut = file.and_then(|file| {
        file.set_len(keep as u64)?;
        Ok(file)
    });
    cut.map_err(SweepError::io(path, "cannot be written"))
}

/// What a file of rows holds.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) header: Option<Header>,
    pub(super) rows: BTreeMap<u64, SweepRow>,
    /// Points that have a second, equal row.
    pub(super) repeated: Vec<u64>,
    /// Bytes up to the end of the last whole line.
    whole_bytes: usize,
}

/// Bytes up to the end of the last whole line.
fn whole_lines(bytes: &[u8]) -> usize {
    bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1)
}

/// Reads a file of rows; a last line without an end is passed over.
pub(super) fn read_rows(path: &Path, bytes: &[u8]) -> Result<Found, SweepError> {
    let whole_bytes = whole_lines(bytes);
    let mut found = Found { whole_bytes, ..Found::default() };
    let name = path.display().to_string();
    for (number, line) in (1..).zip(bytes[..whole_bytes].split_inclusive(|byte| *byte == b'\n')) {
        if number == 1 {
            found.header = Some(read_line(line, number, &name)?);
            continue;
        }
        let row: SweepRow = read_line(line, number, &name)?;
        let points = found.header.as_ref().map_or(0, |header: &Header| header.points);
        if row.point >= points {
            let found = format!("point {} of {points}", row.point);
            return Err(SweepError::Damaged { path: name, line: number, found });
        }
        match found.rows.get(&row.point) {
            Some(other) if *other == row => found.repeated.push(row.point),
            Some(other) => {
                return Err(SweepError::Contradiction { point: other.point, first: name.clone(), second: name });
            }
            None => {
                found.rows.insert(row.point, row);
            }
        }
    }
    Ok(found)
}

/// What a line of a file holds.
fn read_line<T: DeserializeOwned>(line: &[u8], number: usize, file: &str) -> Result<T, SweepError> {
    serde_json::from_slice(line).map_err(|error| SweepError::Damaged {
        path: file.to_owned(),
        line: number,
        found: format!("{} ({error})", excerpt(line)),
    })
}

fn excerpt(line: &[u8]) -> String {
    let text: String = String::from_utf8_lossy(line).trim_end().chars().take(40).collect();
    format!("{text:?}")
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

/// Rows as comma-separated values after a header of comments.
fn table(header: &Header, rows: &BTreeMap<u64, SweepRow>) -> String {
    let parameters: Vec<&String> = header.axes.iter().flat_map(|axis| &axis.paths).collect();
    let measured: Vec<&String> = header.measure.keys().collect();
    let origin = [
        ("machine", header.machine.clone()),
        ("config_hash", header.config_hash.clone()),
        ("version", header.version.clone()),
        ("level", header.level.clone()),
        ("seed", header.seed.to_string()),
    ];
    let comments: String = origin.iter().map(|(key, value)| format!("# {key}: {value}\n")).collect();
    let mut writer = csv::WriterBuilder::new().flexible(true).from_writer(comments.into_bytes());
    let columns = ["point", "status"].into_iter().chain(parameters.iter().chain(&measured).map(|name| name.as_str()));
    put_line(&mut writer, columns.chain(["trace_hash", "error"]).map(str::to_owned));
    for row in rows.values() {
        let status = if row.status == super::Status::Done { "done" } else { "failed" };
        let settings = parameters.iter().map(|path| row.parameters.get(*path).map_or_else(String::new, plain));
        let values = measured.iter().map(|name| row.value_text(name));
        let cells = [row.point.to_string(), status.to_owned()].into_iter().chain(settings);
        let last = [row.trace_hash.clone().unwrap_or_default(), row.error.clone().unwrap_or_default()];
        put_line(&mut writer, cells.chain(values).chain(last));
    }
    let bytes = writer.into_inner().unwrap_or_default();
    String::from_utf8(bytes).unwrap_or_default()
}

impl SweepRow {
    /// A quantity's value as text; empty where the run shows none.
    fn value_text(&self, name: &str) -> String {
        self.measured.get(name).copied().flatten().map_or_else(String::new, |value| value.to_string())
    }
}

fn plain(value: &serde_json::Value) -> String {
    value.as_str().map_or_else(|| value.to_string(), str::to_owned)
}

/// Puts a line; memory can always be written.
fn put_line(writer: &mut csv::Writer<Vec<u8>>, cells: impl Iterator<Item = String>) {
    let _ = writer.write_record(cells);
}
