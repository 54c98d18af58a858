//! Parameters of the scheduler for one linear stretch, the straight-line code from `.linear` to `.endlinear`.

#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// Number of lines from which the scheduler chooses the next operation, counted from the first unissued line.
    pub(super) window: usize,
    /// Threshold in clocks. A pipe is drained if one of its values is more urgent than the best operation by more than
    /// this number.
    pub(super) eagerness: u32,
    /// Number of registers in each register file that only the first unissued line can use.
    pub(super) reserve: usize,
    /// Number of registers that are additionally reserved for each 64 lines of distance from the first unissued line.
    /// Distant lines then wait if few registers are free.
    pub(super) slope: usize,
    /// Seed of random changes of the priorities of operations. With 0, the priorities stay unchanged.
    pub(super) shake: u32,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { window: 40, eagerness: 20, reserve: 2, slope: 10, shake: 0 }
    }
}
