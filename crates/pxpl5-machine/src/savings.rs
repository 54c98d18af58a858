//! What a run does not compute because nothing would come of it.

use std::fmt;
use std::str::FromStr;

/// A saving that an experiment can give up (`Experiment::without`). None of them changes a time or a pixel that is
/// seen, which `tests/savings.rs` shows by doing without each; `cargo bench --bench savings` measures what they are worth.
///
/// What nobody looks at is one more saving: `Pixels` of the experiment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Saving {
    /// Boards sleep until something happens to them. Without it every processor polls its programs and the ring its
    /// arbiter at every edge of the boards' 40 MHz clock. (Renderers and frame buffers have nothing to poll: a SIMD array
    /// takes the same time whatever its data are, so the arrival of a command tells its end.)
    IdleBoards,
    /// The ring computes the end of a message at its grant. Without it every word slot of every channel is an event.
    Transfers,
    /// A region that no primitive touches is drawn once and kept for as long as its other commands stay the same, and triangles that
    /// firmware sends to regions which they do not touch (Slats) are left out of their pixels. Without it everything is drawn.
    EmptyRegions,
    /// Code that repeats with all it needs in the caches takes the clocks that were counted before (cycle level). Without it
    /// the i860s count every clock.
    RepeatedCode,
}

impl Saving {
    /// Every saving that an experiment can give up.
    pub const ALL: [Self; 4] = [Self::IdleBoards, Self::Transfers, Self::EmptyRegions, Self::RepeatedCode];

    /// The name by which the command knows it.
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

impl fmt::Display for Saving {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Saving {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        Self::ALL
            .into_iter()
            .find(|saving| saving.name() == text)
            .ok_or_else(|| format!("expected {}, found {text:?}", Self::ALL.map(Self::name).join(", ")))
    }
}
