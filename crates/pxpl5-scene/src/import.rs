//! Readers of model files in the formats PLY, OBJ, STL, glTF and PDB.

#[cfg(feature = "files")]
mod files;
mod gltf;
mod mesh;
mod model;
mod obj;
mod pdb;
mod placement;
mod ply;
mod polygon;
mod source;
mod stl;

use crate::error::unreadable;
use pxpl5_sim::parameters::{FileError, FileErrorKind};
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
use crate::motion::HeadMotion;
use crate::scene::Scene;

impl Placement {
    /// Returns the transformation that brings a model to this placement. The balls (centre, radius) describe the extent
    /// of the model.
    fn fit(self, balls: impl Iterator<Item = (DVec3, f64)> + Clone) -> Fit {
        match self {
            Self::Fitted => Fit::new(balls),
            Self::AsInFile => Fit::none(),
        }
    }

    fn motion(self) -> HeadMotion {
        match self {
            Self::Fitted => mesh::motion_for_fitted(),
            Self::AsInFile => HeadMotion::STILL,
        }
    }
}

/// A file format that the importers can read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// PLY polygon file: ASCII, binary little-endian or binary big-endian. The element `vertex` has `x y z`, and
    /// optionally `nx ny nz` and `red green blue`. The element `face` (optionally with `red green blue`) or `tristrips`
    /// has `vertex_indices` or `vertex_index`.
    Ply,
    /// Wavefront OBJ file with the statements `v` (with or without colours), `vn`, `f` and `s`. All other statements
    /// are ignored. A line that ends in `\` continues on the next line.
    Obj,
    /// STL file, ASCII or binary. Each triangle is flat and has its own three vertices. The normals of the file are not
    /// used, because the corners determine them.
    Stl,
    /// glTF 2.0 file, as JSON (`.gltf`) or binary (`.glb`). The triangles, strips and fans of the default scene are
    /// read, with the transforms of their nodes. Colours are the base colours of materials times the colours of
    /// vertices. Textures, skins, morph targets and animations are not read.
    Gltf,
    /// Protein Data Bank file. The `ATOM` and `HETATM` records of its first model become spheres. If an atom has
    /// alternate locations, only the first is used.
    Pdb,
}

impl Format {
    /// Returns the format of a file by the extension of its name, in upper or lower case. Returns `None` for an unknown
    /// extension. The file itself is not read.
    pub fn of_path(path: &Path) -> Option<Self> {
        Self::of_extension(path.extension()?.to_str()?)
    }

    /// Returns the format for an extension without its dot, in upper or lower case. Returns `None` for an unknown
    /// extension.
    pub fn of_extension(extension: &str) -> Option<Self> {
        match extension.to_ascii_lowercase().as_str() {
            "ply" => Some(Format::Ply),
            "obj" => Some(Format::Obj),
            "stl" => Some(Format::Stl),
            "gltf" | "glb" => Some(Format::Gltf),
            "pdb" | "ent" => Some(Format::Pdb),
            _ => None,
        }
    }
}

/// Reads a model from `reader` until the end of the data. `name` identifies the model in errors and becomes the name of
/// the scene.
///
/// [`from_bytes`] describes the conversion into a scene.
///
/// # Errors
///
/// Returns a [`FileError`] if the reader fails, and all errors of [`from_bytes`].
pub fn from_reader(reader: impl Read, format: Format, name: &str) -> Result<Scene, FileError> {
    placed_from_reader(reader, format, name, Placement::Fitted)
}

/// Reads a model as [`from_reader`] does. `placement` determines position and size of the model.
///
/// # Errors
///
/// The same as [`from_reader`].
pub fn placed_from_reader(
    reader: impl Read,
    format: Format,
    name: &str,
    placement: Placement,
) -> Result<Scene, FileError> {
    read_placed(reader, 0, format, (name, None), placement)
}

/// Reads a model as [`placed_from_reader`] does.
///
/// `size` is the expected number of bytes of the model, for which memory is reserved. `folder` is the folder of the
/// model's file, and `None` for a model without a file.
fn read_placed(
    reader: impl Read,
    size: u64,
    format: Format,
    (name, folder): (&str, Option<&Path>),
    placement: Placement,
) -> Result<Scene, FileError> {
    // Read one byte beyond the limit, so that a larger file can be detected.
    let mut bytes = Vec::with_capacity(size.min(MAX_FILE_BYTES) as usize + 1);
    let mut limited = reader.take(MAX_FILE_BYTES + 1);
    limited.read_to_end(&mut bytes).map_err(|error| unreadable(name, &error))?;
    match read(&bytes, format, (name, folder), placement)? {
        Content::Scene(scene) => Ok(*scene),
        Content::Mesh(model) => {
            // Free the file's bytes before the scene is made.
            let size = bytes.len();
            drop(bytes);
            model.into_scene(name, size, placement)
        }
    }
}

/// Reads a model from the bytes of its file. `name` identifies the model in errors and becomes the name of the scene.
///
/// Convex and concave polygons are cut into triangles. A missing normal becomes the mean of the normals of adjacent
/// triangles, weighted by area. In OBJ files the mean covers only triangles of the same smoothing group, and faces
/// without a smoothing group are flat.
///
/// The model is moved so that the centre of its bounding box is the origin. The model is scaled so that its farthest
/// point is [`crate::config::IMPORT_RADIUS_M`] from the origin. Both eyes then see the whole model under
/// [`Scene::motion`], whatever the units of the file. The axes stay the same: +y is up, and +z faces the viewer.
///
/// # Errors
///
/// [`FileError`] states the error and its position in the file. No input causes a panic. Reading needs a limited amount
/// of memory: [`crate::config::MEMORY_TIMES_FILE`] times the size of the file, including the file itself, plus
/// [`crate::config::MEMORY_FLOOR_BYTES`].
pub fn from_bytes(bytes: &[u8], format: Format, name: &str) -> Result<Scene, FileError> {
    placed_from_bytes(bytes, format, name, Placement::Fitted)
}

/// Reads a model from the bytes of its file as [`from_bytes`] does. `placement` determines position and size of the
/// model.
///
/// # Errors
///
/// The same as [`from_bytes`].
pub fn placed_from_bytes(bytes: &[u8], format: Format, name: &str, placement: Placement) -> Result<Scene, FileError> {
    match read(bytes, format, (name, None), placement)? {
        Content::Mesh(model) => model.into_scene(name, bytes.len(), placement),
        Content::Scene(scene) => Ok(*scene),
    }
}

enum Content {
    /// A mesh that is not yet a scene. The file's bytes can be freed before the scene is made.
    Mesh(Model),
    Scene(Box<Scene>),
}

fn read(
    bytes: &[u8],
    format: Format,
    (name, folder): (&str, Option<&Path>),
    placement: Placement,
) -> Result<Content, FileError> {
    let source = Source { name, bytes, folder };
    // Reject unsuitable bytes before any parser reads them. The header of a binary STL file may have any bytes.
    if format != Format::Stl {
        source.check_is_bytes_of_text()?;
    }
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let expected = format_args!("at most {MAX_FILE_BYTES} bytes");
        return Err(FileError::new(FileErrorKind::TooLarge, expected, "more").in_file(name));
    }
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(FileError::new(FileErrorKind::Empty, "a model", "an empty file").in_file(name));
    }
    Ok(match format {
        Format::Ply => Content::Mesh(ply::read(&source)?),
        Format::Obj => Content::Mesh(obj::read(&source)?),
        Format::Stl => Content::Mesh(stl::read(&source)?),
        Format::Gltf => Content::Mesh(gltf::read(&source)?),
        Format::Pdb => Content::Scene(Box::new(pdb::read(&source, placement)?)),
    })
}
