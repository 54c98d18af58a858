use pxpl5_geometry::Culling;
use std::ops::Range;

/// The coordinates in which a structure is placed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelFrame {
    /// The room, in which the viewer moves.
    World,
    /// The viewer's head, so that the structure moves with the head.
    Head,
}

/// Successive primitives that move together.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplayStructure {
    /// Range of the structure's triangles in the display list.
    pub triangles: Range<usize>,
    /// Range of the structure's spheres in the display list.
    pub spheres: Range<usize>,
    pub frame: ModelFrame,
    /// Choice of the triangles that are not drawn because of their winding. PHIGS+ has this choice for each structure.
    pub culling: Culling,
}
