//! Readers of model files: PLY, OBJ, PDB.

mod mesh;
mod obj;
mod pdb;
mod ply;
mod source;

use std::fs::{self, File};
use std::io::Read;
use std::path::Path;

pub(crate) use mesh::{Mesh, Normals};
pub(crate) use pdb::{Atom, read_atoms};
pub(crate) use source::Source;

use crate::config::MAX_FILE_BYTES;
use crate::error::LoadError;
use crate::scene::Scene;

/// A file format that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Polygon file: ASCII, binary little-endian or binary big-endian; element `vertex` with `x y z`, optionally
    /// `nx ny nz` and `red green blue`; element `face` with `vertex_indices` or `vertex_index`.
    Ply,
    /// Wavefront object: `v`, `vn`, `f`; everything else is passed over. No line continuations.
    Obj,
    /// Protein Data Bank: `ATOM` and `HETATM` of the first model become spheres; of alternate locations the first.
    Pdb,
}

impl Format {
    /// The format of a file name, by its extension in any case.
    #[must_use]
    pub fn of(path: &Path) -> Option<Self> {
        let extension = path.extension()?.to_str()?.to_ascii_lowercase();
        match extension.as_str() {
            "ply" => Some(Format::Ply),
            "obj" => Some(Format::Obj),
            "pdb" | "ent" => Some(Format::Pdb),
            _ => None,
        }
    }
}

/// Loads a model file, of the format that its extension says.
///
/// Polygons are cut into fans; missing normals become the mean of the adjacent triangles, weighted by area. The model
/// is moved so that the centre of its box is the origin, and scaled so that its farthest point is
/// [`crate::config::FIT_RADIUS_M`] away: so it fills the view of [`Scene::motion`], whatever the units of the file.
/// Its axes stay: +y is up, +z faces the viewer.
///
/// # Errors
///
/// [`LoadError`] says what is wrong, and where. No file makes it panic or take more than a few times its size.
pub fn load(path: impl AsRef<Path>) -> Result<Scene, LoadError> {
    let path = path.as_ref();
    let file = path.display().to_string();
    let Some(format) = Format::of(path) else {
        return Err(not_a_model(path, file));
    };
    let io = |source| LoadError::Io { file: file.clone(), source };
    let kind = fs::metadata(path).map_err(io)?.file_type();
    if !kind.is_file() {
        let found = if kind.is_dir() { "a directory" } else { "a device or a pipe" };
        return Err(LoadError::NotAFile { file, found });
    }
    let opened = File::open(path).map_err(io)?;
    from_reader(opened, format, &file)
}

/// The most telling fault of a path without a known extension.
fn not_a_model(path: &Path, file: String) -> LoadError {
    match fs::metadata(path) {
        Ok(data) if data.is_dir() => LoadError::NotAFile { file, found: "a directory" },
        Err(source) => LoadError::Io { file, source },
        Ok(_) => {
            LoadError::UnknownFormat { file, found: path.extension().unwrap_or_default().to_string_lossy().into() }
        }
    }
}

/// Reads a model to the end of `reader`; `name` stands for it in errors and as the name of the scene. See [`load`].
///
/// # Errors
///
/// As [`load`].
pub fn from_reader(reader: impl Read, format: Format, name: &str) -> Result<Scene, LoadError> {
    let mut bytes = Vec::new();
    let mut limited = reader.take(MAX_FILE_BYTES + 1);
    limited.read_to_end(&mut bytes).map_err(|source| LoadError::Io { file: name.to_owned(), source })?;
    from_bytes(&bytes, format, name)
}

/// Reads a model from memory; `name` stands for it in errors and as the name of the scene. See [`load`].
///
/// # Errors
///
/// As [`load`].
pub fn from_bytes(bytes: &[u8], format: Format, name: &str) -> Result<Scene, LoadError> {
    let source = Source { name, bytes };
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(LoadError::TooLarge { file: name.to_owned(), expected: MAX_FILE_BYTES });
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(LoadError::Empty { file: name.to_owned() });
    }
    match format {
        Format::Ply => ply::read(&source),
        Format::Obj => obj::read(&source),
        Format::Pdb => pdb::read(&source),
    }
}
