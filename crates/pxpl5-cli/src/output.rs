//! Output files, which are written under temporary names and then renamed.

mod target;

use crate::error::CliError;
use image::RgbImage;
use pxpl5::lab::manifest::{MANIFEST_FILE, Manifest, temporary_file};
use pxpl5::sweep::ROWS_FILE;
use pxpl5::views::png_bytes;
use pxpl5::views::results::{origin, origin_lines};
use pxpl5::views::timeline::TimelineOptions;
use pxpl5::{Outcome, PictureNumber, Report};
use std::fs::{self, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use target::{Place, Target};
use tempfile::NamedTempFile;

/// Files of one folder, which are kept in memory until [`OutputFolder::commit`].
#[derive(Debug)]
pub(crate) struct OutputFolder {
    path: PathBuf,
    place: Place,
    files: Vec<(Target, Vec<u8>)>,
    listing: Listing,
}

/// The relation of the written files to the manifest in the folder. A manifest is the list of a run's files.
#[derive(Debug)]
enum Listing {
    /// The written files do not belong to the run of the manifest, so that the manifest does not list these files.
    None,
    /// The written files are all files of one run, and replace all files of the previous run in the folder.
    Own(Manifest),
    /// The written files derive from the results in the folder, and are added to the manifest if the folder has one.
    Added(Manifest),
}

impl OutputFolder {
    /// Returns an output folder for all files of one run. These files replace all files of the previous run.
    ///
    /// Fails if the folder holds a sweep, because a new run would delete rows that may have taken hours to compute.
    pub(crate) fn of_run(path: &Path, command: &str) -> Result<Self, CliError> {
        before(path)?;
        Self::begin(path, Place::folder("--out"), Listing::Own(Manifest::new(command)))
    }

    /// Returns an output folder for files that do not enter the manifest.
    pub(crate) fn open(path: &Path, option: &'static str) -> Result<Self, CliError> {
        Self::begin(path, Place::folder(option), Listing::None)
    }

    /// Returns an output folder for files that derive from the results in the folder `results`. Both folders may be the
    /// same.
    pub(crate) fn beside(path: &Path, option: &'static str, results: &Path) -> Result<Self, CliError> {
        Self::begin(path, Place::folder(option), added_to(path, results))
    }

    /// Checks that the folder is writable before the simulation begins, because a simulation may take hours. Folders
    /// that were created for the check are removed again, so that an interrupted run leaves no empty folder.
    fn begin(path: &Path, place: Place, listing: Listing) -> Result<Self, CliError> {
        let missing = path.ancestors().take_while(|part| !part.as_os_str().is_empty() && !part.exists());
        let missing: Vec<&Path> = missing.collect();
        let tried = fs::create_dir_all(path).and_then(|()| temporary_file(path)).map(drop);
        for folder in missing {
            let _ = fs::remove_dir(folder);
        }
        tried.map_err(|error| place.refused(path, &error))?;
        Ok(Self { path: path.to_path_buf(), place, files: Vec::new(), listing })
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Adds a file, which [`OutputFolder::commit`] writes. Fails if `name` is a folder.
    pub(crate) fn put(&mut self, name: &str, bytes: &[u8]) -> Result<(), CliError> {
        let target = Target::of(&self.path.join(name), &self.place)?;
        if let (Listing::Own(manifest) | Listing::Added(manifest), Target::File(_)) = (&mut self.listing, &target) {
            manifest.add(name, bytes);
        }
        self.files.push((target, bytes.to_vec()));
        Ok(())
    }

    /// Writes all files under temporary names, then to devices, pipes and standard output, and then renames the files.
    /// Until the renames, every file has its previous contents.
    pub(crate) fn commit(mut self) -> Result<(), CliError> {
        fs::create_dir_all(&self.path).map_err(|error| self.place.refused(&self.path, &error))?;
        let gone = self.put_manifest()?;
        let refused = |path: &Path, error: &io::Error| self.place.refused(path, error);
        let mut staged = Vec::new();
        for (target, bytes) in &self.files {
            if let Target::File(name) = target {
                staged.push((name, written(name, bytes).map_err(|error| refused(name, &error))?));
            }
        }
        for (target, bytes) in &self.files {
            match target {
                Target::File(_) => {}
                Target::StandardOutput => crate::terminal::print_bytes(bytes)?,
                Target::Through(path) => {
                    let opened = OpenOptions::new().write(true).open(path);
                    opened.and_then(|mut file| file.write_all(bytes)).map_err(|error| refused(path, &error))?;
                }
            }
        }
        for (name, file) in staged {
            file.persist(name).map_err(|error| refused(name, &error.error))?;
        }
        // Files of the previous run that the new run does not have.
        gone.iter().try_for_each(|path| fs::remove_file(path).map_err(|error| refused(path, &error)))
    }

    /// Adds the manifest as the first file to be renamed. After a crash between two renames, the hashes in the manifest
    /// show which files belong to the new run. Returns the files of the previous run that a new run must delete.
    fn put_manifest(&mut self) -> Result<Vec<PathBuf>, CliError> {
        // A new run replaces the previous manifest; derived files extend it.
        let (manifest, gone) = match &mut self.listing {
            Listing::None => return Ok(Vec::new()),
            Listing::Own(manifest) => {
                let before = before(&self.path)?;
                let gone = before.map(|before| manifest.replace(&before, &self.path));
                (manifest.clone(), gone.unwrap_or_default())
            }
            Listing::Added(added) => {
                let Some(mut manifest) = Manifest::read(&self.path)? else { return Ok(Vec::new()) };
                manifest.add_all(added);
                (manifest, Vec::new())
            }
        };
        let target = Target::of(&self.path.join(MANIFEST_FILE), &self.place)?;
        self.files.insert(0, (target, manifest.to_text().into_bytes()));
        Ok(gone)
    }
}

/// Writes a temporary file beside `name`, with the permissions of the file that it will replace.
fn written(name: &Path, bytes: &[u8]) -> io::Result<NamedTempFile> {
    let mut file = temporary_file(folder_of(name))?;
    file.write_all(bytes)?;
    match name.symlink_metadata() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(error) => return Err(error),
        Ok(found) if !found.is_file() => return Err(io::Error::other("it is no longer a regular file")),
        Ok(found) => fs::set_permissions(file.path(), found.permissions())?,
    }
    Ok(file)
}

/// Returns the manifest of the run that will be replaced, or `None` if the folder has no manifest. Fails if the folder
/// holds a sweep.
fn before(folder: &Path) -> Result<Option<Manifest>, CliError> {
    let before = Manifest::read(folder)?;
    if before.as_ref().is_some_and(|before| before.command() == Manifest::SWEEP) || folder.join(ROWS_FILE).exists() {
        let folder = folder.display();
        return Err(CliError::usage(format!("{folder}: the folder holds rows of a sweep; choose another folder")));
    }
    Ok(before)
}

/// Returns [`Listing::Added`] if files are written into the folder `results` itself, otherwise [`Listing::None`].
fn added_to(folder: &Path, results: &Path) -> Listing {
    let whole = |path: &Path| path.canonicalize().ok();
    match (whole(folder), whole(results)) {
        (Some(folder), Some(results)) if folder == results => Listing::Added(Manifest::new("")),
        _ => Listing::None,
    }
}

/// A single output file, written completely or not at all. The bytes for a device or pipe are written into the device
/// or pipe, which is never replaced.
#[derive(Debug)]
pub(crate) struct OutputFile {
    target: Target,
    folder: OutputFolder,
}

impl OutputFile {
    /// Resolves the path of an option. Fails if the path is a folder or is not writable. Devices and pipes are not
    /// checked.
    pub(crate) fn open(path: &Path, option: &'static str) -> Result<Self, CliError> {
        Self::begin(path, option, None)
    }

    /// Resolves the path of an output file that derives from the results in the folder `results`. The file may be in
    /// this folder.
    pub(crate) fn of_results(path: &Path, option: &'static str, results: &Path) -> Result<Self, CliError> {
        Self::begin(path, option, Some(results))
    }

    fn begin(path: &Path, option: &'static str, results: Option<&Path>) -> Result<Self, CliError> {
        if path.file_name().is_none() || path.is_dir() {
            let path = path.display();
            return Err(CliError::usage(format!("{option}: expected the name of a file, found {path}")));
        }
        let place = Place::file(option, path);
        let target = Target::of(path, &place)?;
        let folder = if let Target::File(name) = &target {
            let folder = folder_of(name);
            let listing = results.map_or(Listing::None, |results| added_to(folder, results));
            OutputFolder::begin(folder, place, listing)?
        } else {
            OutputFolder { path: PathBuf::from("."), place, files: Vec::new(), listing: Listing::None }
        };
        Ok(Self { target, folder })
    }

    /// Returns true if the output goes to standard output, so that the command must print nothing else.
    pub(crate) fn is_standard_output(&self) -> bool {
        self.target == Target::StandardOutput
    }

    /// Writes the file and then renames the file to its final name. After an error, a regular file has its previous
    /// contents.
    pub(crate) fn write(mut self, bytes: &[u8]) -> Result<(), CliError> {
        if let (Listing::Added(manifest), Target::File(path)) = (&mut self.folder.listing, &self.target) {
            manifest.add(&path.file_name().unwrap_or_default().to_string_lossy(), bytes);
        }
        self.folder.files.push((self.target, bytes.to_vec()));
        self.folder.commit()
    }
}

/// Returns the folder of a file. A name without a folder means the current folder.
fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns the timeline of a run as SVG. An XML comment states the settings that reproduce the run.
pub(crate) fn timeline(outcome: &Outcome, report: &Report, picture: Option<PictureNumber>) -> String {
    let svg = pxpl5::views::timeline::svg(outcome, &TimelineOptions { picture, ..TimelineOptions::default() });
    let origin: String = origin_lines(report, "").chars().filter(|c| *c == '\n' || !is_forbidden(*c)).collect();
    // XML comments must not contain two hyphens in a row.
    let comment = format!("<!--\n{}-->\n", origin.replace("--", "- -"));
    // The comment follows the XML declaration, which must be the first line.
    let at = if svg.starts_with("<?xml") { svg.find('\n').map_or(0, |end| end + 1) } else { 0 };
    format!("{}{comment}{}", &svg[..at], &svg[at..])
}

/// Returns true for a character that XML forbids, or allows only as a character reference.
fn is_forbidden(c: char) -> bool {
    c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}')
}

/// Returns a picture as PNG. Text chunks state the settings that reproduce the run, and whether the picture is
/// complete.
pub(crate) fn png(picture: &RgbImage, report: &Report) -> Result<Vec<u8>, CliError> {
    let mut chunks = origin(report);
    chunks.push(("complete", report.ends_complete.to_string()));
    png_bytes(picture, &chunks).map_err(CliError::failure)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("pxpl5-output-{}-{name}", std::process::id()))
    }

    #[test]
    fn an_uncommitted_output_leaves_no_file() {
        let path = place("dropped").join("inner");
        let mut folder = OutputFolder::open(&path, "--out").expect("the temporary directory can be written");
        folder.put("a.txt", b"half").expect("written");
        drop(folder);
        assert!(!place("dropped").exists());
    }

    #[test]
    fn a_committed_output_leaves_only_its_own_files() {
        let path = place("kept");
        let mut folder = OutputFolder::open(&path, "--out").expect("the temporary directory can be written");
        folder.put("a.txt", b"whole").expect("written");
        folder.commit().expect("renamed");
        let names: Vec<_> = fs::read_dir(&path).expect("there").map(|e| e.expect("entry").file_name()).collect();
        assert_eq!(names, ["a.txt"]);
        assert_eq!(fs::read(path.join("a.txt")).expect("there"), b"whole");
        fs::remove_dir_all(path).expect("ours");
    }
}
