//! Errors in the definition of an experiment.

use crate::cube_faces::DepthError;
use address_recalculation::ArpError;
use address_recalculation::priority::PriorityError;
use thiserror::Error;
use tracking::SettingError;

/// The reason why an experiment cannot run.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum WalkError {
    /// The scene contains an object that cube faces cannot show.
    #[error("scene {scene}: expected {expected}, found {found}")]
    Scene {
        /// Name of the scene.
        scene: String,
        /// The rule that every part of the scene must obey.
        expected: &'static str,
        /// The part that violates the requirement.
        found: String,
    },
    /// A parameter of a policy is invalid.
    #[error(transparent)]
    Priority(#[from] PriorityError),
    /// A parameter of the display, its lens or an orientation is invalid.
    #[error(transparent)]
    Display(#[from] ArpError),
    /// The near or far distance is invalid.
    #[error(transparent)]
    Depth(#[from] DepthError),
    /// The walk is impossible, for example because its path is too short.
    #[error(transparent)]
    Motion(#[from] SettingError),
    /// The rate of the renderer is not positive.
    #[error("source.triangles_per_s: expected more than 0, found {0}")]
    Rate(f64),
    /// No setting has the requested path.
    #[error("{place}: there is no key `{found}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// The option or file that contains the path.
        place: String,
        /// The requested path.
        found: String,
        /// The valid path that is most similar to the requested path.
        nearest: String,
    },
    /// A setting has an invalid value.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// The option or file that contains the value.
        place: String,
        /// Path of the setting.
        key: String,
        /// Description of the valid values.
        expected: String,
        /// The invalid value.
        found: String,
    },
}

impl WalkError {
    /// Returns true if the scene causes the error.
    #[must_use]
    pub const fn is_of_scene(&self) -> bool {
        matches!(self, Self::Scene { .. })
    }
}
