//! The result of a policy for one frame.

/// The memories that a frame draws, and the memories that must be shown together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Update {
    /// Flag for each memory: true if it is drawn.
    pub due: Vec<bool>,
    /// Flag for each memory: true if it exchanged content, so that it must be shown together with the other such
    /// memories.
    pub together: Vec<bool>,
    /// True if cells were assigned anew around another home cell.
    pub deals_anew: bool,
}

impl Update {
    /// Returns the memories to draw, most urgent first.
    pub fn memories(&self) -> impl Iterator<Item = usize> {
        self.due.iter().enumerate().filter(|(_, due)| **due).map(|(memory, _)| memory)
    }

    /// Returns the memories that swap together as a bit mask for the display, with bit k for memory k.
    #[must_use]
    pub fn together_bits(&self) -> u8 {
        (0..).zip(&self.together).map(|(memory, together)| u8::from(*together) << memory).sum()
    }
}
