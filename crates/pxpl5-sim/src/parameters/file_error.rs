//! The error of a file or text that cannot be used. The function [`text_of`] converts the bytes of a file to text, and
//! returns this error if a byte is not UTF-8.

use std::fmt::{self, Display};
use std::io;
use std::path::Path;

/// Error of a file or a text that cannot be used. The message states the file, the position of the error, and the
/// expected and found content.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct FileError {
    pub kind: FileErrorKind,
    /// Path or name of the file. Empty if the text does not come from a file.
    pub file: Box<str>,
    /// Position of the error in the file, such as `line 3, byte 4`. Empty if the whole file is wrong.
    pub place: Box<str>,
    /// The expected content, in words. Empty if `found` is a whole sentence.
    pub expected: Box<str>,
    /// The content of the file at the position of the error, or a sentence that describes the error.
    pub found: Box<str>,
}

/// The kind of a [`FileError`], from an unreadable file to invalid content.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum FileErrorKind {
    /// The file is missing or cannot be read.
    Unreadable,
    /// The operating system does not write the file or make the folder, or it cannot read it again.
    Unwritable,
    /// The path leads to a directory, a device or a pipe instead of a file.
    NotAFile,
    /// The program cannot read files of this format, or was built without the reader for this format.
    UnknownFormat,
    /// The file is too large, or its contents need too much memory.
    TooLarge,
    /// The file has no content, or no content that this program can use.
    Empty,
    /// A byte is not UTF-8.
    NotText,
    /// The content breaks the rules of its format.
    Syntax,
    /// The file ends too early: its header announces more content.
    Truncated,
    /// An index in the file refers to an item that the file does not contain.
    Index,
    /// A number in the file is outside its allowed range.
    Number,
    /// The file was written by another version of the program, or for another purpose.
    Foreign,
    /// The contents contradict each other, or were changed after they were written.
    Damaged,
    /// A file or directory that already exists prevents the writing of the file.
    Occupied,
    /// Results of the same work exist already, and the user did not ask to resume the work.
    Unfinished,
    /// Another process is writing the file.
    Locked,
}

impl FileError {
    /// Creates an error about the content of a file. [`FileError::at`] adds the position in the file, and
    /// [`FileError::in_file`] adds the name of the file.
    pub fn new(kind: FileErrorKind, expected: impl Display, found: impl Display) -> Self {
        let [expected, found] = [expected.to_string().into(), found.to_string().into()];
        Self { kind, file: "".into(), place: "".into(), expected, found }
    }

    /// Creates the error of a file that the operating system cannot read.
    pub fn unreadable(file: impl Display, expected: &str, error: impl Display) -> Self {
        Self::new(FileErrorKind::Unreadable, expected, error).in_file(file)
    }

    /// Creates an error whose message is only the sentence `reason`.
    pub fn because(kind: FileErrorKind, reason: impl Display) -> Self {
        Self::new(kind, "", reason)
    }

    /// Returns a function that converts an [`io::Error`] to the error of a file of results. `doing` describes the failed
    /// operation.
    pub fn io(file: &Path, doing: &'static str) -> impl FnOnce(io::Error) -> Self {
        move |error| Self::because(FileErrorKind::Unwritable, format_args!("{doing}: {error}")).in_file(file.display())
    }

    #[must_use]
    pub fn at(self, place: impl Display) -> Self {
        Self { place: place.to_string().into(), ..self }
    }

    #[must_use]
    pub fn in_file(self, file: impl Display) -> Self {
        Self { file: file.to_string().into(), ..self }
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, file, place, expected, found } = self;
        for part in [file, place] {
            if !part.is_empty() {
                write!(f, "{part}: ")?;
            }
        }
        match kind {
            _ if expected.is_empty() => f.write_str(found),
            FileErrorKind::Unreadable => write!(f, "expected {expected}, found: {found}"),
            _ => write!(f, "expected {expected}, found {found}"),
        }
    }
}

impl std::error::Error for FileError {}

/// Converts the bytes of a file to text.
///
/// # Errors
///
/// Returns a [`FileError`] if a byte is not UTF-8. The error gives the line of the byte and the position of the byte
/// within the line, both counted from 1.
pub fn text_of(bytes: &[u8]) -> Result<&str, FileError> {
    std::str::from_utf8(bytes).map_err(|error| {
        // Only the valid text before the error gives its line and place.
        let before = &bytes[..error.valid_up_to()];
        let lines = before.iter().filter(|byte| **byte == b'\n').count();
        let begin = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let found = bytes.get(before.len()).copied().unwrap_or_default();
        let place = format!("line {}, byte {}", lines + 1, before.len() - begin + 1);
        FileError::new(FileErrorKind::NotText, "UTF-8 text", format_args!("byte {found:#04x}")).at(place)
    })
}

#[cfg(test)]
mod tests {
    use super::text_of;

    #[test]
    fn a_byte_that_is_not_text_is_reported_with_line_and_byte() {
        assert_eq!(text_of("a\né".as_bytes()), Ok("a\né"));
        // An e with an acute accent in Latin-1, and a character of UTF-8 that ends early.
        for (bytes, place, byte) in [
            (&b"\xe9"[..], "line 1, byte 1", "0xe9"),
            (b"a\nb\ncaf\xe9\n", "line 3, byte 4", "0xe9"),
            (b"ab\xc3", "line 1, byte 3", "0xc3"),
        ] {
            let error = text_of(bytes).expect_err(place).to_string();
            assert_eq!(error, format!("{place}: expected UTF-8 text, found byte {byte}"));
        }
    }
}
