//! When finished regions leave the renderers.

/// When the regions of a field are copied to the frame buffers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CopySchedule {
    /// All regions before the retrace.
    Whole,
    /// Top regions before the retrace, bottom regions right after it (the COPY optimisation).
    Split,
    /// All before the retrace, into the buffer that does not hold the last complete field of these lines; only a
    /// complete field is shown, otherwise that one again. (Beyond the prototype: named as future work in TR94.)
    Backup,
}

impl CopySchedule {
    /// Whether bottom regions are copied after the retrace.
    #[must_use]
    pub const fn is_split(self) -> bool {
        matches!(self, Self::Split)
    }
}
