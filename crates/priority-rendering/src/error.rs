//! What can be wrong with what a user hands in.

use thiserror::Error;

/// A number that the policies cannot use: its key, what was expected and what was found.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[error("{0}")]
pub struct PriorityError(
    /// Key, expected and found, for people.
    pub String,
);
