//! Positions of errors in model files, and errors that every importer can return.

use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::{fmt, io};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum FilePlace {
    /// Line number, counted from 1.
    Line(u64),
    /// Offset from the beginning of the file, in bytes.
    Byte(u64),
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FilePlace::Line(line) => write!(f, "line {line}"),
            FilePlace::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

pub(crate) fn unreadable(file: &str, error: &io::Error) -> FileError {
    FileError::unreadable(file, "a readable file", error)
}

pub(crate) fn nothing_to_draw(file: &str, expected: &str) -> FileError {
    FileError::new(FileErrorKind::Empty, format_args!("at least one {expected}"), "none").in_file(file)
}
