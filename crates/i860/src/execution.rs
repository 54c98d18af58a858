//! The executed part of a basic block.

/// The executed part of a basic block, including its delay slot and the outcome of its branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Execution {
    /// Number of instructions or pairs that were executed, without the delay slot.
    pub(crate) units: usize,
    pub(crate) slot: bool,
    pub(crate) taken: bool,
    pub(crate) trapped: bool,
}
