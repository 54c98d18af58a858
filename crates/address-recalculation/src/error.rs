//! What can be wrong with what a user hands in.

use thiserror::Error;

/// A number, a lens or an orientation that the display cannot use.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ArpError {
    /// A number beyond its limits: its path, what was expected and what was found.
    #[error("{0}")]
    Number(String),
    /// A lens that folds the picture over itself, or that cannot have this angle.
    #[error("arp.lens: expected {expected}, found {found}")]
    Lens {
        /// The rule that it breaks.
        expected: String,
        /// What it is instead.
        found: String,
    },
    /// A file of viewing vectors that cannot be read.
    #[error("arp.lens table, line {line}: expected {expected}, found {found}")]
    Table {
        /// Line of the file, from 1; the one after the last where something is missing.
        line: usize,
        /// What should stand there.
        expected: String,
        /// What stands there instead.
        found: String,
    },
    /// A matrix that turns nothing: not finite, stretched, or a reflection.
    #[error("orientation: expected a rotation within 1e-3, found {0}")]
    Orientation(String),
}
