//! Where the path of an output leads.

use crate::error::CliError;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};

/// What a path to write to leads to, behind all links.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// A regular file, or none yet: it is replaced at once, by renaming.
    File(PathBuf),
    /// A device, a pipe or a socket: it is written into and stays what it is.
    Through(PathBuf),
    /// This process's standard output by another name, such as /dev/stdout.
    StandardOutput,
}

/// Links that lead on from each other; more are a circle.
const MOST_LINKS: usize = 40;

impl Target {
    /// Follows a path.
    ///
    /// # Errors
    ///
    /// When it leads to a folder, or cannot be followed.
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

/// The file that a path stands for, whether there is one or not: a link is not replaced, but what it names.
fn behind_links(path: &Path, place: &Place) -> Result<PathBuf, CliError> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        // What is no link ends the way; so does what is not there.
        let Ok(next) = path.read_link() else { return Ok(path) };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(place.refused(&path, &"its links lead in a circle"))
}

/// Whether standard output is this very file, pipe or device.
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

/// How an error names an output: as its user did.
#[derive(Clone, Debug)]
pub(super) struct Place {
    /// The option that says where the output goes.
    option: &'static str,
    /// The file that the option names; none where it names a folder, whose files are named one by one.
    file: Option<PathBuf>,
}

impl Place {
    pub(super) const fn folder(option: &'static str) -> Self {
        Self { option, file: None }
    }

    pub(super) fn file(option: &'static str, path: &Path) -> Self {
        Self { option, file: Some(path.to_path_buf()) }
    }

    /// Why a path cannot be written, and what to do about it.
    pub(super) fn refused(&self, path: &Path, reason: &dyn Display) -> CliError {
        let path = self.file.as_deref().unwrap_or(path).display();
        CliError::failure(format!("{path} cannot be written: {reason}; choose another place with {}", self.option))
    }
}
