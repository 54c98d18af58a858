/// A shortcut of the simulator that an experiment can disable (`Experiment::without`).
///
/// No optimization changes a time or a visible pixel. The test `tests/optimizations.rs` repeats runs with each
/// optimization disabled. `cargo bench -p pxpl5-benches --bench optimizations` measures the speed-ups.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Optimization {
    /// Boards sleep until their next event.
    ///
    /// If disabled, every processor and the arbiter of the ring check for work at every edge of the boards' 40 MHz
    /// clock. Renderers and frame buffers always sleep, because the end of a command is known when the command arrives.
    IdleBoards,
    /// The ring computes the end of a message when the message starts. If disabled, every word on every channel is an
    /// event.
    Transfers,
    /// The pixels of regions without primitives are computed once and reused.
    ///
    /// Slats also sends triangles to regions that they do not touch, and these are skipped too. If disabled, the pixels
    /// of every region and triangle are computed.
    EmptyRegions,
    /// At the cycle level, the clocks of repeated code are reused if all its instructions and data are in the caches.
    ///
    /// If disabled, the i860s count every clock.
    RepeatedCode,
}

impl Optimization {
    /// All optimizations that an experiment can disable.
    pub const ALL: [Self; 4] = [Self::IdleBoards, Self::Transfers, Self::EmptyRegions, Self::RepeatedCode];

    /// Returns the name used on the command line.
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
