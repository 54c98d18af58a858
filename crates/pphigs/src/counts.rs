/// A number of triangles and a number of spheres, or of their commands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PrimitiveCounts {
    pub triangles: u32,
    pub spheres: u32,
}

impl PrimitiveCounts {
    #[must_use]
    pub const fn total(self) -> u32 {
        self.triangles + self.spheres
    }

    /// Returns the number of vertices: three corners of each triangle, and the centre of each sphere.
    #[must_use]
    pub const fn vertices(self) -> u64 {
        3 * self.triangles as u64 + self.spheres as u64
    }
}
