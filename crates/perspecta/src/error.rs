//! What can be wrong with what a user hands in.

use thiserror::Error;

/// A number, a camera or a message that the display cannot use.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PerspectaError {
    /// A number beyond its limits: its path, what was expected and what was found.
    #[error("{0}")]
    Number(String),
    /// A camera that sees nothing.
    #[error("view.{what}: expected {expected}, found {found}")]
    Camera {
        /// Which of its numbers.
        what: &'static str,
        /// The rule that it breaks.
        expected: &'static str,
        /// The number that was given.
        found: f64,
    },
}
