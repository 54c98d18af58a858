//! Where the path of an output leads.

use crate::error::CliError;
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
    pub(super) fn of(path: &Path) -> Result<Self, CliError> {
        match path.metadata() {
            Ok(found) if found.is_dir() => Err(CliError::failure(format!(
                "{} cannot be written: it is a folder; choose another name with --out",
                path.display()
            ))),
            Ok(found) if is_standard_output(&found) => Ok(Self::StandardOutput),
            Ok(found) if found.is_file() => behind_links(path).map(Self::File),
            Ok(_) => Ok(Self::Through(path.to_path_buf())),
            Err(error) if error.kind() == io::ErrorKind::NotFound => behind_links(path).map(Self::File),
            Err(error) => Err(refused(path, &error)),
        }
    }
}

/// The file that a path stands for, whether there is one or not: a link is not replaced, but what it names.
fn behind_links(path: &Path) -> Result<PathBuf, CliError> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        // What is no link ends the way; so does what is not there.
        let Ok(next) = path.read_link() else { return Ok(path) };
        path = path.parent().unwrap_or(Path::new("")).join(next);
    }
    Err(CliError::failure(format!("{} cannot be written: its links lead in a circle", path.display())))
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

pub(super) fn refused(path: &Path, error: &io::Error) -> CliError {
    CliError::failure(format!("{} cannot be written: {error}; choose another place with --out", path.display()))
}
