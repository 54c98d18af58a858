//! What was executed of a block.

/// How much of a block was executed, and how it ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Execution {
    /// Units executed, not counting the slot.
    pub(crate) units: usize,
    /// Whether the slot was executed.
    pub(crate) slot: bool,
    /// Whether the branch at the end was taken.
    pub(crate) taken: bool,
    /// Whether the last of these units trapped.
    pub(crate) trapped: bool,
}
