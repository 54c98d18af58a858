//! The result of a policy: the memories to draw in one frame.

/// The memories that a frame draws, and the memories that must become visible together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Update {
    /// Flag of each memory: true if the frame draws it.
    pub due: Vec<bool>,
    /// Flag of each memory: true if this memory exchanged content with another memory. All such memories must become
    /// visible together.
    pub together: Vec<bool>,
    /// True if cells (squares of the floor) were assigned to memories anew, around a new home cell.
    pub reassigns_cells: bool,
}

impl Update {
    /// Returns the indices of the memories to draw, most urgent first.
    pub fn memories(&self) -> impl Iterator<Item = usize> {
        self.due.iter().enumerate().filter(|(_, due)| **due).map(|(memory, _)| memory)
    }

    /// Returns the memories that swap together as a bit mask for the display. Bit k stands for memory k.
    pub fn together_bits(&self) -> u8 {
        (0..).zip(&self.together).map(|(memory, together)| u8::from(*together) << memory).sum()
    }
}
