//! The manifest of an output folder, which lists the files of the last command that wrote into the folder.
//!
//! A folder may hold files of several runs and files of the user. The manifest distinguishes these files. Readers use
//! only listed and unchanged files. The next run removes all listed files that it does not write again.

use pxpl5_measure::program;
use pxpl5_run::Fingerprint;
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use tempfile::NamedTempFile;

/// Name of the manifest file in its folder.
pub const MANIFEST_FILE: &str = "manifest.json";

/// A file in the manifest, with a hash that identifies the file's contents.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestEntry {
    /// Name of the file, without a folder.
    pub name: String,
    /// [`Fingerprint`] of the contents. `None` for a file that grows, such as the rows of a sweep.
    pub contents: Option<String>,
}

/// List of the files in a folder that one command wrote.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    schema: String,
    version: String,
    /// Commit of the program that wrote the files, if known. Earlier programs stated no commit.
    #[serde(default)]
    commit: Option<String>,
    command: String,
    files: Vec<ManifestEntry>,
    /// Files of the previous manifest that will be removed after this manifest is written. After a crash, some of these
    /// files may still exist.
    #[serde(default)]
    replaced: Vec<ManifestEntry>,
}

impl ManifestEntry {
    fn of(name: &str, bytes: &[u8]) -> Self {
        Self { name: name.to_owned(), contents: Some(Fingerprint::of(bytes).to_string()) }
    }

    fn is_of(&self, bytes: &[u8]) -> bool {
        self.contents.as_ref().is_none_or(|contents| *contents == Fingerprint::of(bytes).to_string())
    }
}

impl Manifest {
    /// Name and version of the JSON layout.
    pub const SCHEMA: &'static str = "pxpl5-manifest/1";

    /// Command name that the manifest in the folder of a sweep states. Other commands never replace the rows in a
    /// folder with this command name, because the rows can be the work of hours.
    pub const SWEEP: &'static str = "sweep";

    /// Creates an empty manifest for a command.
    pub fn new(command: &str) -> Self {
        Self {
            schema: Self::SCHEMA.to_owned(),
            version: program::VERSION.to_owned(),
            commit: program::commit().map(str::to_owned),
            command: command.to_owned(),
            files: Vec::new(),
            replaced: Vec::new(),
        }
    }

    /// Reads the manifest of a folder. Returns `None` if the folder has no manifest.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if the file cannot be read or is not a manifest.
    pub fn read(folder: &Path) -> Result<Option<Self>, FileError> {
        let path = folder.join(MANIFEST_FILE);
        let found = path.display().to_string();
        let no_manifest = |what: String| {
            let expected = format_args!("a manifest of pxpl5 (schema {})", Self::SCHEMA);
            let what = format_args!("{what}; choose another folder");
            FileError::new(FileErrorKind::Occupied, expected, what).in_file(&found)
        };
        match path.metadata() {
            // A missing folder has no manifest either.
            Err(error) if [io::ErrorKind::NotFound, io::ErrorKind::NotADirectory].contains(&error.kind()) => {
                return Ok(None);
            }
            Err(error) => return Err(FileError::io(&path, "cannot be read")(error)),
            // Reading a pipe would block.
            Ok(there) if !there.is_file() => {
                return Err(no_manifest("something that is not a regular file".to_owned()));
            }
            Ok(_) => {}
        }
        let bytes = fs::read(&path).map_err(FileError::io(&path, "cannot be read"))?;
        let manifest: Self = serde_json::from_slice(&bytes).map_err(|error| no_manifest(error.to_string()))?;
        if manifest.schema != Self::SCHEMA {
            return Err(no_manifest(format!("schema {}", manifest.schema)));
        }
        let all = manifest.files.iter().chain(&manifest.replaced);
        // A name that leads out of the folder could cause the removal of unrelated files.
        match all.map(|entry| &entry.name).find(|name| !is_plain(name)) {
            Some(name) => Err(no_manifest(format!("the file name {name:?}"))),
            None => Ok(Some(manifest)),
        }
    }

    /// Returns the name of the command that wrote the files of the manifest.
    pub fn command(&self) -> &str {
        &self.command
    }

    /// Returns the names of all files in the manifest, in the order in which they were written.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|entry| entry.name.as_str())
    }

    /// Returns true if the manifest contains a file of this name.
    pub fn lists(&self, name: &str) -> bool {
        self.names().any(|listed| listed == name)
    }

    /// Adds a file with a hash of its contents.
    pub fn add(&mut self, name: &str, bytes: &[u8]) {
        self.put(ManifestEntry::of(name, bytes));
    }

    /// Adds a file that still grows, without a hash.
    pub fn add_growing(&mut self, name: &str) {
        self.put(ManifestEntry { name: name.to_owned(), contents: None });
    }

    /// Adds all files of the manifest `other`.
    pub fn add_all(&mut self, other: &Self) {
        other.files.iter().for_each(|entry| self.put(entry.clone()));
    }

    fn put(&mut self, entry: ManifestEntry) {
        match self.files.iter_mut().find(|listed| listed.name == entry.name) {
            Some(listed) => *listed = entry,
            None => self.files.push(entry),
        }
    }

    /// Reads a file of the manifest. Returns `None` if the manifest does not list the file.
    ///
    /// # Errors
    ///
    /// Returns a [`FileError`] if the file is missing or its contents have changed.
    pub fn read_file(&self, folder: &Path, name: &str) -> Result<Option<Vec<u8>>, FileError> {
        let Some(entry) = self.files.iter().find(|entry| entry.name == name) else { return Ok(None) };
        let path = folder.join(name);
        let changed = |found| {
            let expected = format_args!("the file that {MANIFEST_FILE} lists");
            FileError::new(FileErrorKind::Damaged, expected, found).in_file(path.display())
        };
        // A manifest from elsewhere must not bring a file from behind a link into a page.
        if !path.symlink_metadata().is_ok_and(|found| found.is_file()) {
            return Err(changed("no file of this folder"));
        }
        let bytes = fs::read(&path).map_err(|_| changed("a file that cannot be read"))?;
        if entry.is_of(&bytes) { Ok(Some(bytes)) } else { Err(changed("other contents")) }
    }

    /// Replaces the previous manifest `before` by this manifest. Returns the old files that must be removed: unchanged
    /// files that the new run does not write.
    pub fn replace(&mut self, before: &Self, folder: &Path) -> Vec<PathBuf> {
        let gone = before.files.iter().chain(&before.replaced).filter(|entry| !self.lists(&entry.name));
        // Files that the user has changed are kept. A file can be in both lists if it was replaced and written again.
        let mut gone: Vec<ManifestEntry> = gone.filter(|entry| is_unchanged(folder, entry)).cloned().collect();
        gone.sort_by(|a, b| a.name.cmp(&b.name));
        gone.dedup_by(|a, b| a.name == b.name);
        self.replaced = gone;
        self.replaced.iter().map(|entry| folder.join(&entry.name)).collect()
    }

    /// Returns the text of the manifest file.
    pub fn to_text(&self) -> String {
        // Serialization of text and lists of text cannot fail.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// Beginning and end of the names of temporary files.
const TEMPORARY: [&str; 2] = [".pxpl5-", ".tmp"];

/// Creates a file with the permissions of new files, which is deleted unless it is renamed.
///
/// # Errors
///
/// Returns the error of the file system.
pub fn temporary_file(folder: &Path) -> io::Result<NamedTempFile> {
    let [prefix, suffix] = TEMPORARY;
    tempfile::Builder::new().prefix(prefix).suffix(suffix).make_in(folder, |path| fs::File::create_new(path))
}

/// Returns true for the name of a temporary file, which a process that was killed has left behind.
pub(crate) fn is_temporary(name: &str) -> bool {
    name.starts_with(TEMPORARY[0]) && name.ends_with(TEMPORARY[1])
}

/// Returns true for a plain file name without a folder, except for the manifest's own name.
fn is_plain(name: &str) -> bool {
    let is_one_part = Path::new(name).file_name().is_some_and(|part| part == name);
    is_one_part && !name.contains(['/', '\\']) && name != MANIFEST_FILE
}

/// Returns true if the file exists with unchanged contents. Returns false for files that grow.
fn is_unchanged(folder: &Path, entry: &ManifestEntry) -> bool {
    let path = folder.join(&entry.name);
    let is_file = path.symlink_metadata().is_ok_and(|found| found.is_file());
    is_file && entry.contents.is_some() && fs::read(path).is_ok_and(|bytes| entry.is_of(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_manifest_is_read_as_written_and_finds_changed_files() {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        assert_eq!(Manifest::read(folder).expect("no file is no error"), None);
        let mut manifest = Manifest::new("run");
        manifest.add("a", b"one");
        manifest.add("a", b"two");
        manifest.add_growing("b");
        fs::write(folder.join(MANIFEST_FILE), manifest.to_text()).expect("ours");
        assert_eq!(Manifest::read(folder).expect("it is one").as_ref(), Some(&manifest));
        for (contents, is_whole) in [("one", false), ("two", true)] {
            fs::write(folder.join("a"), contents).expect("ours");
            assert_eq!(manifest.read_file(folder, "a").is_ok(), is_whole, "{contents}");
        }
        assert!(manifest.read_file(folder, "b").is_err(), "it is not there");
        assert_eq!(manifest.read_file(folder, "c").ok().flatten(), None);
    }

    #[test]
    fn files_not_written_again_are_removed_unless_the_user_changed_them() {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        let mut before = Manifest::new("run");
        for name in ["kept", "changed", "gone", "absent"] {
            before.add(name, b"old");
        }
        for (name, contents) in [("kept", "old"), ("changed", "mine"), ("gone", "old")] {
            fs::write(folder.join(name), contents).expect("ours");
        }
        let mut next = Manifest::new("run");
        next.add("kept", b"new");
        assert_eq!(next.replace(&before, folder), [folder.join("gone")]);
        // If a run ended before it removed a file, the next run removes the file.
        let mut third = Manifest::new("run");
        assert_eq!(third.replace(&next, folder), [folder.join("gone")], "`kept` has the old contents");
        // Another command writes the file of the list `replaced` again. The next run removes the file once.
        next.add("gone", b"old");
        let mut fourth = Manifest::new("run");
        assert_eq!(fourth.replace(&next, folder), [folder.join("gone")], "the file is in both lists");
    }

    #[test]
    fn a_name_that_leads_out_of_the_folder_is_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let folder = folder.path();
        for name in ["../a", "/etc/passwd", "a/b", "..", "", "manifest.json"] {
            let text = format!(
                "{{\"schema\":\"{}\",\"version\":\"0\",\"command\":\"run\",\"files\":[{{\"name\":\"{name}\",\"contents\":null}}]}}",
                Manifest::SCHEMA
            );
            fs::write(folder.join(MANIFEST_FILE), text).expect("ours");
            assert_eq!(Manifest::read(folder).expect_err(name).kind, FileErrorKind::Occupied, "{name}");
        }
    }
}
