//! Conversion of users' files to text, and the type of errors in such texts.

use std::fmt;

/// An error in a text: its place, the expected content and the content found.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextError {
    /// Place of the error in the text, such as `line 3, byte 4`. Empty if the whole text is wrong.
    pub place: String,
    /// The expected content, in words.
    pub expected: &'static str,
    /// The content found.
    pub found: String,
}

impl TextError {
    /// Creates the error of a text that has the wrong form as a whole.
    #[must_use]
    pub fn whole(expected: &'static str, text: &str) -> Self {
        Self { place: String::new(), expected, found: format!("{text:?}") }
    }
}

impl fmt::Display for TextError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { place, expected, found } = self;
        let colon = if place.is_empty() { "" } else { ": " };
        write!(f, "{place}{colon}expected {expected}, found {found}")
    }
}

impl std::error::Error for TextError {}

/// Converts the bytes of a file to text.
///
/// # Errors
///
/// Returns a [`TextError`] if a byte is not UTF-8. The error gives the line of the byte and the position of the byte
/// within the line, both counted from 1.
pub fn text_of(bytes: &[u8]) -> Result<&str, TextError> {
    std::str::from_utf8(bytes).map_err(|error| {
        // The valid text before the error suffices to compute the line and the position.
        let before = &bytes[..error.valid_up_to()];
        let lines = before.iter().filter(|byte| **byte == b'\n').count();
        let begin = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let found = bytes.get(before.len()).copied().unwrap_or_default();
        let place = format!("line {}, byte {}", lines + 1, before.len() - begin + 1);
        TextError { place, expected: "UTF-8 text", found: format!("byte {found:#04x}") }
    })
}

#[cfg(test)]
mod tests {
    use super::text_of;

    #[test]
    fn a_byte_that_is_no_text_is_told_by_line_and_byte() {
        assert_eq!(text_of("a\né".as_bytes()), Ok("a\né"));
        // The letter e with an acute accent in Latin-1, and an incomplete UTF-8 character.
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
