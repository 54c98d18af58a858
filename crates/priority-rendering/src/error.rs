//! Error of the policies.

use thiserror::Error;

/// A parameter or scene that the policies cannot use.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct PriorityError(
    /// Text with the parameter, the expected and the found value.
    pub String,
);
