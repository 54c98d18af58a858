//! What can be wrong with an experiment.

use address_recalculation::ArpError;
use cube_faces::DepthError;
use priority_rendering::PriorityError;
use thiserror::Error;
use tracking::SettingError;

/// Why an experiment cannot be made.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// A scene with something that faces cannot show.
    #[error("scene {scene}: expected {expected}, found {found}")]
    Scene {
        /// Its name.
        scene: String,
        /// What every part of it must be.
        expected: &'static str,
        /// The part that is something else.
        found: String,
    },
    /// A number of the policies.
    #[error(transparent)]
    Priority(#[from] PriorityError),
    /// A number of the display, its lens or an orientation.
    #[error(transparent)]
    Display(#[from] ArpError),
    /// Near and far.
    #[error(transparent)]
    Depth(#[from] DepthError),
    /// A walk that there cannot be.
    #[error(transparent)]
    Motion(#[from] SettingError),
    /// A renderer that draws nothing.
    #[error("source.triangles_per_s: expected more than 0, found {0}")]
    Rate(f64),
    /// There is no setting of this path.
    #[error("{place}: there is no key `{found}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// The option or file that named it.
        place: String,
        /// The path that nobody knows.
        found: String,
        /// The nearest valid one.
        nearest: String,
    },
    /// A setting was given a value that it cannot have.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// The option or file that gave it.
        place: String,
        /// Path of the setting.
        key: String,
        /// What values it takes, in words.
        expected: String,
        /// The value that was given.
        found: String,
    },
}

impl ExperimentError {
    /// Whether the scene is at fault and not what was asked for.
    #[must_use]
    pub const fn is_of_scene(&self) -> bool {
        matches!(self, Self::Scene { .. })
    }
}
