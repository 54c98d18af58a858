//! The file being read: its name, its bytes, and the errors that point into it.

use crate::config::MAX_COORDINATE;
use crate::error::{FilePlace, LoadError};

pub(crate) struct Source<'a> {
    pub(crate) name: &'a str,
    pub(crate) bytes: &'a [u8],
}

impl<'a> Source<'a> {
    /// The first `length` bytes as text.
    pub(crate) fn text(&self, length: usize) -> Result<&'a str, LoadError> {
        let bytes = &self.bytes[..length];
        std::str::from_utf8(bytes).map_err(|e| LoadError::NotText {
            file: self.name.to_owned(),
            at: FilePlace::Byte(e.valid_up_to() as u64),
            found: bytes[e.valid_up_to()],
        })
    }

    /// All lines with their numbers, from 1, whether they end in LF, CR LF or, as they did once, in CR alone; without the mark by
    /// which some editors begin a text (U+FEFF).
    pub(crate) fn lines(&self) -> Result<impl Iterator<Item = (u64, &'a str)>, LoadError> {
        let text = self.text(self.bytes.len())?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let end = if text.contains('\n') { '\n' } else { '\r' };
        Ok((1..).zip(text.split_terminator(end).map(|line| line.strip_suffix('\r').unwrap_or(line))))
    }

    pub(crate) fn syntax(&self, at: FilePlace, expected: impl Into<String>, found: impl Into<String>) -> LoadError {
        LoadError::Syntax { file: self.name.to_owned(), at, expected: expected.into(), found: found.into() }
    }

    pub(crate) fn truncated(&self, at: FilePlace, expected: impl Into<String>, found: impl Into<String>) -> LoadError {
        LoadError::Truncated { file: self.name.to_owned(), at, expected: expected.into(), found: found.into() }
    }

    /// The vector, if each of its coordinates is usable.
    pub(crate) fn coordinates(&self, at: FilePlace, v: [f64; 3]) -> Result<[f64; 3], LoadError> {
        match v.into_iter().find(|x| x.is_nan() || x.abs() > MAX_COORDINATE) {
            None => Ok(v),
            Some(found) => {
                Err(LoadError::Coordinate { file: self.name.to_owned(), at, expected: MAX_COORDINATE, found })
            }
        }
    }

    /// The index counted from 0, if it is below `count`; `found` is what the file says.
    pub(crate) fn index(
        &self,
        at: FilePlace,
        what: &'static str,
        zero_based: i64,
        count: usize,
        found: i64,
    ) -> Result<u32, LoadError> {
        match u32::try_from(zero_based) {
            Ok(index) if (index as usize) < count => Ok(index),
            _ => Err(LoadError::Index { file: self.name.to_owned(), at, what, expected: count, found }),
        }
    }
}

/// A piece of a file short enough for a message.
pub(crate) fn excerpt(text: &str) -> String {
    let short: String = text.trim_end().chars().take(40).collect();
    format!("{short:?}")
}
