//! What is wrong with a source.

use super::check::Rule;
use std::fmt;

/// A fault in the source.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {reason}")]
pub struct AssemblyError {
    /// File name as given.
    pub file: String,
    /// Line from 1; of the call, for text from a macro.
    pub line: usize,
    /// The fault, with the expected and the found text.
    pub reason: String,
}

/// A rule that a source breaks, which may be what its writer wants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssemblyWarning {
    /// File name as given.
    pub file: String,
    /// Line from 1; of the call, for text from a macro.
    pub line: usize,
    /// The rule.
    pub rule: Rule,
    /// The fault, with the expected and the found text.
    pub reason: String,
}

impl fmt::Display for AssemblyWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {} [{}]", self.file, self.line, self.reason, self.rule.name())
    }
}

/// All faults of a source, in the order of its lines.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", lines(.0))]
pub struct AssemblyErrors(
    /// In the order of their lines; there is at least one.
    pub Vec<AssemblyError>,
);

fn lines(errors: &[AssemblyError]) -> String {
    errors.iter().map(AssemblyError::to_string).collect::<Vec<_>>().join("\n")
}
