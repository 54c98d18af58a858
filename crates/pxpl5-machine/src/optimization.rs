//! Optimizations of the simulator that change no result.

/// An optimization of the simulator. An experiment can disable each optimization (`Experiment::without`).
///
/// No optimization changes a time or a visible pixel. The test `tests/optimizations.rs` repeats runs with each optimization
/// disabled. `cargo bench --bench optimizations` measures the speed-ups.
///
/// A separate setting of the experiment, `Pixels`, skips the computation of pixels that no reader needs.
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
    /// The pixels of a region without primitives are computed once. These pixels are reused while the commands of such
    /// a region stay the same.
    ///
    /// The firmware of Slats also sends triangles to regions that the triangles do not touch. The computation of pixels
    /// skips these triangles. If disabled, the pixels of every region and triangle are computed.
    EmptyRegions,
    /// At the cycle level, the clocks of repeated code are reused from an earlier execution. The reuse requires that
    /// all instructions and data of the code are in the caches.
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
