//! The file being read: its name, its bytes, and functions that report errors with positions in the file.

use std::path::Path;

use crate::config::MAX_COORDINATE;
use crate::error::FilePlace;
use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::fmt::Display;

pub(crate) struct Source<'a> {
    pub(crate) name: &'a str,
    pub(crate) bytes: &'a [u8],
    /// Folder of the file, in which files that belong to the model are searched. `None` if there is no file.
    pub(crate) folder: Option<&'a Path>,
}

impl<'a> Source<'a> {
    /// Returns an error if the file is UTF-16 text, which begins with a byte order mark.
    pub(crate) fn check_is_bytes_of_text(&self) -> Result<(), FileError> {
        match self.bytes {
            [found @ 0xff, 0xfe, ..] | [found @ 0xfe, 0xff, ..] => {
                let found = format_args!("byte {found:#04x}");
                Err(self.error(FileErrorKind::NotText, FilePlace::Byte(0), "UTF-8 text", found))
            }
            _ => Ok(()),
        }
    }

    /// Returns all lines with their numbers, counted from 1, without a byte order mark (U+FEFF). Lines may end in LF,
    /// CR LF or CR alone. The lines are bytes, because comments and names may have any encoding.
    pub(crate) fn lines(&self) -> impl Iterator<Item = (u64, &'a [u8])> + Clone {
        let text = without_padding(self.bytes.strip_prefix(MARK).unwrap_or(self.bytes));
        let end = if text.contains(&b'\n') { b'\n' } else { b'\r' };
        let text = text.strip_suffix(&[end]).unwrap_or(text);
        (1..).zip(text.split(move |byte| *byte == end).map(|line| line.strip_suffix(b"\r").unwrap_or(line)))
    }

    pub(crate) fn syntax(&self, at: FilePlace, expected: impl Display, found: impl Display) -> FileError {
        self.error(FileErrorKind::Syntax, at, expected, found)
    }

    pub(crate) fn truncated(&self, at: FilePlace, expected: impl Display, found: impl Display) -> FileError {
        self.error(FileErrorKind::Truncated, at, expected, found)
    }

    fn error(&self, kind: FileErrorKind, at: impl Display, expected: impl Display, found: impl Display) -> FileError {
        FileError::new(kind, expected, found).at(at).in_file(self.name)
    }

    /// Returns an error for a part of a glTF file. `part` is the path of this part in the file's JSON.
    pub(crate) fn part(&self, part: impl Display, expected: impl Display, found: impl Display) -> FileError {
        self.error(FileErrorKind::Syntax, part, expected, found)
    }

    /// Parses a number. `what` describes the number in errors.
    pub(crate) fn number(&self, at: FilePlace, what: &str, word: &[u8]) -> Result<f64, FileError> {
        match text(word) {
            word if is_not_a_number(word) => Ok(f64::NAN),
            word => word.parse().map_err(|_| self.syntax(at, format!("a number for {what}"), excerpt(word))),
        }
    }

    /// Returns the vector if all its coordinates are finite and not larger than the limit for imported models.
    /// Otherwise returns an error.
    pub(crate) fn coordinates(&self, at: FilePlace, v: [f64; 3]) -> Result<[f64; 3], FileError> {
        match v.into_iter().find(|x| x.is_nan() || x.abs() > MAX_COORDINATE) {
            None => Ok(v),
            Some(found) => {
                let expected = format_args!("a coordinate between -{MAX_COORDINATE:e} and {MAX_COORDINATE:e}");
                Err(self.error(FileErrorKind::Number, at, expected, found))
            }
        }
    }

    /// Returns the index if it is below `count`, and an error otherwise. `found` is the index as the file states it,
    /// for the error message.
    pub(crate) fn index(
        &self,
        at: FilePlace,
        what: &'static str,
        zero_based: i64,
        count: usize,
        found: i64,
    ) -> Result<u32, FileError> {
        match u32::try_from(zero_based) {
            Ok(index) if (index as usize) < count => Ok(index),
            _ => {
                let expected = format_args!("an index of one of {count} {what}");
                Err(self.error(FileErrorKind::Index, at, expected, found))
            }
        }
    }
}

/// The byte order mark U+FEFF in UTF-8.
pub(crate) const MARK: &[u8] = b"\xef\xbb\xbf";

/// Returns the bytes without the zeros with which some programs pad a file to a round length.
pub(crate) fn without_padding(bytes: &[u8]) -> &[u8] {
    &bytes[..bytes.iter().rposition(|byte| *byte != 0).map_or(0, |last| last + 1)]
}

/// Returns a word of a file as text. If the word is not UTF-8, the result is a character that occurs in no number.
pub(crate) fn text(word: &[u8]) -> &str {
    std::str::from_utf8(word).unwrap_or("\u{fffd}")
}

/// Returns true for a word by which programs write NaN, such as `nan`, `-nan(ind)` and `1.#QNAN`.
pub(crate) fn is_not_a_number(word: &str) -> bool {
    let word = word.trim_start_matches(['-', '+']).as_bytes();
    word.get(..3).is_some_and(|begin| begin.eq_ignore_ascii_case(b"nan")) || word.contains(&b'#')
}

pub(crate) fn excerpt(text: &str) -> String {
    let short: String = text.trim_end().chars().take(40).collect();
    format!("{short:?}")
}
