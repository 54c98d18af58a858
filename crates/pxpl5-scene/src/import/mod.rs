//! Readers of model files: PLY, OBJ, PDB.

#[cfg(feature = "files")]
mod files;
mod mesh;
mod model;
mod obj;
mod pdb;
mod placement;
mod ply;
mod polygon;
mod source;

use std::io::Read;
use std::path::Path;

use glam::DVec3;

#[cfg(feature = "files")]
pub use files::{load, load_placed};
use mesh::Fit;
pub(crate) use mesh::{Mesh, fitted_scene};
use model::Model;
pub(crate) use pdb::{Atom, read_atoms};
pub use placement::Placement;
pub(crate) use source::Source;

use crate::config::MAX_FILE_BYTES;
use crate::error::LoadError;
use crate::motion::HeadMotion;
use crate::scene::Scene;

impl Placement {
    /// What is done to the coordinates of balls (centre, radius) that the model consists of.
    fn fit(self, balls: impl Iterator<Item = (DVec3, f64)> + Clone) -> Fit {
        match self {
            Self::Fitted => Fit::new(balls),
            Self::AsInFile => Fit::none(),
        }
    }

    /// How the head moves that looks at a model placed so.
    fn motion(self) -> HeadMotion {
        match self {
            Self::Fitted => mesh::seeing_fitted(),
            Self::AsInFile => mesh::standing_at_the_origin(),
        }
    }
}

/// A file format that can be read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Polygon file: ASCII, binary little-endian or binary big-endian; element `vertex` with `x y z`, optionally
    /// `nx ny nz` and `red green blue`; element `face`, perhaps with `red green blue`, or `tristrips`, with `vertex_indices` or `vertex_index`.
    Ply,
    /// Wavefront object: `v` with or without colours, `vn`, `f`, `s`; everything else is passed over. A line that ends in `\` goes on
    /// in the next one.
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
    read_placed(reader, 0, format, name, placement)
}

/// As [`placed_from_reader`], of something that has about `size` bytes.
fn read_placed(
    reader: impl Read,
    size: u64,
    format: Format,
    name: &str,
    placement: Placement,
) -> Result<Scene, LoadError> {
    let mut bytes = Vec::with_capacity(size.min(MAX_FILE_BYTES) as usize + 1);
    let mut limited = reader.take(MAX_FILE_BYTES + 1);
    limited.read_to_end(&mut bytes).map_err(|source| LoadError::Io { file: name.to_owned(), source })?;
    match read(&bytes, format, name, placement)? {
        Content::Scene(scene) => Ok(*scene),
        Content::Mesh(model) => {
            let size = bytes.len();
            drop(bytes);
            model.into_scene(name, size, placement)
        }
    }
}

/// Reads a model from memory; `name` stands for it in errors and as the name of the scene.
///
/// Polygons are cut into triangles, concave ones too. Missing normals become the mean of the adjacent triangles, weighted by area; in
/// OBJ files only within a smoothing group, and faces without one are flat. The model
/// is moved so that the centre of its box is the origin, and scaled so that its farthest point is
/// [`crate::config::IMPORT_RADIUS_M`] away: so both eyes see all of it under [`Scene::motion`], whatever the units of the file.
/// Its axes stay: +y is up, +z faces the viewer.
///
/// # Errors
///
/// [`LoadError`] says what is wrong, and where. No bytes make it panic, or take more than [`crate::config::MEMORY_TIMES_FILE`]
/// times their size, their own included.
pub fn from_bytes(bytes: &[u8], format: Format, name: &str) -> Result<Scene, LoadError> {
    placed_from_bytes(bytes, format, name, Placement::Fitted)
}

/// As [`from_bytes`], with the model where `placement` says.
///
/// # Errors
///
/// As [`from_bytes`].
pub fn placed_from_bytes(bytes: &[u8], format: Format, name: &str, placement: Placement) -> Result<Scene, LoadError> {
    match read(bytes, format, name, placement)? {
        Content::Mesh(model) => model.into_scene(name, bytes.len(), placement),
        Content::Scene(scene) => Ok(*scene),
    }
}

/// What a file has been read to.
enum Content {
    /// Not a scene yet: making it takes memory, for which the file's bytes can be given up.
    Mesh(Model),
    Scene(Box<Scene>),
}

fn read(bytes: &[u8], format: Format, name: &str, placement: Placement) -> Result<Content, LoadError> {
    let source = Source { name, bytes };
    source.check_is_bytes_of_text()?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(LoadError::TooLarge { file: name.to_owned(), expected: MAX_FILE_BYTES });
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(LoadError::Empty { file: name.to_owned() });
    }
    Ok(match format {
        Format::Ply => Content::Mesh(ply::read(&source)?),
        Format::Obj => Content::Mesh(obj::read(&source)?),
        Format::Pdb => Content::Scene(Box::new(pdb::read(&source, placement)?)),
    })
}
