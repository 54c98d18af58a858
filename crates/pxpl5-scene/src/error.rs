//! Errors in model files, scenes, displays and head motions.

use std::fmt;
use std::io;

use thiserror::Error;

/// The position in a file at which an error was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilePlace {
    /// Line number, counted from 1.
    Line(u64),
    /// Offset from the beginning of the file, in bytes.
    Byte(u64),
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            FilePlace::Line(line) => write!(f, "line {line}"),
            FilePlace::Byte(byte) => write!(f, "byte {byte}"),
        }
    }
}

/// The reason why a model file could not be loaded. Every message names the file, the position of the error, and the
/// expected and found content.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The operating system reports an error: the file is missing or unreadable, or the disk failed.
    #[error("{file}: expected a readable file, found: {source}")]
    Io {
        /// Path of the model file, as the caller gave it.
        file: String,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The path leads to a directory, a device or a pipe instead of a file.
    #[error("{file}: expected a regular file, found {found}")]
    NotAFile {
        /// Path of the model file, as the caller gave it.
        file: String,
        /// Description of the object at the path: "a directory" or "a device or a pipe".
        found: &'static str,
    },
    /// The file's extension is unknown, so no importer reads the file.
    #[error("{file}: expected an extension .ply, .obj, .stl, .gltf, .glb or .pdb, found {found:?}")]
    UnknownFormat {
        /// Path of the model file, as the caller gave it.
        file: String,
        /// The extension of the path, or an empty text if the path has no extension.
        found: String,
    },
    /// The file is larger than [`crate::config::MAX_FILE_BYTES`].
    #[error("{file}: expected at most {expected} bytes, found more")]
    TooLarge {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Largest allowed size of a model file, in bytes.
        expected: u64,
    },
    /// The model needs more memory than [`crate::config::MEMORY_TIMES_FILE`] times the size of its file. This happens
    /// if a file refers to the same corners very often.
    #[error("{file}: expected a model that takes at most {expected} bytes, as its size allows, found {found}")]
    TooMuchMemory {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Greatest memory that the model may take, in bytes.
        expected: u64,
        /// Memory that the model would take, in bytes.
        found: u64,
    },
    /// The file is empty or contains only white space.
    #[error("{file}: expected a model, found an empty file")]
    Empty {
        /// Name of the model file, as the caller gave it.
        file: String,
    },
    /// A part of the file that must be text contains a byte that is not UTF-8.
    #[error("{file}: {at}: expected UTF-8 text, found byte {found:#04x}")]
    NotText {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Position of the error in the file.
        at: FilePlace,
        /// First byte that is not UTF-8.
        found: u8,
    },
    /// The file breaks the rules of its format.
    #[error("{file}: {at}: expected {expected}, found {found}")]
    Syntax {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Position of the error in the file.
        at: FilePlace,
        /// Description of the content that the format requires.
        expected: String,
        /// Content of the file at this position, quoted and cut to 40 characters.
        found: String,
    },
    /// The file ends before all content that its header announces. A far too large number in the header causes this
    /// error too.
    #[error("{file}: {at}: expected {expected}, found {found}")]
    Truncated {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Position of the error in the file.
        at: FilePlace,
        /// Content that the header announced, for example a number of rows.
        expected: String,
        /// Description of the content that is left in the file.
        found: String,
    },
    /// A corner of a face refers to a vertex or a normal that does not exist.
    #[error("{file}: {at}: expected an index of one of {expected} {what}, found {found}")]
    Index {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Position of the error in the file.
        at: FilePlace,
        /// Kind of the indexed items: "vertices" or "normals".
        what: &'static str,
        /// Number of vertices or normals that the file has. A valid index refers to an existing vertex or normal.
        expected: usize,
        /// The index as it is written in the file.
        found: i64,
    },
    /// A part of a glTF file breaks the rules of the format, or needs something that the importer cannot read.
    #[error("{file}: {part}: expected {expected}, found {found}")]
    Part {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Path of the part in the JSON of the file, for example `meshes[0].primitives[1].indices`.
        part: String,
        /// Description of the content that the importer can read.
        expected: String,
        /// Description of the content of the file.
        found: String,
    },
    /// The importer of the format is not part of this program.
    #[error(
        "{file}: expected a program with the feature {feature} for {format} files, found one built without {feature}; \
         build it with --features {feature}"
    )]
    NotBuilt {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Name of the format.
        format: &'static str,
        /// Name of the feature that has the importer.
        feature: &'static str,
    },
    /// A coordinate is NaN, infinite, or larger than [`crate::config::MAX_COORDINATE`] in absolute value.
    #[error("{file}: {at}: expected a coordinate between -{expected:e} and {expected:e}, found {found}")]
    Coordinate {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Position of the error in the file.
        at: FilePlace,
        /// Largest allowed absolute coordinate, in units of the file.
        expected: f64,
        /// The coordinate that was read, in units of the file.
        found: f64,
    },
    /// The file is well formed but contains nothing to draw.
    #[error("{file}: expected at least one {expected}, found none")]
    NothingToDraw {
        /// Name of the model file, as the caller gave it.
        file: String,
        /// Kind of content that is missing: "triangle", "triangle with an area" or "atom".
        expected: &'static str,
    },
}

/// The reason why a scene could not be found or created.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// No built-in scene has this name.
    #[error("scene {found:?}: expected one of {valid}; the nearest is {nearest:?}")]
    UnknownScene {
        /// The requested name, cut to 40 characters.
        found: String,
        /// The valid name that is most similar to the requested name, by the number of changed characters.
        nearest: String,
        /// All valid names, separated by commas.
        valid: String,
    },
    /// The N of a scene name such as `full-screen:N` is not a number or is out of range.
    #[error("scene {scene}: expected N {expected}, found {found:?}")]
    TriangleCount {
        /// Name of the scene, with N in place of the number of triangles.
        scene: &'static str,
        /// Allowed values of N.
        expected: String,
        /// Text after the colon of the requested name.
        found: String,
    },
    /// The number of primitives to keep is zero or exceeds the number in the scene.
    #[error("scene {scene}: expected 1 to {expected} triangles to keep, found {found}")]
    Kept {
        /// Name of the scene.
        scene: String,
        /// Number of primitives that the scene has, which is the greatest allowed number.
        expected: usize,
        /// Requested number of primitives to keep.
        found: usize,
    },
    /// A part of a scene, such as a vertex, breaks a rule of [`crate::Scene`].
    #[error("scene {scene}: {what} {index}: expected {expected}, found {found}")]
    Part {
        /// Name of the scene.
        scene: String,
        /// Kind of the part: "vertex", "triangle", "sphere", "structure" or "corner of the path".
        what: &'static str,
        /// Index of the part, counted from 0.
        index: usize,
        /// The rule for scenes that the part breaks.
        expected: String,
        /// Description of the part that breaks the rule.
        found: String,
    },
}

/// The reason why a display or a head motion could not be created: one of its numbers is out of range.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{what}: expected {expected}, found {found}")]
pub struct RangeError {
    /// Name of the number that is out of range.
    pub what: &'static str,
    /// Allowed range of the number, in words.
    pub expected: &'static str,
    /// Value of the number that was given, in the unit that the name states.
    pub found: f64,
}

/// Returns an error unless `holds` is true.
pub(crate) fn require(holds: bool, what: &'static str, expected: &'static str, found: f64) -> Result<(), RangeError> {
    if holds { Ok(()) } else { Err(RangeError { what, expected, found }) }
}
