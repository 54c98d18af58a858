//! What is wrong with a source.

/// A fault in the source.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{file}:{line}: {reason}")]
pub struct AssemblyError {
    /// File name as given.
    pub file: String,
    /// Line from 1; of the call, for text from a macro.
    pub line: usize,
    /// What is wrong: expected and found.
    pub reason: String,
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
