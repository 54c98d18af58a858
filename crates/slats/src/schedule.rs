/// The order and the time of the copies of a field's regions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CopySchedule {
    /// All regions are copied before the retrace.
    Whole,
    /// The top regions are copied before the retrace, and the bottom regions right after the retrace.
    Split,
    /// The top regions are copied first, then the bottom regions, into a second buffer.
    ///
    /// If the top regions are late, the display shows the last complete field of the same lines again. The late field
    /// appears at the next retrace of its lines.
    ///
    /// This schedule is not in the prototype. TR94 proposes to copy a backup field as future work. With two buffers in
    /// turn no such copy is needed, because the last complete field stays in its buffer.
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
