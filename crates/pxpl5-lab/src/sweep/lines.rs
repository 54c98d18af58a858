//! Files of JSON lines that survive a crash: each line is appended by one write, and an incomplete last line is dropped.

use pxpl5_sim::parameters::{FileError, FileErrorKind};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};

/// A file that grows by whole lines.
#[derive(Debug)]
pub(crate) struct LineFile {
    path: PathBuf,
    file: File,
    /// Length of the file in bytes.
    pub(crate) end: u64,
}

impl LineFile {
    /// Opens or creates a file. Until [`Self::cut`], no line may be appended.
    pub(crate) fn open(path: PathBuf) -> Result<Self, FileError> {
        let file = OpenOptions::new().create(true).append(true).open(&path);
        let file = file.map_err(FileError::io(&path, "cannot be written"))?;
        Ok(Self { path, file, end: 0 })
    }

    /// Reads the file from its beginning. Each of its lines is `what`.
    pub(crate) fn lines(&self, what: &'static str) -> Result<Lines, FileError> {
        Lines::open(&self.path, what)
    }

    /// Keeps only the first `end` bytes. An empty file gets the line of `header`.
    pub(crate) fn cut(&mut self, end: u64, header: &impl Serialize) -> Result<(), FileError> {
        self.file.set_len(end).map_err(FileError::io(&self.path, "cannot be written"))?;
        self.end = end;
        if end == 0 { self.put(&line_of(header)) } else { Ok(()) }
    }

    /// Appends a line by one write. After a crash, at most this line is incomplete. After an error, it is removed.
    pub(crate) fn put(&mut self, line: &str) -> Result<(), FileError> {
        if let Err(error) = self.file.write_all(line.as_bytes()) {
            // Only the first error is reported.
            let _ = self.file.set_len(self.end);
            return Err(FileError::io(&self.path, "cannot be written")(error));
        }
        self.end += line.len() as u64;
        Ok(())
    }
}

pub(crate) fn line_of(value: &impl Serialize) -> String {
    let mut line = serde_json::to_string(value).unwrap_or_default();
    line.push('\n');
    line
}

/// Sequential reader of a file, from its beginning to its last complete line.
#[derive(Debug)]
pub(crate) struct Lines {
    path: PathBuf,
    what: &'static str,
    file: BufReader<File>,
    text: Vec<u8>,
    /// Number of the last read line, counted from 1.
    line: usize,
    /// Length in bytes of all lines that were read.
    pub(crate) whole_bytes: u64,
}

impl Lines {
    pub(super) fn open(path: &Path, what: &'static str) -> Result<Self, FileError> {
        let file = File::open(path)
            .map_err(|error| FileError::unreadable(path.display(), "a readable file of rows", error))?;
        let (file, text) = (BufReader::new(file), Vec::new());
        Ok(Self { path: path.to_owned(), what, file, text, line: 0, whole_bytes: 0 })
    }

    /// Reads a line. Returns false if no complete line is left.
    pub(crate) fn read(&mut self) -> Result<bool, FileError> {
        self.text.clear();
        self.file.read_until(b'\n', &mut self.text).map_err(FileError::io(&self.path, "cannot be read"))?;
        let is_whole = self.text.last() == Some(&b'\n');
        if is_whole {
            self.line += 1;
            self.whole_bytes += self.text.len() as u64;
        }
        Ok(is_whole)
    }

    /// Reads the value of the next line, or `None` if no complete line is left.
    pub(crate) fn next<T: DeserializeOwned>(&mut self) -> Result<Option<T>, FileError> {
        if !self.read()? {
            return Ok(None);
        }
        let excerpt = || String::from_utf8_lossy(&self.text).trim_end().chars().take(40).collect::<String>();
        let value = serde_json::from_slice(&self.text);
        value.map(Some).map_err(|error| self.damaged(format!("{:?} ({error})", excerpt())))
    }

    /// Creates the error of a line with a wrong content.
    pub(super) fn damaged(&self, found: String) -> FileError {
        let file = format!("{}, line {}", self.path.display(), self.line);
        FileError::new(FileErrorKind::Damaged, self.what, found).in_file(file)
    }
}
