//! What can be wrong with an experiment file or a setting.

use pxpl5_machine::ConfigError;
use pxpl5_scene::{LoadError, RangeError, SceneError};
use thiserror::Error;

/// Why an experiment file or a setting was refused. Every message says where, what, what was expected, what was found.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FileError {
    /// The file cannot be read.
    #[error("{file}: expected a readable experiment file, found: {reason}")]
    Io {
        /// Path of the file, as it was given.
        file: String,
        /// What the operating system said.
        reason: String,
    },
    /// The text is not TOML.
    #[error("{place}: not TOML: {reason}")]
    Syntax {
        /// File and line, or option.
        place: String,
        /// What the parser said.
        reason: String,
    },
    /// There is no such key.
    #[error("{place}: there is no key `{found}`; did you mean `{nearest}`?")]
    UnknownKey {
        /// File and line, or option.
        place: String,
        /// The key that nobody knows, as it was written.
        found: String,
        /// The nearest valid one.
        nearest: String,
    },
    /// A value is of the wrong kind or out of range.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// File and line, or option.
        place: String,
        /// Path of the key that was set.
        key: String,
        /// What values the key takes, in words.
        expected: String,
        /// The value that was given, at most 60 characters of it.
        found: String,
    },
    /// A setting has no meaning for the pipeline that was chosen.
    #[error("{place}: {key} does not apply to the pipeline {pipeline}; leave it out (it is for {applies_to})")]
    NotApplicable {
        /// File and line, or option.
        place: String,
        /// Path of the key that was set.
        key: String,
        /// Name of the pipeline that was chosen.
        pipeline: &'static str,
        /// The pipelines that know it.
        applies_to: String,
    },
    /// A setting that must be given is missing.
    #[error("{key} is missing: give {how}")]
    Missing {
        /// Path of the key that nobody set.
        key: &'static str,
        /// How to give it.
        how: &'static str,
    },
    /// The head, its tracker or its predictor cannot be had.
    #[error("{place}: {reason}")]
    Head {
        /// File and line, or option.
        place: String,
        /// What was expected and what was found.
        reason: String,
    },
    /// Two settings say different things about the same.
    #[error("{place}: {key} and {other} set the same numbers; leave one out")]
    Conflict {
        /// File and line, or option.
        place: String,
        /// Path of the parameter that was set.
        key: String,
        /// The key of the pipeline that sets it too, with its value.
        other: String,
    },
    /// The machine or its numbers are impossible.
    #[error("{place}: {error}")]
    Config {
        /// File and line, or option; "machine" for the machine as a whole.
        place: String,
        /// What the machine says about it.
        error: ConfigError,
    },
    /// There is no such scene.
    #[error("{0}")]
    Scene(#[from] SceneError),
    /// The model file cannot be used.
    #[error("{0}")]
    Load(#[from] LoadError),
    /// The head motion is impossible.
    #[error("motion: {0}")]
    Motion(#[from] RangeError),
}
