//! Result files: all of them appear, whole, or none.

mod batch;
mod target;

use crate::error::CliError;
use batch::Batch;
use image::RgbImage;
use pxpl5::lab::manifest::{MANIFEST_FILE, Manifest};
use pxpl5::results::{origin, origin_lines};
use pxpl5::sweep::ROWS_FILE;
use pxpl5::timeline::TimelineOptions;
use pxpl5::views::png_bytes;
use pxpl5::{Outcome, Report};
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use target::{Place, Target};

/// A folder that can be written, and the files that are going to be in it.
#[derive(Debug)]
pub(crate) struct OutputFolder {
    path: PathBuf,
    place: Place,
    /// Folders that were made for it, outermost first.
    made: Vec<PathBuf>,
    batch: Batch,
    listing: Listing,
}

/// How often a folder is made that another process removes.
const MOST_TRIES: u32 = 100;

/// What the manifest of a folder says of the files that are written.
#[derive(Debug)]
enum Listing {
    /// Nothing: the folder is not theirs.
    None,
    /// They are all of one run, which takes the place of the run before.
    Own(Manifest),
    /// They are made of what the folder holds: its manifest lists them too, if it has one.
    Added(Manifest),
}

impl OutputFolder {
    /// Returns a folder for all files of one run. They take the place of the files of the run before, as a whole.
    ///
    /// # Errors
    ///
    /// When it is not a folder, or cannot be made or written; when it holds a sweep, whose rows are the work of hours.
    pub(crate) fn of_run(path: &Path, command: &str) -> Result<Self, CliError> {
        before(path)?;
        Self::begin(path, Place::folder("--out"), Listing::Own(Manifest::new(command)))
    }

    /// Returns a folder for files that belong to nothing else there.
    ///
    /// # Errors
    ///
    /// When it is not a folder, or cannot be made or written.
    pub(crate) fn open(path: &Path, option: &'static str) -> Result<Self, CliError> {
        Self::begin(path, Place::folder(option), Listing::None)
    }

    /// Returns a folder for files that are made of what `results` holds, which may be the same folder.
    ///
    /// # Errors
    ///
    /// As [`Self::open`].
    pub(crate) fn beside(path: &Path, option: &'static str, results: &Path) -> Result<Self, CliError> {
        Self::begin(path, Place::folder(option), added_to(path, results))
    }

    /// Tries to write, before hours are spent on what could not be kept. What had to be made for that goes again, so that a
    /// run that is ended in any way leaves no empty folder.
    fn begin(path: &Path, place: Place, listing: Listing) -> Result<Self, CliError> {
        let batch = Batch::new(place.clone());
        let mut folder = Self { path: path.to_path_buf(), place, made: Vec::new(), batch, listing };
        folder.in_folder(|batch| batch.try_in(path))?;
        if let Some(_lock) = folder.lock() {
            batch::remove_left_over(path);
        }
        folder.unmake();
        Ok(folder)
    }

    /// Does something in the folder that no other process may disturb.
    fn in_folder(&mut self, mut what: impl FnMut(&mut Batch) -> io::Result<()>) -> Result<(), CliError> {
        let mut tries = 0;
        loop {
            self.make()?;
            let lock = self.lock();
            let done = what(&mut self.batch);
            drop(lock);
            tries += 1;
            match done {
                // Another process has made the folder too, and removes it again while it is empty.
                Err(error) if error.kind() == io::ErrorKind::NotFound && tries < MOST_TRIES => {}
                Err(error) => return Err(self.place.refused(&self.path, &error)),
                Ok(()) => return Ok(()),
            }
        }
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Makes the folder and those around it that are missing.
    fn make(&mut self) -> Result<(), CliError> {
        let missing = self.path.ancestors().take_while(|part| !part.as_os_str().is_empty() && !part.exists());
        let mut made: Vec<PathBuf> = missing.map(Path::to_path_buf).collect();
        made.reverse();
        self.made.extend(made);
        fs::create_dir_all(&self.path).map_err(|error| self.place.refused(&self.path, &error))
    }

    /// Removes the folders that were made, if they are still empty.
    fn unmake(&mut self) {
        for folder in self.made.drain(..).rev() {
            let _ = fs::remove_dir(folder);
        }
    }

    /// Keeps other processes from writing here; none on a file system without locks: better no protection than no results.
    fn lock(&self) -> Option<File> {
        let folder = File::open(&self.path).ok()?;
        folder.lock().ok()?;
        Some(folder)
    }

    /// Writes a file under a temporary name; a device, a pipe or a link of that name is written through when all files
    /// are given their names.
    ///
    /// # Errors
    ///
    /// When it cannot be written, or is a folder.
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

    /// Gives all files their names, or none. Of several processes that write into one folder, one after the other does.
    ///
    /// # Errors
    ///
    /// When a file of that name is in the way and cannot be replaced; every name has then what it had before.
    pub(crate) fn commit(mut self) -> Result<(), CliError> {
        self.make()?;
        let _lock = self.lock();
        self.put_manifest()?;
        self.batch.commit()?;
        self.made.clear();
        Ok(())
    }

    /// The manifest comes before all other files: after a kill between them, contents tell which are of this run.
    fn put_manifest(&mut self) -> Result<(), CliError> {
        let manifest = match &mut self.listing {
            Listing::None => return Ok(()),
            Listing::Own(manifest) => {
                if let Some(before) = before(&self.path)? {
                    let gone = manifest.replace(&before, &self.path);
                    gone.into_iter().for_each(|path| self.batch.take_away(path));
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
        self.batch.last_first();
        Ok(())
    }
}

/// The manifest of the run whose place is taken, if there is one.
fn before(folder: &Path) -> Result<Option<Manifest>, CliError> {
    let before = Manifest::read(folder)?;
    if before.as_ref().is_some_and(|before| before.command() == Manifest::SWEEP) || folder.join(ROWS_FILE).exists() {
        let folder = folder.display();
        return Err(CliError::usage(format!("{folder}: there are rows of a sweep here; choose another folder")));
    }
    Ok(before)
}

/// Files that are written into the folder that they are made of are listed there.
fn added_to(folder: &Path, results: &Path) -> Listing {
    let whole = |path: &Path| path.canonicalize().ok();
    match (whole(folder), whole(results)) {
        (Some(folder), Some(results)) if folder == results => Listing::Added(Manifest::new("")),
        _ => Listing::None,
    }
}

/// What was not committed leaves no trace: files are removed, and so are folders made for them, if still empty.
impl Drop for OutputFolder {
    fn drop(&mut self) {
        self.batch.discard();
        self.unmake();
    }
}

/// One file that is going to be written: whole or not at all, and through whatever is no regular file.
#[derive(Debug)]
pub(crate) struct OutputFile {
    target: Target,
    /// For what is there already and is no file.
    batch: Batch,
    /// The folder that it will be in; none for what is there already and is no file.
    folder: Option<OutputFolder>,
}

impl OutputFile {
    /// Looks where the path leads that an option gives, and tries to write there if that can be done without a trace.
    ///
    /// # Errors
    ///
    /// When the path is a folder, does not end in a name, or its folder cannot be made or written.
    pub(crate) fn open(path: &Path, option: &'static str) -> Result<Self, CliError> {
        Self::begin(path, option, None)
    }

    /// The same of a file that is made of what a folder holds, in which it may be written.
    ///
    /// # Errors
    ///
    /// As [`Self::open`].
    pub(crate) fn of_results(path: &Path, option: &'static str, results: &Path) -> Result<Self, CliError> {
        Self::begin(path, option, Some(results))
    }

    fn begin(path: &Path, option: &'static str, results: Option<&Path>) -> Result<Self, CliError> {
        if path.file_name().is_none() || path.is_dir() {
            let path = path.display();
            return Err(CliError::usage(format!("{option}: {path} is no file name; give the name of a file")));
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

    /// Whether it goes to standard output, where nothing else should go then.
    pub(crate) fn is_standard_output(&self) -> bool {
        self.target == Target::StandardOutput
    }

    /// Writes all of it: the file gets its name when it is whole.
    ///
    /// # Errors
    ///
    /// When that cannot be done; a regular file is then as it was.
    pub(crate) fn write(mut self, bytes: &[u8]) -> Result<(), CliError> {
        let Some(mut folder) = self.folder.take() else {
            // A stream is written when all is committed.
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

/// The folder of a file; the one that the process is in, of a bare name.
fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A timeline as SVG, with its origin as a comment behind the XML declaration, if it has one.
pub(crate) fn timeline(outcome: &Outcome, report: &Report) -> String {
    let svg = pxpl5::timeline::svg(outcome, &TimelineOptions::default());
    let origin: String = origin_lines(report, "").chars().filter(|c| *c == '\n' || !is_forbidden(*c)).collect();
    // Two hyphens would end the comment.
    let comment = format!("<!--\n{}-->\n", origin.replace("--", "- -"));
    let at = if svg.starts_with("<?xml") { svg.find('\n').map_or(0, |end| end + 1) } else { 0 };
    format!("{}{comment}{}", &svg[..at], &svg[at..])
}

/// Returns true for characters that no XML document may hold, or only as references.
fn is_forbidden(c: char) -> bool {
    c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}')
}

/// A picture as PNG, with its origin, and whether it is complete, as text chunks.
///
/// # Errors
///
/// When the encoder refuses it.
pub(crate) fn png(picture: &RgbImage, report: &Report) -> Result<Vec<u8>, CliError> {
    let mut chunks = origin(report);
    chunks.push(("complete", report.ends_complete.to_string()));
    png_bytes(picture, &chunks).map_err(|error| CliError::failure(format!("a picture cannot be encoded: {error}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(name: &str) -> PathBuf {
        std::env::temp_dir().join(format!("pxpl5-output-{}-{name}", std::process::id()))
    }

    #[test]
    fn what_is_not_committed_leaves_no_trace() {
        let path = place("dropped").join("inner");
        let mut folder = OutputFolder::open(&path, "--out").expect("the temporary directory can be written");
        folder.put("a.txt", b"half").expect("written");
        drop(folder);
        assert!(!place("dropped").exists());
    }

    #[test]
    fn what_is_committed_is_there_alone() {
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
