//! When finished regions leave the renderers.

/// When the regions of a field are copied to the frame buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CopySchedule {
    /// All regions before the retrace.
    Whole,
    /// Top regions before the retrace, bottom regions right after it (the COPY optimisation).
    Split,
    /// Top regions, then bottom regions, into the buffer that does not hold the last complete field of these lines. A field is shown at its
    /// retrace if its top regions are there, else that one again, and the late field at the next retrace of its lines. (Beyond the
    /// prototype: TR94 names a backup field as future work, filled by spare bandwidth of the frame buffers. Two buffers that take
    /// turns need no copy, since the last complete field stays where it was written.)
    Backup,
}

impl CopySchedule {
    /// Returns true if bottom regions are copied after all top ones.
    #[must_use]
    pub const fn is_split(self) -> bool {
        matches!(self, Self::Split | Self::Backup)
    }
}
