//! Errors in the configuration and in input data.

use thiserror::Error;

/// A parameter, lens or orientation that the display cannot use.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ArpError {
    /// A parameter is out of range. The text has its path, the expected and the found value.
    #[error("{0}")]
    Number(String),
    /// The lens folds the picture over itself, or is not suitable for the requested viewing angle.
    #[error("arp.lens: expected {expected}, found {found}")]
    Lens {
        /// The violated rule.
        expected: String,
        /// The value that violates the rule.
        found: String,
    },
    /// A file of viewing vectors is invalid.
    #[error("arp.lens table, line {line}: expected {expected}, found {found}")]
    Table {
        /// Line of the file, counted from 1. If data are missing, the number is the line after the last line.
        line: usize,
        /// Description of the expected content.
        expected: String,
        /// The content found.
        found: String,
    },
    /// A matrix is not a rotation: not finite, stretched, or a reflection.
    #[error("orientation: expected a rotation within 1e-3, found {0}")]
    Orientation(String),
}
