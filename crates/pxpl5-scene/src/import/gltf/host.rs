//! Reading of files that a glTF file refers to, such as buffers, from the disk of this computer.
#![cfg(feature = "files")]

use std::fs;
use std::io::Read;
use std::path::Path;

/// Reads a file of at most `limit` bytes. The error describes the object that was found instead of such a file.
pub(super) fn read_file(path: &Path, limit: u64) -> Result<Vec<u8>, String> {
    let metadata = fs::metadata(path).map_err(|error| error.to_string())?;
    // Reading a device or a pipe might never end.
    if !metadata.is_file() {
        return Err("no regular file".to_owned());
    }
    if metadata.len() > limit {
        return Err(format!("{} bytes, and only {limit} are allowed", metadata.len()));
    }
    let mut bytes = Vec::with_capacity(metadata.len() as usize);
    let file = fs::File::open(path).map_err(|error| error.to_string())?;
    file.take(limit).read_to_end(&mut bytes).map_err(|error| error.to_string())?;
    Ok(bytes)
}
