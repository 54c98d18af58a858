//! What can be wrong with what a user hands in.

use perspecta::PerspectaError;
use spatialgl::SpatialError;
use thiserror::Error;

/// A setting, a scene or a question that cannot be answered: what, where, what was expected and what was found.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum VolumeError {
    /// There is no setting of this path.
    #[error("{place}: there is no key `{found}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// The option that named it.
        place: String,
        /// The path that nobody knows.
        found: String,
        /// The nearest valid one.
        nearest: String,
    },
    /// A setting was given a value that it cannot have.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// The option that gave it.
        place: String,
        /// Path of the setting.
        key: String,
        /// What values it takes, in words.
        expected: String,
        /// The value that was given.
        found: String,
    },
    /// A slice, a batch or a picture that is not there.
    #[error("{what}: expected {expected}, found {found}")]
    Missing {
        /// What was asked for.
        what: &'static str,
        /// Which of them there are.
        expected: String,
        /// The one that was asked for.
        found: String,
    },
    /// What the pipeline cannot draw.
    #[error(transparent)]
    Pipeline(#[from] SpatialError),
    /// What the display or an eye before it cannot be.
    #[error(transparent)]
    Display(#[from] PerspectaError),
}

impl VolumeError {
    /// Whether the scene is at fault and not what was asked for.
    #[must_use]
    pub const fn is_of_scene(&self) -> bool {
        matches!(self, Self::Pipeline(SpatialError::NotFinite { .. } | SpatialError::Index { .. }))
    }
}
