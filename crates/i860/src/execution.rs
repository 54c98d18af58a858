//! The executed part of a basic block.

/// The executed part of a basic block, and the end of its execution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Execution {
    /// Number of instructions or pairs that were executed, without the delay slot.
    pub(crate) units: usize,
    pub(crate) slot: bool,
    /// True if the branch at the end of the block was taken.
    pub(crate) taken: bool,
    pub(crate) trapped: bool,
}
