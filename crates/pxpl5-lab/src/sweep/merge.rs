//! Joining shards.

use super::store::{Found, check_header, line_of, read_rows, replace, write_all};
use super::{Header, ROWS_FILE, Status, SweepError, SweepRow, TIMES_FILE};
use std::collections::BTreeMap;
use std::fs;
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

/// Rows by point, each with the file that it is from.
type Joined = BTreeMap<u64, (SweepRow, String)>;

/// Joins the rows of folders into one folder, in order of the points. Nothing is written unless all is well.
///
/// # Errors
///
/// [`SweepError::Foreign`] when a folder is of another sweep, [`SweepError::Contradiction`] when a point has different
/// rows, [`SweepError::Missing`] when points are nowhere and that is not allowed.
pub fn merge(folders: &[PathBuf], out: &Path, allow_missing: bool) -> Result<Merged, SweepError> {
    let mut all: Option<(Header, Joined)> = None;
    let mut duplicates = Vec::new();
    for folder in folders {
        let path = folder.join(ROWS_FILE);
        let Found { header, rows, repeated, .. } = found(&path)?;
        let Some(header) = header else { continue };
        duplicates.extend(repeated);
        let (first, joined) = all.get_or_insert_with(|| (header.clone(), Joined::new()));
        check_header(&path, first, Some(&header))?;
        duplicates.extend(join(joined, rows, &path.display().to_string())?);
    }
    let Some((header, joined)) = all else {
        return Err(SweepError::Missing { missing: 0, points: 0, which: "no folder holds a row".to_owned() });
    };
    let missing: Vec<u64> = (0..header.points).filter(|point| !joined.contains_key(point)).collect();
    if !missing.is_empty() && !allow_missing {
        let which = ranges(&missing);
        return Err(SweepError::Missing { missing: missing.len() as u64, points: header.points, which });
    }
    let rows: BTreeMap<u64, SweepRow> = joined.into_iter().map(|(point, (row, _))| (point, row)).collect();
    write(folders, out, &header, &rows)?;
    duplicates.sort_unstable();
    duplicates.dedup();
    let failed = rows.values().filter(|row| row.status == Status::Failed).count() as u64;
    Ok(Merged { points: header.points, failed, duplicates, missing })
}

fn found(path: &Path) -> Result<Found, SweepError> {
    let bytes = fs::read(path).map_err(SweepError::io(path, "cannot be read"))?;
    read_rows(path, &bytes)
}

/// Adds rows; gives the points that were there already.
fn join(joined: &mut Joined, rows: BTreeMap<u64, SweepRow>, name: &str) -> Result<Vec<u64>, SweepError> {
    let mut duplicates = Vec::new();
    for (point, row) in rows {
        match joined.get(&point) {
            Some((other, _)) if *other == row => duplicates.push(point),
            Some((_, first)) => {
                return Err(SweepError::Contradiction { point, first: first.clone(), second: name.to_owned() });
            }
            None => {
                joined.insert(point, (row, name.to_owned()));
            }
        }
    }
    Ok(duplicates)
}

fn write(folders: &[PathBuf], out: &Path, header: &Header, rows: &BTreeMap<u64, SweepRow>) -> Result<(), SweepError> {
    fs::create_dir_all(out).map_err(SweepError::io(out, "cannot be made"))?;
    let times: String = [line_of(header)].into_iter().chain(folders.iter().map(|folder| times_of(folder))).collect();
    replace(&out.join(TIMES_FILE), &times)?;
    write_all(out, header, rows)
}

/// The lines of a folder's times behind the first one, which is the header.
fn times_of(folder: &Path) -> String {
    let text = fs::read_to_string(folder.join(TIMES_FILE)).unwrap_or_default();
    text.lines().skip(1).map(|line| format!("{line}\n")).collect()
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
