//! Structures: primitives that move together.

use pxpl5_geometry::Culling;
use std::ops::Range;

/// What the coordinates of a structure are fixed to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelFrame {
    /// The room in which the viewer stands.
    World,
    /// The viewer's head, with which it moves.
    Head,
}

/// A run of primitives with one model matrix.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayStructure {
    /// Numbers of its triangles in the display list.
    pub triangles: Range<usize>,
    /// Numbers of its spheres in the display list.
    pub spheres: Range<usize>,
    /// Whether it stands in the room or moves with the head.
    pub frame: ModelFrame,
    /// Which of its triangles are dropped for the way they face, as PHIGS+ has it for a structure.
    pub culling: Culling,
}
