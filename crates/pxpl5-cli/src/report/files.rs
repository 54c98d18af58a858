//! The files of a results folder that are of its run: those that its manifest lists.

use crate::error::CliError;
use crate::terminal::complain;
use pxpl5::lab::manifest::{MANIFEST_FILE, Manifest};
use std::fs;
use std::path::Path;

/// A results folder, of which only the listed files are read.
pub(super) struct Files<'a> {
    folder: &'a Path,
    manifest: Option<Manifest>,
    /// Says what is left out.
    quiet: bool,
}

impl<'a> Files<'a> {
    /// Reads the manifest of a folder.
    ///
    /// # Errors
    ///
    /// When the file of its name is no manifest.
    pub(super) fn of(folder: &'a Path, quiet: bool) -> Result<Self, CliError> {
        Ok(Self { folder, manifest: Manifest::read(folder)?, quiet })
    }

    pub(super) const fn folder(&self) -> &Path {
        self.folder
    }

    /// The file that says what the others are of. Without a manifest it stands alone: nobody knows of which run the others are.
    ///
    /// # Errors
    ///
    /// When it cannot be read, or is not the one that the manifest lists.
    pub(super) fn first(&self, name: &str) -> Result<Vec<u8>, String> {
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

    /// Says that files are left out where no manifest lists them.
    pub(super) fn warn_if_unlisted(&self) {
        if self.manifest.is_none() {
            self.warn(&format!(
                "{}: there is no {MANIFEST_FILE} that says which pictures and tables are of this run; they are left out. Run it again to \
                 have them",
                self.folder.display()
            ));
        }
    }

    /// Names of the listed files.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.manifest.iter().flat_map(Manifest::names)
    }

    /// A listed file; `None` of one that is not listed, or is not as it was written, which is said.
    pub(super) fn read(&self, name: &str) -> Option<Vec<u8>> {
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
            complain(&format!("pxpl5: warning: {text}\n"));
        }
    }
}
