//! Files that appear together: the one place through which the command writes.

use super::target::{Place, Target};
use crate::error::CliError;
use std::ffi::OsStr;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

/// Outputs that are ready, but have not yet been given their names.
#[derive(Debug)]
pub(super) struct Batch {
    /// How an error names what cannot be written.
    place: Place,
    files: Vec<Staged>,
    /// Files of the run before that go when all others have their names.
    gone: Vec<PathBuf>,
    /// What goes into devices, pipes and standard output, which cannot be taken back: written last.
    streams: Vec<(Target, Vec<u8>)>,
}

/// A file that is whole under a temporary name.
#[derive(Debug)]
struct Staged {
    temporary: PathBuf,
    name: PathBuf,
    /// Held open and locked, so that another process can tell it from what a dead one left; none where it could not be made.
    lock: Option<File>,
}

/// A name that has its file, or none any more, and what had that name before.
struct Placed {
    name: PathBuf,
    before: Option<PathBuf>,
}

/// What begins every temporary name.
const TEMPORARY: &str = ".pxpl5-";

/// A name beside a file that no other output of any process has.
fn beside(path: &Path, end: &str) -> PathBuf {
    static NEXT: AtomicU64 = AtomicU64::new(0);
    let number = NEXT.fetch_add(1, Ordering::Relaxed);
    path.with_file_name(format!("{TEMPORARY}{}-{number}.{end}", std::process::id()))
}

/// Returns true for names as [`beside`] makes them.
fn is_temporary(name: &OsStr) -> bool {
    let parts = name.to_str().and_then(|name| name.strip_prefix(TEMPORARY)?.rsplit_once('.'));
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    parts.is_some_and(|(numbers, end)| {
        let both = numbers.split_once('-');
        ["tmp", "old"].contains(&end) && both.is_some_and(|(process, number)| is_number(process) && is_number(number))
    })
}

/// Removes what processes that are dead have left under temporary names: nobody holds its lock. The caller holds the
/// folder's lock, so that no file is between its birth and its lock, and no process is replacing files.
pub(super) fn remove_left_over(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| is_temporary(&entry.file_name())) {
        let path = entry.path();
        let is_file = entry.file_type().is_ok_and(|kind| kind.is_file());
        let opened = is_file.then(|| File::open(&path).ok()).flatten();
        if opened.is_some_and(|file| file.try_lock().is_ok()) {
            let _ = fs::remove_file(path);
        }
    }
}

impl Batch {
    pub(super) const fn new(place: Place) -> Self {
        Self { place, files: Vec::new(), gone: Vec::new(), streams: Vec::new() }
    }

    /// Writes a file under a temporary name, or keeps what goes elsewhere.
    ///
    /// # Errors
    ///
    /// When the file cannot be written.
    pub(super) fn put(&mut self, target: &Target, bytes: &[u8]) -> io::Result<()> {
        if let Target::File(name) = target {
            return self.stage(name, bytes);
        }
        self.streams.push((target.clone(), bytes.to_vec()));
        Ok(())
    }

    /// Tries whether a folder can be written.
    ///
    /// # Errors
    ///
    /// When it cannot.
    pub(super) fn try_in(&mut self, folder: &Path) -> io::Result<()> {
        self.stage(&folder.join("tried"), b"")?;
        self.discard();
        Ok(())
    }

    fn stage(&mut self, name: &Path, bytes: &[u8]) -> io::Result<()> {
        let temporary = beside(name, "tmp");
        let mut file = OpenOptions::new().write(true).create_new(true).open(&temporary)?;
        // A file system without locks: what a dead process leaves there stays.
        let _ = file.try_lock();
        let written = file.write_all(bytes);
        self.files.push(Staged { temporary, name: name.to_path_buf(), lock: Some(file) });
        written
    }

    /// The file that was put last is given its name first.
    pub(super) fn last_first(&mut self) {
        let last = self.files.pop();
        self.files.splice(..0, last);
    }

    /// Takes a file away when all others have their names.
    pub(super) fn take_away(&mut self, path: PathBuf) {
        self.gone.push(path);
    }

    /// Gives all files their names, then writes the rest. When something fails every name has what it had before.
    ///
    /// # Errors
    ///
    /// When a name cannot be given or a device, pipe or standard output cannot be written.
    pub(super) fn commit(&mut self) -> Result<(), CliError> {
        let mut placed = Vec::new();
        let result = self.place_all(&mut placed).and_then(|()| self.write_streams());
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
        for Staged { temporary, name, .. } in &self.files {
            let before = kept(name, temporary).map_err(|error| self.place.refused(name, &error))?;
            placed.push(Placed { name: name.clone(), before });
            fs::rename(temporary, name).map_err(|error| self.place.refused(name, &error))?;
        }
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

    /// Removes what has no name yet.
    pub(super) fn discard(&mut self) {
        self.streams.clear();
        self.gone.clear();
        for Staged { temporary, lock, .. } in self.files.drain(..) {
            // Some systems remove no file that is open.
            drop(lock);
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
