//! Readers of model files: PLY, OBJ, PDB.

#[cfg(feature = "files")]
mod files;
mod mesh;
mod obj;
mod pdb;
mod placement;
mod ply;
mod source;

use std::io::Read;
use std::path::Path;

use glam::DVec3;

#[cfg(feature = "files")]
pub use files::{load, load_placed};
use mesh::Fit;
pub(crate) use mesh::{Mesh, Normals, fitted_scene};
pub(crate) use pdb::{Atom, read_atoms};
pub use placement::Placement;
pub(crate) use source::Source;

use crate::config::MAX_FILE_BYTES;
use crate::error::LoadError;
use crate::scene::{Scene, Sphere};

impl Placement {
    /// What is done to the coordinates of balls (centre, radius) that the model consists of.
    fn fit(self, balls: impl Iterator<Item = (DVec3, f64)> + Clone) -> Fit {
        match self {
            Self::Fitted => Fit::new(balls),
            Self::AsInFile => Fit::none(),
        }
    }

    fn scene(self, name: &str, mesh: Mesh, spheres: Vec<Sphere>) -> Scene {
        match self {
            Self::Fitted => fitted_scene(name, mesh, spheres),
            Self::AsInFile => mesh::unfitted_scene(name, mesh, spheres),
        }
    }
}

/// A file format that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Polygon file: ASCII, binary little-endian or binary big-endian; element `vertex` with `x y z`, optionally
    /// `nx ny nz` and `red green blue`; element `face`, or `tristrips`, with `vertex_indices` or `vertex_index`.
    Ply,
    /// Wavefront object: `v`, `vn`, `f`; everything else is passed over. No line continuations.
    Obj,
    /// Protein Data Bank: `ATOM` and `HETATM` of the first model become spheres; of an atom's alternate locations the first.
    Pdb,
}

impl Format {
    /// The format of a file name, by its extension in any case; `None` for one that no reader knows. Looks at the name
    /// only.
    #[must_use]
    pub fn of_path(path: &Path) -> Option<Self> {
        Self::of_extension(path.extension()?.to_str()?)
    }

    /// The format that an extension without its dot stands for, in any case; `None` for one that no reader knows.
    #[must_use]
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "ply" => Some(Format::Ply),
            "obj" => Some(Format::Obj),
            "pdb" | "ent" => Some(Format::Pdb),
            _ => None,
        }
    }
}

/// Reads a model to the end of `reader`; `name` stands for it in errors and as the name of the scene.
///
/// What becomes of the model: see [`from_bytes`].
///
/// # Errors
///
/// [`LoadError::Io`] if the reader fails, and all those of [`from_bytes`].
pub fn from_reader(reader: impl Read, format: Format, name: &str) -> Result<Scene, LoadError> {
    placed_from_reader(reader, format, name, Placement::Fitted)
}

/// As [`from_reader`], with the model where `placement` says.
///
/// # Errors
///
/// As [`from_reader`].
pub fn placed_from_reader(
    reader: impl Read,
    format: Format,
    name: &str,
    placement: Placement,
) -> Result<Scene, LoadError> {
    let mut bytes = Vec::new();
    let mut limited = reader.take(MAX_FILE_BYTES + 1);
    limited.read_to_end(&mut bytes).map_err(|source| LoadError::Io { file: name.to_owned(), source })?;
    placed_from_bytes(&bytes, format, name, placement)
}

/// Reads a model from memory; `name` stands for it in errors and as the name of the scene.
///
/// Polygons are cut into fans; missing normals become the mean of the adjacent triangles, weighted by area. The model
/// is moved so that the centre of its box is the origin, and scaled so that its farthest point is
/// [`crate::config::IMPORT_RADIUS_M`] away: so both eyes see all of it under [`Scene::motion`], whatever the units of the file.
/// Its axes stay: +y is up, +z faces the viewer.
///
/// # Errors
///
/// [`LoadError`] says what is wrong, and where. No bytes make it panic, or take more than fifteen times their size.
pub fn from_bytes(bytes: &[u8], format: Format, name: &str) -> Result<Scene, LoadError> {
    placed_from_bytes(bytes, format, name, Placement::Fitted)
}

/// As [`from_bytes`], with the model where `placement` says.
///
/// # Errors
///
/// As [`from_bytes`].
pub fn placed_from_bytes(bytes: &[u8], format: Format, name: &str, placement: Placement) -> Result<Scene, LoadError> {
    let source = Source { name, bytes, placement };
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
