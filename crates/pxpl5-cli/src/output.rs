//! Output files, of which either all appear under their final names, or none.

mod batch;
mod target;

use crate::error::CliError;
use batch::Batch;
use image::RgbImage;
use pxpl5::lab::manifest::{MANIFEST_FILE, Manifest};
use pxpl5::sweep::ROWS_FILE;
use pxpl5::views::png_bytes;
use pxpl5::views::results::{origin, origin_lines};
use pxpl5::views::timeline::TimelineOptions;
use pxpl5::{Outcome, Report};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use target::{Place, Target};

#[derive(Debug)]
pub(crate) struct OutputFolder {
    path: PathBuf,
    place: Place,
    /// Folders that were created for this output: the output folder and its missing parents, outermost first.
    made: Vec<PathBuf>,
    batch: Batch,
    listing: Listing,
}

/// Maximum number of attempts to create a folder, because other processes may remove the folder again.
const MAX_TRIES: u32 = 100;

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
        let batch = Batch::new(place.clone());
        let mut folder = Self { path: path.to_path_buf(), place, made: Vec::new(), batch, listing };
        // A temporary file shows whether the folder is writable.
        folder.in_folder(|batch| batch.try_in(path))?;
        if let Some(_lock) = folder.lock() {
            batch::remove_leftover_files(path);
        }
        // The folder is created again when files are written.
        folder.unmake();
        Ok(folder)
    }

    /// Executes `what` on the output files while the folder is locked. The lock prevents other processes from removing
    /// or changing the folder.
    fn in_folder(&mut self, mut what: impl FnMut(&mut Batch) -> io::Result<()>) -> Result<(), CliError> {
        // Another process may remove the folder between its creation and the write.
        let mut tries = 0;
        loop {
            self.make()?;
            let lock = self.lock();
            let done = what(&mut self.batch);
            drop(lock);
            tries += 1;
            match done {
                // Another process that has created the folder may remove it while it is empty.
                Err(error) if error.kind() == io::ErrorKind::NotFound && tries < MAX_TRIES => {}
                Err(error) => return Err(self.place.refused(&self.path, &error)),
                Ok(()) => return Ok(()),
            }
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    fn make(&mut self) -> Result<(), CliError> {
        let missing = self.path.ancestors().take_while(|part| !part.as_os_str().is_empty() && !part.exists());
        let mut made: Vec<PathBuf> = missing.map(Path::to_path_buf).collect();
        made.reverse();
        self.made.extend(made);
        fs::create_dir_all(&self.path).map_err(|error| self.place.refused(&self.path, &error))
    }

    fn unmake(&mut self) {
        for folder in self.made.drain(..).rev() {
            let _ = fs::remove_dir(folder);
        }
    }

    /// Locks the folder against other processes. Returns `None` on a file system without locks, so that results are
    /// written without this protection.
    fn lock(&self) -> Option<File> {
        let folder = File::open(&self.path).ok()?;
        folder.lock().ok()?;
        Some(folder)
    }

    /// Writes a file under a temporary name. If `name` is a device, a pipe or a link to one of these, only
    /// [`OutputFolder::commit`] writes the bytes. Fails if `name` is a folder.
    pub(crate) fn put(&mut self, name: &str, bytes: &[u8]) -> Result<(), CliError> {
        let target = Target::of(&self.path.join(name), &self.place)?;
        if let (Listing::Own(manifest) | Listing::Added(manifest), Target::File(_)) = (&mut self.listing, &target) {
            manifest.add(name, bytes);
        }
        self.put_target(&target, bytes)
    }

    fn put_target(&mut self, target: &Target, bytes: &[u8]) -> Result<(), CliError> {
        self.in_folder(|batch| batch.put(target, bytes))
    }

    /// Renames all files to their final names. Processes that commit to the same folder take turns. After an error,
    /// each file has its previous contents.
    pub(crate) fn commit(mut self) -> Result<(), CliError> {
        self.make()?;
        let _lock = self.lock();
        self.put_manifest()?;
        self.batch.commit()?;
        self.made.clear();
        Ok(())
    }

    /// Adds the manifest as the first file to be renamed. After a crash between two renames, the hashes in the manifest
    /// show which files belong to the new run.
    fn put_manifest(&mut self) -> Result<(), CliError> {
        // A new run replaces the previous manifest; derived files extend it.
        let manifest = match &mut self.listing {
            Listing::None => return Ok(()),
            Listing::Own(manifest) => {
                if let Some(before) = before(&self.path)? {
                    let gone = manifest.replace(&before, &self.path);
                    gone.into_iter().for_each(|path| self.batch.remove_on_commit(path));
                }
                manifest.clone()
            }
            Listing::Added(added) => {
                let Some(mut manifest) = Manifest::read(&self.path)? else { return Ok(()) };
                manifest.add_all(added);
                manifest
            }
        };
        let target = Target::of(&self.path.join(MANIFEST_FILE), &self.place)?;
        let put = self.batch.put(&target, manifest.to_text().as_bytes());
        put.map_err(|error| self.place.refused(&self.path, &error))?;
        // The manifest must get its name before all other files.
        self.batch.rename_last_file_first();
        Ok(())
    }
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

/// Without a commit, removes the temporary files and all empty folders that were created for these files.
impl Drop for OutputFolder {
    fn drop(&mut self) {
        self.batch.discard();
        self.unmake();
    }
}

/// A single output file, written completely or not at all. The bytes for a device or pipe are written into the device
/// or pipe, which is never replaced.
#[derive(Debug)]
pub(crate) struct OutputFile {
    target: Target,
    /// Bytes for a target that exists and is not a regular file, such as a device or a pipe.
    batch: Batch,
    /// Folder of the output file. `None` if the target is not a regular file.
    folder: Option<OutputFolder>,
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
        let folder = match &target {
            Target::File(name) => {
                let folder = folder_of(name);
                let listing = results.map_or(Listing::None, |results| added_to(folder, results));
                Some(OutputFolder::begin(folder, place.clone(), listing)?)
            }
            Target::Through(_) | Target::StandardOutput => None,
        };
        Ok(Self { target, batch: Batch::new(place), folder })
    }

    /// Returns true if the output goes to standard output, so that the command must print nothing else.
    pub(crate) fn is_standard_output(&self) -> bool {
        self.target == Target::StandardOutput
    }

    /// Writes the file and then renames the file to its final name. After an error, a regular file has its previous
    /// contents.
    pub(crate) fn write(mut self, bytes: &[u8]) -> Result<(), CliError> {
        let Some(mut folder) = self.folder.take() else {
            // A stream is written by `commit`.
            let _ = self.batch.put(&self.target, bytes);
            return self.batch.commit();
        };
        if let (Listing::Added(manifest), Target::File(path)) = (&mut folder.listing, &self.target) {
            manifest.add(&path.file_name().unwrap_or_default().to_string_lossy(), bytes);
        }
        folder.put_target(&self.target, bytes)?;
        folder.commit()
    }
}

/// Returns the folder of a file. A name without a folder means the current folder.
fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns the timeline of a run as SVG. An XML comment states the settings that reproduce the run.
pub(crate) fn timeline(outcome: &Outcome, report: &Report) -> String {
    let svg = pxpl5::views::timeline::svg(outcome, &TimelineOptions::default());
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
