//! Where control goes.

/// How control goes on after a unit (an instruction or a pair).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    /// To the instruction that follows in memory.
    Next,
    /// There too, but it may have been stored to.
    NextOfChangedCode,
    /// To a target, at once.
    Jump(u32),
    /// To a target, after the next unit.
    Delayed(u32),
    /// To what follows the next unit.
    Skip,
    /// To a trap, whose cause is noted.
    Trapped,
}
