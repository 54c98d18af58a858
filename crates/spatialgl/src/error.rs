//! What can be wrong with what a user hands in.

use std::fmt::Display;
use thiserror::Error;

/// A setting, a vertex or an index that cannot be used: what, where, what was expected and what was found.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SpatialError {
    /// A number that no display or volume can be made with.
    #[error("{what}: expected {expected}, found {found}")]
    Setting {
        /// Path of the number, as in `--set`.
        what: &'static str,
        /// The rule that it breaks.
        expected: String,
        /// The number that was given.
        found: String,
    },
    /// A coordinate, normal or size that is infinite or no number.
    #[error("vertex {index}: expected a finite {what}, found {found}")]
    NotFinite {
        /// Number of the vertex in its buffer.
        index: usize,
        /// Which of its properties: "position" or "normal".
        what: &'static str,
        /// The value that was given.
        found: String,
    },
    /// An index beyond the vertices of its buffer.
    #[error("index {at}: expected below {vertices}, found {found}")]
    Index {
        /// Which index of the list, counted from 0.
        at: usize,
        /// Vertices in the buffer.
        vertices: usize,
        /// The index that was given.
        found: u32,
    },
    /// A range of vertices beyond the end of its buffer, or with its end before its start.
    #[error("vertices {start}..{end}: expected a range within 0..{vertices}")]
    Range {
        /// First vertex of the range.
        start: usize,
        /// End of the range.
        end: usize,
        /// Vertices in the buffer.
        vertices: usize,
    },
}

impl SpatialError {
    pub(crate) fn setting(what: &'static str, expected: impl Display, found: impl Display) -> Self {
        Self::Setting { what, expected: expected.to_string(), found: found.to_string() }
    }
}

/// `Ok` if the rule holds, otherwise the error.
pub(crate) fn require(
    holds: bool,
    what: &'static str,
    expected: impl Display,
    found: impl Display,
) -> Result<(), SpatialError> {
    if holds { Ok(()) } else { Err(SpatialError::setting(what, expected, found)) }
}
