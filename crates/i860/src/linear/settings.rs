//! Parameters of a linear stretch.

/// Parameters of the scheduler.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// Number of lines, from the first one that has not issued, that may issue.
    pub(super) window: usize,
    /// Threshold in clocks. The scheduler drains a pipe if a value in it is more urgent than the best operation by more
    /// than this.
    pub(super) eagerness: u32,
    /// Registers of each file that only the first unissued line may take.
    pub(super) reserve: usize,
    /// Additional reserved registers for each 64 lines of distance from the first unissued line, so that distant lines
    /// wait when registers are scarce.
    pub(super) slope: usize,
    /// Seed of random changes of the priorities; 0 for none.
    pub(super) shake: u32,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { window: 40, eagerness: 20, reserve: 2, slope: 10, shake: 0 }
    }
}
