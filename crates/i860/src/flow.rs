//! Control flow after an instruction or pair.

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Flow {
    Next,
    /// Continue with the next instruction in memory, which a store may have changed.
    NextOfChangedCode,
    /// Jump to the target address immediately.
    Jump(u32),
    /// Jump to the target address after the delay slot.
    Delayed(u32),
    /// Skip one instruction or pair, which is the delay slot of a branch that is not taken.
    Skip,
    Trapped,
}
