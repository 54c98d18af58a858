//! Types of numbers in code, and the check against limits.

use crate::{ParameterError, Value};

/// A type that a field of a table can have.
pub trait Number: Copy + Into<Value> {
    /// Converts a value to this type; `None` if a whole number is required and the value is not whole.
    fn from_value(value: Value) -> Option<Self>;

    /// Assigns a value to the field `name`.
    ///
    /// # Errors
    ///
    /// [`ParameterError::NotWhole`] if a whole number is required and the value is not whole.
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

/// Checks a number that is in no table, or whose limits depend on other numbers, as a table checks its own numbers.
///
/// # Errors
///
/// [`ParameterError::OutOfLimits`] if the number is outside `limits`, the smallest and largest allowed value.
pub fn check<N: Number>(name: &'static str, found: N, limits: (N, N)) -> Result<(), ParameterError> {
    check_value(name, found.into(), (limits.0.into(), limits.1.into()))
}

/// Checks a [`Value`] against its limits. With constant limits this takes two comparisons.
#[doc(hidden)]
#[inline]
pub fn check_value(name: &'static str, found: Value, limits: (Value, Value)) -> Result<(), ParameterError> {
    if limits.0 <= found && found <= limits.1 {
        return Ok(());
    }
    Err(ParameterError::OutOfLimits { name, limits, found })
}
