//! What a stretch may say of its schedule.

/// How a stretch is scheduled.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// Lines from the first one that has not issued that may issue.
    pub(super) window: usize,
    /// How much more urgent an operation must be than what a drain would bring out.
    pub(super) eagerness: u32,
    /// Registers of either file that only the first line which has not issued may take.
    pub(super) reserve: usize,
    /// Registers more for each 64 lines behind that one, so that what is far ahead waits when they run short.
    pub(super) slope: usize,
    /// Start of a sequence that shakes the priorities; 0 leaves them.
    pub(super) shake: u32,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { window: 40, eagerness: 20, reserve: 2, slope: 10, shake: 0 }
    }
}
