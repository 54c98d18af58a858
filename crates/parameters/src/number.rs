//! The types that a number can have in code, and the check of one by its limits.

use crate::{ParameterError, Value};

/// A type that a field of a table can have.
pub trait Number: Copy + Into<Value> {
    /// The value in this type; `None` where a whole number is wanted and it is none.
    fn from_value(value: Value) -> Option<Self>;

    /// Gives the field of that name a value.
    ///
    /// # Errors
    ///
    /// [`ParameterError::NotWhole`] where a whole number is wanted and it is none.
    fn assign(&mut self, name: &'static str, value: Value) -> Result<(), ParameterError> {
        *self = Self::from_value(value).ok_or(ParameterError::NotWhole { name, found: value })?;
        Ok(())
    }
}

impl Number for u64 {
    fn from_value(value: Value) -> Option<Self> {
        value.whole()
    }
}

impl Number for f64 {
    fn from_value(value: Value) -> Option<Self> {
        Some(value.real())
    }
}

/// Checks a number that stands in no table, or whose limits follow from others, as a table checks its own.
///
/// # Errors
///
/// [`ParameterError::OutOfLimits`] if it is beyond the limits, which are the smallest and the largest value allowed.
pub fn check<N: Number>(name: &'static str, found: N, limits: (N, N)) -> Result<(), ParameterError> {
    let limits = (limits.0.into(), limits.1.into());
    let found = found.into();
    if (limits.0..=limits.1).contains(&found) {
        return Ok(());
    }
    Err(ParameterError::OutOfLimits { name, limits, found })
}
