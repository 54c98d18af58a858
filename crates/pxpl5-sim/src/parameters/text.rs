//! Conversion of users' files to text.

/// Converts the bytes of a file to text.
///
/// # Errors
///
/// Returns a message if a byte is not UTF-8. The message gives the line of the byte and the position of the byte within
/// the line, both counted from 1.
pub fn text_of(bytes: &[u8]) -> Result<&str, String> {
    std::str::from_utf8(bytes).map_err(|error| {
        // Only the valid text before the error gives its line and place.
        let before = &bytes[..error.valid_up_to()];
        let lines = before.iter().filter(|byte| **byte == b'\n').count();
        let begin = before.iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        let found = bytes.get(before.len()).copied().unwrap_or_default();
        format!("line {}, byte {}: expected UTF-8 text, found byte {found:#04x}", lines + 1, before.len() - begin + 1)
    })
}

#[cfg(test)]
mod tests {
    use super::text_of;

    #[test]
    fn a_byte_that_is_no_text_is_told_by_line_and_byte() {
        assert_eq!(text_of("a\né".as_bytes()), Ok("a\né"));
        // The e with an acute of Latin-1, and a character of UTF-8 that ends early.
        for (bytes, place, byte) in [
            (&b"\xe9"[..], "line 1, byte 1", "0xe9"),
            (b"a\nb\ncaf\xe9\n", "line 3, byte 4", "0xe9"),
            (b"ab\xc3", "line 1, byte 3", "0xc3"),
        ] {
            assert_eq!(text_of(bytes), Err(format!("{place}: expected UTF-8 text, found byte {byte}")));
        }
    }
}
