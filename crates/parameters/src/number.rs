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
    check_value(name, found.into(), (limits.0.into(), limits.1.into()))
}

/// The same of a value. Where the limits are constants it is two comparisons.
#[doc(hidden)]
#[inline]
pub fn check_value(name: &'static str, found: Value, limits: (Value, Value)) -> Result<(), ParameterError> {
    if limits.0 <= found && found <= limits.1 {
        return Ok(());
    }
    Err(ParameterError::OutOfLimits { name, limits, found })
}
