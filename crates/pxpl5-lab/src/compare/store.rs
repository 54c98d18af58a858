//! The finished rows of a comparison in a folder, so that an interrupted comparison can be resumed.
//!
//! ```text
//!   rows/rows.jsonl    header, then one line for each finished row
//!   rows/1-seen.png    last picture of the row in line 1 after the header, and the ideal picture
//! ```
//!
//! Each line is appended by one write. After a crash, the last line may be incomplete. The incomplete line is removed,
//! and only its row is computed again.

use super::gallery::LastPicture;
use super::row::ComparisonRow;
use crate::error::StudyError;
use crate::sweep::{LineFile, ROWS_FILE, line_of, lock};
use image::RgbImage;
use pxpl5_measure::FieldMisregistration;
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Name and version of the JSON layout of the rows.
pub const ROWS_SCHEMA: &str = "pxpl5-comparison-rows/2";

/// Name of the folder with the finished rows, inside the folder of a comparison.
pub const ROWS_FOLDER: &str = "rows";

/// The first line of the file of finished rows, with the settings that identify a comparison.
#[derive(Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Header {
    pub(super) schema: String,
    pub(super) version: String,
    pub(super) rows: Vec<String>,
    /// Keys and options with their values, and the hashes of files that appear as values.
    pub(super) settings: BTreeMap<String, String>,
    /// Hash of all effective settings of the first row, including the settings from presets.
    pub(super) config_hash: String,
}

/// A line of the file of finished rows: a row, and the data of the row that comparison.json leaves out.
#[derive(Debug, Serialize, Deserialize)]
struct Line {
    row: ComparisonRow,
    by_field: Vec<FieldMisregistration>,
    picture: Option<PictureFiles>,
}

#[derive(Debug, Serialize, Deserialize)]
struct PictureFiles {
    seen: String,
    should_be: Option<String>,
    is_complete: bool,
}

/// The finished rows of a comparison, stored in one folder.
#[derive(Debug)]
pub struct CompareStore {
    folder: PathBuf,
    /// Finished rows of an earlier process.
    found: Vec<ComparisonRow>,
    /// File of the rows, and the number of its rows.
    rows: Mutex<(LineFile, usize)>,
    /// Lock of the folder. No other process can open the folder while this object exists.
    _lock: File,
}

impl CompareStore {
    pub(super) fn open(folder: &Path, header: &Header, resume: bool) -> Result<Self, StudyError> {
        fs::create_dir_all(folder).map_err(FileError::io(folder, "cannot be made"))?;
        // The folder is locked before any change.
        let lock = lock(folder)?;
        let path = folder.join(ROWS_FILE);
        let mut file = LineFile::open(path.clone())?;
        let mut lines = file.lines("a row of a comparison")?;
        let before: Option<Header> = lines.next()?;
        let mut found = Vec::new();
        // Rows are read only if they are kept, because another version may have written them.
        if resume {
            header.check(&path, before.as_ref())?;
            while let Some(line) = lines.next::<Line>()? {
                found.push(line.row_in(folder)?);
            }
        } else {
            let (mut rows, of) = (0, before.map_or(0, |before| before.rows.len()));
            while lines.read()? {
                rows += 1;
            }
            if rows > 0 && rows < of {
                let reason = format_args!(
                    "{rows} of {of} rows of an interrupted comparison are here; resume the comparison, or choose another folder"
                );
                return Err(FileError::because(FileErrorKind::Unfinished, reason).in_file(path.display()).into());
            }
        }
        file.cut(if resume { lines.whole_bytes } else { 0 }, header)?;
        let rows = Mutex::new((file, found.len()));
        Ok(Self { folder: folder.to_owned(), found, rows, _lock: lock })
    }

    /// Returns the number of finished rows of an earlier process.
    pub const fn found(&self) -> usize {
        self.found.len()
    }

    /// Returns the finished row of an earlier process with this name, if any.
    pub fn row(&self, name: &str) -> Option<&ComparisonRow> {
        self.found.iter().find(|row| row.pipeline == name)
    }

    /// Appends a finished row. Returns the row as read back from the file, so that an interruption changes no result.
    pub(super) fn append(&self, row: ComparisonRow) -> Result<ComparisonRow, StudyError> {
        let mut rows = self.rows.lock().unwrap_or_else(PoisonError::into_inner);
        let (file, count) = &mut *rows;
        // The pictures are stored first, because the line of the row names them.
        let picture = row.picture.as_ref().map(|picture| self.put_picture(*count + 1, picture)).transpose()?;
        let text = line_of(&Line { by_field: row.by_field.clone(), picture, row });
        file.put(&text)?;
        *count += 1;
        let line: Line = serde_json::from_str(&text)
            .map_err(std::io::Error::from)
            .map_err(FileError::io(&self.folder, "cannot be read"))?;
        line.row_in(&self.folder)
    }

    fn put_picture(&self, number: usize, picture: &LastPicture) -> Result<PictureFiles, StudyError> {
        let put = |what: &str, picture: &RgbImage| {
            let name = format!("{number}-{what}.png");
            let path = self.folder.join(&name);
            let written = picture.save_with_format(&path, image::ImageFormat::Png).map_err(std::io::Error::other);
            written.map_err(FileError::io(&path, "cannot be written"))?;
            Ok::<_, StudyError>(name)
        };
        let should_be = picture.should_be.as_ref().map(|ideal| put("should-be", ideal)).transpose()?;
        Ok(PictureFiles { seen: put("seen", &picture.seen)?, should_be, is_complete: picture.is_complete })
    }
}

impl Header {
    fn check(&self, path: &Path, found: Option<&Self>) -> Result<(), StudyError> {
        let Some(found) = found.filter(|found| *found != self) else { return Ok(()) };
        let value = |header: &Self, key: &str| header.settings.get(key).map_or("not set", String::as_str).to_owned();
        let keys = self.settings.keys().chain(found.settings.keys());
        let settings = keys.map(|key| (key.as_str(), value(self, key), value(found, key)));
        // The hash is compared last, because an error with the name of a key is more helpful.
        let pairs = [
            ("schema", self.schema.clone(), found.schema.clone()),
            ("version", self.version.clone(), found.version.clone()),
        ];
        let last = [
            ("rows", self.rows.join(","), found.rows.join(",")),
            ("the hash of all settings", self.config_hash.clone(), found.config_hash.clone()),
        ];
        match pairs.into_iter().chain(settings).chain(last).find(|(_, expected, found)| expected != found) {
            Some((key, expected, found)) => {
                let reason =
                    format_args!("these rows are of another comparison: {key} was {found}, expected {expected}");
                Err(FileError::because(FileErrorKind::Occupied, reason).in_file(path.display()).into())
            }
            None => Ok(()),
        }
    }
}

impl Line {
    fn row_in(self, folder: &Path) -> Result<ComparisonRow, StudyError> {
        let read = |name: &String| {
            let path = folder.join(name);
            let picture = image::open(&path).map_err(std::io::Error::other);
            Ok::<_, StudyError>(picture.map_err(FileError::io(&path, "cannot be read"))?.into_rgb8())
        };
        let picture = self.picture.map(|files| {
            let should_be = files.should_be.as_ref().map(read).transpose()?;
            Ok::<_, StudyError>(LastPicture { seen: read(&files.seen)?, should_be, is_complete: files.is_complete })
        });
        Ok(ComparisonRow { by_field: self.by_field, picture: picture.transpose()?, ..self.row })
    }
}
