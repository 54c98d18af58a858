//! The error type of studies, which consist of many experiments.

use pxpl5_run::ExperimentError;
use pxpl5_sim::parameters::{FileError, SettingError};
use thiserror::Error;

/// An error that prevents a study. A study is a comparison, a search for a limit, the measurement of a published
/// figure, or a measurement with the latency rig.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A setting is invalid, or the pendulum rig gives no measurement with the settings.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// An experiment of the study cannot run.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    /// A file of finished rows cannot be read or written, is damaged, or holds rows of another comparison. Or the
    /// comparison in the folder is unfinished, and the user did not allow a resume.
    #[error(transparent)]
    File(#[from] FileError),
    /// The experiment of a published figure yields no result.
    #[error("figure {id}: {reason}")]
    Figure {
        /// Number of the figure in ACCURACY.md.
        id: &'static str,
        /// Reason why the experiment yields no result.
        reason: String,
    },
}

impl StudyError {
    /// Returns a function that converts an error of the experiment of figure `id`.
    pub(crate) fn of_figure(id: &'static str) -> impl FnOnce(Self) -> Self {
        move |error| match error {
            Self::Experiment(ExperimentError::Stopped(_)) => error,
            _ => Self::Figure { id, reason: error.to_string() },
        }
    }
}
