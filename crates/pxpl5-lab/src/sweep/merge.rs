//! Joining shards.

use super::joined::Joined;
use super::replacement::Replacement;
use super::store::{check_command, line_of, renew_manifest, write_all};
use super::{SweepError, TIMES_FILE};
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
    let mut joined = Joined::of(folders)?;
    let points = joined.header().points;
    let missing = joined.missing();
    if !missing.is_empty() && !allow_missing {
        return Err(SweepError::Missing { missing: missing.len() as u64, points, which: ranges(&missing) });
    }
    write(&mut joined, folders, out)?;
    Ok(Merged { points, failed: joined.failed(), duplicates: joined.duplicates().to_vec(), missing })
}

fn write(joined: &mut Joined, folders: &[PathBuf], out: &Path) -> Result<(), SweepError> {
    check_command(out)?;
    std::fs::create_dir_all(out).map_err(SweepError::io(out, "cannot be made"))?;
    let header = joined.header().clone();
    let mut times = Replacement::of(&out.join(TIMES_FILE))?;
    times.put(line_of(&header).as_bytes())?;
    folders.iter().try_for_each(|folder| put_times(&mut times, &folder.join(TIMES_FILE)))?;
    times.finish()?;
    let rows = (0..header.points).filter_map(|point| joined.row(point).transpose());
    write_all(out, &header, rows)?;
    renew_manifest(out)
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
