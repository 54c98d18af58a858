//! Errors that occur when a parameter is read, set or checked.

use crate::parameters::{ParameterInfo, Value};
use thiserror::Error;

/// The reason why a parameter cannot be read or set, or why the model rejects its value.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ParameterError {
    /// No parameter has this name.
    #[error("there is no parameter `{name}`; expected one of {}", valid.join(", "))]
    Unknown {
        /// Requested name.
        name: String,
        /// Names of all parameters of the table, in the order of the fields.
        valid: Vec<&'static str>,
    },
    /// The value is not whole, but the field holds whole numbers.
    #[error("{name} must be a whole number, found {found}")]
    NotWhole {
        /// Field name of the parameter within its table.
        name: &'static str,
        /// Rejected value.
        found: Value,
    },
    /// A value lies outside the limits of the model.
    #[error("{name} must be {} to {}, found {found}", limits.0, limits.1)]
    OutOfLimits {
        /// Field name of the parameter within its table.
        name: &'static str,
        /// Smallest and largest value that the model can use.
        limits: (Value, Value),
        /// Rejected value.
        found: Value,
    },
}

impl ParameterError {
    /// Makes the error for a table that has no parameter called `name`. Tables that are written without the macro can
    /// also use this function.
    #[must_use]
    pub fn unknown(name: &str, infos: &[ParameterInfo]) -> Self {
        let valid = infos.iter().map(|info| info.name).collect();
        Self::Unknown { name: name.to_owned(), valid }
    }
}
