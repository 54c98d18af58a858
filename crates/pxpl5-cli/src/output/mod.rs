//! Result files: all of them appear, whole, or none.

use crate::error::CliError;
use image::RgbImage;
use pxpl5::results::{origin, origin_lines};
use pxpl5::timeline::TimelineOptions;
use pxpl5::views::png_bytes;
use pxpl5::{Outcome, Report};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// A folder that can be written, and the files that are going to be in it.
#[derive(Debug)]
pub(crate) struct OutputFolder {
    path: PathBuf,
    /// Folders that were made for it, outermost first.
    made: Vec<PathBuf>,
    /// Temporary and final names.
    files: Vec<(PathBuf, PathBuf)>,
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
        let mut folder = Self { path: path.to_path_buf(), made, files: Vec::new() };
        folder.put(".pxpl5-probe", b"")?;
        folder.discard();
        Ok(folder)
    }

    /// The folder of a file, and the file's name in it.
    ///
    /// # Errors
    ///
    /// As [`Self::open`], and when the path does not end in a name.
    pub(crate) fn of_file(path: &Path) -> Result<(Self, String), CliError> {
        let name = path.file_name().filter(|_| !path.is_dir());
        let name =
            name.ok_or_else(|| CliError::usage(format!("{} is no file name; give one with --out", path.display())))?;
        let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
        Ok((Self::open(folder.unwrap_or_else(|| Path::new(".")))?, name.to_string_lossy().into_owned()))
    }

    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes a file under a temporary name.
    ///
    /// # Errors
    ///
    /// When it cannot be written.
    pub(crate) fn put(&mut self, name: &str, bytes: &[u8]) -> Result<(), CliError> {
        let temporary = self.path.join(format!(".{name}.{}.tmp", std::process::id()));
        let result = fs::File::create(&temporary).and_then(|mut file| file.write_all(bytes));
        self.files.push((temporary, self.path.join(name)));
        result.map_err(|error| refused(&self.path.join(name), &error))
    }

    /// Gives all files their names.
    ///
    /// # Errors
    ///
    /// When a file of that name is in the way and cannot be replaced.
    pub(crate) fn commit(mut self) -> Result<(), CliError> {
        for (temporary, name) in std::mem::take(&mut self.files) {
            let renamed = fs::rename(&temporary, &name);
            if let Err(error) = renamed {
                let _ = fs::remove_file(&temporary);
                return Err(refused(&name, &error));
            }
        }
        self.made.clear();
        Ok(())
    }

    fn discard(&mut self) {
        for (temporary, _) in self.files.drain(..) {
            let _ = fs::remove_file(temporary);
        }
    }
}

/// What was not committed leaves no trace: files are removed, and so are folders made for them, if still empty.
impl Drop for OutputFolder {
    fn drop(&mut self) {
        self.discard();
        for folder in self.made.iter().rev() {
            let _ = fs::remove_dir(folder);
        }
    }
}

fn refused(path: &Path, error: &std::io::Error) -> CliError {
    CliError::failure(format!("{} cannot be written: {error}; choose another folder with --out", path.display()))
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
