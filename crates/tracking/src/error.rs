//! What a user can get wrong in a configuration.

use core::fmt;

/// A setting that no machine could have.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum ConfigError {
    /// A number is not finite or out of range.
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
    Contradiction {
        /// Which settings, and how they contradict.
        what: &'static str,
    },
}

impl ConfigError {
    /// `found` if it is within [low, high], which NaN never is.
    pub(crate) fn check(what: &'static str, found: f64, low: f64, high: f64) -> Result<(), Self> {
        if (low..=high).contains(&found) {
            return Ok(());
        }
        Err(Self::OutOfRange { what, found, low, high })
    }
}

impl fmt::Display for ConfigError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutOfRange { what, found, low, high } => {
                write!(f, "{what}: expected {low} to {high}, found {found}")
            }
            Self::Contradiction { what } => write!(f, "settings contradict each other: {what}"),
        }
    }
}

impl std::error::Error for ConfigError {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_message_says_what_was_expected_and_found() {
        let error = ConfigError::check("line rate", f64::NAN, 300.0, 115_200.0).unwrap_err();
        assert_eq!(error.to_string(), "line rate: expected 300 to 115200, found NaN");
    }
}
