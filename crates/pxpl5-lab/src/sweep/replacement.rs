//! Replaces a file by a complete new version, so that no reader finds an incomplete file.

use pxpl5_sim::parameters::FileError;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// A new version of a file, under a temporary name in the same folder. Without a call of `finish`, the temporary file
/// is removed and the old version stays.
#[derive(Debug)]
pub(super) struct Replacement {
    path: PathBuf,
    temporary: PathBuf,
    writer: BufWriter<File>,
}

impl Replacement {
    pub(super) fn of(path: &Path) -> Result<Self, FileError> {
        let temporary = path.with_extension(format!("{}.tmp", std::process::id()));
        let file = File::create(&temporary).map_err(FileError::io(path, "cannot be written"))?;
        Ok(Self { path: path.to_owned(), temporary, writer: BufWriter::new(file) })
    }

    pub(super) fn put(&mut self, bytes: &[u8]) -> Result<(), FileError> {
        self.writer.write_all(bytes).map_err(FileError::io(&self.path, "cannot be written"))
    }

    pub(super) fn finish(mut self) -> Result<(), FileError> {
        self.take_place().map_err(FileError::io(&self.path, "cannot be written"))
    }

    fn take_place(&mut self) -> io::Result<()> {
        self.writer.flush()?;
        self.writer.get_ref().sync_all()?;
        fs::rename(&self.temporary, &self.path)
    }
}

impl Drop for Replacement {
    fn drop(&mut self) {
        // After a successful `finish` no file has the temporary name.
        let _ = fs::remove_file(&self.temporary);
    }
}
