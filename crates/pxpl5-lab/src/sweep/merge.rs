//! Merges the shards of a sweep into one folder. A shard is a part that a separate process computes.

use super::TIMES_FILE;
use super::joined::{Joined, missing_points};
use super::lines::line_of;
use super::replacement::Replacement;
use super::store::{check_command, renew_manifest, write_all};
use pxpl5_sim::parameters::FileError;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

/// Result of merging the shards of a sweep.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Merged {
    /// Number of points of the sweep.
    pub points: u64,
    /// Number of points that could not be simulated.
    pub failed: u64,
    /// Points with more than one row. All rows of such a point were equal.
    pub duplicates: Vec<u64>,
    /// Points without a row. Empty unless missing points were allowed.
    pub missing: Vec<u64>,
}

/// Merges the rows of several folders into one folder, in ascending order of the points. After an error, nothing is
/// written.
///
/// # Errors
///
/// Returns a [`FileError`] if a folder belongs to another sweep, or if a point has different rows. Also fails if points
/// are missing and `allow_missing` is false.
pub fn merge(folders: &[PathBuf], out: &Path, allow_missing: bool) -> Result<Merged, FileError> {
    let mut joined = Joined::of(folders)?;
    let points = joined.header().points;
    let missing = joined.missing();
    if !missing.is_empty() && !allow_missing {
        return Err(missing_points(missing.len() as u64, points, &ranges(&missing)));
    }
    write(&mut joined, folders, out)?;
    Ok(Merged { points, failed: joined.failed().count() as u64, duplicates: joined.duplicates().to_vec(), missing })
}

fn write(joined: &mut Joined, folders: &[PathBuf], out: &Path) -> Result<(), FileError> {
    check_command(out)?;
    std::fs::create_dir_all(out).map_err(FileError::io(out, "cannot be made"))?;
    let header = joined.header().clone();
    // Times of all shards are concatenated; they need no order.
    let mut times = Replacement::of(&out.join(TIMES_FILE))?;
    times.put(line_of(&header).as_bytes())?;
    folders.iter().try_for_each(|folder| put_times(&mut times, &folder.join(TIMES_FILE)))?;
    times.finish()?;
    let rows = (0..header.points).filter_map(|point| joined.row(point).transpose());
    write_all(out, &header, rows)?;
    renew_manifest(out)
}

fn put_times(times: &mut Replacement, path: &Path) -> Result<(), FileError> {
    let Ok(file) = File::open(path) else { return Ok(()) };
    let lines = BufReader::new(file).lines().map_while(Result::ok);
    lines.skip(1).try_for_each(|line| times.put(format!("{line}\n").as_bytes()))
}

/// Formats a list of numbers as at most ten ranges.
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
