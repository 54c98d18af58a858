//! Errors of experiment files and settings.

use pxpl5_machine::ConfigError;
use pxpl5_scene::{LoadError, RangeError, SceneError};
use thiserror::Error;

/// Error of an experiment file or a setting. Every message names the place and the key, the expected value and the
/// value found.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// An experiment file that cannot be read.
    #[error("{file}: expected a readable experiment file, found: {reason}")]
    Io {
        /// Path of the file, as the user gave it.
        file: String,
        /// Message of the operating system.
        reason: String,
    },
    /// Text that is not valid TOML.
    #[error("{place}: not TOML: {reason}")]
    Syntax {
        /// File and line, or the command line option.
        place: String,
        /// Message of the TOML parser.
        reason: String,
    },
    /// A key that does not exist.
    #[error("{place}: there is no key `{found}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// File and line, or the command line option.
        place: String,
        /// Unknown key, as the user wrote it.
        found: String,
        /// Most similar valid key.
        nearest: String,
    },
    /// A value of the wrong type or out of range.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// File and line, or the command line option.
        place: String,
        /// Path of the key.
        key: String,
        /// Valid values of the key, in words.
        expected: String,
        /// Value that the user gave, cut to 60 characters.
        found: String,
    },
    /// A setting that does not apply to the chosen pipeline.
    #[error("{place}: {key} does not apply to the pipeline {pipeline}; leave it out (it is for {applies_to})")]
    NotApplicable {
        /// File and line, or the command line option.
        place: String,
        /// Path of the key.
        key: String,
        /// Name of the chosen pipeline.
        pipeline: &'static str,
        /// Pipelines that have the key, separated by commas.
        applies_to: String,
    },
    /// A required setting that is missing.
    #[error("{key} is missing: give {how}")]
    Missing {
        /// Path of the missing key.
        key: &'static str,
        /// Example of a value.
        how: &'static str,
    },
    /// A head, tracker or predictor that cannot be built.
    #[error("{place}: {reason}")]
    Head {
        /// File and line, or the command line option.
        place: String,
        /// Expected value and value found, in words.
        reason: String,
    },
    /// Two settings that set the same number.
    #[error("{place}: {key} and {other} set the same numbers; leave one out")]
    Conflict {
        /// File and line, or the command line option.
        place: String,
        /// Path of the machine's parameter.
        key: String,
        /// Key of the pipeline that sets the parameter too, with its value.
        other: String,
    },
    /// A machine that cannot be built.
    #[error("{place}: {error}")]
    Config {
        /// File and line, or the command line option. The text "machine" if the error concerns the machine as a
        /// whole.
        place: String,
        /// Error of the machine's configuration.
        error: ConfigError,
    },
    /// A built-in scene that does not exist.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// A model file that cannot be used.
    #[error("{0}")]
    Load(#[from] LoadError),
    /// A head motion with a parameter out of range.
    #[error("motion: {0}")]
    Motion(#[from] RangeError),
}
