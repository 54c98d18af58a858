//! Schedules for copying finished regions.

/// Copy schedule: when the regions of a field are copied to the frame buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CopySchedule {
    /// Copies all regions before the retrace.
    Whole,
    /// Copies the top regions before the retrace and the bottom regions right after the retrace (the COPY
    /// optimization).
    Split,
    /// Copies top regions, then bottom regions. The regions go into the buffer that does not hold the last complete
    /// field of the same lines.
    ///
    /// A field is shown at its retrace if its top regions are ready. Otherwise the last complete field is shown again,
    /// and the late field appears at the next retrace of its lines.
    ///
    /// This schedule is not in the prototype. TR94 proposes a backup field as future work, with a copy that uses the
    /// spare bandwidth of the frame buffers. With two alternating buffers no such copy is needed, because the last
    /// complete field stays in its buffer.
    Backup,
}

pxpl5_sim::parameters::named!(CopySchedule, "copy schedule", CopySchedule::ALL);

impl CopySchedule {
    /// All schedules with their names in experiment files.
    pub const ALL: [(&str, Self); 3] = [("whole", Self::Whole), ("split", Self::Split), ("backup", Self::Backup)];

    /// Returns true if the bottom regions are copied later than all top regions.
    #[must_use]
    pub const fn is_split(self) -> bool {
        matches!(self, Self::Split | Self::Backup)
    }
}
