//! Files that appear together: the one place through which the command writes.

use super::target::{Target, refused};
use crate::error::CliError;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Outputs that are ready, but have not yet been given their names.
#[derive(Debug, Default)]
pub(super) struct Batch {
    files: Vec<Staged>,
    /// What goes into devices, pipes and standard output, which cannot be taken back: written last.
    streams: Vec<(Target, Vec<u8>)>,
}

/// A file that is whole under a temporary name.
#[derive(Debug)]
struct Staged {
    temporary: PathBuf,
    name: PathBuf,
}

/// A file that has its name, and what had that name before.
struct Placed {
    name: PathBuf,
    before: Option<PathBuf>,
}

/// A name beside a file that no other output of any process has.
fn beside(path: &Path, end: &str) -> PathBuf {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    path.with_file_name(format!(".pxpl5-{}-{number}.{end}", std::process::id()))
}

impl Batch {
    /// Writes a file under a temporary name, or keeps what goes elsewhere.
    ///
    /// # Errors
    ///
    /// When the file cannot be written.
    pub(super) fn put(&mut self, target: &Target, bytes: &[u8]) -> Result<(), CliError> {
        let Target::File(name) = target else {
            self.streams.push((target.clone(), bytes.to_vec()));
            return Ok(());
        };
        let temporary = beside(name, "tmp");
        let created = OpenOptions::new().write(true).create_new(true).open(&temporary);
        self.files.push(Staged { temporary, name: name.clone() });
        created.and_then(|mut file| file.write_all(bytes)).map_err(|error| refused(name, &error))
    }

    /// Gives all files their names, then writes the rest. When something fails every name has what it had before.
    ///
    /// # Errors
    ///
    /// When a name cannot be given or a device, pipe or standard output cannot be written.
    pub(super) fn commit(&mut self) -> Result<(), CliError> {
        let mut placed = Vec::new();
        let result = self.place_all(&mut placed).and_then(|()| self.streams.iter().try_for_each(write_through));
        for Placed { name, before } in placed.into_iter().rev() {
            match (before, result.is_ok()) {
                (Some(before), true) => drop(fs::remove_file(before)),
                (Some(before), false) => {
                    let _ = fs::rename(&before, name);
                    // Where the name still is this very file, renaming does nothing.
                    let _ = fs::remove_file(before);
                }
                (None, true) => {}
                (None, false) => drop(fs::remove_file(name)),
            }
        }
        self.discard();
        result
    }

    fn place_all(&mut self, placed: &mut Vec<Placed>) -> Result<(), CliError> {
        for Staged { temporary, name } in &self.files {
            let before = kept(name, temporary).map_err(|error| refused(name, &error))?;
            placed.push(Placed { name: name.clone(), before });
            fs::rename(temporary, name).map_err(|error| refused(name, &error))?;
        }
        Ok(())
    }

    /// Removes what has no name yet.
    pub(super) fn discard(&mut self) {
        self.streams.clear();
        for Staged { temporary, .. } in self.files.drain(..) {
            let _ = fs::remove_file(temporary);
        }
    }
}

/// What was not committed leaves no trace.
impl Drop for Batch {
    fn drop(&mut self) {
        self.discard();
    }
}

/// Keeps what has a name now under another one too; what comes in its place gets its permissions.
fn kept(name: &Path, next: &Path) -> io::Result<Option<PathBuf>> {
    match name.symlink_metadata() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
        Ok(found) if !found.is_file() => return Err(io::Error::other("it has become something else than a file")),
        Ok(found) => fs::set_permissions(next, found.permissions())?,
    }
    let old = beside(name, "old");
    // Where there are no hard links, the name is empty for a moment.
    fs::hard_link(name, &old).or_else(|_| fs::rename(name, &old))?;
    Ok(Some(old))
}

fn write_through((target, bytes): &(Target, Vec<u8>)) -> Result<(), CliError> {
    match target {
        Target::StandardOutput => crate::terminal::print_bytes(bytes),
        Target::Through(path) | Target::File(path) => {
            let opened: io::Result<File> = OpenOptions::new().write(true).open(path);
            opened.and_then(|mut file| file.write_all(bytes)).map_err(|error| refused(path, &error))
        }
    }
}
