//! The outer structure of a glTF file: the chunks of a binary file, and the memory that its JSON takes after parsing.

use gltf_json::Root;
use pxpl5_sim::parameters::FileError;

use crate::error::FilePlace;
use crate::import::Source;
use crate::import::source::MARK;

const MAGIC: &[u8] = b"glTF";
/// Number of bytes of the header of a binary file: magic number, version and length.
const HEADER: usize = 12;
/// Number of bytes of a chunk before its content: 4 bytes for the length and 4 for the type.
const CHUNK: usize = 8;

pub(super) struct Chunks<'a> {
    pub(super) json: &'a [u8],
    pub(super) binary: Option<&'a [u8]>,
    /// True if the whole file is JSON. Errors then state a line number instead of a byte offset.
    is_text: bool,
}

impl<'a> Chunks<'a> {
    pub(super) fn of(source: &Source<'a>) -> Result<Self, FileError> {
        let bytes = source.bytes;
        if !bytes.starts_with(MAGIC) {
            let json = bytes.strip_prefix(MARK).unwrap_or(bytes);
            return Ok(Self { json, binary: None, is_text: true });
        }
        let version = word(source, 4, "the version of binary glTF")?;
        if version != 2 {
            return Err(source.syntax(FilePlace::Byte(4), "binary glTF of version 2", format!("version {version}")));
        }
        let announced = word(source, 8, "the length of the file")? as usize;
        if announced > bytes.len() || announced < HEADER {
            let expected = format!("a file of {announced} bytes, {HEADER} or more");
            return Err(source.truncated(FilePlace::Byte(8), expected, format!("{} bytes", bytes.len())));
        }
        let (kind, json, next) = chunk(source, HEADER)?;
        if kind != *b"JSON" {
            let found = String::from_utf8_lossy(&kind).into_owned();
            return Err(source.syntax(FilePlace::Byte(16), "a chunk of the type JSON first", format!("{found:?}")));
        }
        // The binary chunk is the second one. Chunks of other types are skipped, as the format requires.
        let binary = match next < announced {
            true => Some(chunk(source, next)?).filter(|(kind, _, _)| kind == b"BIN\0").map(|(_, binary, _)| binary),
            false => None,
        };
        Ok(Self { json, binary, is_text: false })
    }

    /// Parses the JSON.
    ///
    /// # Errors
    ///
    /// Fails for JSON that is not glTF, and for JSON that would take too much memory for the size of the file.
    pub(super) fn parse(&self, source: &Source<'_>) -> Result<Root, FileError> {
        Root::from_slice(self.json).map_err(|error| {
            // The library adds the position to its message. The `at` of our error states this position already.
            let message = error.to_string();
            let message = message.split(" at line ").next().unwrap_or_default();
            let found: String = message.chars().take(200).collect();
            let at = match self.is_text {
                true => FilePlace::Line(error.line() as u64),
                false => FilePlace::Byte((HEADER + CHUNK) as u64),
            };
            source.syntax(at, "the JSON of glTF 2.0", found)
        })
    }

    /// Returns the greatest number of bytes that the JSON takes after parsing.
    ///
    /// An item with a few bytes in the file can take hundreds of bytes after parsing. The items are therefore counted
    /// before parsing, so that a small file cannot exhaust the memory.
    pub(super) fn parsed_bytes(&self) -> usize {
        let [mut objects, mut texts, mut numbers] = [0_usize; 3];
        let mut bytes = self.json.iter();
        while let Some(byte) = bytes.next() {
            match byte {
                b'"' => {
                    texts += 1;
                    // Skip the text, in which a backslash hides a quotation mark.
                    while let Some(byte) = bytes.next() {
                        match byte {
                            b'\\' => drop(bytes.next()),
                            b'"' => break,
                            _ => {}
                        }
                    }
                }
                // A text before a colon is a key, which takes no memory.
                b':' => texts = texts.saturating_sub(1),
                b'{' => objects += 1,
                b',' | b'[' => numbers += 1,
                _ => {}
            }
        }
        let of = |count: usize, bytes: usize| count.saturating_mul(bytes);
        let lists = of(texts, TEXT_BYTES).saturating_add(of(numbers, NUMBER_BYTES));
        self.json.len().saturating_add(of(objects, OBJECT_BYTES)).saturating_add(lists)
    }
}

/// Greatest number of bytes that a JSON object takes after parsing. The largest objects in a list are nodes and
/// materials. A growing list takes up to three times the size of its items.
const OBJECT_BYTES: usize = 3 * max(size_of::<gltf_json::Node>(), size_of::<gltf_json::Material>());
/// Greatest number of bytes that a text takes in a growing list, in addition to its characters.
const TEXT_BYTES: usize = 3 * size_of::<String>();
/// Greatest number of bytes that an index or a number takes in a growing list. The largest numbers in memory are the
/// limits of an accessor, because the parser stores each limit as a JSON value.
const NUMBER_BYTES: usize = 3 * size_of::<gltf_json::Value>();

const fn max(a: usize, b: usize) -> usize {
    if a > b { a } else { b }
}

fn word(source: &Source<'_>, at: usize, what: &str) -> Result<u32, FileError> {
    match source.bytes.get(at..at + 4) {
        Some(&[a, b, c, d]) => Ok(u32::from_le_bytes([a, b, c, d])),
        _ => Err(source.truncated(FilePlace::Byte(at as u64), what, "the end of the file")),
    }
}

/// Returns the type and the content of the chunk at a position, and the position of the next chunk.
fn chunk<'a>(source: &Source<'a>, at: usize) -> Result<([u8; 4], &'a [u8], usize), FileError> {
    let length = word(source, at, "the length of a chunk")? as usize;
    let kind = word(source, at + 4, "the type of a chunk")?.to_le_bytes();
    let begin = at + CHUNK;
    let content = source.bytes.get(begin..begin.saturating_add(length)).ok_or_else(|| {
        let found = format!("{} bytes", source.bytes.len() - begin);
        source.truncated(FilePlace::Byte(at as u64), format!("a chunk of {length} bytes"), found)
    })?;
    Ok((kind, content, begin + length))
}
