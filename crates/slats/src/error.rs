//! Errors of the Slats configuration.

use thiserror::Error;

/// The reason why Slats cannot run on a machine.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum SlatsConfigError {
    /// The number of contexts of all renderers is less than the number of regions.
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
