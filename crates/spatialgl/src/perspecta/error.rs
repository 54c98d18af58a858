//! Errors in the settings and cameras of a user.

use thiserror::Error;

/// An error for a number or a camera that the display cannot use.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum PerspectaError {
    /// A number is out of range. The text names the path of the number, the expected and the found value.
    #[error("{0}")]
    Number(String),
    /// A number of a camera is out of range.
    #[error("view.{what}: expected {expected}, found {found}")]
    Camera {
        /// Name of the number that is out of range.
        what: &'static str,
        /// Rule that the number breaks.
        expected: &'static str,
        /// The number that was given.
        found: f64,
    },
}
