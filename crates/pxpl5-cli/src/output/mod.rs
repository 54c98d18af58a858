//! Result files: all of them appear, whole, or none.

mod batch;
mod target;

use crate::error::CliError;
use batch::Batch;
use image::RgbImage;
use pxpl5::results::{origin, origin_lines};
use pxpl5::timeline::TimelineOptions;
use pxpl5::views::png_bytes;
use pxpl5::{Outcome, Report};
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use target::{Target, refused};

/// A folder that can be written, and the files that are going to be in it.
#[derive(Debug)]
pub(crate) struct OutputFolder {
    path: PathBuf,
    /// Folders that were made for it, outermost first.
    made: Vec<PathBuf>,
    batch: Batch,
}

impl OutputFolder {
    /// Makes the folder, if need be, and tries to write into it: before hours are spent on what could not be kept.
    ///
    /// # Errors
    ///
    /// When it is not a folder, or cannot be made or written.
    pub(crate) fn open(path: &Path) -> Result<Self, CliError> {
        let missing = path.ancestors().take_while(|part| !part.as_os_str().is_empty() && !part.exists());
        let mut made: Vec<PathBuf> = missing.map(Path::to_path_buf).collect();
        made.reverse();
        fs::create_dir_all(path).map_err(|error| refused(path, &error))?;
        let mut folder = Self { path: path.to_path_buf(), made, batch: Batch::default() };
        folder.batch.put(&Target::File(path.join("probe")), b"")?;
        folder.batch.discard();
        Ok(folder)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file under a temporary name; a device, a pipe or a link of that name is written through when all files
    /// are given their names.
    ///
    /// # Errors
    ///
    /// When it cannot be written, or is a folder.
    pub(crate) fn put(&mut self, name: &str, bytes: &[u8]) -> Result<(), CliError> {
        let target = Target::of(&self.path.join(name))?;
        self.batch.put(&target, bytes)
    }

    /// Gives all files their names, or none. Of several processes that write into one folder, one after the other does.
    ///
    /// # Errors
    ///
    /// When a file of that name is in the way and cannot be replaced; every name has then what it had before.
    pub(crate) fn commit(mut self) -> Result<(), CliError> {
        // A file system without locks: better no protection than no results.
        let lock = File::open(&self.path).ok();
        let _locked = lock.as_ref().map(File::lock);
        self.batch.commit()?;
        self.made.clear();
        Ok(())
    }
}

/// What was not committed leaves no trace: files are removed, and so are folders made for them, if still empty.
impl Drop for OutputFolder {
    fn drop(&mut self) {
        self.batch.discard();
        for folder in self.made.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

/// One file that is going to be written: whole or not at all, and through whatever is no regular file.
#[derive(Debug)]
pub(crate) struct OutputFile {
    target: Target,
    /// Goes before the folder, which is removed only if it is empty.
    batch: Batch,
    /// The folder that it will be in; none for what is there already and is no file.
    folder: Option<OutputFolder>,
}

impl OutputFile {
    /// Looks where the path leads, and tries to write there if that can be done without a trace.
    ///
    /// # Errors
    ///
    /// When the path is a folder, does not end in a name, or its folder cannot be made or written.
    pub(crate) fn open(path: &Path) -> Result<Self, CliError> {
        if path.file_name().is_none() || path.is_dir() {
            return Err(CliError::usage(format!("{} is no file name; give the name of a file", path.display())));
        }
        let target = Target::of(path)?;
        let folder = match &target {
            Target::File(name) => Some(OutputFolder::open(folder_of(name))?),
            Target::Through(_) | Target::StandardOutput => None,
        };
        Ok(Self { target, batch: Batch::default(), folder })
    }

    /// Whether it goes to standard output, where nothing else should go then.
    pub(crate) fn is_standard_output(&self) -> bool {
        self.target == Target::StandardOutput
    }

    /// Says what it will hold; nobody sees it yet.
    ///
    /// # Errors
    ///
    /// When it cannot be written.
    pub(crate) fn put(&mut self, bytes: &[u8]) -> Result<(), CliError> {
        self.batch.put(&self.target, bytes)
    }

    /// Gives the file its name, or writes into what is there.
    ///
    /// # Errors
    ///
    /// When that cannot be done; a regular file is then as it was.
    pub(crate) fn commit(mut self) -> Result<(), CliError> {
        self.batch.commit()?;
        self.folder.map_or(Ok(()), OutputFolder::commit)
    }

    /// Writes all of it at once.
    ///
    /// # Errors
    ///
    /// As [`Self::put`] and [`Self::commit`].
    pub(crate) fn write(mut self, bytes: &[u8]) -> Result<(), CliError> {
        self.put(bytes)?;
        self.commit()
    }
}

/// The folder of a file; the one that the process is in, of a bare name.
fn folder_of(file: &Path) -> &Path {
    file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A timeline as SVG, with its origin as a comment behind the XML declaration, if it has one.
pub(crate) fn timeline(outcome: &Outcome, report: &Report) -> String {
    let svg = pxpl5::timeline::svg(outcome, &TimelineOptions::default());
    // Two hyphens would end the comment.
    let comment = format!("<!--\n{}-->\n", origin_lines(report, "").replace("--", "- -"));
    let at = if svg.starts_with("<?xml") { svg.find('\n').map_or(0, |end| end + 1) } else { 0 };
    format!("{}{comment}{}", &svg[..at], &svg[at..])
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
        let mut folder = OutputFolder::open(&path).expect("the temporary directory can be written");
        folder.put("a.txt", b"half").expect("written");
        drop(folder);
        assert!(!place("dropped").exists());
    }

    #[test]
    fn what_is_committed_is_there_alone() {
        let path = place("kept");
        let mut folder = OutputFolder::open(&path).expect("the temporary directory can be written");
        folder.put("a.txt", b"whole").expect("written");
        folder.commit().expect("renamed");
        let names: Vec<_> = fs::read_dir(&path).expect("there").map(|e| e.expect("entry").file_name()).collect();
        assert_eq!(names, ["a.txt"]);
        assert_eq!(fs::read(path.join("a.txt")).expect("there"), b"whole");
        fs::remove_dir_all(path).expect("ours");
    }
}
