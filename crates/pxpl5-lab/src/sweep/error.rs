//! What can go wrong with the files of a sweep.

use crate::experiment_file::FileError;
use crate::manifest::ManifestError;
use thiserror::Error;

/// Why a sweep did not run or shards could not be joined.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A file or folder cannot be read or written.
    #[error("{path}: {doing}: {reason}")]
    Io {
        /// The file or folder.
        path: String,
        /// What was tried, in words: `cannot be read`.
        doing: &'static str,
        /// What the operating system said.
        reason: String,
    },
    /// Another process is writing into the folder.
    #[error("{path}: another process is writing here; wait for it, or choose another folder")]
    Locked {
        /// Path of the folder, as it was given.
        path: String,
    },
    /// The folder holds results already.
    #[error("{path}: there are {rows} finished points here already; continue with --resume, or choose another folder")]
    NotEmpty {
        /// Path of the folder, as it was given.
        path: String,
        /// Number of finished points that it holds.
        rows: u64,
    },
    /// The folder holds results of another sweep.
    #[error("{path}: these are results of another sweep: {what} was {found}, expected {expected}")]
    Foreign {
        /// Path of the file of rows.
        path: String,
        /// What differs first between the two headers.
        what: String,
        /// What this sweep has.
        expected: String,
        /// What the file has.
        found: String,
    },
    /// The folder holds what another command wrote.
    #[error("{path}: these are files of `pxpl5 {command}`; choose another folder")]
    Occupied {
        /// Path of the folder, as it was given.
        path: String,
        /// The command that wrote there.
        command: String,
    },
    /// The manifest of the folder cannot be used.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// A line is no row.
    #[error("{path}, line {line}: expected a row of a sweep, found {found}")]
    Damaged {
        /// Path of the file of rows.
        path: String,
        /// The line, from 1.
        line: usize,
        /// Its beginning, or what is wrong with it.
        found: String,
    },
    /// A point has two different rows.
    #[error("point {point} has different rows in {first} and {second}")]
    Contradiction {
        /// Number of the point, from 0.
        point: u64,
        /// The file with the row that was read first.
        first: String,
        /// Another file, or the same.
        second: String,
    },
    /// Some points are in none of the folders.
    #[error("{missing} of {points} points are missing: {which}; run the shards that hold them with --resume")]
    Missing {
        /// Number of points that are missing.
        missing: u64,
        /// Number of points of the whole sweep.
        points: u64,
        /// Which points, as ranges of their numbers.
        which: String,
    },
    /// The experiment file is wrong.
    #[error(transparent)]
    File(#[from] FileError),
}

impl SweepError {
    pub(super) fn io(path: &std::path::Path, doing: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.display().to_string();
        move |error| Self::Io { path, doing, reason: error.to_string() }
    }
}
