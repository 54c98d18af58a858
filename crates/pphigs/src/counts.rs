//! Numbers of primitives.

/// Numbers of primitives or commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrimitiveCounts {
    /// Number of triangles, or of triangle commands.
    pub triangles: u32,
    /// Number of spheres, or of sphere commands.
    pub spheres: u32,
}

impl PrimitiveCounts {
    /// Triangles and spheres together.
    #[must_use]
    pub const fn total(self) -> u32 {
        self.triangles + self.spheres
    }
}
