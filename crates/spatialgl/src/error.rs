//! Errors in the settings and data of a user.

use std::fmt::Display;
use thiserror::Error;

/// An error for a setting, a vertex or an index. Each message names the item, the expected and the found value.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SpatialError {
    /// A number is out of range for a display or a volume.
    #[error("{what}: expected {expected}, found {found}")]
    Setting {
        /// Path of the number, as in `--set`.
        what: &'static str,
        /// Rule that the number breaks.
        expected: String,
        /// The number that was given.
        found: String,
    },
    /// A position or normal of a vertex is infinite or NaN.
    #[error("vertex {index}: expected a finite {what}, found {found}")]
    NotFinite {
        /// Index of the vertex in its buffer.
        index: usize,
        /// Affected property: "position" or "normal".
        what: &'static str,
        /// The value that was given.
        found: String,
    },
    /// An index exceeds the vertices of its buffer.
    #[error("index {at}: expected below {vertices}, found {found}")]
    Index {
        /// Position of the index in the list, counted from 0.
        at: usize,
        /// Number of vertices in the buffer.
        vertices: usize,
        /// The index that was given.
        found: u32,
    },
    /// A range of vertices exceeds its buffer, or its end comes before its start.
    #[error("vertices {start}..{end}: expected a range within 0..{vertices}")]
    Range {
        /// Index of the first vertex of the range.
        start: usize,
        /// Index after the last vertex of the range.
        end: usize,
        /// Number of vertices in the buffer.
        vertices: usize,
    },
}

impl SpatialError {
    pub(crate) fn setting(what: &'static str, expected: impl Display, found: impl Display) -> Self {
        Self::Setting { what, expected: expected.to_string(), found: found.to_string() }
    }
}

/// Returns an error with these texts if `holds` is false.
pub(crate) fn require(
    holds: bool,
    what: &'static str,
    expected: impl Display,
    found: impl Display,
) -> Result<(), SpatialError> {
    if holds { Ok(()) } else { Err(SpatialError::setting(what, expected, found)) }
}
