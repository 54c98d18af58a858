//! Joining shards.

use super::replacement::Replacement;
use super::rows::{RowFile, RowReader};
use super::store::{check_header, line_of, write_all};
use super::{Header, ROWS_FILE, SweepError, SweepRow, TIMES_FILE};
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// What joining the shards of a sweep found, point by point.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merged {
    /// Points of the sweep.
    pub points: u64,
    /// Points that could not be simulated.
    pub failed: u64,
    /// Points that were there more than once, with equal rows.
    pub duplicates: Vec<u64>,
    /// Points that are nowhere; none unless that was allowed.
    pub missing: Vec<u64>,
}

/// Joins the rows of folders into one folder, in order of the points. Nothing is written unless all is well.
///
/// # Errors
///
/// [`SweepError::Foreign`] when a folder is of another sweep, [`SweepError::Contradiction`] when a point has different
/// rows, [`SweepError::Missing`] when points are nowhere and that is not allowed.
pub fn merge(folders: &[PathBuf], out: &Path, allow_missing: bool) -> Result<Merged, SweepError> {
    let files = folders.iter().map(|folder| RowFile::open(&folder.join(ROWS_FILE)));
    let files: Vec<RowFile> =
        files.filter(|file| !file.as_ref().is_ok_and(RowFile::is_empty)).collect::<Result<_, _>>()?;
    let Some(header) = files.iter().find_map(RowFile::header) else {
        return Err(SweepError::Missing { missing: 0, points: 0, which: "no folder holds a row".to_owned() });
    };
    files.iter().try_for_each(|file| check_header(file.path(), header, file.header()))?;
    let duplicates = duplicates(&files, header)?;
    let missing: Vec<u64> = (0..header.points).filter(|point| holder(&files, *point).is_none()).collect();
    if !missing.is_empty() && !allow_missing {
        let which = ranges(&missing);
        return Err(SweepError::Missing { missing: missing.len() as u64, points: header.points, which });
    }
    write(&files, folders, out, header)?;
    let is_failed = |point: &u64| holder(&files, *point).is_some_and(|file| files[file].is_failed(*point));
    let failed = (0..header.points).filter(is_failed).count() as u64;
    Ok(Merged { points: header.points, failed, duplicates, missing })
}

/// The first file that has a row of a point.
fn holder(files: &[RowFile], point: u64) -> Option<usize> {
    files.iter().position(|file| file.holds(point))
}

fn readers(files: &[RowFile]) -> Result<Vec<RowReader<'_>>, SweepError> {
    files.iter().map(RowFile::reader).collect()
}

/// Points that have several rows, all equal.
fn duplicates(files: &[RowFile], header: &Header) -> Result<Vec<u64>, SweepError> {
    let mut all: Vec<u64> = files.iter().flat_map(RowFile::repeated).copied().collect();
    let mut readers = readers(files)?;
    for point in 0..header.points {
        let mut holders = (0..files.len()).filter(|file| files[*file].holds(point));
        let Some(first) = holders.next() else { continue };
        for other in holders {
            if readers[first].row(point)? != readers[other].row(point)? {
                let [first, second] = [first, other].map(|file| files[file].path().display().to_string());
                return Err(SweepError::Contradiction { point, first, second });
            }
            all.push(point);
        }
    }
    all.sort_unstable();
    all.dedup();
    Ok(all)
}

fn write(files: &[RowFile], folders: &[PathBuf], out: &Path, header: &Header) -> Result<(), SweepError> {
    std::fs::create_dir_all(out).map_err(SweepError::io(out, "cannot be made"))?;
    let mut times = Replacement::of(&out.join(TIMES_FILE))?;
    times.put(line_of(header).as_bytes())?;
    folders.iter().try_for_each(|folder| put_times(&mut times, &folder.join(TIMES_FILE)))?;
    times.finish()?;
    let mut readers = readers(files)?;
    let rows = (0..header.points).filter_map(|point| row(&mut readers, point).transpose());
    write_all(out, header, rows)
}

/// A point's row from the first file that has one.
fn row(readers: &mut [RowReader], point: u64) -> Result<Option<SweepRow>, SweepError> {
    for reader in readers {
        if let Some(row) = reader.row(point)? {
            return Ok(Some(row));
        }
    }
    Ok(None)
}

/// The lines of a folder's times behind the first one, which is the header.
fn put_times(times: &mut Replacement, path: &Path) -> Result<(), SweepError> {
    let Ok(file) = File::open(path) else { return Ok(()) };
    let lines = BufReader::new(file).lines().map_while(Result::ok);
    lines.skip(1).try_for_each(|line| times.put(format!("{line}\n").as_bytes()))
}

/// Ranges of numbers in order, at most ten of them.
fn ranges(numbers: &[u64]) -> String {
    let mut ranges: Vec<(u64, u64)> = Vec::new();
    for number in numbers {
        match ranges.last_mut() {
            Some((_, last)) if *last + 1 == *number => *last = *number,
            _ => ranges.push((*number, *number)),
        }
    }
    let more = if ranges.len() > 10 { ", ..." } else { "" };
    format!("{}{more}", ranges.iter().take(10).map(range_text).collect::<Vec<_>>().join(", "))
}

fn range_text((first, last): &(u64, u64)) -> String {
    if first == last { first.to_string() } else { format!("{first} to {last}") }
}
