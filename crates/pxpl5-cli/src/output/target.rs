//! Resolver of output paths through links to files, devices and standard output.

use crate::error::CliError;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// A file, device or pipe at which an output path ends after all links are followed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// A regular file, or a path at which no file exists yet. One rename replaces the contents.
    File(PathBuf),
    /// A device, a pipe or a socket, into which the bytes are written, because no file may replace it.
    Through(PathBuf),
    StandardOutput,
}

/// Maximum number of links that are followed. A longer chain is treated as a circle.
const MAX_LINKS: usize = 40;

impl Target {
    pub(super) fn of(path: &Path, place: &Place) -> Result<Self, CliError> {
        match path.metadata() {
            Ok(found) if found.is_dir() => Err(place.refused(path, &"it is a folder")),
            Ok(found) if is_standard_output(&found) => Ok(Self::StandardOutput),
            Ok(found) if found.is_file() => behind_links(path, place).map(Self::File),
            Ok(_) => Ok(Self::Through(path.to_path_buf())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => behind_links(path, place).map(Self::File),
            Err(error) => Err(place.refused(path, &error)),
        }
    }
}

/// Returns the file to which a path leads after all links. This file need not exist, and writing to it changes no link.
fn behind_links(path: &Path, place: &Place) -> Result<PathBuf, CliError> {
    let mut path = path.to_path_buf();
    for _ in 0..MAX_LINKS {
        // The chain ends at a path that is not a link or does not exist.
        let Ok(next) = path.read_link() else { return Ok(path) };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(place.refused(&path, &"its symbolic links form a loop"))
}

/// Returns true if `found` is the metadata of the file, pipe or device behind standard output.
#[cfg(unix)]
fn is_standard_output(found: &std::fs::Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    let output = std::fs::metadata("/dev/stdout");
    output.is_ok_and(|output| (output.dev(), output.ino()) == (found.dev(), found.ino()))
}

#[cfg(not(unix))]
fn is_standard_output(_: &std::fs::Metadata) -> bool {
    false
}

#[derive(Clone, Debug)]
pub(super) struct Place {
    option: &'static str,
    /// Name of the file in the path, or `None` if the option requires a folder.
    file: Option<PathBuf>,
}

impl Place {
    pub(super) const fn folder(option: &'static str) -> Self {
        Self { option, file: None }
    }

    pub(super) fn file(option: &'static str, path: &Path) -> Self {
        Self { option, file: Some(path.to_path_buf()) }
    }

    /// Returns the error for a path that cannot be written. The error advises the user to choose another path.
    pub(super) fn refused(&self, path: &Path, reason: &dyn Display) -> CliError {
        let path = self.file.as_deref().unwrap_or(path).display();
        CliError::failure(format!("{path} cannot be written: {reason}; choose another place with {}", self.option))
    }
}
