use crate::parameters::{SettingError, Value};

/// A number type that a parameter of a table can have: `u64` or `f64`.
pub trait Number: Copy + Into<Value> {
    /// Converts a value to this number type. Returns `None` if the type is `u64` and the value is not a whole number.
    fn from_value(value: Value) -> Option<Self>;

    /// Sets the parameter called `name` to a value.
    ///
    /// # Errors
    ///
    /// Returns a [`SettingError`] if the parameter needs a whole number and the value is not whole.
    fn assign(&mut self, name: &'static str, value: Value) -> Result<(), SettingError> {
        *self = Self::from_value(value).ok_or(SettingError::not_whole(name, value))?;
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

/// Checks a number against its limits. This function is for numbers that belong to no table of parameters, or whose
/// limits depend on other numbers.
///
/// # Errors
///
/// Returns a [`SettingError`] if the number is outside `limits`, the smallest and largest allowed value.
pub fn check<N: Number>(name: &'static str, found: N, limits: (N, N)) -> Result<(), SettingError> {
    check_value(name, found.into(), (limits.0.into(), limits.1.into()))
}

/// Checks a [`Value`] against `limits`, the smallest and largest allowed value. If the limits are constants, the check
/// compiles to two comparisons.
#[doc(hidden)]
#[inline]
pub fn check_value(name: &'static str, found: Value, limits: (Value, Value)) -> Result<(), SettingError> {
    if limits.0 <= found && found <= limits.1 {
        return Ok(());
    }
    Err(SettingError::limits(name, limits, found))
}
