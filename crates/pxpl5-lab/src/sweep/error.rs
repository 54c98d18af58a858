//! Errors of the files of a sweep.

use crate::experiment_file::FileError;
use crate::manifest::ManifestError;
use thiserror::Error;

/// Error of a sweep, or of merging its shards (parts computed by separate processes).
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum SweepError {
    /// A file or folder cannot be read or written.
    #[error("{path}: {doing}: {reason}")]
    Io {
        /// Path of the file or folder.
        path: String,
        /// Failed operation in words, such as `cannot be read`.
        doing: &'static str,
        /// Message of the operating system.
        reason: String,
    },
    /// Another process is writing into the folder.
    #[error("{path}: another process is writing here; wait for it, or choose another folder")]
    Locked {
        /// Path of the folder, as given by the user.
        path: String,
    },
    /// The folder already holds finished points, and the user did not allow a resume.
    #[error("{path}: there are {rows} finished points here already; continue with --resume, or choose another folder")]
    NotEmpty {
        /// Path of the folder, as given by the user.
        path: String,
        /// Number of finished points in the folder.
        rows: u64,
    },
    /// The folder holds results of another sweep.
    #[error("{path}: these are results of another sweep: {what} was {found}, expected {expected}")]
    Foreign {
        /// Path of the file of result rows.
        path: String,
        /// Name of the first value that differs between the two headers.
        what: String,
        /// Value in the header of this sweep.
        expected: String,
        /// Value in the header of the folder's file.
        found: String,
    },
    /// The folder holds files of another command.
    #[error("{path}: these are files of `pxpl5 {command}`; choose another folder")]
    Occupied {
        /// Path of the folder, as given by the user.
        path: String,
        /// Name of the command that wrote the files.
        command: String,
    },
    /// The manifest (list of files) of the folder cannot be used.
    #[error(transparent)]
    Manifest(#[from] ManifestError),
    /// A line in the file of result rows is not a row.
    #[error("{path}, line {line}: expected a row of a sweep, found {found}")]
    Damaged {
        /// Path of the file of result rows.
        path: String,
        /// Number of the line, counted from 1.
        line: usize,
        /// Beginning of the line, or the parser's error.
        found: String,
    },
    /// Two different rows exist for the same point.
    #[error("point {point} has different rows in {first} and {second}")]
    Contradiction {
        /// Index of the point, counted from 0.
        point: u64,
        /// Path of the file whose row was read first.
        first: String,
        /// Path of the file whose row was read second, possibly the same file.
        second: String,
    },
    /// Some points are in none of the folders.
    #[error("{missing} of {points} points are missing: {which}; run the shards that hold them with --resume")]
    Missing {
        /// Number of missing points.
        missing: u64,
        /// Number of points of the whole sweep.
        points: u64,
        /// Missing points as ranges of their indices.
        which: String,
    },
    /// An invalid experiment file.
    #[error(transparent)]
    File(#[from] FileError),
}

impl SweepError {
    pub(crate) fn io(path: &std::path::Path, doing: &'static str) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.display().to_string();
        move |error| Self::Io { path, doing, reason: error.to_string() }
    }
}
