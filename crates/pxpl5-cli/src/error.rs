//! Errors that end a command, with their exit codes.

use pxpl5::{ExperimentError, FileError, FileErrorKind, SettingError, SettingErrorKind, StudyError};
use std::fmt::{self, Display};

/// Exit code for a wrong command line or a wrong file.
const USAGE: u8 = 2;
/// Exit code of a valid command that could not finish its work.
const FAILURE: u8 = 1;

/// Exit code of a command that was ended by Ctrl-C: 128 plus the number of the signal, as in shells.
pub(crate) const INTERRUPTED: u8 = 130;

/// Exit code if another process is writing into the folder (`EX_TEMPFAIL` of sysexits.h). The same command may succeed
/// later.
pub(crate) const BUSY: u8 = 75;

/// An error that ends a command.
#[derive(Debug)]
pub struct CliError {
    code: u8,
    message: String,
}

impl CliError {
    pub(crate) fn failure(message: impl Display) -> Self {
        Self { code: FAILURE, message: message.to_string() }
    }

    pub(crate) fn interrupted(message: impl Display) -> Self {
        Self { code: INTERRUPTED, message: message.to_string() }
    }

    pub(crate) fn usage(message: impl Display) -> Self {
        Self { code: USAGE, message: message.to_string() }
    }

    pub(crate) fn message(&self) -> &str {
        &self.message
    }

    /// Returns the exit code of the command: 1 for a failure, 2 for a wrong command line or a wrong file.
    pub const fn exit_code(&self) -> u8 {
        self.code
    }
}

impl fmt::Display for CliError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

impl std::error::Error for CliError {}

impl From<SettingError> for CliError {
    fn from(error: SettingError) -> Self {
        let code = match error.kind {
            SettingErrorKind::File(kind) => code_of(kind),
            _ => USAGE,
        };
        Self { code, message: error.to_string() }
    }
}

impl From<FileError> for CliError {
    fn from(error: FileError) -> Self {
        let message = match error.kind {
            FileErrorKind::Unfinished => format!("{error} (--resume)"),
            _ => error.to_string(),
        };
        Self { code: code_of(error.kind), message }
    }
}

const fn code_of(kind: FileErrorKind) -> u8 {
    match kind {
        FileErrorKind::Locked => BUSY,
        FileErrorKind::Unwritable => FAILURE,
        // The user can give another file or choose another folder.
        _ => USAGE,
    }
}

impl From<StudyError> for CliError {
    fn from(error: StudyError) -> Self {
        match error {
            StudyError::Setting(error) => error.into(),
            StudyError::File(error) => error.into(),
            StudyError::Experiment(error) => error.into(),
            _ => Self::failure(error),
        }
    }
}

impl From<ExperimentError> for CliError {
    fn from(error: ExperimentError) -> Self {
        match &error {
            ExperimentError::Config(_)
            | ExperimentError::Recording(_)
            | ExperimentError::Level
            | ExperimentError::Scene(_) => Self::usage(error),
            ExperimentError::Run { .. } => Self::failure(format!("{error}; nothing was written. {}", advice(&error))),
            _ => Self::failure(error),
        }
    }
}

fn advice(error: &ExperimentError) -> &'static str {
    let text = error.to_string();
    if text.contains("bytes") {
        "Give the machine more GPs (--gps), or draw fewer primitives (--triangles)"
    } else {
        "The same command with fewer --fields shows the pictures until then"
    }
}

/// Prints help, version or a command line error, and returns the exit code.
pub(crate) fn usage(error: &clap::Error) -> u8 {
    // A closed pipe (`| head`) is not an error.
    let _ = error.print();
    u8::try_from(error.exit_code()).unwrap_or(USAGE)
}
