//! Summary of an outcome: the numbers that every level of modelling gives.

use pxpl5_run::{Outcome, Summary};

/// Returns the summary of an outcome over the pictures in the result window.
#[must_use]
pub fn summary(outcome: &Outcome) -> Summary {
    outcome.summary()
}
