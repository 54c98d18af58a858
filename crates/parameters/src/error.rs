//! Errors of reading, setting or checking a number.

use crate::{ParameterInfo, Value};
use thiserror::Error;

/// The reason why a parameter cannot be read or set, or why the model cannot use it.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ParameterError {
    /// No parameter has this name.
    #[error("there is no parameter `{name}`; expected one of {}", valid.join(", "))]
    Unknown {
        /// Requested name.
        name: String,
        /// Names of the table, in its order.
        valid: Vec<&'static str>,
    },
    /// A field of whole numbers cannot hold the value.
    #[error("{name} must be a whole number, found {found}")]
    NotWhole {
        /// Field name within its table.
        name: &'static str,
        /// Rejected value.
        found: Value,
    },
    /// A value lies outside the limits of the model.
    #[error("{name} must be {} to {}, found {found}", limits.0, limits.1)]
    OutOfLimits {
        /// Field name within its table.
        name: &'static str,
        /// Smallest and largest value that the model can use.
        limits: (Value, Value),
        /// Rejected value.
        found: Value,
    },
}

impl ParameterError {
    /// Makes the error of a table that lacks the name. Tables not made by the macro can use it too.
    #[must_use]
    pub fn unknown(name: &str, infos: &[ParameterInfo]) -> Self {
        let valid = infos.iter().map(|info| info.name).collect();
        Self::Unknown { name: name.to_owned(), valid }
    }
}
