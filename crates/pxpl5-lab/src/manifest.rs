//! The manifest of an output folder: which files the command wrote that wrote there last.
//!
//! A folder may hold files of several runs, and files of its user. The manifest tells them apart: a reader trusts only
//! what is listed and unchanged, and the next run takes away what it does not write again.

use pxpl5_run::Fingerprint;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Name of the manifest in its folder.
pub const MANIFEST_FILE: &str = "manifest.json";

/// A file of a folder, and how its contents are told from others.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ManifestEntry {
    /// Name of the file, without a folder.
    pub name: String,
    /// [`Fingerprint`] of its contents; `None` of a file that grows, such as the rows of a sweep.
    pub contents: Option<String>,
}

/// The files of a folder, and the command that wrote them.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    schema: String,
    version: String,
    command: String,
    files: Vec<ManifestEntry>,
    /// Files of the manifest before, which are taken away once this one stands: after a kill they may still be there.
    #[serde(default)]
    replaced: Vec<ManifestEntry>,
}

/// Why a file of a folder cannot be used.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ManifestError {
    /// The manifest cannot be read.
    #[error("{path}: cannot be read: {reason}")]
    Io {
        /// Path of the manifest.
        path: String,
        /// The reason that the operating system gives.
        reason: String,
    },
    /// The file of that name is no manifest.
    #[error("{path}: expected a manifest of pxpl5 (schema {}), found {found}; choose another folder", Manifest::SCHEMA)]
    NoManifest {
        /// Path of the file.
        path: String,
        /// The first thing that is wrong with it.
        found: String,
    },
    /// A listed file is gone, or has other contents.
    #[error("{path}: expected the file that {MANIFEST_FILE} lists, found {found}")]
    Changed {
        /// Path of the file.
        path: String,
        /// What is there instead.
        found: &'static str,
    },
}

impl ManifestEntry {
    fn of(name: &str, bytes: &[u8]) -> Self {
        Self { name: name.to_owned(), contents: Some(Fingerprint::of(bytes).to_string()) }
    }

    /// Returns true if the contents are those of the entry.
    fn is_of(&self, bytes: &[u8]) -> bool {
        self.contents.as_ref().is_none_or(|contents| *contents == Fingerprint::of(bytes).to_string())
    }
}

impl Manifest {
    /// Name and version of the layout.
    pub const SCHEMA: &'static str = "pxpl5-manifest/1";

    /// The word for sweeps, whose rows are the work of hours.
    pub const SWEEP: &'static str = "sweep";

    /// An empty manifest of a command.
    #[must_use]
    pub fn new(command: &str) -> Self {
        Self {
            schema: Self::SCHEMA.to_owned(),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            command: command.to_owned(),
            files: Vec::new(),
            replaced: Vec::new(),
        }
    }

    /// Reads the manifest of a folder; `None` where there is none.
    ///
    /// # Errors
    ///
    /// [`ManifestError`] when there is a file of its name that is no manifest, or cannot be read.
    pub fn read(folder: &Path) -> Result<Option<Self>, ManifestError> {
        let path = folder.join(MANIFEST_FILE);
        let found = path.display().to_string();
        let no_manifest = |what: String| ManifestError::NoManifest { path: found.clone(), found: what };
        match path.metadata() {
            // Where there is no folder there is no manifest either.
            Err(error) if [io::ErrorKind::NotFound, io::ErrorKind::NotADirectory].contains(&error.kind()) => {
                return Ok(None);
            }
            Err(error) => return Err(ManifestError::Io { path: found, reason: error.to_string() }),
            // A pipe would be waited for.
            Ok(there) if !there.is_file() => return Err(no_manifest("something else than a file".to_owned())),
            Ok(_) => {}
        }
        let bytes =
            fs::read(&path).map_err(|error| ManifestError::Io { path: found.clone(), reason: error.to_string() })?;
        let manifest: Self = serde_json::from_slice(&bytes).map_err(|error| no_manifest(error.to_string()))?;
        if manifest.schema != Self::SCHEMA {
            return Err(no_manifest(format!("schema {}", manifest.schema)));
        }
        let all = manifest.files.iter().chain(&manifest.replaced);
        // A name that leads out of the folder could take away files of others.
        match all.map(|entry| &entry.name).find(|name| !is_plain(name)) {
            Some(name) => Err(no_manifest(format!("the file name {name:?}"))),
            None => Ok(Some(manifest)),
        }
    }

    /// The command that wrote the files.
    #[must_use]
    pub fn command(&self) -> &str {
        &self.command
    }

    /// Names of the files, in the order in which they were written.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.iter().map(|entry| entry.name.as_str())
    }

    /// Returns true if a file is listed.
    #[must_use]
    pub fn lists(&self, name: &str) -> bool {
        self.names().any(|listed| listed == name)
    }

    /// Lists a file with its contents.
    pub fn add(&mut self, name: &str, bytes: &[u8]) {
        self.put(ManifestEntry::of(name, bytes));
    }

    /// Lists a file that still grows.
    pub fn add_growing(&mut self, name: &str) {
        self.put(ManifestEntry { name: name.to_owned(), contents: None });
    }

    /// Lists what another manifest lists.
    pub fn add_all(&mut self, other: &Self) {
        other.files.iter().for_each(|entry| self.put(entry.clone()));
    }

    fn put(&mut self, entry: ManifestEntry) {
        match self.files.iter_mut().find(|listed| listed.name == entry.name) {
            Some(listed) => *listed = entry,
            None => self.files.push(entry),
        }
    }

    /// Reads a listed file; `None` of one that is not listed.
    ///
    /// # Errors
    ///
    /// [`ManifestError::Changed`] when it is gone, or has other contents than were written.
    pub fn read_file(&self, folder: &Path, name: &str) -> Result<Option<Vec<u8>>, ManifestError> {
        let Some(entry) = self.files.iter().find(|entry| entry.name == name) else { return Ok(None) };
        let path = folder.join(name);
        let changed = |found| ManifestError::Changed { path: path.display().to_string(), found };
        if !path.is_file() {
            return Err(changed("no file"));
        }
        let bytes = fs::read(&path).map_err(|_| changed("one that cannot be read"))?;
        if entry.is_of(&bytes) { Ok(Some(bytes)) } else { Err(changed("other contents")) }
    }

    /// Takes the place of the manifest before. Returns the files that are to be taken away: those that are not written
    /// again, and that nobody has changed since.
    #[must_use]
    pub fn replace(&mut self, before: &Self, folder: &Path) -> Vec<PathBuf> {
        let gone = before.files.iter().chain(&before.replaced).filter(|entry| !self.lists(&entry.name));
        let gone: Vec<ManifestEntry> = gone.filter(|entry| is_unchanged(folder, entry)).cloned().collect();
        self.replaced = gone;
        self.replaced.iter().map(|entry| folder.join(&entry.name)).collect()
    }

    /// The manifest as it is written.
    #[must_use]
    pub fn to_text(&self) -> String {
        // Texts and lists of texts can be written.
        serde_json::to_string_pretty(self).unwrap_or_default() + "\n"
    }
}

/// Returns true if the name leads to a file of the folder itself, other than the manifest.
fn is_plain(name: &str) -> bool {
    let is_one_part = Path::new(name).file_name().is_some_and(|part| part == name);
    is_one_part && !name.contains(['/', '\\']) && name != MANIFEST_FILE
}

/// Returns true if a regular file with the contents of the entry is there. Of a file that grows this is not known.
fn is_unchanged(folder: &Path, entry: &ManifestEntry) -> bool {
    let path = folder.join(&entry.name);
    let is_file = path.symlink_metadata().is_ok_and(|found| found.is_file());
    is_file && entry.contents.is_some() && fs::read(path).is_ok_and(|bytes| entry.is_of(&bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        let path = std::env::temp_dir().join(format!("pxpl5-manifest-{}-{name}", std::process::id()));
        let _ = fs::remove_dir_all(&path);
        fs::create_dir_all(&path).expect("the temporary directory can be written");
        path
    }

    #[test]
    fn a_manifest_is_read_as_it_was_written_and_tells_what_has_changed() {
        let folder = folder("round");
        assert_eq!(Manifest::read(&folder).expect("no file is no error"), None);
        let mut manifest = Manifest::new("run");
        manifest.add("a", b"one");
        manifest.add("a", b"two");
        manifest.add_growing("b");
        fs::write(folder.join(MANIFEST_FILE), manifest.to_text()).expect("ours");
        assert_eq!(Manifest::read(&folder).expect("it is one").as_ref(), Some(&manifest));
        for (contents, is_whole) in [("one", false), ("two", true)] {
            fs::write(folder.join("a"), contents).expect("ours");
            assert_eq!(manifest.read_file(&folder, "a").is_ok(), is_whole, "{contents}");
        }
        assert!(manifest.read_file(&folder, "b").is_err(), "it is not there");
        assert_eq!(manifest.read_file(&folder, "c").ok().flatten(), None);
        fs::remove_dir_all(folder).expect("ours");
    }

    #[test]
    fn what_is_not_written_again_goes_unless_its_user_has_changed_it() {
        let folder = folder("gone");
        let mut before = Manifest::new("run");
        for name in ["kept", "changed", "gone", "absent"] {
            before.add(name, b"old");
        }
        for (name, contents) in [("kept", "old"), ("changed", "mine"), ("gone", "old")] {
            fs::write(folder.join(name), contents).expect("ours");
        }
        let mut next = Manifest::new("run");
        next.add("kept", b"new");
        assert_eq!(next.replace(&before, &folder), [folder.join("gone")]);
        // A run that was killed before it took the file away leaves that to the one behind it.
        let mut third = Manifest::new("run");
        assert_eq!(third.replace(&next, &folder), [folder.join("gone")], "`kept` has the old contents");
        fs::remove_dir_all(folder).expect("ours");
    }

    #[test]
    fn a_name_that_leads_out_of_the_folder_is_refused() {
        let folder = folder("out");
        for name in ["../a", "/etc/passwd", "a/b", "..", "", "manifest.json"] {
            let text = format!(
                "{{\"schema\":\"{}\",\"version\":\"0\",\"command\":\"run\",\"files\":[{{\"name\":\"{name}\",\"contents\":null}}]}}",
                Manifest::SCHEMA
            );
            fs::write(folder.join(MANIFEST_FILE), text).expect("ours");
            assert!(matches!(Manifest::read(&folder), Err(ManifestError::NoManifest { .. })), "{name}");
        }
        fs::remove_dir_all(folder).expect("ours");
    }
}
