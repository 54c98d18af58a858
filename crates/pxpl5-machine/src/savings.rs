//! Optimizations of the simulator that change no result.

/// An optimization of the simulator. An experiment can disable each one (`Experiment::without`).
///
/// No optimization changes a time or a visible pixel: `tests/savings.rs` repeats runs with each one disabled. `cargo
/// bench --bench savings` measures the speed-ups.
///
/// Unread pixels are skipped by a separate setting, `Pixels` of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Optimization {
    /// Boards sleep until their next event.
    ///
    /// If disabled, every processor polls its programs and the ring polls its arbiter at every edge of the boards' 40
    /// MHz clock. Renderers and frame buffers never poll. The duration of a renderer's command does not depend on data,
    /// so the end of the command is known when the command arrives.
    IdleBoards,
    /// The ring computes the end of a message when it grants the channel. If disabled, every word on every channel
    /// causes an event.
    Transfers,
    /// A region without primitives is drawn once. Its pixels are reused while the region's other commands stay the
    /// same.
    ///
    /// Firmware of Slats also sends triangles to regions that they do not touch. Such triangles are skipped when pixels
    /// are computed. If disabled, every region and triangle is drawn.
    EmptyRegions,
    /// Repeated code whose instructions and data are all in the caches takes the clocks counted at an earlier execution
    /// (cycle level).
    ///
    /// If disabled, the i860s count every clock.
    RepeatedCode,
}

impl Optimization {
    /// All optimizations that an experiment can disable.
    pub const ALL: [Self; 4] = [Self::IdleBoards, Self::Transfers, Self::EmptyRegions, Self::RepeatedCode];

    /// Returns the name used on the command line.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::IdleBoards => "idle-boards",
            Self::Transfers => "transfers",
            Self::EmptyRegions => "empty-regions",
            Self::RepeatedCode => "repeated-code",
        }
    }
}

pxpl5_sim::parameters::named!(Optimization, "optimization", Optimization::ALL.map(|one| (one.name(), one)));
