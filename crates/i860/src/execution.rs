//! The executed part of a basic block.

/// The executed part of a block, and how it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Execution {
    /// Number of executed instructions or pairs, without the delay slot.
    pub(crate) units: usize,
    /// True if the slot was executed.
    pub(crate) slot: bool,
    /// True if the branch at the end was taken.
    pub(crate) taken: bool,
    /// True if the last executed instruction or pair trapped.
    pub(crate) trapped: bool,
}
