//! What is drawn in a frame.

/// The memories that a frame draws, in rising order of their numbers, and those that must be shown together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Update {
    /// Whether each memory is drawn.
    pub due: Vec<bool>,
    /// Whether each memory gave or took something, so that it may only be shown together with the others that did.
    pub together: Vec<bool>,
    /// Whether cells were dealt anew around another home.
    pub deals_anew: bool,
}

impl Update {
    /// The memories that are drawn, the most urgent first.
    pub fn memories(&self) -> impl Iterator<Item = usize> {
        self.due.iter().enumerate().filter(|(_, due)| **due).map(|(memory, _)| memory)
    }

    /// The memories that swap together, bit k for memory k, as the display takes it.
    #[must_use]
    pub fn together_bits(&self) -> u8 {
        (0..).zip(&self.together).map(|(memory, together)| u8::from(*together) << memory).sum()
    }
}
