//! The outer structure of a glTF file: the chunks of a binary file, and the memory that its JSON takes after parsing.

use std::borrow::Cow;

use pxpl5_sim::parameters::FileError;
use serde_json::Value;

use super::json::Root;
use crate::error::FilePlace;
use crate::import::Source;
use crate::import::source::{MARK, excerpt, without_padding};

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

    /// Returns the JSON as text. Bytes that are not UTF-8 occur only in names, so they are replaced.
    pub(super) fn text(&self) -> Cow<'a, str> {
        String::from_utf8_lossy(without_padding(self.json))
    }

    /// Parses the lists of the JSON, but not their items.
    ///
    /// # Errors
    ///
    /// Fails for JSON that is not glTF 2.0.
    pub(super) fn parse<'t>(&self, source: &Source<'_>, text: &'t str) -> Result<Root<'t>, FileError> {
        let asset: Head = serde_json::from_str(text).map_err(|error| self.json_fault(source, &error))?;
        asset.check_version(source)?;
        let parts = serde_json::from_str(text).map_err(|error| self.json_fault(source, &error))?;
        Root::of(source, &parts)
    }

    fn json_fault(&self, source: &Source<'_>, error: &serde_json::Error) -> FileError {
        // The library adds the position to its message. The `at` of our error states this position already.
        let message = error.to_string();
        let message = message.split(" at line ").next().unwrap_or_default();
        let found: String = message.chars().take(200).collect();
        let at = match self.is_text {
            true => FilePlace::Line(error.line() as u64),
            false => FilePlace::Byte((HEADER + CHUNK) as u64),
        };
        source.syntax(at, "the JSON of glTF 2.0", found)
    }

    /// Returns the greatest number of bytes that the JSON takes after parsing. The parser stores a reference for each item
    /// of a list, and each comma or opening bracket of the JSON may stand for an item.
    pub(super) fn parsed_bytes(&self) -> usize {
        let items = self.json.iter().filter(|byte| matches!(byte, b',' | b'[')).count();
        self.json.len().saturating_add(items.saturating_mul(ITEM_BYTES))
    }
}

/// Greatest number of bytes that an item takes in a list. A growing list takes up to three times the size of its items.
const ITEM_BYTES: usize = 3 * size_of::<&serde_json::value::RawValue>();

/// The first part of a file that is read. A file of another version may have another form.
#[derive(serde::Deserialize)]
struct Head {
    asset: Option<Asset>,
}

#[derive(serde::Deserialize)]
#[serde(rename_all = "camelCase")]
struct Asset {
    version: Option<Value>,
    min_version: Option<Value>,
}

impl Head {
    fn check_version(self, source: &Source<'_>) -> Result<(), FileError> {
        let text = |version: Option<Value>| version.map(|v| v.as_str().map_or_else(|| v.to_string(), str::to_owned));
        let (version, least) = self.asset.map_or((None, None), |asset| (text(asset.version), text(asset.min_version)));
        match least.as_deref().or(version.as_deref()) {
            Some("2.0" | "2") => Ok(()),
            // A file of a later version 2.x that states no minimum version can be read as 2.0.
            Some(later) if later.starts_with("2.") && least.is_none() => Ok(()),
            Some(other) => Err(source.part("asset.version", "glTF 2.0", format_args!("glTF {}", excerpt(other)))),
            None => Err(source.part("asset.version", "glTF 2.0", "no version")),
        }
    }
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
