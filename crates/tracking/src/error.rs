//! What a user can get wrong in a configuration.

use parameters::ParameterError;
use thiserror::Error;

/// A setting that no machine could have.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum SettingError {
    /// A number of the tables is not finite or out of range.
    #[error(transparent)]
    Parameter(#[from] ParameterError),
    /// A number that stands in no table is not finite or out of range.
    #[error("{what}: expected {low} to {high}, found {found}")]
    OutOfRange {
        /// Which setting.
        what: &'static str,
        /// What was given.
        found: f64,
        /// Least allowed value.
        low: f64,
        /// Greatest allowed value.
        high: f64,
    },
    /// Two settings contradict each other.
    #[error("settings contradict each other: {what}")]
    Contradiction {
        /// Which settings, and how they contradict.
        what: &'static str,
    },
}

impl SettingError {
    /// `found` if it is within [low, high], which NaN never is.
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
