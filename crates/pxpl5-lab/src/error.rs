//! The error type of studies, which consist of many experiments.

use pxpl5_run::ExperimentError;
use pxpl5_sim::parameters::{FileError, SettingError};
use thiserror::Error;
use tracking::rig::RigError;

/// An error that prevents a study. A study is a comparison, a search for a limit, the measurement of a published
/// figure, or a measurement with the latency rig.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum StudyError {
    /// A setting is invalid.
    #[error(transparent)]
    Setting(#[from] SettingError),
    /// An experiment of the study cannot run.
    #[error(transparent)]
    Experiment(#[from] ExperimentError),
    /// The number of display fields of a run is too small or too large.
    #[error("fields: expected {} to {}, found {found}", expected.0, expected.1)]
    Fields {
        /// Minimum and maximum number of display fields of a run.
        expected: (u64, u64),
        /// Number of display fields in the settings.
        found: u64,
    },
    /// The comparison has no seeds.
    #[error("seeds: expected at least one, found none")]
    NoSeed,
    /// The registry has no pipeline that takes part in comparisons.
    #[error("expected a registry with a pipeline that is compared, found none")]
    NoPipeline,
    /// The settings have no head motion, so there is no error to compare.
    #[error("expected a head.motion, found none: without a head there is no error to compare")]
    NoHead,
    /// The query requires a precision, but the head moves in the same way for every seed.
    #[error(
        "this motion is the same for all seeds: its interval is a bootstrap over time, which more seeds do not make narrower; \
         use head.motion = synthetic or a longer recording, or compare without a precision"
    )]
    OneMotion,
    /// The seeds of a comparison are not usable.
    #[error("seeds: expected {expected}, found {found}")]
    Seeds {
        /// Description of usable seeds.
        expected: String,
        /// The unusable seed, or the unusable number of seeds.
        found: u64,
    },
    /// A file of finished rows cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The folder holds rows of a comparison with other settings.
    #[error("{path}: these rows are of another comparison: {key} was {found}, expected {expected}")]
    OtherSettings {
        /// Path of the file of finished rows.
        path: String,
        /// First setting with a different value.
        key: String,
        /// Value of the setting in this comparison.
        expected: String,
        /// Value of the setting in the file.
        found: String,
    },
    /// The folder holds rows of an interrupted comparison, and the user did not allow a resume.
    #[error(
        "{path}: {rows} of {of} rows of an interrupted comparison are here; resume the comparison, or choose another folder"
    )]
    Unfinished {
        /// Path of the file of finished rows.
        path: String,
        /// Number of finished rows of the interrupted comparison.
        rows: usize,
        /// Number of all rows of the interrupted comparison.
        of: usize,
    },
    /// Another thread stopped the comparison.
    #[error("the comparison was stopped")]
    Stopped,
    /// A line in the file of finished rows cannot be read as a row of a comparison.
    #[error("{path}, line {line}: expected a row of a comparison, found {found}")]
    Damaged {
        /// Path of the file of finished rows.
        path: String,
        /// Number of the damaged line in the file, counted from 1.
        line: usize,
        /// Message of the parser.
        found: String,
    },
    /// The pendulum rig gave no measurement. Either the tracker reported no pass of the pendulum through its lowest
    /// point, or the photodiode detected no bright pixel.
    #[error(transparent)]
    Rig(#[from] RigError),
    /// A requested frame was not shown completely.
    #[error(
        "expected the time of complete display for {expected} frames that low points requested, found it for {found}"
    )]
    NotShown {
        /// Number of frames that the rig requested, one for each pass of the pendulum through its lowest point.
        expected: usize,
        /// Number of completely shown frames, according to the pipeline's records.
        found: usize,
    },
    /// The photodiode cannot detect when a frame of this pipeline appears.
    #[error("expected a pipeline whose frames a photodiode can distinguish, found {pipeline}: {reason}; {definition}")]
    NoFrames {
        /// Name of the pipeline.
        pipeline: &'static str,
        /// Reason why a change from dark to bright under the photodiode does not show the start of a new frame.
        reason: &'static str,
        /// The pipeline's own definition of the time at which a picture is due.
        definition: &'static str,
    },
    /// The line of the photodiode lies below the screen.
    #[error("line of the photodiode: expected a line from 0 to {}, found {found}", lines.saturating_sub(1))]
    Photodiode {
        /// Number of lines on the screen.
        lines: u32,
        /// Number of the line under the photodiode in the settings, counted from 0.
        found: u32,
    },
}
