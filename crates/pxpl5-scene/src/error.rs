//! What can be wrong with a file, a scene, a display or a motion.

use std::fmt;
use std::io;

use thiserror::Error;

/// Where in a file a fault was found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FilePlace {
    /// A line, counted from 1.
    Line(u64),
    /// An offset from the beginning of the file, in bytes.
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

/// Why a model could not be loaded. Every message names the file, the place, what was expected and what was found.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The operating system refused: the file is missing, unreadable, or the disk failed.
    #[error("{file}: expected a readable file, found: {source}")]
    Io {
        /// Path of the file, as it was given.
        file: String,
        /// What the operating system said.
        source: io::Error,
    },
    /// The path leads to a directory, a device or a pipe.
    #[error("{file}: expected a regular file, found {found}")]
    NotAFile {
        /// Path of the file, as it was given.
        file: String,
        /// What the path leads to: "a directory", or "a device or a pipe".
        found: &'static str,
    },
    /// The extension is none that an importer reads.
    #[error("{file}: expected an extension .ply, .obj or .pdb, found {found:?}")]
    UnknownFormat {
        /// Path of the file, as it was given.
        file: String,
        /// The extension, empty if there is none.
        found: String,
    },
    /// The file is larger than [`crate::config::MAX_FILE_BYTES`].
    #[error("{file}: expected at most {expected} bytes, found more")]
    TooLarge {
        /// Name of the file, as it was given.
        file: String,
        /// The limit in bytes.
        expected: u64,
    },
    /// The model takes more memory than [`crate::config::MEMORY_TIMES_FILE`] times its file: corners that repeat without end.
    #[error("{file}: expected a model that takes at most {expected} bytes, as its size allows, found {found}")]
    TooMuchMemory {
        /// Name of the file, as it was given.
        file: String,
        /// The limit in bytes.
        expected: u64,
        /// What the model would take, in bytes.
        found: u64,
    },
    /// The file has no bytes, or nothing but white space.
    #[error("{file}: expected a model, found an empty file")]
    Empty {
        /// Name of the file, as it was given.
        file: String,
    },
    /// A byte that is not UTF-8 in a file, or part of a file, that must be text.
    #[error("{file}: {at}: expected UTF-8 text, found byte {found:#04x}")]
    NotText {
        /// Name of the file, as it was given.
        file: String,
        /// Where in the file the fault was found.
        at: FilePlace,
        /// The first byte that does not belong.
        found: u8,
    },
    /// The file breaks the rules of its format.
    #[error("{file}: {at}: expected {expected}, found {found}")]
    Syntax {
        /// Name of the file, as it was given.
        file: String,
        /// Where in the file the fault was found.
        at: FilePlace,
        /// What the format asks for.
        expected: String,
        /// What stands there, quoted and cut to 40 characters.
        found: String,
    },
    /// The file ends before everything that it announces; also how an absurd count in a header shows.
    #[error("{file}: {at}: expected {expected}, found {found}")]
    Truncated {
        /// Name of the file, as it was given.
        file: String,
        /// Where in the file the fault was found.
        at: FilePlace,
        /// What the file announced, for example a number of rows.
        expected: String,
        /// What is left of the file instead.
        found: String,
    },
    /// A corner refers to a vertex or a normal that does not exist.
    #[error("{file}: {at}: expected an index of one of {expected} {what}, found {found}")]
    Index {
        /// Name of the file, as it was given.
        file: String,
        /// Where in the file the fault was found.
        at: FilePlace,
        /// What is indexed: "vertices" or "normals".
        what: &'static str,
        /// How many of them the file has up to that place.
        expected: usize,
        /// The index as the file has it.
        found: i64,
    },
    /// A coordinate is not a number, infinite, or beyond [`crate::config::MAX_COORDINATE`].
    #[error("{file}: {at}: expected a coordinate between -{expected:e} and {expected:e}, found {found}")]
    Coordinate {
        /// Name of the file, as it was given.
        file: String,
        /// Where in the file the fault was found.
        at: FilePlace,
        /// The limit, in units of the file.
        expected: f64,
        /// The coordinate as read, in units of the file.
        found: f64,
    },
    /// The file is well formed but holds nothing to draw.
    #[error("{file}: expected at least one {expected}, found none")]
    NothingToDraw {
        /// Name of the file, as it was given.
        file: String,
        /// What one would have been enough: "triangle" or "atom".
        expected: &'static str,
    },
}

/// Why a scene could not be had or made.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum SceneError {
    /// No built-in scene has this name.
    #[error("scene {found:?}: expected one of {valid}; the nearest is {nearest:?}")]
    UnknownScene {
        /// The name asked for, cut to 40 characters.
        found: String,
        /// The valid name with the fewest edits to it.
        nearest: String,
        /// All valid names, with commas between.
        valid: String,
    },
    /// The N of a scene such as `full-screen:N` is no number or out of range.
    #[error("scene {scene}: expected N {expected}, found {found:?}")]
    TriangleCount {
        /// The scene, with N in its name.
        scene: &'static str,
        /// What N may be.
        expected: String,
        /// What stands after the colon.
        found: String,
    },
    /// More primitives are to be kept than there are, or none.
    #[error("scene {scene}: expected 1 to {expected} triangles to keep, found {found}")]
    Kept {
        /// Name of the scene.
        scene: String,
        /// How many primitives it has.
        expected: usize,
        /// How many were to be kept.
        found: usize,
    },
    /// A part of a hand-made scene breaks a rule of [`crate::Scene`].
    #[error("scene {scene}: {what} {index}: expected {expected}, found {found}")]
    Part {
        /// Name of the scene.
        scene: String,
        /// "vertex", "triangle", "sphere", "structure" or "corner of the path".
        what: &'static str,
        /// Which of them, counted from 0.
        index: usize,
        /// The rule that it breaks.
        expected: String,
        /// What the scene holds instead.
        found: String,
    },
}

/// Why a display or a head motion could not be made: a number out of its range.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{what}: expected {expected}, found {found}")]
pub struct RangeError {
    /// Name of the number, with its unit.
    pub what: &'static str,
    /// The allowed range, in words.
    pub expected: &'static str,
    /// The number that was given, in the unit of its name.
    pub found: f64,
}

/// `Ok` if `holds`, otherwise the error.
pub(crate) fn require(holds: bool, what: &'static str, expected: &'static str, found: f64) -> Result<(), RangeError> {
    if holds { Ok(()) } else { Err(RangeError { what, expected, found }) }
}
