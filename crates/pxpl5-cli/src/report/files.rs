//! Reader of the files in a results folder. Only files that the folder's manifest lists belong to the run.

use crate::error::CliError;
use crate::terminal::print_error;
use pxpl5::lab::manifest::{MANIFEST_FILE, Manifest};
use std::fs;
use std::path::Path;

/// A results folder. Files that the manifest (list of a run's files) does not list are left out.
pub(crate) struct Files<'a> {
    folder: &'a Path,
    manifest: Option<Manifest>,
    quiet: bool,
}

impl<'a> Files<'a> {
    /// Reads the manifest of a folder. Fails if the manifest file exists but is not valid.
    pub(crate) fn of(folder: &'a Path, quiet: bool) -> Result<Self, CliError> {
        Ok(Self { folder, manifest: Manifest::read(folder)?, quiet })
    }

    pub(crate) const fn folder(&self) -> &Path {
        self.folder
    }

    /// Reads the main results file, even without a manifest. Fails if the file differs from its entry in the manifest.
    pub(crate) fn first(&self, name: &str) -> Result<Vec<u8>, String> {
        let Some(manifest) = &self.manifest else {
            let bytes = fs::read(self.folder.join(name)).map_err(|error| error.to_string())?;
            self.warn_if_unlisted();
            return Ok(bytes);
        };
        let read = manifest.read_file(self.folder, name).map_err(|error| error.to_string())?;
        read.ok_or_else(|| {
            format!("{MANIFEST_FILE} does not list it; it lists files of `pxpl5 {}`", manifest.command())
        })
    }

    /// Prints a warning if the folder has no manifest. All files except the main results file are then left out.
    pub(crate) fn warn_if_unlisted(&self) {
        if self.manifest.is_none() {
            self.warn(&format!(
                "{}: the folder has no {MANIFEST_FILE}, so the pictures and tables of the run are not known and are left out. \
                 Run the command again to get them",
                self.folder.display()
            ));
        }
    }

    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.manifest.iter().flat_map(Manifest::names)
    }

    /// Returns the contents of a file, or `None` if the manifest does not list the file. Returns `None` with a warning
    /// if the file has changed.
    pub(crate) fn read(&self, name: &str) -> Option<Vec<u8>> {
        match self.manifest.as_ref()?.read_file(self.folder, name) {
            Ok(bytes) => bytes,
            Err(error) => {
                self.warn(&format!("{error}: it is left out"));
                None
            }
        }
    }

    fn warn(&self, text: &str) {
        if !self.quiet {
            print_error(&format!("pxpl5: warning: {text}\n"));
        }
    }
}
