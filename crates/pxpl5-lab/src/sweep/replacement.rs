//! Replaces a file by a complete new version, so that no reader finds an incomplete file.

use crate::manifest::temporary_file;
use pxpl5_sim::parameters::FileError;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// A new version of a file, under a temporary name in the same folder. Without a call of `finish`, the old version stays.
#[derive(Debug)]
pub(super) struct Replacement {
    path: PathBuf,
    writer: BufWriter<NamedTempFile>,
}

impl Replacement {
    pub(super) fn of(path: &Path) -> Result<Self, FileError> {
        let file = temporary_file(path.parent().unwrap_or(path)).map_err(FileError::io(path, "cannot be written"))?;
        Ok(Self { path: path.to_owned(), writer: BufWriter::new(file) })
    }

    pub(super) fn put(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        self.writer.write_all(bytes).map_err(FileError::io(&self.path, "cannot be written"))
    }

    pub(super) fn finish(self) -> Result<(), FileError> {
        let file = self.writer.into_inner().map_err(|error| error.into_error());
        let synced = file.and_then(|file| file.as_file().sync_all().map(|()| file));
        let placed = synced.and_then(|file| Ok(file.persist(&self.path)?));
        placed.map(drop).map_err(FileError::io(&self.path, "cannot be written"))
    }
}
