//! An outcome as the few numbers that every level of modelling gives.

use pxpl5_run::{Outcome, Summary};

/// The numbers of an outcome over the pictures in the window.
#[must_use]
pub fn summary(outcome: &Outcome) -> Summary {
    outcome.summary()
}
