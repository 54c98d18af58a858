//! Output files that get their final names together. All files that the commands write pass through this module.

use super::target::{Place, Target};
use crate::error::CliError;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

#[derive(Debug)]
pub(super) struct Batch {
    place: Place,
    files: Vec<Staged>,
    /// Files of the previous run, which are deleted after all new files have got their final names.
    gone: Vec<PathBuf>,
    /// Targets such as pipes, with the bytes for each target. These bytes are written last, because writing to a pipe
    /// cannot be undone.
    streams: Vec<(Target, Vec<u8>)>,
}

#[derive(Debug)]
struct Staged {
    temporary: PathBuf,
    name: PathBuf,
    /// Locked handle of the file, or `None` if the file is not locked. The lock shows that the writing process still
    /// runs.
    lock: Option<File>,
}

struct Placed {
    name: PathBuf,
    before: Option<PathBuf>,
}

const TEMPORARY: &str = ".pxpl5-";

/// Returns a path in the folder of `path`. The file name contains `end` and differs from all other names in use.
fn beside(path: &Path, end: &str) -> PathBuf {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    path.with_file_name(format!("{TEMPORARY}{}-{number}.{end}", std::process::id()))
}

fn is_temporary(name: &OsStr) -> bool {
    let parts = name.to_str().and_then(|name| name.strip_prefix(TEMPORARY)?.rsplit_once('.'));
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    // Both numbers must be decimal, so that files of other programs are never removed.
    parts.is_some_and(|(numbers, end)| {
        let both = numbers.split_once('-');
        ["tmp", "old"].contains(&end) && both.is_some_and(|(process, number)| is_number(process) && is_number(number))
    })
}

/// Removes the temporary files of processes that have ended. No process holds a lock on such a file.
///
/// The folder must be locked during the call. Otherwise, another process may have created a file and not yet locked the
/// file, or may be replacing files.
pub(super) fn remove_leftover_files(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| is_temporary(&entry.file_name())) {
        let path = entry.path();
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        let opened = is_file.then(|| File::open(&path).ok()).flatten();
        // A lock that can be taken shows that the writer has ended.
        if opened.is_some_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(path);
        }
    }
}

impl Batch {
    pub(super) const fn new(place: Place) -> Self {
        Self { place, files: Vec::new(), gone: Vec::new(), streams: Vec::new() }
    }

    /// Writes bytes for a regular file under a temporary name. Keeps bytes for any other target until
    /// [`Batch::commit`].
    pub(super) fn put(&mut self, target: &Target, bytes: &[u8]) -> io::Result<()> {
        if let Target::File(name) = target {
            return self.stage(name, bytes);
        }
        self.streams.push((target.clone(), bytes.to_vec()));
        Ok(())
    }

    /// Writes a temporary file to check that a folder is writable.
    pub(super) fn try_in(&mut self, folder: &Path) -> io::Result<()> {
        self.stage(&folder.join("tried"), b"")?;
        self.discard();
        Ok(())
    }

    fn stage(&mut self, name: &Path, bytes: &[u8]) -> io::Result<()> {
        let temporary = beside(name, "tmp");
        let mut file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
        // Without file locks, temporary files of ended processes stay in the folder.
        let _ = file.try_lock();
        let written = file.write_all(bytes);
        self.files.push(Staged { temporary, name: name.to_path_buf(), lock: Some(file) });
        written
    }

    pub(super) fn rename_last_file_first(&mut self) {
        let last = self.files.pop();
        self.files.splice(..0, last);
    }

    pub(super) fn remove_on_commit(&mut self, path: PathBuf) {
        self.gone.push(path);
    }

    /// Renames all files to their final names, then writes to devices, pipes and standard output. After an error, each
    /// file name has its previous contents.
    pub(super) fn commit(&mut self) -> Result<(), CliError> {
        let mut placed = Vec::new();
        let result = self.place_all(&mut placed).and_then(|()| self.write_streams());
        // In reverse order, delete the previous contents of each name after success and restore them after a failure.
        for Placed { name, before } in placed.into_iter().rev() {
            match (before, result.is_ok()) {
                (Some(before), true) => drop(fs::remove_file(before)),
                (Some(before), false) => {
                    let _ = fs::rename(&before, name);
                    // Renaming does nothing if both names already lead to the same file.
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
        // Keep the previous contents of each name before the rename, so that a failure can restore them.
        for Staged { temporary, name, .. } in &self.files {
            let before = kept(name, temporary).map_err(|error| self.place.refused(name, &error))?;
            placed.push(Placed { name: name.clone(), before });
            fs::rename(temporary, name).map_err(|error| self.place.refused(name, &error))?;
        }
        // Files of the previous run are renamed first, and deleted only after everything succeeded.
        for name in &self.gone {
            let old = beside(name, "old");
            fs::rename(name, &old).map_err(|error| self.place.refused(name, &error))?;
            placed.push(Placed { name: name.clone(), before: Some(old) });
        }
        Ok(())
    }

    fn write_streams(&self) -> Result<(), CliError> {
        self.streams.iter().try_for_each(|(target, bytes)| match target {
            Target::StandardOutput => crate::terminal::print_bytes(bytes),
            Target::Through(path) | Target::File(path) => {
                let opened: io::Result<File> = OpenOptions::new().write(true).open(path);
                opened.and_then(|mut file| file.write_all(bytes)).map_err(|error| self.place.refused(path, &error))
            }
        })
    }

    /// Removes all files without a final name, and drops the bytes for devices, pipes and standard output.
    pub(super) fn discard(&mut self) {
        self.streams.clear();
        self.gone.clear();
        for Staged { temporary, lock, .. } in self.files.drain(..) {
            // Some systems cannot remove a file that is open.
            drop(lock);
            let _ = fs::remove_file(temporary);
        }
    }
}

impl Drop for Batch {
    fn drop(&mut self) {
        self.discard();
    }
}

/// Keeps the contents of the file `name` under a second name, so that a failed commit can restore the contents. Copies
/// the permissions of `name` to the file `next`. Returns the second name, or `None` if `name` does not exist.
fn kept(name: &Path, next: &Path) -> io::Result<Option<PathBuf>> {
    match name.symlink_metadata() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
        Ok(found) if !found.is_file() => return Err(io::Error::other("it is no longer a regular file")),
        Ok(found) => fs::set_permissions(next, found.permissions())?,
    }
    let old = beside(name, "old");
    // On file systems without hard links, `name` does not exist for a moment.
    fs::hard_link(name, &old).or_else(|_| fs::rename(name, &old))?;
    Ok(Some(old))
}
