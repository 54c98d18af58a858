//! Errors of experiment files and settings.

use pxpl5_machine::ConfigError;
use pxpl5_scene::{LoadError, RangeError, SceneError};
use thiserror::Error;

/// Error of an experiment file or a setting. Every message names the file or option, the key, the expected value and
/// the value found.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// The experiment file cannot be read.
    #[error("{file}: expected a readable experiment file, found: {reason}")]
    Io {
        /// Path of the file, as given by the user.
        file: String,
        /// Message of the operating system.
        reason: String,
    },
    /// The text is not valid TOML.
    #[error("{place}: not TOML: {reason}")]
    Syntax {
        /// File and line, or the command line option.
        place: String,
        /// Message of the TOML parser.
        reason: String,
    },
    /// The key does not exist.
    #[error("{place}: there is no key `{found}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// File and line, or the command line option.
        place: String,
        /// Unknown key, as the user wrote it.
        found: String,
        /// Most similar valid key.
        nearest: String,
    },
    /// The value has the wrong type or is out of range.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// File and line, or the command line option.
        place: String,
        /// Path of the key.
        key: String,
        /// Valid values of the key, in words.
        expected: String,
        /// Value that the user gave, shortened to 60 characters.
        found: String,
    },
    /// The setting does not apply to the chosen pipeline.
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
    /// A required setting is missing.
    #[error("{key} is missing: give {how}")]
    Missing {
        /// Path of the missing key.
        key: &'static str,
        /// Example of a value for the key, in words.
        how: &'static str,
    },
    /// The head motion, tracker or predictor cannot be built.
    #[error("{place}: {reason}")]
    Head {
        /// File and line, or the command line option.
        place: String,
        /// Expected value and value found, in words.
        reason: String,
    },
    /// A machine parameter and a key of the pipeline set the same number.
    #[error("{place}: {key} and {other} set the same numbers; leave one out")]
    Conflict {
        /// File and line, or the command line option.
        place: String,
        /// Path of the machine's parameter.
        key: String,
        /// Key of the pipeline that sets the same parameter, with its value.
        other: String,
    },
    /// No machine can be built from the settings.
    #[error("{place}: {error}")]
    Config {
        /// File and line, or the command line option. The text is "machine" if the error concerns the machine as a
        /// whole.
        place: String,
        /// Error of the machine's configuration.
        error: ConfigError,
    },
    /// The built-in scene does not exist.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The model file cannot be used.
    #[error("{0}")]
    Load(#[from] LoadError),
    /// A parameter of the head motion is out of range.
    #[error("motion: {0}")]
    Motion(#[from] RangeError),
}
