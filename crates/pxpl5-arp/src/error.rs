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
    /// A picture that cannot be written.
    #[error("{0}")]
    Picture(String),
}
