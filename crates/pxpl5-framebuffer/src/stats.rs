//! What a frame buffer has done.

/// Counts since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct FrameBufferStats {
    /// Fields whose scan has begun so far.
    pub fields: u64,
    /// Messages of pixels received.
    pub messages: u64,
    /// Regions received as a whole.
    pub regions: u64,
    /// Swap requests that took effect.
    pub swaps: u64,
    /// Lines of regions that a region of the same place has overwritten before the beam had shown them from the first pixel
    /// to the last: the newer one came too early, or the older one too late to be shown at all, or its buffer was shown for
    /// one field only, which scans every second line.
    pub lines_never_shown: u64,
}
