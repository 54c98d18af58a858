//! Structures: groups of primitives that move together.

use pxpl5_geometry::Culling;
use std::ops::Range;

/// Frame of reference of a structure's coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelFrame {
    /// The room, in which the viewer moves.
    World,
    /// The viewer's head. The structure moves with the head.
    Head,
}

/// Consecutive primitives with a common model matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayStructure {
    /// Range of the structure's triangles in the display list.
    pub triangles: Range<usize>,
    /// Range of the structure's spheres in the display list.
    pub spheres: Range<usize>,
    /// Frame of reference: the room or the viewer's head.
    pub frame: ModelFrame,
    /// Culling mode of the structure's triangles. PHIGS+ sets this mode for each structure.
    pub culling: Culling,
}
