//! Errors in the settings and requests of a user.

use spatialgl::SpatialError;
use spatialgl::perspecta::PerspectaError;
use thiserror::Error;

/// An error in a setting, a scene or a request. Each message names the item, the expected and the found value.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum VolumeError {
    /// No setting has the given path.
    #[error("{place}: there is no key `{found}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// Option that contained the path.
        place: String,
        /// Path that no setting has.
        found: String,
        /// The valid path that is most similar to the given path.
        nearest: String,
    },
    /// The value that was given for a setting is not allowed.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// Option that contained the value.
        place: String,
        /// Path of the setting.
        key: String,
        /// Allowed values, in words.
        expected: String,
        /// The value that was given.
        found: String,
    },
    /// A requested slice, batch or picture does not exist, or a requested combination is not supported.
    #[error("{what}: expected {expected}, found {found}")]
    Missing {
        /// Name of the requested item.
        what: &'static str,
        /// Available items, in words.
        expected: String,
        /// The item that was requested.
        found: String,
    },
    /// An error of the drawing pipeline.
    #[error(transparent)]
    Pipeline(#[from] SpatialError),
    /// An error of the display or of a camera.
    #[error(transparent)]
    Display(#[from] PerspectaError),
}

impl VolumeError {
    /// Returns true if the error is caused by the scene instead of the request.
    #[must_use]
    pub const fn is_of_scene(&self) -> bool {
        matches!(self, Self::Pipeline(SpatialError::NotFinite { .. } | SpatialError::Index { .. }))
    }
}
