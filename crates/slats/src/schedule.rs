//! Schedules for copying finished regions.

/// Time at which the regions of a field are copied to the frame buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CopySchedule {
    /// Copies all regions before the retrace.
    Whole,
    /// Copies the top regions before the retrace and the bottom regions right after it (the COPY optimization).
    Split,
    /// Copies top regions, then bottom regions, into the buffer that does not hold the last complete field of these
    /// lines.
    ///
    /// A field is shown at its retrace if its top regions are ready. Otherwise the last complete field is shown again,
    /// and the late field appears at the next retrace of its lines.
    ///
    /// This schedule is not in the prototype. TR94 names a backup field, filled by spare bandwidth of the frame
    /// buffers, as future work. Two alternating buffers need no such copy, since the last complete field stays in
    /// place.
    Backup,
}

impl CopySchedule {
    /// Returns true if bottom regions are copied after all top regions.
    #[must_use]
    pub const fn is_split(self) -> bool {
        matches!(self, Self::Split | Self::Backup)
    }
}
