//! Errors in the settings of head motion, trackers and predictors.

use pxpl5_sim::parameters::ParameterError;
use thiserror::Error;

/// An error for a setting out of range or for settings that contradict each other.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SettingError {
    /// A number of a parameter table is not finite or is out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A number outside the parameter tables is not finite or is out of range.
    #[error("{what}: expected {low} to {high}, found {found}")]
    OutOfRange {
        /// Description of the setting that is out of range.
        what: &'static str,
        /// The value that was given.
        found: f64,
        /// Least allowed value.
        low: f64,
        /// Greatest allowed value.
        high: f64,
    },
    /// Two settings contradict each other.
    #[error("settings contradict each other: {what}")]
    Contradiction {
        /// Description of both settings and of their contradiction.
        what: &'static str,
    },
}

impl SettingError {
    /// Returns an error unless `found` lies within `low..=high`. NaN is always an error.
    pub(crate) fn check(what: &'static str, found: f64, low: f64, high: f64) -> Result<(), Self> {
        if (low..=high).contains(&found) {
            return Ok(());
        }
        Err(Self::OutOfRange { what, found, low, high })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_says_what_was_expected_and_found() {
        let error = SettingError::check("line rate", f64::NAN, 300.0, 115_200.0).unwrap_err();
        assert_eq!(error.to_string(), "line rate: expected 300 to 115200, found NaN");
    }
}
