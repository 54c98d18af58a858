//! What a frame buffer has done.

/// Counts since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct FrameBufferStats {
    /// Fields begun.
    pub fields: u64,
    /// Messages of pixels received.
    pub messages: u64,
    /// Regions received as a whole.
    pub regions: u64,
    /// Swap requests that took effect.
    pub swaps: u64,
}
