//! Buffers of a glTF file: the binary chunk, data inside the JSON, or files beside the model.

use pxpl5_sim::parameters::FileError;
use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use gltf_json::Root;

#[cfg(feature = "files")]
use super::host::read_file;
use crate::config::MAX_FILE_BYTES;
use crate::import::Source;

/// The bytes of all buffers. A buffer that no triangle needs may be missing.
pub(super) struct Buffers<'a> {
    buffers: Vec<Result<Cow<'a, [u8]>, ErrorText>>,
    /// Number of bytes of the files beside the model that hold buffers.
    pub(super) file_bytes: usize,
    /// Number of bytes of the buffers that were decoded from text inside the JSON.
    pub(super) decoded_bytes: usize,
}

/// The expected and the found content of a buffer that cannot be read.
type ErrorText = [String; 2];

impl<'a> Buffers<'a> {
    pub(super) fn of(source: &Source<'a>, root: &Root, binary: Option<&'a [u8]>) -> Self {
        let mut all = Self { buffers: Vec::with_capacity(root.buffers.len()), file_bytes: 0, decoded_bytes: 0 };
        for (number, buffer) in root.buffers.iter().enumerate() {
            let bytes = match (&buffer.uri, binary) {
                (Some(uri), _) => all.of_uri(source, uri),
                (None, Some(binary)) if number == 0 => Ok(Cow::Borrowed(binary)),
                (None, _) => Err(["a uri, or the binary chunk for the first buffer".to_owned(), "neither".to_owned()]),
            };
            let announced = buffer.byte_length.0;
            all.buffers.push(bytes.and_then(|bytes| match bytes.len() as u64 >= announced {
                true => Ok(bytes),
                false => Err([format!("{announced} bytes"), format!("{} bytes", bytes.len())]),
            }));
        }
        all
    }

    pub(super) fn get(&self, source: &Source<'_>, number: usize) -> Result<&[u8], FileError> {
        match self.buffers.get(number) {
            Some(Ok(bytes)) => Ok(bytes),
            Some(Err([expected, found])) => Err(source.part(format!("buffers[{number}]"), expected, found)),
            None => {
                let found = format!("{} buffers", self.buffers.len());
                Err(source.part(format!("buffers[{number}]"), "a buffer with this index", found))
            }
        }
    }

    fn of_uri(&mut self, source: &Source<'_>, uri: &str) -> Result<Cow<'a, [u8]>, ErrorText> {
        if let Some(data) = uri.strip_prefix("data:") {
            let expected = || "data in base64 after \";base64,\"".to_owned();
            let (_, encoded) = data.split_once(";base64,").ok_or_else(|| [expected(), excerpt(uri)])?;
            let decoded = STANDARD.decode(encoded).map_err(|error| [expected(), error.to_string()])?;
            self.decoded_bytes += decoded.len();
            return Ok(Cow::Owned(decoded));
        }
        let path = path_of(uri).ok_or_else(|| {
            ["data inside the file, or a relative path below the folder of the model".to_owned(), excerpt(uri)]
        })?;
        let Some(folder) = source.folder else {
            return Err(["data inside the file, because the model has no folder".to_owned(), excerpt(uri)]);
        };
        let bytes = read_file(&folder.join(&path), MAX_FILE_BYTES.saturating_sub(self.file_bytes as u64))
            .map_err(|found| [format!("a readable file {}", path.display()), found])?;
        self.file_bytes += bytes.len();
        Ok(Cow::Owned(bytes))
    }
}

fn excerpt(uri: &str) -> String {
    crate::import::source::excerpt(uri)
}

/// Returns the relative path that a URI states. `None` for an absolute path, for a path that leaves its folder, and for
/// a URI with a scheme, such as `https:`.
fn path_of(uri: &str) -> Option<PathBuf> {
    let decoded = percent_decoded(uri)?;
    let path = Path::new(&decoded);
    let stays_below = path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir));
    (stays_below && !decoded.is_empty() && !decoded.contains([':', '\\'])).then(|| path.to_owned())
}

/// Replaces `%` and two hexadecimal digits by the byte with this hexadecimal number.
fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.bytes();
    while let Some(byte) = rest.next() {
        match byte {
            b'%' => {
                let mut digit = || char::from(rest.next()?).to_digit(16);
                bytes.push((digit()? * 16 + digit()?) as u8);
            }
            b'\0' => return None,
            _ => bytes.push(byte),
        }
    }
    String::from_utf8(bytes).ok().filter(|text| !text.contains('\0'))
}

#[cfg(not(feature = "files"))]
fn read_file(_: &Path, _: u64) -> Result<Vec<u8>, String> {
    Err("a program that reads no files".to_owned())
}
