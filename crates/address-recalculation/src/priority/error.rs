//! Error of the policies.

use thiserror::Error;

/// The error for a parameter or a scene that the policies cannot use.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct PriorityError(
    /// Message with the name of the parameter, its expected and its found value.
    pub String,
);
