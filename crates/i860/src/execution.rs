//! The part of a basic block that was executed.

/// The part of a basic block that was executed, and the way in which the execution ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Execution {
    /// Number of instructions or pairs that were executed, without the delay slot.
    pub(crate) units: usize,
    pub(crate) slot: bool,
    /// True if the branch at the end of the block was taken.
    pub(crate) taken: bool,
    pub(crate) trapped: bool,
}
