//! Counts of events in a frame buffer.

/// Counts of a frame buffer since the start of the run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
pub struct FrameBufferStats {
    /// Number of fields whose scan has begun so far.
    pub fields: u64,
    /// Number of received messages of pixels.
    pub messages: u64,
    /// Number of regions for which all messages were received.
    pub regions: u64,
    /// Number of swap requests that took effect.
    pub swaps: u64,
    /// Number of lines that a newer region overwrote before the beam had shown all of their pixels. The newer region
    /// can arrive too early, or the older region too late. A third cause is a buffer that was shown for only one field,
    /// which scans every second line.
    pub lines_never_shown: u64,
}
