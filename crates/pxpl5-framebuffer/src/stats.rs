//! Statistics of a frame buffer.

/// Counts of a frame buffer since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct FrameBufferStats {
    /// Number of fields whose scan has begun.
    pub fields: u64,
    /// Number of received messages of pixels.
    pub messages: u64,
    /// Number of completely received regions.
    pub regions: u64,
    /// Number of swap requests that took effect.
    pub swaps: u64,
    /// Number of lines of regions that were overwritten before the beam had shown them from the first pixel to the
    /// last.
    /// There are three causes: the newer region came too early, the older one came too late, or the buffer was shown
    /// for one field only, which scans every second line.
    pub lines_never_shown: u64,
}
