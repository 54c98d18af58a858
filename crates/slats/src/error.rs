//! Errors of the Slats configuration.

use thiserror::Error;

/// The error for a machine on which Slats cannot run.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SlatsConfigError {
    /// The renderers have fewer contexts than there are regions.
    #[error(
        "Slats binds 20 field regions statically: expected at least {expected} renderers of four contexts, found {found}"
    )]
    TooFewRenderers {
        /// Number of renderers of the machine.
        found: usize,
        /// Smallest number of renderers whose contexts hold the 20 regions of both eyes.
        expected: usize,
    },
    /// There is no graphics processor.
    #[error("Slats needs at least one graphics processor, found none")]
    NoProcessor,
}
