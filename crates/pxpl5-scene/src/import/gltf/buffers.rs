//! Buffers of a glTF file: the binary chunk, data inside the JSON, or files beside the model.

use pxpl5_sim::parameters::FileError;
use std::borrow::Cow;
use std::path::{Component, Path};

use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use serde_json::value::RawValue;

#[cfg(feature = "files")]
use super::host::read_file;
use super::json::{Buffer, parsed};
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

/// Decoder of base64. Padding may be missing, because not all programs write it.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

impl<'a> Buffers<'a> {
    pub(super) fn of(source: &Source<'a>, buffers: &[&RawValue], binary: Option<&'a [u8]>) -> Self {
        let mut all = Self { buffers: Vec::with_capacity(buffers.len()), file_bytes: 0, decoded_bytes: 0 };
        for (number, text) in buffers.iter().enumerate() {
            let bytes = match parsed::<Buffer>(source, "", text) {
                Ok(buffer) => all.of_buffer(source, &buffer, binary.filter(|_| number == 0)),
                Err(error) => Err([error.expected.into(), error.found.into()]),
            };
            all.buffers.push(bytes);
        }
        all
    }

    fn of_buffer(
        &mut self,
        source: &Source<'_>,
        buffer: &Buffer,
        binary: Option<&'a [u8]>,
    ) -> Result<Cow<'a, [u8]>, ErrorText> {
        let bytes = match (&buffer.uri, binary) {
            (Some(uri), _) => self.of_uri(source, uri)?,
            (None, Some(binary)) => Cow::Borrowed(binary),
            (None, None) => {
                return Err(["a uri, or the binary chunk for the first buffer".to_owned(), "neither".to_owned()]);
            }
        };
        match bytes.len() >= buffer.byte_length.0 {
            true => Ok(bytes),
            false => Err([format!("{} bytes", buffer.byte_length.0), format!("{} bytes", bytes.len())]),
        }
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
            let decoded = BASE64.decode(encoded).map_err(|error| [expected(), error.to_string()])?;
            self.decoded_bytes += decoded.len();
            return Ok(Cow::Owned(decoded));
        }
        let decoded = percent_decoded(uri).unwrap_or_else(|| uri.to_owned());
        if !stays_below_its_folder(&decoded) {
            let expected = "data inside the file, or a relative path below the folder of the model";
            return Err([expected.to_owned(), excerpt(uri)]);
        }
        let Some(folder) = source.folder else {
            return Err(["data inside the file, because the model has no folder".to_owned(), excerpt(uri)]);
        };
        // Some programs write the name of the file as it is, although it contains `%` or `\`.
        let written = [uri.to_owned(), uri.replace('\\', "/")].into_iter().filter(|name| stays_below_its_folder(name));
        let exists = std::iter::once(decoded.clone()).chain(written).find(|name| folder.join(name).exists());
        let path = folder.join(exists.as_ref().unwrap_or(&decoded));
        let bytes = read_file(&path, MAX_FILE_BYTES.saturating_sub(self.file_bytes as u64))
            .map_err(|found| [format!("a readable file {decoded}"), found])?;
        self.file_bytes += bytes.len();
        Ok(Cow::Owned(bytes))
    }
}

fn excerpt(uri: &str) -> String {
    crate::import::source::excerpt(uri)
}

/// Returns false for an absolute path, for a path that leaves its folder, and for a URI with a scheme, such as `https:`.
fn stays_below_its_folder(name: &str) -> bool {
    let mut parts = Path::new(name).components();
    parts.all(|part| matches!(part, Component::Normal(_) | Component::CurDir))
        && !name.is_empty()
        && !name.contains([':', '\0'])
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
            _ => bytes.push(byte),
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(not(feature = "files"))]
fn read_file(_: &Path, _: u64) -> Result<Vec<u8>, String> {
    Err("a program that reads no files".to_owned())
}
