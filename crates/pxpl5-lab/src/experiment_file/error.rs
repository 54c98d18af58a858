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
        /// Path as given.
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
        /// The key.
        found: String,
        /// The nearest valid one.
        nearest: String,
    },
    /// A value is of the wrong kind or out of range.
    #[error("{place}: {key}: expected {expected}, found {found}")]
    Value {
        /// File and line, or option.
        place: String,
        /// The key.
        key: String,
        /// What it takes.
        expected: String,
        /// What was given.
        found: String,
    },
    /// A setting has no meaning for the pipeline that was chosen.
    #[error("{place}: {key} does not apply to the pipeline {pipeline}; leave it out (it is for {applies_to})")]
    NotApplicable {
        /// File and line, or option.
        place: String,
        /// The key.
        key: String,
        /// The pipeline chosen.
        pipeline: &'static str,
        /// The pipelines that know it.
        applies_to: String,
    },
    /// A setting that must be given is missing.
    #[error("{key} is missing: give {how}")]
    Missing {
        /// The key.
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
        /// One key.
        key: String,
        /// The other one.
        other: String,
    },
    /// The machine or its numbers are impossible.
    #[error("{place}: {error}")]
    Config {
        /// File and line, or option; "machine" for the machine as a whole.
        place: String,
        /// Why.
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
