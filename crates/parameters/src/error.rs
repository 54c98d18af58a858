//! What can go wrong when a number is read, set or checked.

use crate::{ParameterInfo, Value};
use thiserror::Error;

/// A parameter that could not be read or set, or that the model cannot take.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ParameterError {
    /// No parameter has this name.
    #[error("there is no parameter `{name}`; expected one of {}", valid.join(", "))]
    Unknown {
        /// The name that was asked for.
        name: String,
        /// The names of the table, in its order.
        valid: Vec<&'static str>,
    },
    /// A field of whole numbers was given something else.
    #[error("{name} must be a whole number, found {found}")]
    NotWhole {
        /// Field name within its table.
        name: &'static str,
        /// What it was to become.
        found: Value,
    },
    /// A value lies beyond the limits of the model.
    #[error("{name} must be {} to {}, found {found}", limits.0, limits.1)]
    OutOfLimits {
        /// Field name within its table.
        name: &'static str,
        /// Smallest and largest value that the model can take.
        limits: (Value, Value),
        /// The value that the field has.
        found: Value,
    },
}

impl ParameterError {
    /// The error of a table that has no such name, for tables not made by the macro too.
    #[must_use]
    pub fn unknown(name: &str, infos: &[ParameterInfo]) -> Self {
        let valid = infos.iter().map(|info| info.name).collect();
        Self::Unknown { name: name.to_owned(), valid }
    }
}
