//! Reading of model files from the disk of this computer. Only this module of the crate calls the operating system.
#![cfg(feature = "files")]

use pxpl5_sim::parameters::{FileError, FileErrorKind};
use std::fs::{self, File};
use std::path::Path;

use super::{Format, Placement, read_placed};
use crate::error::unreadable;
use crate::scene::Scene;

/// Loads a model file. The extension of the path determines the format.
///
/// [`crate::from_bytes`] describes the conversion into a scene.
///
/// # Errors
///
/// Returns a [`FileError`] if the path does not lead to a model file, and in the same cases as [`crate::from_bytes`].
pub fn load(path: impl AsRef<Path>) -> Result<Scene, FileError> {
    load_placed(path, Placement::Fitted)
}

/// Loads a model file as [`load`] does. `placement` determines position and size of the model.
///
/// # Errors
///
/// The same as [`load`].
pub fn load_placed(path: impl AsRef<Path>, placement: Placement) -> Result<Scene, FileError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    let Some(format) = Format::of_path(path) else {
        return Err(error_of_path(path, file));
    };
    let metadata = fs::metadata(path).map_err(|error| unreadable(&file, &error))?;
    // Reading a device or a pipe might never end.
    let kind = metadata.file_type();
    if !kind.is_file() {
        let found = if kind.is_dir() { "a directory" } else { "a device or a pipe" };
        return Err(not_a_file(&file, found));
    }
    let opened = File::open(path).map_err(|error| unreadable(&file, &error))?;
    read_placed(opened, metadata.len(), format, (&file, path.parent()), placement)
}

/// Returns an error for a path without the extension of a supported format. The error states whether the path is a
/// directory, cannot be read, or has an unsupported extension.
fn error_of_path(path: &Path, file: String) -> FileError {
    match fs::metadata(path) {
        Ok(data) if data.is_dir() => not_a_file(&file, "a directory"),
        Err(error) if path.extension().is_none() => unreadable(&file, &error),
        _ => {
            let found = format!("{:?}", path.extension().unwrap_or_default().to_string_lossy());
            let expected = "an extension .ply, .obj, .stl, .gltf, .glb or .pdb";
            FileError::new(FileErrorKind::UnknownFormat, expected, found).in_file(file)
        }
    }
}

fn not_a_file(file: &str, found: &str) -> FileError {
    FileError::new(FileErrorKind::NotAFile, "a regular file", found).in_file(file)
}
