//! Errors and warnings of the assembler.

use super::check::Rule;
use std::fmt;

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}{line}: {reason}", if file.is_empty() { "line ".to_owned() } else { format!("{file}:") })]
pub struct AssemblyError {
    /// File name that was passed to [`assemble`](crate::assemble). Empty for code of [`linear`](crate::linear).
    pub file: String,
    /// Line number, counted from 1. For text from a macro, this is the line of the macro call.
    pub line: usize,
    /// Description of the error, with the expected and the found text.
    pub reason: String,
}

impl AssemblyError {
    /// Creates an error for line `line` of a source text that has no file name.
    pub(crate) const fn in_line(line: usize, reason: String) -> Self {
        Self { file: String::new(), line, reason }
    }
}

/// A warning that the program breaks a [`Rule`].
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AssemblyWarning {
    /// File name that was passed to [`assemble`](crate::assemble).
    pub file: String,
    /// Line number, counted from 1. For text from a macro, this is the line of the macro call.
    pub line: usize,
    pub rule: Rule,
    /// Description of the warning, with the expected and the found text.
    pub reason: String,
}

impl fmt::Display for AssemblyWarning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}: {} [{}]", self.file, self.line, self.reason, self.rule.name())
    }
}

#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", lines(.0))]
pub struct AssemblyErrors(
    /// Errors sorted by source line. There is at least one error.
    pub Vec<AssemblyError>,
);

fn lines(errors: &[AssemblyError]) -> String {
    errors.iter().map(AssemblyError::to_string).collect::<Vec<_>>().join("\n")
}
